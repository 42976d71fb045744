// A registry makes the plugin of the given name with the given arguments, declares its
// parameters where it is told to, and says what there is when the name is unknown. The
// spring's energy is 1/2 k x^2 = 1/2 * 3 * 4 = 6 at x = 2 with k = 3; the constant's
// is 7.

#include <deal.II/base/patterns.h>

#include <iostream>
#include <sstream>

#include <mitre/base/plugin_registry.h>

using namespace mitre::base;

struct Law
{
  virtual ~Law()                              = default;
  virtual double energy(const double x) const = 0;
};

struct Spring : Law
{
  explicit Spring(const double stiffness)
    : stiffness(stiffness)
  {
  }

  static void declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Stiffness", "3", dealii::Patterns::Double(0.), "in dyn/cm");
  }

  double energy(const double x) const override
  {
    return 0.5 * stiffness * x * x;
  }

  double stiffness;
};

struct Constant : Law
{
  double energy(const double) const override
  {
    return 7.;
  }
};

int
main()
{
  PluginRegistry<Law, double> laws("law");
  laws.add<Spring>("linear spring", "W = k x^2 / 2");
  laws.add(
    "constant",
    "W = 7",
    [](const double) { return std::make_unique<Constant>(); },
    [](dealii::ParameterHandler &) {});

  std::cout << laws.pattern() << std::endl << laws.help() << std::endl;
  std::cout << laws.contains("constant") << laws.contains("spring") << std::endl;
  for (const std::string &name : laws.names())
    std::cout << laws.create(name, 3.)->energy(2.) << std::endl;

  dealii::ParameterHandler prm;
  prm.enter_subsection("Law");
  laws.declare_parameters("linear spring", prm);
  std::cout << prm.get_double("Stiffness") << std::endl;

  try
    {
      laws.create("linaer spring", 3.);
    }
  catch (const UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
  try
    {
      laws.add<Spring>("constant", "once more");
    }
  catch (const dealii::ExceptionBase &error)
    {
      std::ostringstream text;
      error.print_info(text);
      std::cout << (text.str().find("'constant' is registered twice") !=
                    std::string::npos)
                << std::endl;
    }
}
