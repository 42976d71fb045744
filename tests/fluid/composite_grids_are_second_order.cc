// Flows between boundaries through regions of finer patches, whose errors fall with
// second order at the worst face of all, where levels meet included.
//
// Stokes flow: the stream function y exp(k x) sin(k y), k = 3, is biharmonic; the
// pressure is -2 mu k exp(k x) sin(k y). The side y = 0 is open (the pressure and both
// velocities are zero there), the others have the exact velocity. The region x > 1/2, y >
// 1/2 (and z > 1/2 in 3D, which is periodic in z) is finer, so that levels meet at walls.
//
// Channel flow at 30 degrees to the grid, (1 - s^2) along the channel with s across it,
// and its linear pressure, through a strip of finer patches; velocities are given on all
// sides. On one level it is exact, as parabolas are.
//
// Both start from the exact velocity, and come to rest in large time steps.
//
// The sum of viscous forces over a periodic box with two and three levels is zero to
// round-off for velocities without pattern.
//
// With the argument "table" errors and orders on more grids are printed.

#include <cstring>

#include "momentum.h"

using namespace grid_tests;
using namespace fluid_tests;

namespace
{
  const double mu = 0.5;

  template <int dim>
  double stokes_velocity(const Point<dim> &x, const unsigned int c)
  {
    const double k = 3., e = std::exp(k * (x[0] - 1.));
    return c == 0   ? e * (std::sin(k * x[1]) + k * x[1] * std::cos(k * x[1]))
           : c == 1 ? -k * x[1] * e * std::sin(k * x[1])
                    : 0.;
  }

  template <int dim>
  double stokes_pressure(const Point<dim> &x)
  {
    const double k = 3.;
    return -2. * mu * k * std::exp(k * (x[0] - 1.)) * std::sin(k * x[1]);
  }

  template <int dim>
  double channel_velocity(const Point<dim> &x, const unsigned int c)
  {
    const double angle = numbers::PI / 6., cosine = std::cos(angle),
                 sine = std::sin(angle);
    const double s    = cosine * (x[1] - 0.5) - sine * (x[0] - 0.5);
    return (1. - s * s) * (c == 0 ? cosine : c == 1 ? sine : 0.);
  }

  struct Result
  {
    double velocity, mean_velocity, pressure;
  };

  template <int dim, typename Exact>
  Result
  run(const unsigned int n, const bool stokes, const bool refined, const Exact &exact)
  {
    grid::PatchGrid<dim> patch_grid(
      MPI_COMM_WORLD, unit_box<dim>(n, refined ? 2 : 1, dim == 3 ? "z" : ""));
    patch_grid.adapt([&](const BoundingBox<dim> &box) {
      bool finer = true;
      if (stokes)
        for (unsigned int d = 0; d < dim; ++d)
          finer = finer && box.center()[d] > 0.5;
      else
        finer = std::abs(box.center()[0] - 0.5) < 0.25;
      return static_cast<int>(finer ? patch_grid.maximum_level()
                                    : patch_grid.minimum_level());
    });

    fluid::BoundaryConditions<dim> conditions;
    const auto exact_velocity = given_velocity<dim>(
      [exact](const Point<dim> &x, const unsigned int c, double) { return exact(x, c); });
    if (stokes)
      {
        conditions.add(
          "open", {2}, given_pressure<dim>([](const Point<dim> &, unsigned int, double) {
            return 0.;
          }));
        conditions.add("given", {0, 1, 3}, exact_velocity);
      }
    else
      conditions.add("given", {0, 1, 2, 3}, exact_velocity);
    fluid::FluidParameters parameters;
    parameters.viscosity = mu;
    parameters.advection =
      stokes ? fluid::AdvectionScheme::none : fluid::AdvectionScheme::ppm;
    parameters.solver.relative_tolerance = 1e-9;
    fluid::NavierStokes<dim> flow(patch_grid, conditions, parameters);
    flow.set_velocity(exact, 0.);
    grid::VectorType force;
    flow.operators().initialize_velocity(force);
    double time = 0.;
    // mu dt / (rho h^2) stays below 1000
    const unsigned int times = std::max(1u, n / 32);
    for (const double dt : {0.1 / times, 0.01})
      for (unsigned int step = 0; step < 10 * times; ++step, time += dt)
        flow.advance(time, dt, force);

    double sum = 0., volume = 0.;
    for_each_face(flow.space(),
                  [&](const std::size_t entry,
                      const unsigned int,
                      const unsigned int c,
                      const Point<dim> &x) {
                    const double w = flow.space().volumes().local_element(entry);
                    const double e = flow.velocity().local_element(entry) - exact(x, c);
                    sum += w * e * e;
                    volume += w;
                  });
    sum    = Utilities::MPI::sum(sum, MPI_COMM_WORLD);
    volume = Utilities::MPI::sum(volume, MPI_COMM_WORLD);
    return {velocity_error(flow, exact),
            std::sqrt(sum / volume),
            stokes ? pressure_error(flow, stokes_pressure<dim>) : 0.};
  }

