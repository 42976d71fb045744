#ifndef mitre_structure_spring_laws_spring_law_h
#define mitre_structure_spring_laws_spring_law_h

#include <deal.II/base/parameter_handler.h>

#include <string>

#include <mitre/structure/fibre_network.h>

namespace mitre::structure
{
  /**
   * Tension of a spring as a function of its length. Below the rest length it is a
   * pressure (negative) or zero, as the law has it; whether a part takes pressures at all
   * is not the law's business.
   */
  class SpringLaw
  {
  public:
    virtual ~SpringLaw() = default;

    /// @param what names the law in messages: "Part chord, spring law collagen"
    virtual void parse_parameters(dealii::ParameterHandler &prm,
                                  const std::string &what) = 0;

    /// Number of values that a spring may have beside stiffness and rest length.
    virtual unsigned int n_spring_parameters() const
    {
      return 0;
    }

    /// Whether the tension is a function of the strain, so that there must be a rest
    /// length.
    virtual bool needs_rest_length() const = 0;

    /// [dyn] at @p length [cm]
    virtual double tension(const Spring &spring, const double length) const = 0;

    /// The integral of the tension from the rest length on [erg].
    virtual double energy(const Spring &spring, const double length) const = 0;
  };
} // namespace mitre::structure

#endif
