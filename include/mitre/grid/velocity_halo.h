#ifndef mitre_grid_velocity_halo_h
#define mitre_grid_velocity_halo_h

#include <memory>
#include <vector>

#include <mitre/grid/staggered_space.h>

namespace mitre::grid
{
  /// Which neighbours a halo takes values from.
  enum class HaloShape : unsigned char
  {
    star, ///< across the sides only, as difference stencils need
    full  ///< edges and corners too, as the delta kernels need
  };


  /**
   * Copies of the velocity on a patch that are padded on every side by a number of
   * layers from what lies beyond: patches of the same level, averages of finer ones,
   * quadratic interpolation from coarser ones, or the extension by the boundary
   * condition. With BoundaryExtension::quadratic, for second differences, the faces on
   * the interface to a coarser patch are replaced, too, by quadratic interpolation.
   *
   * gather() is linear in the vector (plus prescribed boundary values, if wanted), and
   * scatter_add() is its exact transpose; rows of the gather sum to one away from
   * boundaries, so that scattering conserves the sum.
   *
   * Entry (i_0, i_1, ..) of a padded array, i_0 fastest, of component c is at
   * x_d = lower_d + (i_d - width + (d == c ? 0 : 1/2)) h_d.
   */
  template <int dim>
  class VelocityHalo
  {
  public:
    using Index = std::array<int, dim>;

    /**
     * After construction either make_own_partitioner(), so that import() copies vectors
     * of the solver into one that has the ghosts, or add_ghosts() to the ghosts that the
     * solver's vectors have anyhow and localize().
     */
    VelocityHalo(const StaggeredSpace<dim> &space,
                 const unsigned int width,
                 const HaloShape shape,
                 const BoundaryExtension extension);

    unsigned int width() const
    {
      return g;
    }

    HaloShape shape() const
    {
      return halo_shape;
    }

    /// Extents of the padded array of component @p c: n + (d == c) + 2 width.
    std::array<unsigned int, dim> extents(const unsigned int c) const;

    /// Number of entries of the padded array of component @p c.
    std::size_t size(const unsigned int c) const;

    /// Entries of other ranks that the halo reads.
    void add_ghosts(std::vector<dealii::types::global_dof_index> &ghosts) const;

    /// Uses vectors with this partitioner from now on.
    void localize(
      const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &partitioner);

    /// Makes a partitioner of its own, for import() and scattering.
    void make_own_partitioner();

    /// The vector with this halo's ghost values. Needs make_own_partitioner().
    /// Collective.
    const VectorType &import(const VectorType &u);

    /// What import() returned last.
    const VectorType &last_import() const
    {
      return imported;
    }

    /// Prescribed values that gather() adds when asked to.
    void set_boundary_values(
      const std::function<double(const BoundaryTerm<dim> &)> &prescribed);

    /// Fills the padded array of component @p c of owned patch @p p.
    void gather(const VectorType &u,
                const unsigned int p,
                const unsigned int c,
                double *padded,
                const bool with_boundary_values = false) const;

    /// Prepares scattering: an accumulator of zeros.
    void begin_scatter();

    /// Adds the transpose of gather() to the accumulator.
    void scatter_add(const unsigned int p, const unsigned int c, const double *padded);

    /**
     * Sums the contributions of all ranks and writes the density (accumulated value /
     * control volume), zero on faces with given velocity, consistent on all copies.
     * @p total, if given, receives the sums on the masters before the division.
     * Collective.
     */
    void end_scatter(VectorType &density, VectorType *total = nullptr);

    std::size_t memory_consumption() const;

  private:
    void build();
    std::shared_ptr<const PatchRows<dim>> build_rows(const unsigned int p,
                                                     const unsigned int direction) const;

    bool has_neighbor(const unsigned int direction) const;

    /// The faces of component @p c of patch @p p, with its halo, on interfaces to coarser
    /// leaves: entry of the padded array, and index. Those beyond the patch in @p
    /// direction, and for sides those of the patch there, too.
    std::vector<std::pair<unsigned int, Index>>
    interface_faces(const unsigned int p,
                    const unsigned int c,
                    const unsigned int direction) const;

    const StaggeredSpace<dim> &space;
    const unsigned int n, g;
    const HaloShape halo_shape;
    const BoundaryExtension extension;

    /// Boxes of entries that are copied from a patch of this rank.
    struct Block
    {
      unsigned int patch;
      unsigned short int direction; ///< number of the offset, base 3
    };

    /// Per offset (base 3) and component: extents and starts of the copied box.
    struct BlockShape
    {
      std::array<unsigned int, 3> size;
      std::size_t from, to;
    };
    std::vector<std::array<BlockShape, dim>> shapes;

    /// Calls operation(to, from, index) for the entries of component @p c that lie beyond
    /// the patch in a direction: their places in the padded array and in a neighbour of
    /// the same level, and their indices relative to the patch.
    template <typename Operation>
    void for_each_entry(const unsigned int direction,
                        const unsigned int c,
                        const Operation &operation) const;

    void copy_block(const BlockShape &shape,
                    const unsigned int c,
                    const double *from,
                    double *padded) const;

    std::vector<unsigned int> block_starts;
    std::vector<Block> blocks;

    /// Per patch and component: entries copied from ghosts.
    std::vector<std::size_t> single_starts;
    std::vector<unsigned int> single_to;
    std::vector<dealii::types::global_dof_index> single_from_global;
    std::vector<unsigned int> single_from;

    /// A set of rows for each component, and one of the values of coarser leaves
    /// that are not unknowns themselves, to which these rows refer.
    RowTable<dim> rows;
    mutable std::vector<double> auxiliary;

    static unsigned int auxiliary_set(const unsigned int c)
    {
      return dim + c;
    }

    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;
    VectorType imported, accumulator;
  };
} // namespace mitre::grid

#endif
