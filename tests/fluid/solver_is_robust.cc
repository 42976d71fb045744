// The Stokes solver reduces the residual of a right-hand side without pattern by 1e-8 in
// a number of iterations that does not grow with the number of cells, of finer levels (in
// boxes one inside the other) or of the cells of a patch, whether the time step or
// viscosity dominates, and whatever holds at the boundaries. The bounds are the same for
// all boxes; the worst at mu dt = 1000 rho h^2, open discs in walls in 3D, takes 32.
// doc/solver.md has more of the table.

#include "solver_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

template <int dim>
void
check(const std::vector<SolverBox> &boxes,
      const std::vector<std::pair<double, unsigned int>> &bounds)
{
  fluid::StokesSolverParameters parameters;
  parameters.relative_tolerance = 1e-8;
  std::vector<unsigned int> largest(bounds.size(), 0);
  for (const SolverBox &box : boxes)
    {
      SolverProblem<dim> problem(box);
      for (unsigned int i = 0; i < bounds.size(); ++i)
        largest[i] = std::max(largest[i], problem.solve(parameters, bounds[i].first));
    }
  for (unsigned int i = 0; i < bounds.size(); ++i)
    {
      out() << dim << "D, " << boxes.front().boundary
            << ", mu dt / (rho h^2) = " << bounds[i].first << ": iterations at most "
            << bounds[i].second << ": ";
      if (largest[i] <= bounds[i].second)
        out() << "yes" << std::endl;
      else
        out() << "no, but " << largest[i] << std::endl;
    }
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const std::string boundary : {"periodic", "walls", "open", "disc"})
    {
      const std::vector<std::pair<double, unsigned int>> bounds = {
        {1e-4, 11}, {1e-2, 12}, {1., 15}, {10., 21}, {100., 27}, {1000., 34}};
      check<2>({{32, 8, 0, boundary},
                {128, 8, 0, boundary},
                {128, 16, 0, boundary},
                {32, 8, 1, boundary},
                {32, 8, 3, boundary},
                {64, 8, 2, boundary},
                {64, 16, 2, boundary}},
               bounds);
      check<3>({{16, 8, 0, boundary}, {32, 16, 0, boundary}, {16, 8, 1, boundary}},
               bounds);
    }
}
