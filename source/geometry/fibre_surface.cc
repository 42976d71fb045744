#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/geometry/fibre_surface.h>
#include <mitre/io/safe_file.h>

namespace mitre::geometry
{
  namespace
  {
    using dealii::Point;
    using Pair = std::pair<unsigned int, unsigned int>;


    Pair sorted(const unsigned int a, const unsigned int b)
    {
      return {std::min(a, b), std::max(a, b)};
    }


    /// Springs by their ends, in the order in which they were named first.
    class Segments
    {
    public:
      void add(const unsigned int a,
               const unsigned int b,
               const double stiffness,
               const double width)
      {
        const auto added = number.emplace(sorted(a, b), all.size());
        if (added.second)
          all.push_back({{{a, b}}, 0., 0.});
        Segment &segment = all[added.first->second];
        segment.stiffness += stiffness;
        segment.width += width;
      }

      /// Of the strip that the segment between two nodes stands for.
      double width(const unsigned int a, const unsigned int b) const
      {
        return all[number.at(sorted(a, b))].width;
      }

      struct Segment
      {
        std::array<unsigned int, 2> nodes;
        double stiffness, width;
      };

      std::vector<Segment> all;

    private:
      std::map<Pair, unsigned int> number;
    };


    std::string describe(const QuadSurface &surface, const unsigned int q)
    {
      std::ostringstream text;
      text << "quadrilateral " << q << " at ("
           << 0.25 *
                (surface.nodes[surface.quads[q][0]] + surface.nodes[surface.quads[q][1]] +
                 surface.nodes[surface.quads[q][2]] + surface.nodes[surface.quads[q][3]])
           << ") cm";
      return text.str();
    }
  } // namespace


