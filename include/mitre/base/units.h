#ifndef mitre_base_units_h
#define mitre_base_units_h

#include <string>
#include <vector>

namespace mitre::base
{
  /** One millimetre of mercury in dyn/cm^2. */
  constexpr double mmHg = 1333.22;

  /**
   * The value of one @p unit in Mitre's units, which are cm, g, s and what follows from
   * them (dyn, dyn/cm^2, cm^3): unit_in_cgs("mmHg") = 1333.22, unit_in_cgs("mm") = 0.1.
   * Throws UserError, which lists the known units, for any other name.
   */
  double unit_in_cgs(const std::string &unit);

  /**
   * What a unit that unit_in_cgs() knows measures: "number" (of "1"), "time", "length",
   * "area", "volume", "flow", "velocity", "mass", "force", "pressure" or
   * "force per length".
   */
  std::string quantity_of_unit(const std::string &unit);

  /** The names that unit_in_cgs() knows. */
  std::vector<std::string> known_units();
} // namespace mitre::base

#endif
