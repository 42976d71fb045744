#ifndef mitre_structure_constraints_tether_h
#define mitre_structure_constraints_tether_h

#include <vector>

#include <mitre/base/expression.h>
#include <mitre/structure/constraints/constraint.h>

namespace mitre::structure
{
  /**
   * Springs and dampers between nodes and their target positions,
   * @f[ F = -\kappa (X - X_{target}) - \eta U, @f]
   * per reference volume. The target is the reference position.
   *
   * An explicit time step bounds both: with a body of the fluid's density @f$\rho@f$,
   * @f$\kappa \lesssim \rho/\Delta t^2@f$ and @f$\eta \lesssim \rho/\Delta t@f$.
   */
  template <int dim>
  class Tether : public Constraint<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &what) override;

    void reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements) override;

    unsigned int n_nodes() const override
    {
      return nodes.size();
    }

    void add_force_density(const VectorType &X,
                           const VectorType &U,
                           const double t,
                           VectorType &F) const override;

    double largest_displacement(const VectorType &X, const double t) const override;

  private:
    dealii::Point<dim> target(const unsigned int i, const double t) const;

    /// [dyn/cm^(dim+1)]
    double stiffness = 0;

    /// [dyn s/cm^(dim+1)]
    double damping = 0;

    std::vector<int> material_ids;
    base::Expression<dim> region;

    /// The nodes, by local number, and their reference positions.
    std::vector<unsigned int> nodes;
    std::vector<dealii::Point<dim>> reference_positions;
  };
} // namespace mitre::structure

#endif
