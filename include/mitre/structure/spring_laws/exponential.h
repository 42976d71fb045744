#ifndef mitre_structure_spring_laws_exponential_h
#define mitre_structure_spring_laws_exponential_h

#include <mitre/structure/spring_laws/spring_law.h>

namespace mitre::structure
{
  /**
   * @f$T = \frac{\kappa l_0}{b} (e^{b e} - 1)@f$ with the strain
   * @f$e = l/l_0 - 1@f$ (Fung, Am. J. Physiol. 213 (1967) 1532): @f$\kappa@f$ is the
   * stiffness at rest, and @f$dT/de@f$ grows with @f$T@f$. b is the parameter of the law,
   * or the first one of the spring.
   */
  class ExponentialSpring : public SpringLaw
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &what) override;

    unsigned int n_spring_parameters() const override
    {
      return 1;
    }

    bool needs_rest_length() const override
    {
      return true;
    }

    double tension(const Spring &spring, const double length) const override;

    double energy(const Spring &spring, const double length) const override;

  private:
    double exponent_of(const Spring &spring) const;

    double exponent = 1;
  };
} // namespace mitre::structure

#endif
