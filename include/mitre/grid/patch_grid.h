#ifndef mitre_grid_patch_grid_h
#define mitre_grid_patch_grid_h

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>
#include <deal.II/base/types.h>
#include <deal.II/distributed/tria.h>

#include <array>
#include <functional>
#include <unordered_map>
#include <vector>

namespace mitre::grid
{
  /**
   * The n^dim Cartesian fluid cells that one leaf of the forest carries.
   */
  template <int dim>
  struct Patch
  {
    /// Corner with the smallest coordinates [cm].
    dealii::Point<dim> lower;

    /// Cell width in each direction [cm].
    std::array<double, dim> h;

    /// Refinement level of the leaf.
    int level;

    /// Position in the grid of all patches of that level.
    std::array<int, dim> index;

    /// Number of the leaf among all leaves of all ranks.
    dealii::types::global_dof_index global_id;
  };


  /// A leaf of a forest: its level, and its position in the grid of all patches of that
  /// level; the third coordinate is 0 in two dimensions.
  struct Leaf
  {
    int level;
    std::array<int, 3> index;
  };


  /// What lies beyond a side of a patch.
  enum class Neighbor : unsigned char
  {
    same,
    coarser,
    finer,
    boundary
  };


  /**
   * Size and refinement limits of the Eulerian grid, as the user gives them.
   */
  template <int dim>
  struct PatchGridParameters
  {
    dealii::Point<dim> lower;
    dealii::Point<dim> upper;
    std::array<unsigned int, dim> base_patches;
    std::array<bool, dim> periodic;
    unsigned int cells_per_side = 8;
    unsigned int minimum_level  = 0;
    unsigned int maximum_level  = 0;

    static void declare_parameters(dealii::ParameterHandler &prm);

    /// Throws base::UserError if the box is empty or the sizes cannot work.
    void parse_parameters(dealii::ParameterHandler &prm);
  };


  /**
   * A p4est forest over a box whose leaves each carry a patch of n^dim Cartesian
   * cells. Leaves that meet, also in an edge or a corner only, differ by one level
   * at most. Ghost leaves (the neighbours that other ranks own) are known too.
   */
  template <int dim>
  class PatchGrid
  {
  public:
    using Index = std::array<int, dim>;

    PatchGrid(MPI_Comm communicator, const PatchGridParameters<dim> &parameters);

    /**
     * The leaves of @p forest as they are now, on the same ranks, with patches of
     * @p cells_per_side cells a side: a level of a multigrid method. It has no forest of
     * its own, so that adapt() and update() must not be called.
     */
    PatchGrid(const PatchGrid &forest, const unsigned int cells_per_side);

    PatchGrid(const PatchGrid &)            = delete;
    PatchGrid &operator=(const PatchGrid &) = delete;

    /// n, the number of cells along a side of a patch.
    unsigned int n_cells_per_side() const
    {
      return n;
    }

    unsigned int n_owned_patches() const
    {
      return owned_patches;
    }

    /// Owned patches and ghosts.
    unsigned int n_local_patches() const
    {
      return patches.size();
    }

    /// Patch @p p; those with p < n_owned_patches() belong to this rank.
    const Patch<dim> &patch(const unsigned int p) const
    {
      return patches[p];
    }

    /// Number of patches (or cells) of all ranks.
    dealii::types::global_dof_index n_global_patches() const
    {
      return global_patches;
    }

    dealii::types::global_dof_index n_global_cells() const;

    /// What lies beyond side 2 d (lower) or 2 d + 1 (upper) of an owned patch.
    Neighbor neighbor(const unsigned int p, const unsigned int side) const
    {
      return neighbors[p * 2 * dim + side];
    }

    /// The same-level patch at @p offset from owned patch @p p, or
    /// numbers::invalid_unsigned_int.
    unsigned int neighbor_patch(const unsigned int p, const Index &offset) const;

    /// The position among patches of a level of that which has a cell position of the
    /// level, which must not be negative. (Divisions would be a large part of the time
    /// that a change of the grid takes.)
    Index position_of_patch(Index cell) const
    {
      for (int &i : cell)
        i >>= log_n;
      return cell;
    }

    /**
     * Whose cell position @p cell of @p level (in cells of that level, from the lower
     * corner of the box) is: a leaf of this level, a finer or a coarser one, or nobody's,
     * beyond the boundary. Correct within the layer of ghost leaves.
     */
    Neighbor leaf_at(const int level, Index cell) const;

    /// Whether a leaf that touches owned patch @p p, if only at a corner, is of another
    /// level.
    bool touches_other_level(const unsigned int p) const;

    /// The local patch, owned or ghost, with this number among all leaves; it must be
    /// one.
    unsigned int local_patch(const dealii::types::global_dof_index global_id) const;

    /// The local patch with this level and position; periodic directions wrap.
    unsigned int find(const int level, Index index) const;

    /// Number of patches of @p level along direction @p d.
    int n_patches(const int level, const unsigned int d) const
    {
      return static_cast<int>(parameters.base_patches[d]) << level;
    }

