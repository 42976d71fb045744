#include <cmath>
#include <filesystem>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/geometry/collapsible_channel.h>
#include <mitre/io/safe_file.h>

namespace mitre::geometry
{
  void CollapsibleChannelParameters::declare_parameters(dealii::ParameterHandler &prm)
  {
    const dealii::Patterns::Double positive(1e-10);
    prm.declare_entry("Width", "1", positive, "D, of the channel [cm].");
    prm.declare_entry(
      "Upstream length", "5", positive, "L_u, of the first rigid part [cm].");
    prm.declare_entry("Elastic length", "5", positive, "L, of the elastic part [cm].");
    prm.declare_entry(
      "Downstream length", "30", positive, "L_d, of the second rigid part [cm].");
    prm.declare_entry("Plane strain modulus",
                      "6e6",
                      positive,
                      "E / (1 - nu^2) of the elastic part [dyn/cm^2].");
    prm.declare_entry("Thickness", "0.01", positive, "h, of the elastic part [cm].");
    prm.declare_entry("Spacing",
                      "0.015625",
                      positive,
                      "Distance of nodes [cm], at most that of the grid.");
    prm.declare_entry("Wall stiffness",
                      "1e7",
                      positive,
                      "Of the target points of the rigid parts [dyn/cm for each cm].");
    prm.declare_entry("Wall damping",
                      "0",
                      dealii::Patterns::Double(0),
                      "Of the target points of the rigid parts [dyn s/cm for each cm].");
    prm.declare_entry("Output",
                      "collapsible_channel/wall",
                      dealii::Patterns::Anything(),
                      "Files OUTPUT.vertex, .spring, .beam and .target are written.");
  }


  void CollapsibleChannelParameters::parse_parameters(dealii::ParameterHandler &prm)
  {
    width             = prm.get_double("Width");
    upstream_length   = prm.get_double("Upstream length");
    elastic_length    = prm.get_double("Elastic length");
    downstream_length = prm.get_double("Downstream length");
    modulus           = prm.get_double("Plane strain modulus");
    thickness         = prm.get_double("Thickness");
    spacing           = prm.get_double("Spacing");
    wall_stiffness    = prm.get_double("Wall stiffness");
    wall_damping      = prm.get_double("Wall damping");
    output            = prm.get("Output");
  }


  structure::FibreNetwork<2>
  make_collapsible_wall(const CollapsibleChannelParameters &parameters)
  {
    const unsigned int n_elastic =
      std::ceil(parameters.elastic_length / parameters.spacing - 1e-6);
    AssertThrow(n_elastic >= 4,
                base::UserError("\"Collapsible channel / Spacing\" is " +
                                std::to_string(parameters.spacing) + " cm, which is " +
                                std::to_string(n_elastic) +
                                " nodes in the elastic part; expected 4 at least."));
    const double ds                 = parameters.elastic_length / n_elastic;
    const unsigned int n_upstream   = parameters.upstream_length / ds + 1e-6;
    const unsigned int n_downstream = parameters.downstream_length / ds + 1e-6;
    const unsigned int n            = n_upstream + n_elastic + n_downstream;
    const double start              = parameters.upstream_length - n_upstream * ds;

    structure::FibreNetwork<2> network;
    network.source        = "collapsible channel";
    network.spring_source = network.source;
    for (unsigned int i = 0; i < n; ++i)
      network.nodes.emplace_back(start + (i + 0.5) * ds, parameters.width);

    // The first and the last node of the elastic part are held, and so are the others'.
    const unsigned int first = n_upstream, last = n_upstream + n_elastic - 1;
    for (unsigned int i = 0; i < n; ++i)
      if (i <= first || i >= last)
        network.targets.push_back(
          {i, parameters.wall_stiffness * ds, parameters.wall_damping * ds});
    for (unsigned int i = first; i < last; ++i)
      {
        structure::Spring spring;
        spring.nodes       = {{i, i + 1}};
        spring.stiffness   = parameters.modulus * parameters.thickness / ds;
        spring.rest_length = ds;
        network.springs.push_back(spring);
      }
    for (unsigned int i = first; i <= last; ++i)
      if (i > 0 && i + 1 < n)
        {
          structure::Beam<2> beam;
          beam.nodes = {{i - 1, i, i + 1}};
          beam.stiffness =
            parameters.modulus * std::pow(parameters.thickness, 3) / 12 / std::pow(ds, 3);
          network.beams.push_back(beam);
        }
    return network;
  }


  std::string prepare_collapsible_channel(const CollapsibleChannelParameters &parameters)
  {
    const structure::FibreNetwork<2> network = make_collapsible_wall(parameters);
    const std::filesystem::path parent =
      std::filesystem::path(parameters.output).parent_path();
    if (!parent.empty())
      io::make_folder(parent.string());
    io::write_fibres(network, parameters.output);
    std::ostringstream text;
    text << parameters.output << ": " << network.nodes.size() << " nodes, "
         << network.springs.size() << " springs of " << network.springs[0].stiffness
         << " dyn/cm, " << network.beams.size() << " beams of "
         << network.beams[0].stiffness << " dyn/cm, " << network.targets.size()
         << " target points of " << network.targets[0].stiffness << " dyn/cm\n";
    return text.str();
  }
} // namespace mitre::geometry
