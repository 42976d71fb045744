#include <cmath>

#include <mitre/structure/spring_laws/exponential.h>

namespace mitre::structure
{
  void ExponentialSpring::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Exponent",
                      "10",
                      dealii::Patterns::Double(0),
                      "b in T = kappa l_0 / b (exp(b (l/l_0 - 1)) - 1), unless a spring "
                      "has its own after the force function index [1]. 0: linear.");
  }


  void ExponentialSpring::parse_parameters(dealii::ParameterHandler &prm,
                                           const std::string &)
  {
    exponent = prm.get_double("Exponent");
  }


  double ExponentialSpring::exponent_of(const Spring &spring) const
  {
    return spring.parameters.empty() ? exponent : spring.parameters[0];
  }


  double ExponentialSpring::tension(const Spring &spring, const double length) const
  {
    const double b = exponent_of(spring);
    const double e = length / spring.rest_length - 1;
    return spring.stiffness * spring.rest_length * (b == 0 ? e : std::expm1(b * e) / b);
  }


  double ExponentialSpring::energy(const Spring &spring, const double length) const
  {
    const double b = exponent_of(spring);
    const double e = length / spring.rest_length - 1;
    return spring.stiffness * spring.rest_length * spring.rest_length *
           (b == 0 ? 0.5 * e * e : (std::expm1(b * e) / b - e) / b);
  }
} // namespace mitre::structure
