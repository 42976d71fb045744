#ifndef mitre_tests_exact_flows_h
#define mitre_tests_exact_flows_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

#include <mitre/fluid/navier_stokes.h>

#include "../grid/grid_tests.h"

namespace exact_flows
{
  using namespace dealii;
  using namespace mitre;

  /// Taylor-Green vortices carried by a uniform stream, unit periodic square.
  struct TaylorGreen
  {
    double nu;

    double operator()(const Point<2> &x, const unsigned int c, const double t) const
    {
      const double k = 2. * numbers::PI, decay = std::exp(-2. * k * k * nu * t);
      const double a = k * (x[0] - t), b = k * (x[1] - t);
      return 1. + 2. * decay *
                    (c == 0 ? -std::cos(a) * std::sin(b) : std::sin(a) * std::cos(b));
    }
  };

  /// Arnold-Beltrami-Childress flow, an exact Navier-Stokes solution in three
  /// dimensions, unit periodic cube.
  struct ABC
  {
    double nu;

    double operator()(const Point<3> &x, const unsigned int c, const double t) const
    {
      const double k = 2. * numbers::PI, decay = std::exp(-k * k * nu * t);
      const unsigned int d = (c + 1) % 3, e = (c + 2) % 3;
      return decay * (std::sin(k * x[e]) + std::cos(k * x[d]));
    }
  };

  struct Errors
  {
    double l2, max;
    double max_away; ///< away from the sides of the quarter that refine_quarter() refines
    unsigned int iterations;
  };

  /// Distance from the sides of the box (0, 1/2)^dim, of which the unit box has periodic
  /// images.
  template <int dim>
  double distance_from_quarter(const Point<dim> &x)
  {
    double inside = 1., outside = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double y        = x[d] - std::floor(x[d]);
        const double distance = std::min({std::abs(y), std::abs(y - 0.5), 1. - y});
        if (y < 0.5)
          inside = std::min(inside, distance);
        else
          {
            outside += distance * distance;
            inside = 0.;
          }
      }
    return outside > 0. ? std::sqrt(outside) : inside;
  }

  /// Errors over all faces that are masters.
  template <int dim, typename Exact>
  Errors
  compute_errors(const fluid::NavierStokes<dim> &flow, const Exact &exact, const double t)
  {
    const auto &space = flow.space();
    double square = 0., volume = 0., largest = 0., largest_away = 0.;
    grid_tests::for_each_face(space,
                              [&](const std::size_t entry,
                                  const unsigned int,
                                  const unsigned int c,
                                  const Point<dim> &x) {
                                const double w = space.volumes().local_element(entry);
                                if (w == 0.)
                                  return;
                                const double error =
                                  flow.velocity().local_element(entry) - exact(x, c, t);
                                square += error * error * w;
                                volume += w;
                                largest = std::max(largest, std::abs(error));
                                if (distance_from_quarter(x) > 1. / 8.)
                                  largest_away = std::max(largest_away, std::abs(error));
                              });
    const MPI_Comm comm = space.grid().communicator();
    return {
      std::sqrt(Utilities::MPI::sum(square, comm) / Utilities::MPI::sum(volume, comm)),
      Utilities::MPI::max(largest, comm),
      Utilities::MPI::max(largest_away, comm),
      0};
  }

  /**
   * Asks for the finest level in the box from 0 to 1/2 in each direction, for the lowest
   * elsewhere. On a periodic box that is as good as the middle, and needs two patches a
   * side only.
   */
  template <int dim>
  std::function<int(const BoundingBox<dim> &)>
  refine_quarter(const grid::PatchGrid<dim> &patch_grid)
  {
    return [&patch_grid](const BoundingBox<dim> &box) {
      bool inside = true;
      for (unsigned int d = 0; d < dim; ++d)
        inside = inside && box.center()[d] < 0.5;
      return static_cast<int>(inside ? patch_grid.maximum_level()
                                     : patch_grid.minimum_level());
    };
  }

  template <int dim, typename Exact>
  Errors run(const unsigned int n,
             const bool refined,
             const Exact &exact,
             const double end_time,
             const double courant,
             const double tolerance)
  {
    grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD,
                                    grid_tests::unit_box<dim>(n, refined ? 2 : 1, "xyz"));
    if (refined)
      patch_grid.adapt(refine_quarter(patch_grid));
    fluid::FluidParameters parameters;
    parameters.viscosity                 = exact.nu;
    parameters.solver.relative_tolerance = tolerance;
    fluid::BoundaryConditions<dim> none;
    fluid::NavierStokes<dim> flow(patch_grid, none, parameters);
    flow.set_velocity(
      [&](const Point<dim> &x, const unsigned int c) { return exact(x, c, 0.); }, 0.);
    const unsigned int steps = std::lround(end_time * n / courant);
    const double dt          = end_time / steps;
    grid::VectorType force;
    flow.operators().initialize_velocity(force);
    unsigned int iterations = 0;
    for (unsigned int step = 0; step < steps; ++step)
      iterations += flow.advance(step * dt, dt, force);
    Errors errors     = compute_errors(flow, exact, end_time);
    errors.iterations = (iterations + steps - 1) / steps;
    return errors;
  }

  /// Prints the orders of convergence of the velocity from n to 2n cells a side.
  template <int dim, typename Exact>
  void check_order(const std::string &name,
                   const unsigned int n,
                   const bool refined,
                   const Exact &exact,
                   const double end_time,
                   const double courant,
                   const double least_l2,
                   const double least_max,
                   const double least_away)
  {
    const double tolerance = 1e-7;
    const Errors coarse    = run<dim>(n, refined, exact, end_time, courant, tolerance);
    const Errors fine = run<dim>(2 * n, refined, exact, end_time, courant, tolerance);
    grid_tests::out() << name << (refined ? ", refined" : ", uniform") << ": order in L2 "
                      << grid_tests::above(std::log2(coarse.l2 / fine.l2), least_l2)
                      << ", of the maximum "
                      << grid_tests::above(std::log2(coarse.max / fine.max), least_max)
                      << ", away from interfaces "
                      << grid_tests::above(std::log2(coarse.max_away / fine.max_away),
                                           least_away)
                      << std::endl;
  }

  /// Prints a table of errors and orders for n, 2n, .. cells a side.
  template <int dim, typename Exact>
  void print_table(const std::string &name,
                   const unsigned int first,
                   const unsigned int last,
                   const bool refined,
                   const Exact &exact,
                   const double end_time,
                   const double courant)
  {
    Errors before = {0., 0., 0., 0};
    for (unsigned int n = first; n <= last; n *= 2)
      {
        const Errors now  = run<dim>(n, refined, exact, end_time, courant, 1e-7);
        const auto column = [&](const double value, const double value_before) {
          std::ostringstream text;
          text << " | " << std::scientific << std::setprecision(2) << value << " | ";
          if (n > first)
            text << std::fixed << std::log2(value_before / value);
          return text.str();
        };
        grid_tests::out() << "| " << name << " | " << (refined ? "refined" : "uniform")
                          << " | " << n << column(now.l2, before.l2)
                          << column(now.max, before.max)
                          << column(now.max_away, before.max_away) << " |" << std::endl;
        before = now;
      }
  }
} // namespace exact_flows

#endif
