#include <mitre/fluid/boundary_conditions/interface.h>
#include <mitre/fluid/boundary_conditions/pressure.h>
#include <mitre/fluid/boundary_conditions/velocity.h>
#include <mitre/fluid/boundary_conditions/wall.h>

namespace mitre::fluid
{
  template <int dim>
  const base::PluginRegistry<BoundaryCondition<dim>> &boundary_condition_registry()
  {
    static const auto registry = [] {
      base::PluginRegistry<BoundaryCondition<dim>> conditions("boundary condition type");
      conditions.template add<WallCondition<dim>>("wall", "no slip at a wall at rest");
      conditions.template add<VelocityCondition<dim>>(
        "velocity", "velocity as a function of place and time");
      conditions.template add<PressureCondition<dim>>(
        "pressure", "open boundary: given normal traction, zero tangential velocity");
      conditions.template add<SlipCondition<dim>>(
        "slip", "symmetry: zero normal velocity, zero tangential traction");
      return conditions;
    }();
    return registry;
  }

  template const base::PluginRegistry<BoundaryCondition<2>> &
  boundary_condition_registry();
  template const base::PluginRegistry<BoundaryCondition<3>> &
  boundary_condition_registry();
} // namespace mitre::fluid
