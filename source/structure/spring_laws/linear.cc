#include <mitre/structure/spring_laws/linear.h>

namespace mitre::structure
{
  void LinearSpring::declare_parameters(dealii::ParameterHandler &)
  {
  }


  void LinearSpring::parse_parameters(dealii::ParameterHandler &, const std::string &)
  {
  }


  double LinearSpring::tension(const Spring &spring, const double length) const
  {
    return spring.stiffness * (length - spring.rest_length);
  }


  double LinearSpring::energy(const Spring &spring, const double length) const
  {
    const double extension = length - spring.rest_length;
    return 0.5 * spring.stiffness * extension * extension;
  }
} // namespace mitre::structure
