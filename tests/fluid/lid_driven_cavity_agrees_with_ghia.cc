// Cavity of side 1 with a lid that moves at speed 1, Reynolds number 100: the velocities
// on the lines through the centre, on 64 x 64 cells, against the table of Ghia, Ghia and
// Shin (J. Comput. Phys. 48 (1982) 387-411), within 2 % of the lid's speed, which leaves
// room for their rounding and our discretisation. The flow is steady to 1e-3 a unit of
// time after t = 12, most of which is spent on 32 x 32 cells.

#include "fluid_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

namespace
{
  // place along the line, velocity across it
  const double u_of_y[15][2] = {{0.9766, 0.84123},
                                {0.9688, 0.78871},
                                {0.9609, 0.73722},
                                {0.9531, 0.68717},
                                {0.8516, 0.23151},
                                {0.7344, 0.00332},
                                {0.6172, -0.13641},
                                {0.5000, -0.20581},
                                {0.4531, -0.21090},
                                {0.2813, -0.15662},
                                {0.1719, -0.10150},
                                {0.1016, -0.06434},
                                {0.0703, -0.04775},
                                {0.0625, -0.04192},
                                {0.0547, -0.03717}};
  const double v_of_x[15][2] = {{0.9688, -0.05906},
                                {0.9609, -0.07391},
                                {0.9531, -0.08864},
                                {0.9453, -0.10313},
                                {0.9063, -0.16914},
                                {0.8594, -0.22445},
                                {0.8047, -0.24533},
                                {0.5000, 0.05454},
                                {0.2344, 0.17527},
                                {0.2266, 0.17507},
                                {0.1563, 0.16077},
                                {0.0938, 0.12317},
                                {0.0781, 0.10890},
                                {0.0703, 0.10091},
                                {0.0625, 0.09233}};
} // namespace

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  grid::PatchGridParameters<2> box = unit_box<2>(32, 2, "");
  grid::PatchGrid<2> patch_grid(MPI_COMM_WORLD, box);
  fluid::BoundaryConditions<2> conditions;
  conditions.add(
    "lid", {3}, given_velocity<2>([](const Point<2> &, const unsigned int c, double) {
      return c == 0 ? 1. : 0.;
    }));
  conditions.add("walls", {0, 1, 2}, wall<2>());
  fluid::FluidParameters parameters;
  parameters.viscosity                 = 0.01;
  parameters.solver.relative_tolerance = 1e-7;
  fluid::NavierStokes<2> flow(patch_grid, conditions, parameters);
  grid::VectorType force;
  double time = 0., change = 0.;
  for (const auto &[end, dt] : {std::make_pair(9., 0.02), std::make_pair(12., 0.01)})
    {
      flow.operators().initialize_velocity(force);
      for (; time < end - 0.5 * dt; time += dt)
        flow.advance(time, dt, force);
      force = flow.velocity();
      force.add(-1., flow.previous_velocity());
      change = force.linfty_norm() / dt;
      flow.regrid([](const BoundingBox<2> &) { return 3; }, time);
    }

  // Velocities on the lines: faces on them, linear between the faces.
  for (unsigned int c = 0; c < 2; ++c)
    {
      std::vector<std::pair<double, double>> profile;
      for_each_face(flow.space(),
                    [&](const std::size_t entry,
                        const unsigned int,
                        const unsigned int component,
                        const Point<2> &x) {
                      if (component == c && std::abs(x[c] - 0.5) < 1e-10)
                        profile.emplace_back(x[1 - c],
                                             flow.velocity().local_element(entry));
                    });
      std::sort(profile.begin(), profile.end());
      profile.emplace_back(1., c == 0 ? 1. : 0.);
      double largest = 0.;
      for (const auto &[at, expected] : (c == 0 ? u_of_y : v_of_x))
        {
          auto above = profile.begin();
          while (above->first < at)
            ++above;
          const auto below   = above - 1;
          const double share = (at - below->first) / (above->first - below->first);
          largest            = std::max(
            largest,
            std::abs(below->second + share * (above->second - below->second) - expected));
        }
      out() << (c == 0 ? "u(y)" : "v(x)") << ": " << below(largest, 0.02) << std::endl;
    }
  out() << "change a unit of time: " << below(change, 1e-3) << std::endl;
}
