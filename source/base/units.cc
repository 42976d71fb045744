#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <utility>

#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/base/units.h>

namespace mitre::base
{
  namespace
  {
    const std::vector<std::pair<std::string, double>> units = {
      {"1", 1.},           {"s", 1.},     {"ms", 1e-3},  {"cm", 1.},
      {"mm", 0.1},         {"m", 100.},   {"cm^2", 1.},  {"mm^2", 0.01},
      {"cm^3", 1.},        {"mL", 1.},    {"mL/s", 1.},  {"cm^3/s", 1.},
      {"L/min", 1e3 / 60}, {"cm/s", 1.},  {"m/s", 100.}, {"g", 1.},
      {"dyn", 1.},         {"N", 1e5},    {"mN", 1e2},   {"dyn/cm^2", 1.},
      {"Pa", 10.},         {"kPa", 1e4},  {"MPa", 1e7},  {"dyn/cm", 1.},
      {"N/m", 1e3},        {"mmHg", mmHg}};
  }


  double unit_in_cgs(const std::string &unit)
  {
    const auto found = std::find_if(
      units.begin(), units.end(), [&](const auto &entry) { return entry.first == unit; });
    AssertThrow(
      found != units.end(),
      UserError("There is no unit '" + unit + "'. " + suggest_name(unit, known_units())));
    return found->second;
  }


  std::vector<std::string> known_units()
  {
    std::vector<std::string> names;
    for (const auto &entry : units)
      names.push_back(entry.first);
    return names;
  }
} // namespace mitre::base
