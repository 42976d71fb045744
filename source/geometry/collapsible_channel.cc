#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>

#include <mitre/base/csv_table.h>
#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
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
                      "Distance of nodes in the elastic part [cm], at most that of the "
                      "grid about it.");
    prm.declare_entry(
      "Rigid spacing",
      "0.03125",
      positive,
      "Distance of nodes in the rigid parts [cm], at most that of the grid "
      "about them.");
    prm.declare_entry(
      "Elastic part",
      "fibres",
      dealii::Patterns::Selection("fibres|finite elements"),
      "fibres: springs and beams; finite elements: one layer of quadratic "
      "quadrilaterals, two spacings long.");
    prm.declare_entry("Clamped length",
                      "0.25",
                      positive,
                      "How far the elastic part goes on, held, into the rigid ones [cm]. "
                      "Those of a mesh are held by a constraint of the run.");
    prm.declare_entry(
      "Start shape",
      "",
      base::InputFile(),
      "Where fibres of the elastic part are at the start, stretched or "
      "not: comma-separated values with the columns s, x, y, as in "
      "\"s [cm],x [cm],y [cm]\", s along the straight wall. Empty: straight.");
    prm.declare_entry(
      "Wall stiffness", "1e7", positive, "Of the target points [dyn/cm for each cm].");
    prm.declare_entry("Wall damping",
                      "0",
                      dealii::Patterns::Double(0),
                      "Of the target points [dyn s/cm for each cm].");
    prm.declare_entry(
      "Elastic damping",
      "0",
      dealii::Patterns::Double(0),
      "Of a drag against any motion of the fibres of the elastic part [dyn "
      "s/cm for each cm]: steady states stay what they are, and come sooner.");
    prm.declare_entry("Output",
                      "collapsible_channel/wall",
                      dealii::Patterns::Anything(),
                      "The elastic part goes to OUTPUT.vertex, .spring, .beam and "
                      ".target, or to OUTPUT.msh, the rigid ones to OUTPUT_rigid.vertex "
                      "and .target.");
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
    rigid_spacing     = prm.get_double("Rigid spacing");
    finite_elements   = prm.get("Elastic part") == "finite elements";
    clamped_length    = prm.get_double("Clamped length");
    start_shape       = prm.get("Start shape");
    wall_stiffness    = prm.get_double("Wall stiffness");
    wall_damping      = prm.get_double("Wall damping");
    elastic_damping   = prm.get_double("Elastic damping");
    output            = prm.get("Output");
  }


  namespace
  {
    /// Pieces of the elastic part and of each clamped end, and their size.
    struct Pieces
    {
      Pieces(const CollapsibleChannelParameters &parameters, const double largest_size)
        : n_elastic(std::ceil(parameters.elastic_length / largest_size - 1e-6))
        , size(parameters.elastic_length / n_elastic)
        , n_clamped(std::ceil(parameters.clamped_length / size - 1e-6))
        , n(n_elastic + 2 * n_clamped)
        , start(parameters.upstream_length - n_clamped * size)
      {
      }

      const unsigned int n_elastic;
      const double size;
      const unsigned int n_clamped, n;
      const double start;
    };


    /// Those between nodes, or elements.
    Pieces pieces_of(const CollapsibleChannelParameters &parameters)
    {
      return {parameters,
              parameters.finite_elements ? 2 * parameters.spacing : parameters.spacing};
    }


    /// Move nodes of the elastic part to where the start shape has them, linear between
    /// its points.
    void move_to_start_shape(const CollapsibleChannelParameters &parameters,
                             std::vector<dealii::Point<2>> &nodes)
    {
      const base::CsvTable table(parameters.start_shape, 3, "s [cm],x [cm],y [cm]");
      std::array<const std::vector<double> *, 3> columns;
      for (unsigned int c = 0; c < 3; ++c)
        {
          const std::string name(1, "sxy"[c]);
          const auto found = std::find(table.names.begin(), table.names.end(), name);
          AssertThrow(found != table.names.end(),
                      base::UserError(parameters.start_shape + ": there is no column \"" +
                                      name + "\"; expected s, x and y."));
          columns[c] = &table.values[found - table.names.begin()];
        }
      const std::vector<double> &s = *columns[0];
      const double begin           = parameters.upstream_length,
                   end             = begin + parameters.elastic_length;
      AssertThrow(
        s.size() > 1 && std::abs(s.front() - begin) < 1e-6 &&
          std::abs(s.back() - end) < 1e-6 && std::is_sorted(s.begin(), s.end()),
        base::UserError(parameters.start_shape +
                        ": expected s to rise from the beginning of the elastic "
                        "part, " +
                        std::to_string(begin) + " cm, to its end, " +
                        std::to_string(end) + " cm."));
      for (dealii::Point<2> &node : nodes)
        if (node[0] > begin && node[0] < end)
          {
            const std::size_t i = std::max<std::ptrdiff_t>(
              1, std::lower_bound(s.begin(), s.end() - 1, node[0]) - s.begin());
            const double share = (node[0] - s[i - 1]) / (s[i] - s[i - 1]);
            for (unsigned int d = 0; d < 2; ++d)
              node[d] =
                (1 - share) * (*columns[d + 1])[i - 1] + share * (*columns[d + 1])[i];
          }
    }
  } // namespace


  structure::FibreNetwork<2>
  make_elastic_wall(const CollapsibleChannelParameters &parameters)
  {
    const Pieces pieces = pieces_of(parameters);
    AssertThrow(pieces.n_elastic >= 4,
                base::UserError("\"Collapsible channel / Spacing\" is " +
                                std::to_string(parameters.spacing) + " cm, which is " +
                                std::to_string(pieces.n_elastic) +
                                " nodes in the elastic part; expected 4 at least."));
    const double ds               = pieces.size;
    const double spring_stiffness = parameters.modulus * parameters.thickness / ds;

    structure::FibreNetwork<2> network;
    network.source        = "collapsible channel";
    network.spring_source = network.source;
    for (unsigned int i = 0; i < pieces.n; ++i)
      network.nodes.emplace_back(pieces.start + (i + 0.5) * ds, parameters.width);
    if (!parameters.start_shape.empty())
      move_to_start_shape(parameters, network.nodes);

    const unsigned int first = pieces.n_clamped,
                       last  = pieces.n_clamped + pieces.n_elastic - 1;
    for (unsigned int i = 0; i < pieces.n; ++i)
      if (i <= first || i >= last)
        network.targets.push_back(
          {i,
           i == first || i == last ? spring_stiffness : parameters.wall_stiffness * ds,
           parameters.wall_damping * ds});
    if (parameters.elastic_damping > 0)
      for (unsigned int i = first + 1; i < last; ++i)
        network.targets.push_back({i, 0, parameters.elastic_damping * ds});
    for (unsigned int i = first; i < last; ++i)
      {
        structure::Spring spring;
        spring.nodes       = {{i, i + 1}};
        spring.stiffness   = spring_stiffness;
        spring.rest_length = ds;
        network.springs.push_back(spring);
      }
    for (unsigned int i = first; i <= last; ++i)
      {
        structure::Beam<2> beam;
        beam.nodes = {{i - 1, i, i + 1}};
        beam.stiffness =
          parameters.modulus * std::pow(parameters.thickness, 3) / 12 / std::pow(ds, 3);
        network.beams.push_back(beam);
      }
    return network;
  }


  structure::FibreNetwork<2>
  make_rigid_wall(const CollapsibleChannelParameters &parameters)
  {
    const Pieces pieces = pieces_of(parameters);
    structure::FibreNetwork<2> network;
    network.source      = "collapsible channel";
    const double ds     = parameters.rigid_spacing;
    const double end    = pieces.start + pieces.n * pieces.size;
    const double length = parameters.upstream_length + parameters.elastic_length +
                          parameters.downstream_length;
    for (unsigned int i = pieces.start / ds + 1e-6; i > 0; --i)
      network.nodes.emplace_back(pieces.start - (i - 0.5) * ds, parameters.width);
    const unsigned int n_downstream = std::max(0., (length - end) / ds + 1e-6);
    for (unsigned int i = 0; i < n_downstream; ++i)
      network.nodes.emplace_back(end + (i + 0.5) * ds, parameters.width);
    for (unsigned int i = 0; i < network.nodes.size(); ++i)
      network.targets.push_back(
        {i, parameters.wall_stiffness * ds, parameters.wall_damping * ds});
    return network;
  }


  void write_beam_mesh(const CollapsibleChannelParameters &parameters, std::ostream &out)
  {
    const Pieces pieces  = pieces_of(parameters);
    const unsigned int n = pieces.n;
    const auto node      = [](const unsigned int i, const unsigned int j) {
      return 3 * i + j + 1;
    };
    out << std::setprecision(17) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
        << "$PhysicalNames\n1\n2 1 \"wall\"\n$EndPhysicalNames\n"
        << "$Nodes\n"
        << 3 * (2 * n + 1) << '\n';
    for (unsigned int i = 0; i <= 2 * n; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        out << node(i, j) << ' ' << pieces.start + 0.5 * i * pieces.size << ' '
            << parameters.width + (0.5 * j - 0.5) * parameters.thickness << " 0\n";
    out << "$EndNodes\n$Elements\n" << n << '\n';
    // Type 10: four corners, the middles of the sides, the centre.
    constexpr std::array<std::array<unsigned int, 2>, 9> places = {{{{0, 0}},
                                                                    {{2, 0}},
                                                                    {{2, 2}},
                                                                    {{0, 2}},
                                                                    {{1, 0}},
                                                                    {{2, 1}},
                                                                    {{1, 2}},
                                                                    {{0, 1}},
                                                                    {{1, 1}}}};
    for (unsigned int e = 0; e < n; ++e)
      {
        out << e + 1 << " 10 2 1 1";
        for (const auto &[i, j] : places)
          out << ' ' << node(2 * e + i, j);
        out << '\n';
      }
    out << "$EndElements\n";
  }


  std::string prepare_collapsible_channel(const CollapsibleChannelParameters &parameters)
  {
    AssertThrow(!parameters.finite_elements || parameters.start_shape.empty(),
                base::UserError("\"Collapsible channel / Start shape\" is for an elastic "
                                "part of fibres; a mesh starts undeformed."));
    const structure::FibreNetwork<2> rigid = make_rigid_wall(parameters);
    const std::filesystem::path parent =
      std::filesystem::path(parameters.output).parent_path();
    if (!parent.empty())
      io::make_folder(parent.string());
    io::write_fibres(rigid, parameters.output + "_rigid");
    std::ostringstream text;
    text << parameters.output << "_rigid: " << rigid.nodes.size() << " target points\n"
         << parameters.output;
    if (parameters.finite_elements)
      {
        io::write_file(parameters.output + ".msh",
                       [&](std::ostream &out) { write_beam_mesh(parameters, out); });
        text << ".msh: " << pieces_of(parameters).n << " quadrilaterals of "
             << pieces_of(parameters).size << " cm\n";
        return text.str();
      }
    const structure::FibreNetwork<2> network = make_elastic_wall(parameters);
    io::write_fibres(network, parameters.output);
    text << ": " << network.nodes.size() << " nodes, " << network.springs.size()
         << " springs of " << network.springs[0].stiffness << " dyn/cm, "
         << network.beams.size() << " beams of " << network.beams[0].stiffness
         << " dyn/cm, " << network.targets.size() << " target points of "
         << network.targets[0].stiffness << " dyn/cm\n";
    return text.str();
  }
} // namespace mitre::geometry
