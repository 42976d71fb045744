#ifndef mitre_fluid_boundary_conditions_wall_h
#define mitre_fluid_boundary_conditions_wall_h

#include <mitre/fluid/boundary_conditions/interface.h>

namespace mitre::fluid
{
  /// No slip at a wall at rest: u = 0.
  template <int dim>
  class WallCondition : public BoundaryCondition<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm)
    {
      FeedbackParameters::declare_parameters(prm);
    }

    void parse_parameters(dealii::ParameterHandler &prm, const std::string &) override
    {
      feedback_parameters.parse_parameters(prm);
    }

    grid::BoundaryKind kind() const override
    {
      return grid::BoundaryKind::velocity;
    }

    FeedbackParameters feedback() const override
    {
      return feedback_parameters;
    }

  private:
    FeedbackParameters feedback_parameters;
  };


  /// Symmetry: no flow through the boundary and no tangential traction.
  template <int dim>
  class SlipCondition : public BoundaryCondition<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &)
    {
    }

    void parse_parameters(dealii::ParameterHandler &, const std::string &) override
    {
    }

    grid::BoundaryKind kind() const override
    {
      return grid::BoundaryKind::slip;
    }
  };
} // namespace mitre::fluid

#endif
