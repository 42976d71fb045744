// A letter too many, too few, wrong or swapped with its neighbour is one edit each, and
// case does not count. Names that share little with what was written are not suggested:
// at most a third of the letters may differ.

#include <iostream>

#include <mitre/base/nearest_name.h>

using namespace mitre::base;

int
main()
{
  std::cout << edit_distance("tether", "tethers") << ' '
            << edit_distance("tether", "ether") << ' '
            << edit_distance("tether", "tather") << ' '
            << edit_distance("tether", "tehter") << ' ' << edit_distance("IB_4", "ib_4")
            << ' ' << edit_distance("", "abc") << ' '
            << edit_distance("kitten", "sitting") << std::endl;

  const std::vector<std::string> laws = {"neo-Hookean", "Mooney-Rivlin", "Guccione"};
  for (const std::string name : {"neo-hookian", "Mooney-Rivlni", "Gucione", "Fung", ""})
    std::cout << "'" << name << "' -> '" << nearest_name(name, laws) << "'" << std::endl;
  std::cout << suggest_name("neohookean", laws) << std::endl;
  std::cout << suggest_name("Fung", laws) << std::endl;
  std::cout << suggest_name("Fung", {}) << std::endl;
}
