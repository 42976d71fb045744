// Steps of different lengths, in the ratio 1 : 0.5 : 1.5 : 0.75 : 1.25 over and over, for
// Taylor-Green vortices carried by a stream on one grid: what is left of the difference
// to a computation with many short steps falls by four when all steps are halved
// (Adams-Bashforth with the factors of equal steps would give two). And a step that has
// been taken back leaves nothing behind: repeated, it gives the same numbers.

#include "exact_flows.h"
#include "fluid_tests.h"

using namespace exact_flows;
using namespace fluid_tests;
using grid_tests::above;
using grid_tests::below;

namespace
{
  constexpr unsigned int n    = 32;
  constexpr double end_time   = 0.1;
  constexpr double pattern[5] = {1., 0.5, 1.5, 0.75, 1.25};

  struct Run
  {
    explicit Run(const unsigned int n_periods)
      : patch_grid(MPI_COMM_WORLD, grid_tests::unit_box<2>(n, 1, "xy"))
    {
      fluid::FluidParameters parameters;
      parameters.viscosity                 = 0.05;
      parameters.advection                 = fluid::AdvectionScheme::centered;
      parameters.solver.relative_tolerance = 1e-10;
      flow = std::make_unique<fluid::NavierStokes<2>>(patch_grid, conditions, parameters);
      const TaylorGreen exact{parameters.viscosity};
      flow->set_velocity(
        [&](const Point<2> &x, const unsigned int c) { return exact(x, c, 0.); }, 0.);
      flow->operators().initialize_velocity(force);
      const double mean = end_time / (5 * n_periods);
      for (unsigned int step = 0; step < 5 * n_periods; ++step)
        {
          const double dt = pattern[step % 5] * mean;
          flow->advance(time, dt, force);
          time += dt;
        }
    }

    grid::PatchGrid<2> patch_grid;
    fluid::BoundaryConditions<2> conditions;
    std::unique_ptr<fluid::NavierStokes<2>> flow;
    grid::VectorType force;
    double time = 0.;
  };

  double difference(const grid::VectorType &a, const grid::VectorType &b)
  {
    grid::VectorType d = a;
    d -= b;
    return d.linfty_norm();
  }
} // namespace

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Run coarse(4), fine(8), finest(64);
  const double error_coarse =
    difference(coarse.flow->velocity(), finest.flow->velocity());
  const double error_fine = difference(fine.flow->velocity(), finest.flow->velocity());
  grid_tests::out() << "order in time "
                    << above(std::log2(error_coarse / error_fine), 1.8) << std::endl;

  Run run(4);
  const double dt = 0.3 * end_time / 20;
  fluid::NavierStokes<2>::State state;
  run.flow->save(state);
  run.flow->advance(run.time, dt, run.force);
  const grid::VectorType velocity = run.flow->velocity();
  run.flow->restore(state);
  run.flow->advance(run.time, 5 * dt, run.force);
  const double changed = difference(run.flow->velocity(), velocity);
  run.flow->restore(state);
  run.flow->advance(run.time, dt, run.force);
  grid_tests::out() << "another length: difference " << above(changed, 1e-3)
                    << ", the same once more: "
                    << below(difference(run.flow->velocity(), velocity), 1e-14)
                    << std::endl;
}
