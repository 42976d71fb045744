// The fibres of a prosthesis: areas agree with formulas, segments are at rest and at most
// twice as long as asked for, what is symmetrical is, chordae are long enough for the
// closed valve and end in target points, their stiffness is that of a rod, bending can be
// left out, the edge of the leaflets lies on the disc, and all of it in the tube. A
// leaflet that is too short is found, and so is an annulus that is too wide.

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>

#include <mitre/base/exceptions.h>
#include <mitre/geometry/prosthesis.h>


using namespace mitre;
using namespace mitre::geometry;

namespace
{
  ProsthesisParameters
  read(const std::vector<std::pair<std::string, std::string>> &changes)
  {
    dealii::ParameterHandler prm;
    ProsthesisParameters::declare_parameters(prm);
    for (const auto &[name, value] : changes)
      prm.set(name, value);
    ProsthesisParameters parameters;
    parameters.parse_parameters(prm);
    return parameters;
  }


  double least_distance(const std::vector<Point3> &nodes, const Point3 &x)
  {
    double least = 1e10;
    for (const Point3 &node : nodes)
      least = std::min(least, node.distance(x));
    return least;
  }


  void check(const ProsthesisParameters &parameters)
  {
    const ProsthesisShape shape(parameters);
    const Prosthesis prosthesis             = make_prosthesis(parameters);
    const structure::FibreNetwork<3> &valve = prosthesis.valve;

    // y = d (1 - (1 - cos a)^q) over z = w/2 sin a, integrated with t = 1 - cos a
    const double d = parameters.anterior_depth, p = parameters.posterior_depth,
                 w       = parameters.width;
    double front         = 0;
    const unsigned int n = 100000;
    for (unsigned int i = 0; i < n; ++i)
      {
        const double a = dealii::numbers::PI / 2 * (i + 0.5) / n;
        front += d * (1 - std::pow(1 - std::cos(a), p / d)) * w * std::cos(a) *
                 dealii::numbers::PI / 2 / n;
      }
    std::cout << "area of the annulus: as by formula to 1e-5: "
              << (std::abs(shape.annulus_area() -
                           (dealii::numbers::PI / 4 * p * w + front)) < 1e-5)
              << std::endl;

    unsigned int n_stretched = 0, n_long = 0;
    for (unsigned int i = 0; i < prosthesis.n_leaflet_springs; ++i)
      {
        const auto &spring = valve.springs[i];
        const double length =
          valve.nodes[spring.nodes[0]].distance(valve.nodes[spring.nodes[1]]);
        n_stretched += std::abs(length - spring.rest_length) > 1e-12 ? 1 : 0;
        n_long += length > 2 * parameters.leaflet_spacing ? 1 : 0;
      }
    std::cout << "springs of leaflets not at rest: " << n_stretched
              << ", too long: " << n_long << std::endl;

    std::vector<Point3> mirrored;
    for (const Point3 &x : valve.nodes)
      mirrored.emplace_back(x[0], x[1], 2 * parameters.axis_z - x[2]);
    double asymmetry = 0;
    for (const Point3 &x : mirrored)
      asymmetry = std::max(asymmetry, least_distance(valve.nodes, x));
    std::cout << "mirrored in z: the same nodes to 1e-3 cm: " << (asymmetry < 1e-3)
              << std::endl;

    std::set<unsigned int> targets;
    for (const auto &target : valve.targets)
      targets.insert(target.node);
    unsigned int n_short = 0, n_sides[2] = {0, 0};
    for (const ProsthesisChord &chord : prosthesis.chordae)
      {
        n_short += chord.rest_length < chord.closed_length - 1e-12 ||
                       chord.rest_length < chord.start_length - 1e-12
                     ? 1
                     : 0;
        ++n_sides[chord.side > 0 ? 1 : 0];
      }
    std::cout << "chordae: " << n_sides[0] << " + " << n_sides[1]
              << ", too short: " << n_short << std::endl;

    // Springs of a chord in a row have EA of a rod and end in a target point.
    double largest_error = 0;
    unsigned int n_ends  = 0;
    const double EA      = parameters.chord_modulus * parameters.chord_area;
    for (std::size_t i = prosthesis.n_leaflet_springs; i < valve.springs.size(); ++i)
      {
        const auto &spring = valve.springs[i];
        largest_error      = std::max(
          largest_error, std::abs(spring.stiffness * spring.rest_length / EA - 1));
        n_ends += targets.count(spring.nodes[1]);
      }
    std::cout << "chordae: EA is that of a rod: " << (largest_error < 1e-12)
              << ", ends in target points: " << n_ends << std::endl;

    std::cout << "beams of leaflets: " << (prosthesis.n_leaflet_beams > 0)
              << ", of chordae: " << (valve.beams.size() > prosthesis.n_leaflet_beams)
              << std::endl;

    double off_disc = 0, outside = 0;
    for (const unsigned int node : targets)
      if (valve.nodes[node][0] < parameters.annulus_x + parameters.post_height + 1e-9)
        off_disc =
          std::max(off_disc, least_distance(prosthesis.disc.nodes, valve.nodes[node]));
    for (const auto *network : {&prosthesis.valve, &prosthesis.disc})
      for (const Point3 &x : network->nodes)
        outside =
          std::max(outside,
                   std::hypot(x[1] - parameters.axis_y, x[2] - parameters.axis_z) -
                     0.5 * (parameters.tube_inner_diameter + parameters.tube_thickness));
    // Between the annulus and the tube, points of the disc are near a node. With nodes a
    // spacing apart the middle of a square of four is 0.71 of it away.
    const auto within = [&](const double y, const double z) {
      for (int i = 0; i < 360; ++i)
        {
          const double angle  = i * dealii::numbers::PI / 180;
          const Point3 on_rim = shape.annulus(angle);
          const double polar =
            std::atan2(on_rim[2] - parameters.axis_z, on_rim[1] - parameters.axis_y);
          if (std::abs(
                std::remainder(polar - std::atan2(z, y), 2 * dealii::numbers::PI)) < 0.03)
            return std::hypot(y, z) < std::hypot(on_rim[1] - parameters.axis_y,
                                                 on_rim[2] - parameters.axis_z);
        }
      return false;
    };
    double hole = 0;
    for (double y = -2.9; y < 2.9; y += 0.05)
      for (double z = -2.9; z < 2.9; z += 0.05)
        if (std::hypot(y, z) < 2.9 && !within(y, z))
          hole = std::max(hole,
                          least_distance(prosthesis.disc.nodes,
                                         Point3(parameters.annulus_x,
                                                parameters.axis_y + y,
                                                parameters.axis_z + z)));
    std::cout << "no holes in the disc: " << (hole < 1.1 * parameters.rigid_spacing)
              << std::endl;

    std::cout << "edge of the leaflets beside nodes of the disc: "
              << (off_disc < parameters.rigid_spacing)
              << ", inside of the tube: " << (outside < 1e-9)
              << ", every node of the disc is held: "
              << (prosthesis.disc.targets.size() == prosthesis.disc.nodes.size())
              << std::endl;
  }
} // namespace


int
main()
{
  check(read({}));
  check(read(
    {{"Leaflet spacing", "0.05"}, {"Post height", "0.5"}, {"Anterior chordae", "4"}}));
  check(read({{"Leaflet bending", "false"}}));
  check(read({{"Chordal bending", "false"}}));
  for (const auto &change :
       std::vector<std::pair<std::string, std::string>>{{"Anterior length", "1.1"},
                                                        {"Commissural length", "0.05"},
                                                        {"Annulus width", "5.6"},
                                                        {"Posterior chordae", "7"}})
    try
      {
        make_prosthesis(read({change}));
        std::cout << change.first << ": no error" << std::endl;
      }
    catch (const base::UserError &error)
      {
        std::cout << error.what() << std::endl;
      }
}
