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
   * Usage: construct before the change, which takes the contents of the vectors; after
   * it, when PatchGrid::update() has been called, finish() with vectors of the new grid,
   * or give_back() if nothing has changed. What belongs to the old grid must live until
   * then.
   */
  template <int dim>
  class SolutionTransfer
  {
  public:
    /// @p halo serves to interpolate to refined patches; it has a partitioner of its own
    /// and extends velocities beyond boundaries by reflection.
    SolutionTransfer(PatchGrid<dim> &grid,
                     const StaggeredSpace<dim> &space,
                     VelocityHalo<dim> &halo,
                     const CellHalo<dim> &cells,
                     const std::vector<VectorType *> &velocities,
                     const std::vector<VectorType *> &cell_values);

    /// Collective.
    void finish(const StaggeredSpace<dim> &space,
                const std::vector<VectorType *> &velocities,
                const std::vector<VectorType *> &cell_values);

    /// Returns the contents to the vectors that they came from.
    void give_back();

  private:
    using CellIterator = typename dealii::Triangulation<dim>::cell_iterator;
    using CellStatus   = typename dealii::Triangulation<dim>::CellStatus;

    /// What goes along with a leaf in the forest: of one that stays what it is only
    /// where its values are, of others the values.
    std::vector<char> pack(const CellIterator &cell, const CellStatus status) const;

    /// Copies the values of an old patch to @p to, one vector after the other.
    double *copy_patch(const unsigned int p, double *to) const;

    PatchGrid<dim> &grid;
    const StaggeredSpace<dim> &space;
    const CellHalo<dim> &cells;
    VelocityHalo<dim> &halo;
    const unsigned int halo_width;
    const std::vector<VectorType *> original_velocities, original_cells;
    std::vector<VectorType> velocities, cell_values;
    std::vector<VectorType> ghosted_velocities;
    unsigned int handle;
  };
} // namespace mitre::grid

#endif
