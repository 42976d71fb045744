// Fibres made from quadrilaterals against the theory of thin sheets:
//
// * n x m quadrilaterals have 8 n m + 2 (n + m) springs: eight each, if those on sides
// that
//   two share count half;
// * small strains along the fibres have the membrane energy of E and h with a Poisson
// ratio
//   of 0, and none in shear; with diagonals those of an isotropic sheet with a ratio of
//   1/3, in any direction (1e-3 of the energy, as the strain is 1e-4);
// * bent to a cylinder along either direction, E h^3/12 / (2 R^2) for each area, but that
//   half a segment at either edge is not bent (1e-3, second order in the segments);
// * a surface that is curved at rest has no energy there, one that is flat at rest that
// of
//   its kinks;
// * mistakes in the surface are found.

#include <cmath>
#include <iostream>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/geometry/fibre_surface.h>
#include <mitre/structure/fibre_body.h>

using namespace mitre;
using dealii::Point;

namespace
{
  constexpr double length = 2., width = 1.5;
  constexpr unsigned int n = 12, m = 10;


  std::string below(const double value, const double bound)
  {
    return value < bound ? "ok" : "FAILED, " + std::to_string(value);
  }


  geometry::QuadSurface make_sheet()
  {
    geometry::QuadSurface surface;
    for (unsigned int j = 0; j <= m; ++j)
      for (unsigned int i = 0; i <= n; ++i)
        surface.nodes.emplace_back(length * i / n, width * j / m, 0.);
    for (unsigned int j = 0; j < m; ++j)
      for (unsigned int i = 0; i < n; ++i)
        {
          const unsigned int a = i + (n + 1) * j;
          surface.quads.push_back({{a, a + 1, a + n + 2, a + n + 1}});
        }
    return surface;
  }


  /// The energy of a network whose nodes are moved by a map.
  template <typename Map>
  double energy(const structure::FibreNetwork<3> &network, const Map &map)
  {
    structure::FibreParameters<3> parameters;
    parameters.name = "sheet";
    const structure::FibreBody<3> body(parameters, network, MPI_COMM_SELF);
    structure::VectorType X;
    body.initialize_vector(X);
    std::vector<double> positions;
    for (const Point<3> &s : network.nodes)
      {
        const Point<3> x = map(s);
        positions.insert(positions.end(), {x[0], x[1], x[2]});
      }
    body.from_mesh_order(positions, X);
    return body.compute_elastic_energy(X, 0.);
  }


  void check_mistake(const std::string &text)
  {
    try
      {
        std::istringstream in(text);
        geometry::SheetParameters parameters;
        parameters.modulus = parameters.thickness = 1;
        parameters.diagonals                      = true;
        geometry::make_fibres(geometry::read_quad_surface(in, "a.msh"), parameters);
        std::cout << "no error" << std::endl;
      }
    catch (const base::UserError &error)
      {
        std::cout << error.what() << std::endl;
      }
  }
} // namespace


int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  geometry::SheetParameters sheet;
  sheet.modulus        = 7.;
  sheet.thickness      = 0.1;
  const double area    = length * width;
  const double Eh      = sheet.modulus * sheet.thickness;
  const double bending = Eh * sheet.thickness * sheet.thickness / 12;

  // Strains xx, yy and 2 xy.
  constexpr double e                               = 1e-4;
  const std::vector<std::array<double, 3>> strains = {
    {{e, 0, 0}}, {{0, e, 0}}, {{e, -e / 3, 0}}, {{0, 0, e}}, {{e, e, 0}}, {{e, -e, e}}};
  for (const bool diagonals : {false, true})
    {
      sheet.diagonals                          = diagonals;
      const structure::FibreNetwork<3> network = make_fibres(make_sheet(), sheet);
      std::cout << (diagonals ? "with diagonals: " : "fibres: ") << network.nodes.size()
                << " nodes, "
                << (network.springs.size() ==
                        8 * n * m + 2 * (n + m) + (diagonals ? 8 * n * m : 0)
                      ? "springs ok"
                      : "springs FAILED")
                << std::endl;
      for (const auto &[xx, yy, xy] : strains)
        {
          const double nu    = diagonals ? 1. / 3 : 0.;
          const double exact = 0.5 * area * Eh *
                               ((xx * xx + yy * yy + 2 * nu * xx * yy) / (1 - nu * nu) +
                                (diagonals ? xy * xy / (2 * (1 + nu)) : 0.));
          const double found = energy(network, [&](const Point<3> &s) {
            return Point<3>(
              s[0] * (1 + xx) + 0.5 * xy * s[1], s[1] * (1 + yy) + 0.5 * xy * s[0], 0.);
          });
          std::cout << "  strain " << xx / e << ' ' << yy / e << ' ' << xy / e << ": "
                    << below(std::abs(found - exact) / (Eh * e * e * area), 1e-3)
                    << std::endl;
        }

      // Bent, without the springs, whose chords are shorter than the arc.
      structure::FibreNetwork<3> beams = network;
      beams.springs.clear();
      const double R = 3.;
      for (const unsigned int d : {0u, 1u})
        {
          const double found         = energy(beams, [&](const Point<3> &s) {
            Point<3> x = s;
            x[d]       = R * std::sin(s[d] / R);
            x[2]       = R * (1 - std::cos(s[d] / R));
            return x;
          });
          const double half_segments = d == 0 ? 1. / (2 * n) : 1. / (2 * m);
          std::cout << "  bent along "
                    << "xy"[d] << ": "
                    << below(std::abs(found / (0.5 * bending / (R * R) * area *
                                               (1 - half_segments)) -
                                      1),
                             1e-3)
                    << std::endl;
        }
    }

  // A cylinder that is at rest as such.
  sheet.diagonals               = false;
  geometry::QuadSurface surface = make_sheet();
  for (Point<3> &x : surface.nodes)
    x = Point<3>(std::sin(x[0]), x[1], std::cos(x[0]));
  const auto stay = [](const Point<3> &s) { return s; };
  std::cout << "cylinder: at rest "
            << below(energy(make_fibres(surface, sheet), stay) / bending, 1e-20);
  sheet.curved_at_rest = false;
  // The middles of sides lie on chords, so that all of the bending is at the corners:
  // (n - 1) beams with twice the angle instead of 2 n - 1.
  const double flat  = energy(make_fibres(surface, sheet), stay);
  const double exact = 0.5 * bending * width * length / (2 * n) * 4 * (n - 1);
  std::cout << ", flat at rest " << below(std::abs(flat / exact - 1), 5e-3) << std::endl;

  const std::string head  = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const std::string nodes = "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 9 0 0\n"
                            "6 9 1 0\n$EndNodes\n";
  check_mistake("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
  check_mistake(head + nodes);
  check_mistake(head + nodes + "$Elements\n1\n1 3 2 1 1 1 2 3 7\n$EndElements\n");
  check_mistake(head + nodes + "$Elements\n2\n1 3 2 1 1 1 2 3 4\n");
  check_mistake(head + nodes + "$Elements\n1\n1 3 2 1 1 1 2 2 4\n$EndElements\n");
  check_mistake(head + nodes + "$Elements\n1\n1 3 2 1 1 1 5 6 4\n$EndElements\n");
  check_mistake(head + nodes +
                "$Elements\n3\n1 3 2 1 1 1 2 3 4\n2 3 2 1 1 1 2 3 4\n3 3 2 1 1 1 2 3 "
                "4\n$EndElements\n");
  check_mistake(head + nodes +
                "$Elements\n2\n1 2 2 1 1 1 2 3\n2 3 2 1 1 1 2 3 4\n$EndElements\n");
}
