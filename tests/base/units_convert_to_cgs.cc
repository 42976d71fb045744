// One unit of each kind in cm, g, s: 1 mmHg = 1333.22 dyn/cm^2, 1 kPa = 1e3 N/m^2 =
// 1e3 * 1e5 dyn / 1e4 cm^2 = 1e4 dyn/cm^2, 6 L/min = 6000 mL / 60 s = 100 mL/s.

#include <iostream>

#include <mitre/base/exceptions.h>
#include <mitre/base/units.h>

using namespace mitre::base;

int
main()
{
  std::cout << mmHg << ' ' << unit_in_cgs("mmHg") << ' ' << unit_in_cgs("kPa") << ' '
            << 6 * unit_in_cgs("L/min") << ' ' << unit_in_cgs("mm^2") << ' '
            << unit_in_cgs("ms") << ' ' << unit_in_cgs("N") << ' '
            << unit_in_cgs("dyn/cm^2") << std::endl;
  try
    {
      unit_in_cgs("mmhg");
    }
  catch (const UserError &error)
    {
      std::cout << std::string(error.what()).substr(0, 54) << std::endl;
    }
}