  template <int dim>
  Result run(const unsigned int n, const bool stokes, const bool refined)
  {
    return stokes ? run<dim>(n, stokes, refined, stokes_velocity<dim>)
                  : run<dim>(n, stokes, refined, channel_velocity<dim>);
  }

  template <int dim>
  void check(const unsigned int n, const bool stokes, const double least)
  {
    const Result coarse = run<dim>(n, stokes, true), fine = run<dim>(2 * n, stokes, true);
    out() << dim << "D, " << (stokes ? "Stokes flow" : "oblique channel")
          << ": order of the velocity at the worst face "
          << above(std::log2(coarse.velocity / fine.velocity), least) << ", in L2 "
          << above(std::log2(coarse.mean_velocity / fine.mean_velocity), 1.8);
    if (stokes)
      out() << ", of the pressure in the worst cell "
            << above(std::log2(coarse.pressure / fine.pressure), 0.8);
    out() << std::endl;
  }

  template <int dim>
  void print_table(const bool stokes,
                   const bool refined,
                   const unsigned int first,
                   const unsigned int last)
  {
    Result before{};
    for (unsigned int n = first; n <= last; n *= 2)
      {
        const Result now = run<dim>(n, stokes, refined);
        char row[400];
        const auto order = [&](const double old_error, const double error) {
          static char text[4][20];
          static unsigned int next = 0;
          next                     = (next + 1) % 4;
          if (n == first || error < 1e-8)
            text[next][0] = 0;
          else
            std::snprintf(text[next], 20, "%.2f", std::log2(old_error / error));
          return text[next];
        };
        std::snprintf(row,
                      sizeof row,
                      "| %s, %dD | %s | %u | %.2e | %s | %.2e | %s | ",
                      stokes ? "Stokes flow" : "oblique channel",
                      dim,
                      refined ? "refined" : "uniform",
                      n,
                      now.mean_velocity,
                      order(before.mean_velocity, now.mean_velocity),
                      now.velocity,
                      order(before.velocity, now.velocity));
        out() << row;
        if (stokes)
          {
            std::snprintf(row,
                          sizeof row,
                          "%.2e | %s |",
                          now.pressure,
                          order(before.pressure, now.pressure));
            out() << row << std::endl;
          }
        else
          out() << " | |" << std::endl;
        before = now;
      }
  }

  /// Sum of the viscous forces in a periodic box, relative to the sum of their sizes.
  template <int dim>
  double momentum_change(const unsigned int levels)
  {
    grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD,
                                    unit_box<dim>(dim == 2 ? 32 : 16, levels, "xyz"));
    patch_grid.adapt(refine_ball(patch_grid, diagonal_point<dim>(0.4), 0.1));
    grid::StaggeredSpace<dim> space(patch_grid,
                                    all_sides<dim>(grid::BoundaryKind::velocity));
    fluid::StokesOperators<dim> operators(space);
    grid::VectorType u, force;
    space.initialize_vector(u);
    space.initialize_vector(force);
    interpolate(space, noise<dim>, u);
    space.synchronize(u);
    operators.apply_helmholtz(force, u, 0., 1., false);
    return relative_momentum(space, force);
  }
} // namespace


int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (argc > 1 && std::strcmp(argv[1], "table") == 0)
    {
      out() << "| flow | grid | 1/h | velocity, L2 | order | largest | order | pressure, "
               "largest | order |\n|---|---|---|---|---|---|---|---|---|"
            << std::endl;
      for (const bool stokes : {true, false})
        for (const bool refined : {false, true})
          // the strip takes two patches at least
          print_table<2>(stokes, refined, refined && !stokes ? 32 : 16, 128);
      print_table<3>(true, true, 16, 32);
      return 0;
    }
  check<2>(32, true, 1.8);
  check<2>(32, false, 1.8);
  check<3>(16, true, 1.5);
  const Result uniform = run<2>(32, false, false);
  out() << "2D, oblique channel on one level: " << below(uniform.velocity, 1e-5)
        << std::endl;
  out() << "change of momentum by viscosity where levels meet: 2D "
        << below(std::max(momentum_change<2>(2), momentum_change<2>(3)), 1e-13) << ", 3D "
        << below(momentum_change<3>(2), 1e-13) << std::endl;
}
