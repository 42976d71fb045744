// Iterations that the coupled solver needs to reduce a residual without pattern by 1e-8,
// from 32 to 256 cells a side in 2D and 16 to 64 in 3D, uniform and with one and two
// finer levels, periodic, in a box with walls, and with open ends: bounded by one number
// that does not depend on the number of cells. Where the time step dominates (mu dt =
// 0.01 rho h^2) the projection preconditioner leaves 7 to 10, 12 are allowed; where
// viscosity does (mu dt = 10 rho h^2) 11 to 19, 22 are allowed.

#include <mitre/base/exceptions.h>

#include "fluid_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

template <int dim>
unsigned int
iterations(const unsigned int n,
           const unsigned int levels,
           const std::string &kind,
           const double diffusion_number,
           const unsigned int maximum = 100)
{
  grid::PatchGrid<dim> patch_grid(
    MPI_COMM_WORLD, unit_box<dim>(n, levels, kind == "periodic" ? "xyz" : ""));
  Point<dim> center = diagonal_point<dim>(0.6);
  patch_grid.adapt(refine_ball(patch_grid, center, 0.2));
  fluid::BoundaryConditions<dim> conditions;
  if (kind == "open")
    conditions.add(
      "ends", {0, 1}, given_pressure<dim>([](const Point<dim> &, unsigned int, double) {
        return 0.;
      }));
  std::vector<unsigned int> sides(2 * dim);
  for (unsigned int side = 0; side < 2 * dim; ++side)
    sides[side] = side;
  conditions.add("walls", sides, wall<dim>());

  grid::StaggeredSpace<dim> space(patch_grid, conditions.kinds());
  fluid::StokesOperators<dim> operators(space);
  fluid::StokesSolverParameters parameters;
  parameters.relative_tolerance = 1e-8;
  parameters.maximum_iterations = maximum;
  const double h                = patch_grid.cell_width(patch_grid.maximum_level(), 0);
  fluid::StokesSolver<dim> solver(operators, parameters, 1., diffusion_number * h * h);
  solver.set_time_step(1.);

  grid::VectorType u, p, residual;
  operators.initialize_velocity(u);
  operators.initialize_velocity(residual);
  operators.initialize_pressure(p);
  interpolate(space, noise<dim>, residual);
  space.zero_fixed_faces(residual);
  space.synchronize(residual);
  return solver.solve(u, p, residual, residual.l2_norm());
}

template <int dim>
void
check(const std::vector<unsigned int> &sizes,
      const unsigned int levels,
      const std::string &kind,
      const double diffusion_number,
      const unsigned int bound)
{
  unsigned int largest = 0;
  for (const unsigned int n : sizes)
    {
      const unsigned int k = iterations<dim>(n, levels, kind, diffusion_number);
      largest              = std::max(largest, k);
    }
  out() << dim << "D, " << kind << ", " << levels
        << " levels, mu dt / (rho h^2) = " << diffusion_number << ": "
        << below(largest, bound + 0.5) << std::endl;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const double diffusion_number : {0.01, 10.})
    {
      const bool viscous       = diffusion_number > 1.;
      const unsigned int bound = viscous ? 22 : 12;
      for (const std::string kind : {"periodic", "walls", "open"})
        {
          check<2>({32, 64, 128, 256}, 1, kind, diffusion_number, bound);
          check<2>({32, 64, 128}, 2, kind, diffusion_number, bound);
          check<2>({32, 64}, 3, kind, diffusion_number, bound);
        }
      if (viscous)
        check<3>({16, 32}, 1, "open", diffusion_number, bound);
      else
        check<3>({16, 32, 64}, 1, "open", diffusion_number, bound);
      check<3>({16, 32}, 2, "walls", diffusion_number, bound);
    }
  try
    {
      iterations<2>(32, 1, "walls", 0.01, 3);
      out() << "3 iterations were enough: FAILED" << std::endl;
    }
  catch (const base::UserError &error)
    {
      const std::string message = error.what();
      out() << message.substr(0, message.find(':')) << std::endl;
    }
}
