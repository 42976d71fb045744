#ifndef mitre_structure_spring_laws_linear_h
#define mitre_structure_spring_laws_linear_h

#include <mitre/structure/spring_laws/spring_law.h>

namespace mitre::structure
{
  /// @f$T = \kappa (l - l_0)@f$, with any rest length, 0 too.
  class LinearSpring : public SpringLaw
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &what) override;

    bool needs_rest_length() const override
    {
      return false;
    }

    double tension(const Spring &spring, const double length) const override;

    double energy(const Spring &spring, const double length) const override;
  };
} // namespace mitre::structure

#endif
