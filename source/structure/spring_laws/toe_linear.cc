#include <mitre/structure/spring_laws/toe_linear.h>

namespace mitre::structure
{
  void ToeLinearSpring::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "Transition strain",
      "0.05",
      dealii::Patterns::Double(0),
      "Strain l/l_0 - 1 at which the toe ends and the tension becomes "
      "linear, unless a spring has its own after the force function index "
      "[1].");
  }


  void ToeLinearSpring::parse_parameters(dealii::ParameterHandler &prm,
                                         const std::string &)
  {
    transition = prm.get_double("Transition strain");
  }


  double ToeLinearSpring::transition_of(const Spring &spring) const
  {
    return spring.parameters.empty() ? transition : spring.parameters[0];
  }


  double ToeLinearSpring::tension(const Spring &spring, const double length) const
  {
    const double e   = length / spring.rest_length - 1;
    const double toe = transition_of(spring);
    return spring.stiffness * spring.rest_length *
           (e <= 0 ? 0 : (e < toe ? e * e / (2 * toe) : e - 0.5 * toe));
  }


  double ToeLinearSpring::energy(const Spring &spring, const double length) const
  {
    const double e   = length / spring.rest_length - 1;
    const double toe = transition_of(spring);
    return spring.stiffness * spring.rest_length * spring.rest_length *
           (e <= 0
              ? 0
              : (e < toe ? e * e * e / (6 * toe) : 0.5 * e * (e - toe) + toe * toe / 6));
  }
} // namespace mitre::structure
