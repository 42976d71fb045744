#ifndef mitre_fluid_boundary_conditions_velocity_h
#define mitre_fluid_boundary_conditions_velocity_h

#include <mitre/base/expression.h>
#include <mitre/fluid/boundary_conditions/interface.h>

namespace mitre::fluid
{
  /// A velocity that is a function of place and time.
  template <int dim>
  class VelocityCondition : public BoundaryCondition<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);
    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name) override;

    grid::BoundaryKind kind() const override
    {
      return grid::BoundaryKind::velocity;
    }

    double velocity(const dealii::Point<dim> &x,
                    const unsigned int c,
                    const double t) const override
    {
      return components[c].value(x, t);
    }

    bool velocity_is_zero() const override
    {
      return false;
    }

    FeedbackParameters feedback() const override
    {
      return feedback_parameters;
    }

  private:
    std::vector<base::Expression<dim>> components;
    FeedbackParameters feedback_parameters;
  };
} // namespace mitre::fluid

#endif
