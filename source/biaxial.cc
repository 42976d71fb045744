#include <deal.II/base/parameter_handler.h>

#include <exception>
#include <iostream>
#include <string>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameter_reference.h>
#include <mitre/base/parameters.h>
#include <mitre/biaxial/biaxial_test.h>

namespace
{
  const char *usage =
    "Usage: mitre-biaxial FILE.prm       stretch and fit the laws that the "
    "parameter file names\n"
    "       mitre-biaxial --print-parameters [FILE.prm]\n"
    "                                    print all parameters with "
    "defaults and help texts\n"
    "       mitre-biaxial --parameter-reference\n"
    "                                    the same as Markdown\n"
    "       mitre-biaxial --help         print this text\n"
    "\n"
    "Writes tables of stresses over stretches (CSV) to the output folder; "
    "scripts/plot_biaxial\n"
    "draws them.\n";
}


int
main(int argc, char **argv)
{
  using mitre::biaxial::BiaxialParameters;
  try
    {
      const std::string argument = argc > 1 ? argv[1] : "";
      if (argc != 2 && !(argc == 3 && argument == "--print-parameters"))
        {
          std::cerr << usage;
          return 1;
        }
      if (argument == "--help" || argument == "-h")
        {
          std::cout << usage;
          return 0;
        }

      dealii::ParameterHandler prm;
      if (argument == "--print-parameters" || argument == "--parameter-reference")
        {
          if (argc == 3)
            mitre::base::parse_parameter_file(
              prm, argv[2], &BiaxialParameters::declare_parameters);
          else
            mitre::base::parse_parameter_text(prm,
                                              BiaxialParameters::example(),
                                              "example",
                                              &BiaxialParameters::declare_parameters);
          if (argument == "--print-parameters")
            prm.print_parameters(std::cout, dealii::ParameterHandler::PRM);
          else
            mitre::base::write_parameter_reference(std::cout, prm, 3);
          return 0;
        }
      if (!argument.empty() && argument[0] == '-')
        throw mitre::base::UserError("Unknown option '" + argument + "'; try --help.");

      mitre::base::parse_parameter_file(
        prm, argument, &BiaxialParameters::declare_parameters);
      BiaxialParameters parameters;
      parameters.parse_parameters(prm);
      std::cout << mitre::biaxial::run_biaxial_test(parameters);
      return 0;
    }
  catch (const std::exception &exception)
    {
      std::cerr << "mitre-biaxial: " << exception.what() << '\n';
      return 1;
    }
}
