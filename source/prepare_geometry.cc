#include <deal.II/base/parameter_handler.h>

#include <exception>
#include <iostream>
#include <string>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameter_reference.h>
#include <mitre/base/parameters.h>
#include <mitre/geometry/collapsible_channel.h>
#include <mitre/geometry/fibre_surface.h>
#include <mitre/geometry/mitral_valve.h>
#include <mitre/geometry/prosthesis.h>

namespace
{
  const char *usage =
    "Usage: mitre-geometry FILE.prm       write the meshes that the "
    "parameter file asks for\n"
    "       mitre-geometry --print-parameters\n"
    "                                     print all parameters with "
    "defaults and help texts\n"
    "       mitre-geometry --parameter-reference\n"
    "                                     the same as Markdown\n"
    "       mitre-geometry --help         print this text\n"
    "\n"
    "Of a mitral valve, leaflets.msh, chordae.msh, disc.msh and "
    "tube.msh (gmsh, ASCII, version\n2.2) and summary.txt in the output "
    "folder; of a prosthesis, a\nfibre surface and a collapsible channel files of fibres "
    "(.vertex, .spring, .beam, .target).\nLengths are in cm.\n";


  void declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "Geometry",
      "mitral valve",
      dealii::Patterns::Selection(
        "mitral valve|prosthesis|fibre surface|collapsible channel"),
      "What to make. 'mitral valve': meshes, by all but the following three "
      "subsections; 'prosthesis': a chorded prosthesis as fibres; 'fibre surface': "
      "fibres that span the quadrilaterals "
      "of a mesh; 'collapsible channel': the upper wall of a channel as "
      "fibres, a part of it elastic.");
    prm.enter_subsection("Prosthesis");
    mitre::geometry::ProsthesisParameters::declare_parameters(prm);
    prm.leave_subsection();
    prm.enter_subsection("Fibre surface");
    mitre::geometry::FibreSurfaceParameters::declare_parameters(prm);
    prm.leave_subsection();
    prm.enter_subsection("Collapsible channel");
    mitre::geometry::CollapsibleChannelParameters::declare_parameters(prm);
    prm.leave_subsection();
    mitre::geometry::MitralValveParameters::declare_parameters(prm);
  }


  std::string prepare(dealii::ParameterHandler &prm)
  {
    const std::string geometry = prm.get("Geometry");
    if (geometry == "prosthesis")
      {
        mitre::geometry::ProsthesisParameters parameters;
        prm.enter_subsection("Prosthesis");
        parameters.parse_parameters(prm);
        prm.leave_subsection();
        return mitre::geometry::prepare_prosthesis(parameters);
      }
    if (geometry == "fibre surface")
      {
        mitre::geometry::FibreSurfaceParameters parameters;
        prm.enter_subsection("Fibre surface");
        parameters.parse_parameters(prm);
        prm.leave_subsection();
        return mitre::geometry::prepare_fibre_surface(parameters);
      }
    if (geometry == "collapsible channel")
      {
        mitre::geometry::CollapsibleChannelParameters parameters;
        prm.enter_subsection("Collapsible channel");
        parameters.parse_parameters(prm);
        prm.leave_subsection();
        return mitre::geometry::prepare_collapsible_channel(parameters);
      }
    mitre::geometry::MitralValveParameters parameters;
    parameters.parse_parameters(prm);
    return mitre::geometry::prepare_mitral_valve(parameters);
  }
} // namespace


int
main(int argc, char **argv)
{
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
          declare_parameters(prm);
          prm.print_parameters(std::cout, dealii::ParameterHandler::PRM);
          return 0;
        }
      if (argument == "--parameter-reference")
        {
          declare_parameters(prm);
          mitre::base::write_parameter_reference(std::cout, prm, 3);
          return 0;
        }
      if (!argument.empty() && argument[0] == '-')
        throw mitre::base::UserError("Unknown option '" + argument + "'; try --help.");

      mitre::base::parse_parameter_file(prm, argument, &declare_parameters);
      std::cout << prepare(prm);
      return 0;
    }
  catch (const std::exception &exception)
    {
      std::cerr << "mitre-geometry: " << exception.what() << '\n';
      return 1;
    }
}
