#ifndef mitre_tests_fluid_solver_tests_h
#define mitre_tests_fluid_solver_tests_h

#include <deal.II/base/timer.h>

#include <mitre/base/exceptions.h>

#include "fluid_tests.h"

namespace fluid_tests
{
  /// A box of the Stokes solver's table: its grid and what holds at its sides.
  struct SolverBox
  {
    unsigned int n       = 32;      ///< cells of the lowest level a side
    unsigned int n_patch = 8;       ///< cells a side of a patch
    unsigned int n_finer = 0;       ///< finer levels, in boxes one inside the other
    std::string boundary = "walls"; ///< periodic, walls, open (sides 0 and 1 have a
                                    ///< given pressure) or disc (a part of them has)
    bool operator==(const SolverBox &other) const
    {
      return n == other.n && n_patch == other.n_patch && n_finer == other.n_finer &&
             boundary == other.boundary;
    }
  };


  /**
   * The system of one time step with density and step 1 on the unit box, and a right-hand
   * side without pattern that depends on place only.
   */
  template <int dim>
  class SolverProblem
  {
  public:
    explicit SolverProblem(const SolverBox &box)
      : patch_grid(MPI_COMM_WORLD, grid_of(box))
    {
      patch_grid.adapt([&](const BoundingBox<dim> &leaf) {
        // the k-th finer level fills a box of half the width of the one before
        int level    = patch_grid.minimum_level();
        double width = 0.5;
        for (unsigned int k = 0; k < box.n_finer; ++k, width *= 0.5)
          {
            bool meets = true;
            for (unsigned int d = 0; d < dim; ++d)
              meets = meets && leaf.lower_bound(d) < 0.55 + 0.5 * width &&
                      leaf.upper_bound(d) > 0.55 - 0.5 * width;
            level += (meets ? 1 : 0);
          }
        return level;
      });
      space = std::make_unique<grid::StaggeredSpace<dim>>(
        patch_grid, [box](const unsigned int side, const Point<dim> &x) {
          double square = 0.;
          for (unsigned int d = 1; d < dim; ++d)
            square += (x[d] - 0.4) * (x[d] - 0.4);
          const bool open = side < 2 && (box.boundary == "open" ||
                                         (box.boundary == "disc" && square < 0.0625));
          return grid::BoundaryInfo{
            open ? grid::BoundaryKind::traction : grid::BoundaryKind::velocity, 0};
        });
      operators = std::make_unique<fluid::StokesOperators<dim>>(*space);
      operators->initialize_velocity(u);
      operators->initialize_pressure(p);
      operators->initialize_velocity(rhs);
      grid_tests::interpolate(*space, grid_tests::noise<dim>, rhs);
      space->zero_fixed_faces(rhs);
      space->synchronize(rhs);
    }

    /// Solves from zero with mu dt / (rho h^2) = @p diffusion_number for the smallest h,
    /// and returns the number of iterations.
    unsigned int solve(const fluid::StokesSolverParameters &parameters,
                       const double diffusion_number)
    {
      const double h = patch_grid.cell_width(patch_grid.maximum_level(), 0);
      fluid::StokesSolver<dim> solver(
        *operators, parameters, 1., diffusion_number * h * h);
      solver.set_time_step(1.);
      u                         = 0.;
      p                         = 0.;
      grid::VectorType residual = rhs;
      Timer timer(MPI_COMM_WORLD, true);
      const unsigned int iterations = solver.solve(u, p, residual, rhs.l2_norm());
      timer.stop();
      seconds = timer.wall_time();
      return iterations;
    }

    grid::PatchGrid<dim> patch_grid;
    std::unique_ptr<grid::StaggeredSpace<dim>> space;
    std::unique_ptr<fluid::StokesOperators<dim>> operators;
    grid::VectorType u, p, rhs;
    double seconds = 0.; ///< wall time of the last solve()

  private:
    static grid::PatchGridParameters<dim> grid_of(const SolverBox &box)
    {
      auto parameters =
        grid_tests::unit_box<dim>(8, 1, box.boundary == "periodic" ? "xyz" : "");
      parameters.cells_per_side = box.n_patch;
      parameters.minimum_level  = 0;
      while ((box.n_patch << parameters.minimum_level) < box.n)
        ++parameters.minimum_level;
      parameters.maximum_level = parameters.minimum_level + box.n_finer;
      return parameters;
    }
  };
} // namespace fluid_tests

#endif
