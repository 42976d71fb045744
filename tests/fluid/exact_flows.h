#ifndef mitre_tests_exact_flows_h
#define mitre_tests_exact_flows_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <cmath>
#include <iostream>

#include <mitre/fluid/navier_stokes.h>

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
    double l2, max, divergence;
    unsigned int iterations;
  };

  /// Errors over all faces that are masters.
  template <int dim, typename Exact>
  Errors
  compute_errors(const fluid::NavierStokes<dim> &flow, const Exact &exact, const double t)
  {
    const auto &space = flow.space();
    double square = 0., volume = 0., largest = 0.;
    for (unsigned int p = 0; p < space.grid().n_owned_patches(); ++p)
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int i = 0; i < space.n_dofs_per_component(); ++i)
          {
            const std::size_t dof = space.first_dof(p, c) + i;
            const double w        = space.inverse_volumes().local_element(dof);
            if (w == 0.)
              continue;
            std::array<int, dim> index;
            unsigned int rest = i;
            for (unsigned int d = 0; d < dim; ++d)
              {
                index[d] = rest % space.extent(c, d);
                rest /= space.extent(c, d);
              }
            const double error = flow.velocity().local_element(dof) -
                                 exact(space.position(p, c, index), c, t);
            square += error * error / w;
            volume += 1. / w;
            largest = std::max(largest, std::abs(error));
          }
    const MPI_Comm comm = space.grid().communicator();
    return {
      std::sqrt(Utilities::MPI::sum(square, comm) / Utilities::MPI::sum(volume, comm)),
      Utilities::MPI::max(largest, comm),
      flow.operators().max_divergence(flow.velocity()),
      0};
  }

  /// Grid of the unit box, periodic, with @p n cells of the coarsest level a side, and
  /// one more level in the middle if @p refined.
  template <int dim>
  grid::PatchGridParameters<dim>
  unit_box(const unsigned int n, const bool refined, const bool periodic)
  {
    grid::PatchGridParameters<dim> parameters;
    for (unsigned int d = 0; d < dim; ++d)
      {
        parameters.lower[d]        = 0.;
        parameters.upper[d]        = 1.;
        parameters.base_patches[d] = 1;
        parameters.periodic[d]     = periodic;
      }
    parameters.cells_per_side = 8;
    parameters.minimum_level  = 0;
    while ((8u << parameters.minimum_level) < n)
      ++parameters.minimum_level;
    parameters.maximum_level = parameters.minimum_level + (refined ? 1 : 0);
    return parameters;
  }

  /// Level that a leaf in the middle half of the box should have: one above the lowest.
  template <int dim>
  std::function<int(const BoundingBox<dim> &)>
  refine_middle(const grid::PatchGrid<dim> &patch_grid)
  {
    return [&patch_grid](const BoundingBox<dim> &box) {
      bool inside = true;
      for (unsigned int d = 0; d < dim; ++d)
        inside = inside && std::abs(box.center()[d] - 0.5) < 0.25;
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
    grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, unit_box<dim>(n, refined, true));
    if (refined)
      patch_grid.adapt(refine_middle(patch_grid));
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
} // namespace exact_flows

#endif
