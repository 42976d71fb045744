#ifndef mitre_structure_constraints_target_points_h
#define mitre_structure_constraints_target_points_h

#include <vector>

#include <mitre/structure/constraints/constraint.h>
#include <mitre/structure/fibre_network.h>
#include <mitre/structure/vector_expression.h>

namespace mitre::structure
{
  /**
   * The target points of a fibre network, each with its own stiffness and damping:
   * @f$f = -\kappa (X - X_{target}) - \eta (U - \dot X_{target})@f$ [dyn]. The target is
   * the node's place at rest plus a displacement that is the same expression for all; its
   * velocity is a central difference over 2e-6 s. No plugin: a network brings it along.
   */
  template <int dim>
  class TargetPoints : public Constraint<dim>
  {
  public:
    TargetPoints(std::vector<TargetPoint> targets,
                 const VectorExpression<dim> &displacement);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &what) override;

    void reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements) override;

    unsigned int n_nodes() const override
    {
      return owned.size();
    }

    void add_force_density(const VectorType &X,
                           const VectorType &U,
                           const double t,
                           VectorType &F) const override;

    bool acts_on_points() const override
    {
      return true;
    }

    bool has_nodal_forces() const override
    {
      return true;
    }

    void add_forces(const NodalState &state, double *forces) const override;

    void set_targets(const double t, VectorType &X) const override;

    double largest_displacement(const VectorType &X, const double t) const override;

  private:
    dealii::Point<dim> target(const dealii::Point<dim> &s, const double t) const;

    const std::vector<TargetPoint> targets;
    const VectorExpression<dim> displacement;

    /// Those on owned nodes, which have local numbers, and their places at rest.
    std::vector<TargetPoint> owned;
    std::vector<dealii::Point<dim>> reference_positions;
  };
} // namespace mitre::structure

#endif
