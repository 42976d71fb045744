#ifndef mitre_grid_solution_transfer_h
#define mitre_grid_solution_transfer_h

#include <memory>
#include <vector>

#include <mitre/grid/cell_halo.h>
#include <mitre/grid/velocity_halo.h>

namespace mitre::grid
{
  /**
   * Carries velocities and cell values through a change of the grid, also to other ranks.
   * Refined patches are interpolated linearly; coarsened ones take the mean of the fine
   * faces (which keeps div u = 0) and cells.
   *
   * Usage: construct before the change with everything that belongs to the old grid;
   * after it, when PatchGrid::update() has been called, finish() with vectors of the new
   * one.
   */
  template <int dim>
  class SolutionTransfer
  {
  public:
    SolutionTransfer(PatchGrid<dim> &grid,
                     const StaggeredSpace<dim> &space,
                     const CellHalo<dim> &cells,
                     const std::vector<const VectorType *> &velocities,
                     const std::vector<const VectorType *> &cell_values);

    void finish(const StaggeredSpace<dim> &space,
                const std::vector<VectorType *> &velocities,
                const std::vector<VectorType *> &cell_values);

  private:
    using CellIterator = typename dealii::Triangulation<dim>::cell_iterator;
    using CellStatus   = typename dealii::Triangulation<dim>::CellStatus;

    std::vector<char> pack(const CellIterator &cell, const CellStatus status) const;

    PatchGrid<dim> &grid;
    const StaggeredSpace<dim> &space;
    const CellHalo<dim> &cells;
    VelocityHalo<dim> halo;
    std::vector<const VectorType *> velocities, cell_values;
    std::vector<VectorType> ghosted_velocities, ghosted_cells;
    unsigned int handle;
  };
} // namespace mitre::grid

#endif
