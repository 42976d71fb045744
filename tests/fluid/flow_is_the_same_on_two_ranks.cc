// Each rank computes 50 steps of a flow alone, and all compute it together: velocities
// differ by less than 1e-8 of the largest (solver tolerance 1e-10), faces compared by
// level and place. The grid has walls, a moving wall, an open end and refined patches
// that the cut between the ranks crosses, and changes once on the way.

#include <map>

#include "fluid_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

using Key = std::array<long, 5>;

template <int dim>
std::map<Key, double>
run(MPI_Comm communicator, const unsigned int steps, unsigned int &patches)
{
  grid::PatchGrid<dim> patch_grid(communicator,
                                  unit_box<dim>(16, 2, dim == 3 ? "z" : ""));
  patch_grid.adapt(refine_ball(patch_grid, diagonal_point<dim>(0.75), 0.1));
  fluid::BoundaryConditions<dim> conditions;
  conditions.add(
    "lid",
    {3},
    given_velocity<dim>([](const Point<dim> &, const unsigned int c, double t) {
      return c == 1 ? 0. : std::sin(2. * t + c);
    }));
  conditions.add(
    "end",
    {1},
    given_pressure<dim>([](const Point<dim> &x, unsigned int, const double t) {
      return 0.2 * std::cos(3. * t + x[1]);
    }));
  conditions.add("walls", {0, 2}, wall<dim>());
  fluid::FluidParameters parameters;
  parameters.viscosity                 = 0.01;
  parameters.solver.relative_tolerance = 1e-10;
  fluid::NavierStokes<dim> flow(patch_grid, conditions, parameters);
  flow.set_velocity(
    [](const Point<dim> &x, const unsigned int c) {
      const double k = numbers::PI;
      return c == 0   ? std::sin(k * x[0]) * std::cos(k * x[1])
             : c == 1 ? -std::cos(k * x[0]) * std::sin(k * x[1])
                      : 0.3 * std::cos(2. * k * x[0]);
    },
    0.);
  grid::VectorType force;
  const double dt = 0.01;
  for (unsigned int step = 0; step < steps; ++step)
    {
      if (step == steps / 2)
        flow.regrid(refine_ball(patch_grid, diagonal_point<dim>(0.6), 0.09), step * dt);
      if (step == 0 || step == steps / 2)
        flow.operators().initialize_velocity(force);
      flow.advance(step * dt, dt, force);
    }

  std::map<Key, double> values;
  for_each_face(flow.space(),
                [&](const std::size_t entry,
                    const unsigned int p,
                    const unsigned int c,
                    const Point<dim> &x) {
                  Key key{{patch_grid.patch(p).level, static_cast<long>(c), 0, 0, 0}};
                  for (unsigned int d = 0; d < dim; ++d)
                    key[2 + d] = std::lround(x[d] * 4096.);
                  values[key] = flow.velocity().local_element(entry);
                });
  patches = patch_grid.n_owned_patches();
  return values;
}

template <int dim>
void
check()
{
  unsigned int own_patches, all_patches;
  const auto together = run<dim>(MPI_COMM_WORLD, 50, own_patches);
  const auto alone    = run<dim>(MPI_COMM_SELF, 50, all_patches);
  double difference = 0., largest = 0.;
  bool found = true;
  for (const auto &[key, value] : together)
    {
      const auto other = alone.find(key);
      if (other == alone.end())
        found = false;
      else
        difference = std::max(difference, std::abs(value - other->second));
      largest = std::max(largest, std::abs(value));
    }
  difference          = Utilities::MPI::max(difference, MPI_COMM_WORLD);
  largest             = Utilities::MPI::max(largest, MPI_COMM_WORLD);
  const bool complete = Utilities::MPI::sum(own_patches, MPI_COMM_WORLD) == all_patches;
  const bool shared   = Utilities::MPI::max(own_patches, MPI_COMM_WORLD) < all_patches;
  out() << dim << "D: difference " << below(difference / largest, 1e-8) << ", same faces "
        << (found && complete ? "ok" : "FAILED") << ", shared "
        << (shared ? "ok" : "FAILED") << std::endl;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check<2>();
  check<3>();
}
