#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <string>

#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/base/units.h>

namespace mitre::base
{
  namespace
  {
    struct Unit
    {
      std::string name;
      double in_cgs;
      std::string quantity;
    };

    const std::vector<Unit> units = {{"1", 1., "number"},
                                     {"s", 1., "time"},
                                     {"ms", 1e-3, "time"},
                                     {"cm", 1., "length"},
                                     {"mm", 0.1, "length"},
                                     {"m", 100., "length"},
                                     {"cm^2", 1., "area"},
                                     {"mm^2", 0.01, "area"},
                                     {"cm^3", 1., "volume"},
                                     {"mL", 1., "volume"},
                                     {"mL/s", 1., "flow"},
                                     {"cm^3/s", 1., "flow"},
                                     {"L/min", 1e3 / 60, "flow"},
                                     {"cm/s", 1., "velocity"},
                                     {"m/s", 100., "velocity"},
                                     {"g", 1., "mass"},
                                     {"dyn", 1., "force"},
                                     {"N", 1e5, "force"},
                                     {"mN", 1e2, "force"},
                                     {"dyn/cm^2", 1., "pressure"},
                                     {"Pa", 10., "pressure"},
                                     {"kPa", 1e4, "pressure"},
                                     {"MPa", 1e7, "pressure"},
                                     {"dyn/cm", 1., "force per length"},
                                     {"N/m", 1e3, "force per length"},
                                     {"mmHg", mmHg, "pressure"}};


    const Unit &find_unit(const std::string &unit)
    {
      const auto found = std::find_if(units.begin(), units.end(), [&](const Unit &entry) {
        return entry.name == unit;
      });
      AssertThrow(found != units.end(),
                  UserError("There is no unit '" + unit + "'. " +
                            suggest_name(unit, known_units())));
      return *found;
    }
  } // namespace


  double unit_in_cgs(const std::string &unit)
  {
    return find_unit(unit).in_cgs;
  }


  std::string quantity_of_unit(const std::string &unit)
  {
    return find_unit(unit).quantity;
  }


  std::vector<std::string> known_units()
  {
    std::vector<std::string> names;
    for (const Unit &entry : units)
      names.push_back(entry.name);
    return names;
  }
} // namespace mitre::base
