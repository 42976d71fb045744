#ifndef mitre_grid_cell_halo_h
#define mitre_grid_cell_halo_h

#include <deal.II/lac/la_parallel_vector.h>

#include <memory>
#include <vector>

#include <mitre/grid/staggered_space.h>

namespace mitre::grid
{
  /**
   * Values in the cells of all patches, m cells along a side (m = n for the pressure, a
   * divisor of n on coarser multigrid levels), and copies of them that are padded by one
   * layer across the sides of a patch (corners are not filled).
   *
   * Beyond a side lie the cells of a neighbour of the same level, the coarse cell that
   * touches the face, the mean of the fine cells that touch it, or, at the domain
   * boundary, zero.
   */
  template <int dim, typename Number = double>
  class CellHalo
  {
  public:
    using Vector = dealii::LinearAlgebra::distributed::Vector<Number>;
    using Index  = std::array<int, dim>;

    CellHalo(const PatchGrid<dim> &grid, const unsigned int cells_per_side);

    unsigned int n_cells_per_side() const
    {
      return m;
    }

    unsigned int n_cells_per_patch() const
    {
      return cells_per_patch;
    }

    void initialize_vector(Vector &vector) const
    {
      vector.reinit(partitioner);
    }

    /// Number of entries of a padded array, (m+2)^dim.
    std::size_t padded_size() const
    {
      return dealii::Utilities::fixed_power<dim>(m + 2);
    }

    /**
     * Fills @p padded with the cells of owned patch @p p and one layer beyond each side.
     * The ghost values of @p v must be up to date.
     */
    void gather(const Vector &v, const unsigned int p, Number *padded) const;

    const PatchGrid<dim> &grid() const
    {
      return patch_grid;
    }

    std::size_t memory_consumption() const;

  private:
    const PatchGrid<dim> &patch_grid;
    const unsigned int m, cells_per_patch, cells_per_plane;

    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;

    /// Per patch and side: a patch of this rank, or the start of a list of entries.
    struct Side
    {
      Neighbor kind;
      bool whole;
      unsigned int patch_or_start;
    };
    std::vector<Side> sides;

    /// One entry a face (same, coarser) or 2^(dim-1) (finer).
    std::vector<unsigned int> entries;
  };
} // namespace mitre::grid

#endif
