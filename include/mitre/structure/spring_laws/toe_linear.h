#ifndef mitre_structure_spring_laws_toe_linear_h
#define mitre_structure_spring_laws_toe_linear_h

#include <mitre/structure/spring_laws/spring_law.h>

namespace mitre::structure
{
  /**
   * Collagen whose fibrils straighten one by one: with the strain @f$e = l/l_0 - 1@f$ and
   * the transition strain @f$e_t@f$,
   * @f[ T = \kappa l_0 \cdot \begin{cases} 0 & e < 0 \\ e^2 / (2 e_t) & e < e_t \\
   *     e - e_t/2 & e \ge e_t, \end{cases} @f]
   * which has a continuous slope; beyond the toe the stiffness is @f$\kappa@f$. @f$e_t@f$
   * is the parameter of the law, or the first one of the spring.
   */
  class ToeLinearSpring : public SpringLaw
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
    double transition_of(const Spring &spring) const;

    double transition = 0;
  };
} // namespace mitre::structure

#endif
