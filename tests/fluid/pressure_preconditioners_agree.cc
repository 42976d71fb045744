// Geometric multigrid and hypre's algebraic multigrid on the assembled pressure operator
// give the same velocity and pressure: uniform and with two finer levels, with walls
// (pressure up to a constant), open ends, and periodic. The assembled operator is the one
// that is applied, V (-div grad), to rounding. The same holds when a flow has gone
// through changes of its grid.

#include <mitre/fluid/pressure_hypre.h>

#include "solver_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

template <int dim>
double
relative_difference(const grid::VectorType &a, const grid::VectorType &b)
{
  grid::VectorType difference = a;
  difference.add(-1., b);
  return difference.linfty_norm() / a.linfty_norm();
}

/// Largest difference of assembled and applied operator, relative to the largest value,
/// without the first cell, in which a pressure up to a constant is fixed.
template <int dim>
double
assembly_error(SolverProblem<dim> &problem)
{
  const auto &operators = *problem.operators;
  fluid::PressureHypre<dim> hypre(operators);
  grid::VectorType phi, gradient, product;
  operators.initialize_pressure(phi);
  operators.initialize_pressure(product);
  operators.initialize_velocity(gradient);
  for_each_cell(
    problem.patch_grid,
    [&](const std::size_t entry, const unsigned int, const Point<dim> &x, const double) {
      phi.local_element(entry) = noise(x, 0);
    });
  operators.apply_gradient(gradient, phi, false);
  operators.apply_divergence(product, gradient);

  const auto &matrix  = hypre.assembled_matrix();
  const IndexSet rows = matrix.locally_owned_range_indices();
  PETScWrappers::MPI::Vector src(rows, MPI_COMM_WORLD), dst(rows, MPI_COMM_WORLD);
  for (std::size_t i = 0; i < phi.locally_owned_size(); ++i)
    src(rows.nth_index_in_set(i)) = phi.local_element(i);
  src.compress(VectorOperation::insert);
  matrix.vmult(dst, src);
  double error = 0., largest = 0.;
  for_each_cell(problem.patch_grid,
                [&](const std::size_t entry,
                    const unsigned int,
                    const Point<dim> &,
                    const double volume) {
                  const auto row = rows.nth_index_in_set(entry);
                  if (row == 0)
                    return;
                  largest = std::max(largest, std::abs(dst(row)));
                  error   = std::max(
                    error, std::abs(dst(row) + volume * product.local_element(entry)));
                });
  return Utilities::MPI::max(error, MPI_COMM_WORLD) /
         Utilities::MPI::max(largest, MPI_COMM_WORLD);
}

template <int dim>
void
check(const SolverBox &box, const unsigned int bound)
{
  out() << dim << "D, " << box.boundary << ", " << box.n_finer << " finer levels"
        << std::endl;
  SolverProblem<dim> problem(box);
  out() << "  error of the assembled operator " << below(assembly_error(problem), 1e-13)
        << std::endl;
  fluid::StokesSolverParameters parameters;
  parameters.relative_tolerance     = 1e-11;
  const unsigned int with_multigrid = problem.solve(parameters, 0.01);
  const grid::VectorType u = problem.u, p = problem.p;
  parameters.pressure_preconditioner = fluid::PressurePreconditioner::hypre;
  const unsigned int with_hypre      = problem.solve(parameters, 0.01);
  out() << "  iterations with multigrid " << below(with_multigrid, bound + 0.5)
        << ", with hypre " << below(with_hypre, bound + 0.5) << std::endl
        << "  difference of velocity "
        << below(relative_difference<dim>(u, problem.u), 1e-8) << ", of pressure "
        << below(relative_difference<dim>(p, problem.p), 1e-8) << std::endl;
}

/// Velocity and pressure of a vortex after steps on three grids, one after the other.
std::pair<grid::VectorType, grid::VectorType>
vortex(const fluid::PressurePreconditioner pressure_preconditioner)
{
  grid::PatchGrid<2> patch_grid(MPI_COMM_WORLD, unit_box<2>(32, 2, ""));
  fluid::BoundaryConditions<2> conditions;
  conditions.add("walls", {0, 1, 2, 3}, wall<2>());
  fluid::FluidParameters parameters;
  parameters.solver.relative_tolerance      = 1e-12;
  parameters.solver.pressure_preconditioner = pressure_preconditioner;
  fluid::NavierStokes<2> flow(patch_grid, conditions, parameters);
  flow.set_velocity(
    [](const Point<2> &x, const unsigned int c) {
      const double s0 = std::sin(numbers::PI * x[0]), s1 = std::sin(numbers::PI * x[1]);
      return c == 0 ? s0 * s0 * std::sin(2. * numbers::PI * x[1])
                    : -s1 * s1 * std::sin(2. * numbers::PI * x[0]);
    },
    0.);
  grid::VectorType force;
  const double dt = 0.005;
  double t        = 0.;
  for (const double place : {0.3, 0.5, 0.7})
    {
      flow.regrid(refine_ball(patch_grid, diagonal_point<2>(place), 0.15), t);
      flow.operators().initialize_velocity(force);
      for (unsigned int step = 0; step < 2; ++step, t += dt)
        {
          if (flow.is_first_step())
            flow.predict(t, dt, force);
          flow.advance(t, dt, force);
        }
    }
  return {flow.velocity(), flow.pressure()};
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const std::string boundary : {"walls", "open", "periodic"})
    {
      check<2>({64, 8, 0, boundary}, 16);
      check<2>({32, 8, 2, boundary}, 16);
    }
  check<3>({16, 8, 0, "walls"}, 16);
  check<3>({16, 8, 2, "open"}, 16);

  const auto [u, p] = vortex(fluid::PressurePreconditioner::multigrid);
  const auto [v, q] = vortex(fluid::PressurePreconditioner::hypre);
  out() << "a flow through changes of its grid: difference of velocity "
        << below(relative_difference<2>(u, v), 1e-8) << ", of pressure "
        << below(relative_difference<2>(p, q), 1e-8) << std::endl;
}
