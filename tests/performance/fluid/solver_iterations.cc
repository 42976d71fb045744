// Prints the table of doc/solver.md: iterations of the Stokes solver that reduce the
// residual of a right-hand side without pattern by 1e-8, from a start at zero, over the
// size of the grid, finer levels in nested boxes, the size of the patches, the
// boundaries, and mu dt / (rho h^2), where h is the smallest cell width. With "times" it
// adds the milliseconds of each solve.
//
// Usage: solver_iterations [2|3|both = both] [boundary|all = all] [largest size = 256]
// [multigrid|hypre = multigrid] [times]

#include <cstdio>

#include "../../fluid/solver_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

namespace
{
  fluid::StokesSolverParameters parameters;
  bool with_times = false;

  template <int dim>
  void print_row(const SolverBox &box)
  {
    SolverProblem<dim> problem(box);
    std::ostringstream row;
    row << "| " << dim << "D | " << box.boundary << " | " << box.n_patch << " | " << box.n
        << " | " << box.n_finer << " |";
    for (const double diffusion_number : {1e-4, 1e-2, 1., 10., 100., 1000.})
      {
        try
          {
            row << ' ' << problem.solve(parameters, diffusion_number);
            if (with_times)
              row << " (" << static_cast<int>(1e3 * problem.seconds + 0.5) << " ms)";
            row << " |";
          }
        catch (const base::UserError &)
          {
            row << " >" << parameters.maximum_iterations << " |";
          }
      }
    out() << row.str() << std::endl;
  }

  template <int dim>
  void print_rows(const std::string &boundary, const unsigned int largest)
  {
    for (const unsigned int n_patch : {8, 16})
      for (unsigned int n_finer = 0; n_finer <= 3; ++n_finer)
        {
          // a level more has about as many cells as one size more
          const unsigned int limit =
            std::min(largest, (dim == 2 ? 256u : 128u) >> (n_finer == 0 ? 0 : dim - 1));
          for (unsigned int n = (dim == 2 ? 32 : 16); n <= limit; n *= 2)
            print_row<dim>({n, n_patch, n_finer, boundary});
        }
  }
} // namespace


int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const std::string dimension = argc > 1 ? argv[1] : "both";
  const std::string boundary  = argc > 2 ? argv[2] : "all";
  const unsigned int largest  = argc > 3 ? std::atoi(argv[3]) : 256;
  with_times                  = argc > 5;

  if (argc > 4 && std::string(argv[4]) == "hypre")
    parameters.pressure_preconditioner = fluid::PressurePreconditioner::hypre;
  parameters.relative_tolerance = 1e-8;
  parameters.maximum_iterations = 100;
  out() << "| | boundary | cells a patch | cells a side | finer levels | 1e-4 | 1e-2 | 1 "
           "| 10 | 100 | 1000 |\n|---|---|---|---|---|---|---|---|---|---|---|"
        << std::endl;
  for (const std::string kind : {"periodic", "walls", "open", "disc"})
    if (boundary == "all" || boundary == kind)
      {
        if (dimension != "3")
          print_rows<2>(kind, largest);
        if (dimension != "2")
          print_rows<3>(kind, largest);
      }
}
