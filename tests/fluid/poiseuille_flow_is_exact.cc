// Flow between parallel plates, u = G y (1 - y) / (2 mu), p = p_in - G x, driven by the
// pressures at both ends (2D, and 3D periodic in z). Differences are exact for parabolas
// (also at walls) and for linear pressure, so on a uniform grid the exact flow stays to
// solver tolerance (1e-10; the claim is 1e-8 of the peak) and a fluid at rest comes to
// it (with time steps from large to small, as Crank-Nicolson damps the slow parts by
// large ones and the stiff parts by small ones). With a strip of finer patches along the
// middle it is not exact, as the velocities on both sides of the interface are
// differently interpolated; the errors are small and must fall with second order in the
// velocity and first in the pressure.

#include "fluid_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

struct Result
{
  double velocity, pressure;
};

template <int dim>
Result
run(const unsigned int n,
    const unsigned int levels,
    const bool from_rest,
    const std::vector<std::pair<unsigned int, double>> &time_steps)
{
  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD,
                                  unit_box<dim>(n, levels, dim == 3 ? "z" : ""));
  patch_grid.adapt([&](const BoundingBox<dim> &box) {
    return static_cast<int>(std::abs(box.center()[1] - 0.5) < 0.25
                              ? patch_grid.maximum_level()
                              : patch_grid.minimum_level());
  });
  const double mu = 0.5, G = 4., p_in = 7.;
  const auto exact = [&](const Point<dim> &x, const unsigned int c) {
    return c == 0 ? G / (2. * mu) * x[1] * (1. - x[1]) : 0.;
  };
  const auto exact_pressure = [&](const Point<dim> &x) { return p_in - G * x[0]; };

  fluid::BoundaryConditions<dim> conditions;
  conditions.add(
    "ends", {0, 1}, given_pressure<dim>([&](const Point<dim> &x, unsigned int, double) {
      return exact_pressure(x);
    }));
  conditions.add("plates", {2, 3}, wall<dim>());
  fluid::FluidParameters parameters;
  parameters.viscosity                 = mu;
  parameters.solver.relative_tolerance = 1e-10;
  fluid::NavierStokes<dim> flow(patch_grid, conditions, parameters);
  if (!from_rest)
    flow.set_velocity(exact, 0.);
  grid::VectorType force;
  flow.operators().initialize_velocity(force);
  double time = 0.;
  for (const auto &[steps, dt] : time_steps)
    for (unsigned int step = 0; step < steps; ++step, time += dt)
      flow.advance(time, dt, force);
  return {velocity_error(flow, exact) / (G / (8. * mu)),
          pressure_error(flow, exact_pressure) / G};
}

template <int dim>
void
check(const unsigned int n)
{
  const Result stay = run<dim>(n, 1, false, {{10, 0.05}});
  out() << dim << "D, uniform, from the exact flow: velocity "
        << below(stay.velocity, 1e-8) << ", pressure " << below(stay.pressure, 1e-8)
        << std::endl;
  // the slowest part decays by exp(-pi^2 mu t), 1e-9 at t = 4.2
  const Result rest = run<dim>(n, 1, true, {{40, 0.1}, {20, 0.01}, {20, 0.001}});
  out() << dim << "D, uniform, from rest: velocity " << below(rest.velocity, 1e-8)
        << ", pressure " << below(rest.pressure, 1e-8) << std::endl;
}

template <int dim>
void
check_refined(const unsigned int n)
{
  const Result coarse = run<dim>(n, 2, false, {{10, 0.1}, {10, 0.01}});
  const Result fine   = run<dim>(2 * n, 2, false, {{10, 0.1}, {10, 0.01}});
  out() << dim << "D, refined strip: velocity " << below(coarse.velocity, 1e-4)
        << ", order " << above(std::log2(coarse.velocity / fine.velocity), 1.9)
        << ", pressure " << below(coarse.pressure, 2e-3) << ", order "
        << above(std::log2(coarse.pressure / fine.pressure), 0.95) << std::endl;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check<2>(32);
  check<3>(16);
  check_refined<2>(32);
}