    /// Width of a cell of @p level in direction @p d [cm].
    double cell_width(const int level, const unsigned int d) const
    {
      return (parameters.upper[d] - parameters.lower[d]) /
             (static_cast<double>(n_patches(level, d)) * n);
    }

    /**
     * The owned patch that holds @p x, or numbers::invalid_unsigned_int. Patches are
     * half open, but the upper faces of the box belong to the last ones. In periodic
     * directions @p x may lie outside of the box.
     */
    unsigned int locate(const dealii::Point<dim> &x) const;

    /**
     * Coordinate @p x in direction @p d, or that of the face of the box if it lies beyond
     * by less than a cell of the highest level: the structure may touch the box's faces,
     * and its points there move a little.
     */
    double pull_into_box(const double x, const unsigned int d) const
    {
      const double margin = cell_width(highest_level, d);
      if (parameters.periodic[d] ||
          (x >= parameters.lower[d] && x <= parameters.upper[d]))
        return x;
      if (x < parameters.lower[d] && x > parameters.lower[d] - margin)
        return parameters.lower[d];
      if (x > parameters.upper[d] && x < parameters.upper[d] + margin)
        return parameters.upper[d];
      return x;
    }

    /// Level of the leaf, owned or ghost, that holds @p x; -1 if it is not known here.
    int level_at(const dealii::Point<dim> &x) const;

    const dealii::BoundingBox<dim> &box() const
    {
      return bounding_box;
    }

    const std::array<bool, dim> &periodic() const
    {
      return parameters.periodic;
    }

    unsigned int maximum_level() const
    {
      return parameters.maximum_level;
    }

    unsigned int minimum_level() const
    {
      return parameters.minimum_level;
    }

    /// True if leaves of different levels meet anywhere on any rank.
    bool has_coarse_fine_interfaces() const
    {
      return mixed_levels;
    }

    MPI_Comm communicator() const
    {
      return tria.get_communicator();
    }

    /**
     * Refines and coarsens until the level of each leaf is what @p wanted_level asks
     * for (it is given the box of a leaf and returns a level; limits are applied),
     * as far as the balance between neighbours allows. Before each change
     * @p before_change is called, after it @p after_change, with false if the balance has
     * undone all of it. Returns whether anything changed.
     */
    bool adapt(const std::function<int(const dealii::BoundingBox<dim> &)> &wanted_level,
               const std::function<void()> &before_change          = {},
               const std::function<void(const bool)> &after_change = {});

    /// The leaves of this rank, in the order of its patches.
    std::vector<Leaf> owned_leaves() const;

    /**
     * Makes a forest that has just been constructed the one with these leaves. With
     * @p owners, the rank of each, each leaf goes to its rank, whatever the weights;
     * without, leaves are dealt out by weight. Returns whether all leaves are where
     * @p owners wants them; no if a rank shall have none. Collective, with the same
     * arguments on all ranks; throws dealii::ExcMessage if the leaves are not those of a
     * balanced forest over this box.
     */
    bool set_leaves(const std::vector<Leaf> &leaves,
                    const std::vector<unsigned int> &owners = {});

    /// Weight of a leaf beyond its fluid cells, for the partition (1000 = one patch).
    std::function<unsigned int(const dealii::BoundingBox<dim> &)> extra_weight;

    dealii::parallel::distributed::Triangulation<dim> &triangulation()
    {
      return tria;
    }

    const dealii::parallel::distributed::Triangulation<dim> &triangulation() const
    {
      return tria;
    }

    /**
     * Rebuilds the lists of patches from the forest. Their order depends on the forest
     * and its partition only, by level and then along the space-filling curve, and not on
     * how the forest came about: a run that has been resumed adds numbers up in the same
     * order.
     */
    void update();

    /// The patch of an active cell that this rank owns or has as ghost.
    unsigned int
    patch_of(const typename dealii::Triangulation<dim>::cell_iterator &cell) const;

    dealii::BoundingBox<dim>
    bounding_box_of(const typename dealii::Triangulation<dim>::cell_iterator &cell) const;

  private:
    Index index_of(const dealii::Point<dim> &x, const int level) const;
    static Leaf leaf_of(const int level, const Index &index);
    bool wrap(const int level, Index &index) const;

    const PatchGridParameters<dim> parameters;
    const unsigned int n;
    const unsigned int log_n; ///< to the base of two
    const dealii::BoundingBox<dim> bounding_box;
    dealii::parallel::distributed::Triangulation<dim> tria;

    unsigned int owned_patches                     = 0;
    dealii::types::global_dof_index global_patches = 0;
    std::vector<Patch<dim>> patches;
    std::vector<Neighbor> neighbors;
    /// In the place of all other weights while set_leaves() deals out the leaves.
    std::function<unsigned int(const Leaf &)> exact_weight;

    bool mixed_levels = false;
    int lowest_level = 0, highest_level = 0;

    /// Local patch number by level and position: dense where that is small.
    std::vector<std::vector<int>> dense_lookup;
    std::vector<std::unordered_map<std::uint64_t, unsigned int>> sparse_lookup;
  };
} // namespace mitre::grid

#endif