  structure::FibreNetwork<3> make_fibres(const QuadSurface &surface,
                                         const SheetParameters &parameters)
  {
    const double membrane = parameters.modulus * parameters.thickness;
    const double bending  = membrane * std::pow(parameters.thickness, 2) / 12;

    structure::FibreNetwork<3> network;
    network.source               = "fibres of a surface";
    network.spring_source        = network.source;
    network.nodes                = surface.nodes;
    std::vector<Point<3>> &nodes = network.nodes;

    // Step 1: nodes in the middle of sides, and the quadrilaterals at each of these.
    std::map<Pair, unsigned int> middle_of;
    std::map<Pair, std::vector<unsigned int>> centres_at_side;
    std::vector<std::vector<unsigned int>> quads_at(surface.nodes.size());
    const auto middle = [&](const unsigned int a, const unsigned int b) {
      const auto added = middle_of.emplace(sorted(a, b), nodes.size());
      if (added.second)
        nodes.push_back(nodes[a] + 0.5 * (nodes[b] - nodes[a]));
      return added.first->second;
    };

    // Step 2: each quadrilateral as four small cells, whose sides are segments.
    Segments segments;
    std::vector<std::array<unsigned int, 3>> beams;
    for (unsigned int q = 0; q < surface.quads.size(); ++q)
      {
        const std::array<unsigned int, 4> &corners = surface.quads[q];
        std::array<unsigned int, 4> middles;
        for (unsigned int i = 0; i < 4; ++i)
          middles[i] = middle(corners[i], corners[(i + 1) % 4]);
        const unsigned int centre = nodes.size();
        nodes.push_back(nodes[middles[0]] +
                        0.5 * (nodes[middles[2]] - nodes[middles[0]]));
        for (unsigned int i = 0; i < 4; ++i)
          {
            centres_at_side[sorted(corners[i], corners[(i + 1) % 4])].push_back(centre);
            quads_at[corners[i]].push_back(q);
          }

        for (unsigned int i = 0; i < 4; ++i)
          {
            const std::array<unsigned int, 4> cell = {
              {corners[i], middles[i], centre, middles[(i + 3) % 4]}};
            // Lengths of the cell along its first and its second side.
            const auto side = [&](const unsigned int k) {
              return nodes[cell[k]].distance(nodes[cell[(k + 1) % 4]]);
            };
            const std::array<double, 2> lengths = {
              {0.5 * (side(0) + side(2)), 0.5 * (side(1) + side(3))}};
            AssertThrow(std::min({side(0), side(1), side(2), side(3)}) > 0,
                        base::UserError("Fibres: the " + describe(surface, q) +
                                        " has two corners in one place."));
            for (unsigned int k = 0; k < 4; ++k)
              {
                const double a = lengths[k % 2], b = lengths[(k + 1) % 2];
                double stiffness = membrane * 0.5 * b / side(k);
                if (parameters.diagonals)
                  stiffness *= 9. / 8 - 3. / 8 * a * a / (b * b);
                AssertThrow(stiffness > 0,
                            base::UserError(
                              "Fibres: the " + describe(surface, q) + " is " +
                              std::to_string(a / b) +
                              " times as long as it is wide; with diagonals it must be "
                              "less than 1.73 times."));
                segments.add(cell[k], cell[(k + 1) % 4], stiffness, 0.5 * b);
              }
            if (parameters.diagonals)
              {
                const double a = lengths[0], b = lengths[1];
                const double stiffness = 3. / 16 * membrane * (a * a + b * b) / (a * b);
                segments.add(cell[0], cell[2], stiffness, 0.);
                segments.add(cell[1], cell[3], stiffness, 0.);
              }
          }

        // Step 3: beams within it.
        beams.push_back({{middles[0], centre, middles[2]}});
        beams.push_back({{middles[1], centre, middles[3]}});
      }

    // Step 4: beams along sides and across them.
    std::vector<std::vector<unsigned int>> neighbours(surface.nodes.size());
    for (const auto &[side, m] : middle_of)
      {
        beams.push_back({{side.first, m, side.second}});
        const std::vector<unsigned int> &centres = centres_at_side[side];
        AssertThrow(centres.size() <= 2,
                    base::UserError("Fibres: the side between the nodes " +
                                    std::to_string(side.first) + " and " +
                                    std::to_string(side.second) + " belongs to " +
                                    std::to_string(centres.size()) +
                                    " quadrilaterals; expected at most two."));
        if (centres.size() == 2)
          beams.push_back({{centres[0], m, centres[1]}});
        neighbours[side.first].push_back(side.second);
        neighbours[side.second].push_back(side.first);
      }

    // Step 5: beams across corners, between sides that are opposite each other.
    for (unsigned int i = 0; i < surface.nodes.size(); ++i)
      {
        const bool inner = std::all_of(
          neighbours[i].begin(), neighbours[i].end(), [&](const unsigned int j) {
            return centres_at_side[sorted(i, j)].size() == 2;
          });
        if (quads_at[i].size() != (inner ? 4u : 2u))
          continue;
        for (unsigned int a = 0; a < neighbours[i].size(); ++a)
          for (unsigned int b = a + 1; b < neighbours[i].size(); ++b)
            {
              const auto &first  = centres_at_side[sorted(i, neighbours[i][a])];
              const auto &second = centres_at_side[sorted(i, neighbours[i][b])];
              if (std::find_first_of(
                    first.begin(), first.end(), second.begin(), second.end()) ==
                  first.end())
                beams.push_back({{middle_of[sorted(i, neighbours[i][a])],
                                  i,
                                  middle_of[sorted(i, neighbours[i][b])]}});
            }
      }

    // Step 6: stiffnesses.
    for (const Segments::Segment &segment : segments.all)
      {
        structure::Spring spring;
        spring.nodes       = segment.nodes;
        spring.stiffness   = segment.stiffness;
        spring.rest_length = nodes[segment.nodes[0]].distance(nodes[segment.nodes[1]]);
        network.springs.push_back(spring);
      }
    for (const std::array<unsigned int, 3> &b : beams)
      {
        const double ds =
          0.5 * (nodes[b[0]].distance(nodes[b[1]]) + nodes[b[1]].distance(nodes[b[2]]));
        const double dr = 0.5 * (segments.width(b[0], b[1]) + segments.width(b[1], b[2]));
        structure::Beam<3> beam;
        beam.nodes     = b;
        beam.stiffness = bending * dr / (ds * ds * ds);
        if (parameters.curved_at_rest)
          beam.curvature = (nodes[b[0]] - nodes[b[1]]) + (nodes[b[2]] - nodes[b[1]]);
        network.beams.push_back(beam);
      }
    return network;
  }


