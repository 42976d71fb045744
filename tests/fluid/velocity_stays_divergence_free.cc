// After every step max |div u| h / max |u| is at the tolerance of the solver: the norm of
// h div u over all cells is below "Relative tolerance" (1e-9) times that of u over all N
// entries, so that no single cell exceeds 1e-9 sqrt(N) (twice that is claimed, as forces
// and pressure count in that norm too). A change of the grid leaves a mean square of
// the divergence of at most what it was (a half more are allowed), or 1e-10. A refined
// region that jumps about changes the grid every third step while vortices flow through
// it and past walls.

#include "fluid_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

template <int dim>
void
check(const std::string &periodic, const bool open, const unsigned int levels)
{
  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, unit_box<dim>(16, levels, periodic));
  fluid::BoundaryConditions<dim> conditions;
  if (open)
    conditions.add(
      "ends", {0, 1}, given_pressure<dim>([](const Point<dim> &x, unsigned int, double) {
        return 1. - x[0];
      }));
  conditions.add("walls", std::vector<unsigned int>{0, 1, 2, 3}, wall<dim>());
  if (dim == 3)
    conditions.add("more walls", std::vector<unsigned int>{4, 5}, wall<dim>());

  fluid::FluidParameters parameters;
  parameters.viscosity                 = 0.01;
  parameters.solver.relative_tolerance = 1e-9;
  fluid::NavierStokes<dim> flow(patch_grid, conditions, parameters);
  flow.set_velocity(
    [](const Point<dim> &x, const unsigned int c) {
      const double k = 2. * numbers::PI;
      return c == 0   ? std::sin(k * x[0]) * std::cos(k * x[1])
             : c == 1 ? 0.5 - std::cos(k * x[0]) * std::sin(k * x[1])
                      : std::sin(k * x[0]);
    },
    0.);

  const double dt        = 0.01;
  double step_divergence = 0., regrid_divergence = 0., speed = 0.;
  unsigned int n_changes = 0;
  grid::VectorType force;
  const auto relative = [&]() {
    speed          = flow.velocity().linfty_norm();
    const double h = patch_grid.cell_width(patch_grid.maximum_level(), 0);
    return flow.operators().max_divergence(flow.velocity()) * h / speed;
  };
  const auto norm = [&]() {
    grid::VectorType divergence;
    flow.operators().initialize_pressure(divergence);
    flow.operators().apply_divergence(divergence, flow.velocity());
    // the root mean square over the unit box
    double sum = 0.;
    const unsigned int n_cells =
      Utilities::fixed_power<dim>(patch_grid.n_cells_per_side());
    for (unsigned int i = 0; i < divergence.locally_owned_size(); ++i)
      sum += Utilities::fixed_power<dim>(patch_grid.patch(i / n_cells).h[0]) *
             std::pow(divergence.local_element(i), 2);
    return std::sqrt(Utilities::MPI::sum(sum, MPI_COMM_WORLD)) *
           patch_grid.cell_width(patch_grid.maximum_level(), 0) /
           flow.velocity().linfty_norm();
  };
  for (unsigned int step = 0; step < 12; ++step)
    {
      if (step % 3 == 0)
        {
          const double before = norm();
          Point<dim> center   = diagonal_point<dim>(0.1 + 0.07 * step);
          center[1]           = 0.9 - 0.05 * step;
          const bool changed =
            flow.regrid(refine_ball(patch_grid, center, 0.1), step * dt);
          if (changed)
            {
              ++n_changes;
              flow.operators().initialize_velocity(force);
              regrid_divergence =
                std::max(regrid_divergence, norm() / std::max(before, 1e-10));
            }
        }
      flow.advance(step * dt, dt, force);
      step_divergence =
        std::max(step_divergence, relative() / std::sqrt(flow.velocity().size()));
    }
  out() << dim << "D, " << (periodic.empty() ? "not periodic" : "periodic " + periodic)
        << (open ? ", open" : "") << ": grid changes " << n_changes << ", after steps "
        << below(step_divergence, 2e-9) << ", after changes "
        << below(regrid_divergence, 1.501) << ", still flowing " << above(speed, 0.1)
        << std::endl;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check<2>("xy", false, 3);
  check<2>("", true, 3);
  check<2>("x", false, 3);
  check<3>("z", true, 2);
}
