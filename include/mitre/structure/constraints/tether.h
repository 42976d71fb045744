#ifndef mitre_structure_constraints_tether_h
#define mitre_structure_constraints_tether_h

#include <memory>
#include <vector>

#include <mitre/base/expression.h>
#include <mitre/base/time_table.h>
#include <mitre/structure/constraints/constraint.h>
#include <mitre/structure/vector_expression.h>

namespace mitre::structure
{
  /**
   * Springs and dampers between nodes and their target positions,
   * @f[ f = -\kappa (X - X_{target}) - \eta (U - \dot X_{target}), @f]
   * in some components or all. What f is depends on what the tether acts on:
   * | <code>Acts on</code> | f | |
   * |---|---|---|
   * | volume | density per reference volume at the nodes [dyn/cm^dim] | @f$F = f@f$ |
   * | surface | per reference area [dyn/cm^(dim-1)] | @f$G_a = \int\phi_a f\,dA@f$ |
   * | points | force on each node [dyn] | @f$G_a = f@f$ |
   *
   * The target is the reference position plus a displacement, an expression of place and
   * time or columns of a time table; its velocity is a central difference over 2e-6 s.
   *
   * An explicit time step bounds both: with a body of the fluid's density @f$\rho@f$,
   * @f$\kappa \lesssim \rho/\Delta t^2@f$ and @f$\eta \lesssim \rho/\Delta t@f$ in a
   * volume, times the width of a grid cell on a surface.
   */
  template <int dim>
  class Tether : public Constraint<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &what) override;

    void initialize(const Mesh<dim> &mesh) override;

    void reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements) override;

    unsigned int n_nodes() const override
    {
      return nodes.size();
    }

    void add_force_density(const VectorType &X,
                           const VectorType &U,
                           const double t,
                           VectorType &F) const override;

    bool has_nodal_forces() const override
    {
      return kind != Kind::volume;
    }

    bool acts_on_points() const override
    {
      return kind == Kind::points;
    }

    void add_forces(const NodalState &state, double *forces) const override;

    void set_targets(const double t, VectorType &X) const override;

    double largest_displacement(const VectorType &X, const double t) const override;

  private:
    enum class Kind : unsigned char
    {
      volume,
      surface,
      points
    };

    /// Where the point with the reference position @p s shall be.
    dealii::Point<dim> target(const dealii::Point<dim> &s, const double t) const;

    dealii::Tensor<1, dim> target_velocity(const dealii::Point<dim> &s,
                                           const double t) const;

    /// The force f of a point at x with velocity u.
    dealii::Tensor<1, dim> force(const dealii::Point<dim> &s,
                                 const dealii::Tensor<1, dim> &x,
                                 const dealii::Tensor<1, dim> &u,
                                 const double t) const;

    Kind kind = Kind::volume;

    /// Of f per cm and per cm/s.
    double stiffness = 0;
    double damping   = 0;

    /// 1 for components that are held, else 0.
    dealii::Tensor<1, dim> held;

    VectorExpression<dim> displacement;

    /// Takes the place of the expression if there is one.
    std::shared_ptr<const base::TimeTable> table;
    std::vector<unsigned int> columns;

    std::vector<int> material_ids;
    base::Expression<dim> region;
    SurfaceRegion<dim> surface;

    /// The nodes, by local number, and their reference positions.
    std::vector<unsigned int> nodes;
    std::vector<dealii::Point<dim>> reference_positions;
  };
} // namespace mitre::structure

#endif