  QuadSurface read_quad_surface(std::istream &in, const std::string &source)
  {
    const auto require = [&](const bool condition, const std::string &message) {
      AssertThrow(condition, base::UserError("Mesh file " + source + ": " + message));
    };
    QuadSurface surface;
    std::map<unsigned long, unsigned int> node_of_tag;
    std::string word;
    while (in >> word)
      if (word == "$MeshFormat")
        {
          std::string version;
          int binary = 1;
          require(static_cast<bool>(in >> version >> binary) &&
                    version.rfind("2.", 0) == 0 && binary == 0,
                  "expected gmsh's format 2.2, ASCII.");
        }
      else if (word == "$Nodes")
        {
          std::size_t n = 0;
          require(static_cast<bool>(in >> n), "expected the number of nodes.");
          for (std::size_t i = 0; i < n; ++i)
            {
              unsigned long tag;
              Point<3> x;
              require(static_cast<bool>(in >> tag >> x[0] >> x[1] >> x[2]),
                      "node " + std::to_string(i + 1) + " of " + std::to_string(n) +
                        " cannot be read.");
              require(node_of_tag.emplace(tag, surface.nodes.size()).second,
                      "the node " + std::to_string(tag) + " is there twice.");
              surface.nodes.push_back(x);
            }
        }
      else if (word == "$Elements")
        {
          std::size_t n = 0;
          require(static_cast<bool>(in >> n), "expected the number of elements.");
          std::string line;
          std::getline(in, line);
          for (std::size_t i = 0; i < n; ++i)
            {
              const std::string what = "element " + std::to_string(i + 1) + " of " +
                                       std::to_string(n) + " cannot be read.";
              require(static_cast<bool>(std::getline(in, line)), what);
              std::istringstream words(line);
              unsigned long tag, type, n_tags, ignored;
              require(static_cast<bool>(words >> tag >> type >> n_tags), what);
              if (type != 3)
                continue;
              for (unsigned long k = 0; k < n_tags; ++k)
                require(static_cast<bool>(words >> ignored), what);
              std::array<unsigned int, 4> quad;
              for (unsigned int &corner : quad)
                {
                  unsigned long node;
                  require(static_cast<bool>(words >> node), what);
                  const auto found = node_of_tag.find(node);
                  require(found != node_of_tag.end(),
                          "the element " + std::to_string(tag) + " has the node " +
                            std::to_string(node) + ", which is not there.");
                  corner = found->second;
                }
              surface.quads.push_back(quad);
            }
        }
    require(!surface.quads.empty(), "there are no quadrilaterals.");

    // Nodes of other elements would hang in the fluid.
    std::vector<unsigned int> new_number(surface.nodes.size(),
                                         dealii::numbers::invalid_unsigned_int);
    std::vector<Point<3>> used;
    for (std::array<unsigned int, 4> &quad : surface.quads)
      for (unsigned int &corner : quad)
        {
          if (new_number[corner] == dealii::numbers::invalid_unsigned_int)
            {
              new_number[corner] = used.size();
              used.push_back(surface.nodes[corner]);
            }
          corner = new_number[corner];
        }
    surface.nodes = used;
    return surface;
  }


  void FibreSurfaceParameters::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "Mesh file",
      "",
      base::InputFile(),
      "Quadrilaterals of a surface [cm], as gmsh writes them (.msh, ASCII, "
      "version 2.2).");
    prm.declare_entry("Output",
                      "fibres",
                      dealii::Patterns::Anything(),
                      "Files OUTPUT.vertex, OUTPUT.spring and OUTPUT.beam are written.");
    prm.declare_entry("Young's modulus",
                      "5.4e7",
                      dealii::Patterns::Double(0),
                      "E of the sheet [dyn/cm^2].");
    prm.declare_entry(
      "Thickness", "0.0125", dealii::Patterns::Double(0), "h of the sheet [cm].");
    prm.declare_entry("Diagonals",
                      "false",
                      dealii::Patterns::Bool(),
                      "Whether cells have springs along their diagonals: the sheet then "
                      "resists shear, with a Poisson ratio of 1/3; else that is 0.");
    prm.declare_entry(
      "Curved at rest",
      "true",
      dealii::Patterns::Bool(),
      "Whether beams are at rest in the shape of the surface (as vectors in "
      "space, which do not turn with it); false: where it is flat.");
  }


  void FibreSurfaceParameters::parse_parameters(dealii::ParameterHandler &prm)
  {
    mesh_file            = prm.get("Mesh file");
    output               = prm.get("Output");
    sheet.modulus        = prm.get_double("Young's modulus");
    sheet.thickness      = prm.get_double("Thickness");
    sheet.diagonals      = prm.get_bool("Diagonals");
    sheet.curved_at_rest = prm.get_bool("Curved at rest");
    AssertThrow(
      !mesh_file.empty(),
      base::UserError("The parameter \"Fibre surface / Mesh file\" is not set."));
  }


  std::string prepare_fibre_surface(const FibreSurfaceParameters &parameters)
  {
    std::ifstream in(parameters.mesh_file);
    AssertThrow(in,
                base::UserError("The mesh file '" + parameters.mesh_file +
                                "' cannot be opened for reading."));
    const structure::FibreNetwork<3> network =
      make_fibres(read_quad_surface(in, parameters.mesh_file), parameters.sheet);
    const std::filesystem::path parent =
      std::filesystem::path(parameters.output).parent_path();
    if (!parent.empty())
      io::make_folder(parent.string());
    io::write_fibres(network, parameters.output);
    return parameters.output + ": " + std::to_string(network.nodes.size()) + " nodes, " +
           std::to_string(network.springs.size()) + " springs, " +
           std::to_string(network.beams.size()) + " beams\n";
  }
} // namespace mitre::geometry
