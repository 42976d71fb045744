#include <deal.II/base/parameter_handler.h>

#include <exception>
#include <iostream>
#include <string>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameter_reference.h>
#include <mitre/base/parameters.h>
#include <mitre/geometry/mitral_valve.h>

namespace
{
  const char *usage = "Usage: mitre-geometry FILE.prm       write the meshes that the "
                      "parameter file asks for\n"
                      "       mitre-geometry --print-parameters\n"
                      "                                     print all parameters with "
                      "defaults and help texts\n"
                      "       mitre-geometry --parameter-reference\n"
                      "                                     the same as Markdown\n"
                      "       mitre-geometry --help         print this text\n"
                      "\n"
                      "Writes leaflets.msh, chordae.msh, disc.msh and tube.msh (gmsh, "
                      "ASCII, version 2.2) and\n"
                      "summary.txt to the output folder. Lengths are in cm.\n";
}


int
main(int argc, char **argv)
{
  using mitre::geometry::MitralValveParameters;
  try
    {
      if (argc != 2)
        {
          std::cerr << usage;
          return 1;
        }
      const std::string argument = argv[1];
      if (argument == "--help" || argument == "-h")
        {
          std::cout << usage;
          return 0;
        }

      dealii::ParameterHandler prm;
      if (argument == "--print-parameters")
        {
          MitralValveParameters::declare_parameters(prm);
          prm.print_parameters(std::cout, dealii::ParameterHandler::PRM);
          return 0;
        }
      if (argument == "--parameter-reference")
        {
          MitralValveParameters::declare_parameters(prm);
          mitre::base::write_parameter_reference(std::cout, prm, 3);
          return 0;
        }
      if (!argument.empty() && argument[0] == '-')
        throw mitre::base::UserError("Unknown option '" + argument + "'; try --help.");

      mitre::base::parse_parameter_file(
        prm, argument, &MitralValveParameters::declare_parameters);
      MitralValveParameters parameters;
      parameters.parse_parameters(prm);
      std::cout << mitre::geometry::prepare_mitral_valve(parameters);
      return 0;
    }
  catch (const std::exception &exception)
    {
      std::cerr << "mitre-geometry: " << exception.what() << '\n';
      return 1;
    }
}
