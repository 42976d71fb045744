#include <mitre/base/exceptions.h>
#include <mitre/fluid/boundary_conditions/velocity.h>

namespace mitre::fluid
{
  using namespace dealii;

  namespace
  {
    const char *const component_names[3] = {"Velocity x", "Velocity y", "Velocity z"};
  }


  template <int dim>
  void VelocityCondition<dim>::declare_parameters(ParameterHandler &prm)
  {
    for (unsigned int c = 0; c < dim; ++c)
      prm.declare_entry(component_names[c],
                        "0",
                        Patterns::Anything(),
                        "Component of the velocity [cm/s], an expression of x, y, z [cm] "
                        "and t [s].");
    FeedbackParameters::declare_parameters(prm);
  }


  template <int dim>
  void VelocityCondition<dim>::parse_parameters(ParameterHandler &prm,
                                                const std::string &name)
  {
    feedback_parameters.parse_parameters(prm);
    components.clear();
    for (unsigned int c = 0; c < dim; ++c)
      components.emplace_back(prm.get(component_names[c]),
                              "Boundary conditions / " + name + " / " +
                                component_names[c]);
  }


  template class VelocityCondition<2>;
  template class VelocityCondition<3>;
} // namespace mitre::fluid
