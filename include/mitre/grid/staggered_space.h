#ifndef mitre_grid_staggered_space_h
#define mitre_grid_staggered_space_h

#include <functional>
#include <memory>
#include <vector>

#include <mitre/grid/linear_combination.h>
#include <mitre/grid/patch_grid.h>
#include <mitre/grid/patch_rows.h>
#include <mitre/grid/types.h>

namespace mitre::grid
{
  /// What holds on a part of the boundary, as far as ghost values depend on it.
  enum class BoundaryKind : unsigned char
  {
    velocity, ///< all components given (walls too)
    traction, ///< normal traction given, tangential components given (zero)
    slip      ///< normal component zero, no tangential traction
  };

  /// The kind of boundary somewhere, and the number of the condition that says so.
  struct BoundaryInfo
  {
    BoundaryKind kind;
    unsigned int condition;
  };

  /// What holds at a point of side 2 d (lower) or 2 d + 1 (upper) of the box.
  template <int dim>
  using BoundaryKinds =
    std::function<BoundaryInfo(const unsigned int side, const dealii::Point<dim> &x)>;

  /// How values beyond a boundary with given velocity follow from those inside.
  enum class BoundaryExtension : unsigned char
  {
    quadratic, ///< parabola through the wall value and two values inside
    reflection ///< straight line through the wall value
  };


  /**
   * The staggered velocity: normal components on the faces of the cells of all
   * patches.
   *
   * A patch stores all n+1 planes of faces of each component, so faces that two
   * patches share are stored twice (entry number: patch, component, then x fastest).
   * One of the copies is the *master*: that of the upper patch where both have the
   * same level, that of the coarser patch at a coarse-fine interface. On the interface
   * the fine faces take a linear function along the interface whose mean is the
   * coarse face's velocity; the mass flux through the interface is therefore the same
   * from both sides, and the velocity second order accurate. A vector is *consistent*
   * when all copies follow from their masters (synchronize()).
   *
   * With C the map from masters to all entries, the masters' control volumes are
   * W = C^T (half cell volumes), and fluxes, spreading and the pressure gradient use
   * C^T (collect()): this makes gradient and divergence adjoint, and all forces
   * conservative, also across levels.
   */
  template <int dim>
  class StaggeredSpace
  {
  public:
    using Index = std::array<int, dim>;

    /// @p cache keeps rows from one grid to the next; it must belong to this box and
    /// these boundary kinds.
    StaggeredSpace(
      const PatchGrid<dim> &grid,
      const BoundaryKinds<dim> &boundary_kinds,
      const std::shared_ptr<RowCache<dim>> &cache = std::make_shared<RowCache<dim>>());

    const PatchGrid<dim> &grid() const
    {
      return patch_grid;
    }

    const BoundaryKinds<dim> &boundary_kinds() const
    {
      return kinds;
    }

    /// Rows of weights by the leaves around a patch.
    RowCache<dim> &row_cache() const
    {
      return *cache;
    }

    unsigned int n_dofs_per_patch() const
    {
      return dim * dofs_per_component;
    }

    /// Entries of a component on a patch: (n+1) n^(dim-1).
    unsigned int n_dofs_per_component() const
    {
      return dofs_per_component;
    }

    /// Extent of component @p c of a patch in direction @p d: n, or n+1 if c == d.
    unsigned int extent(const unsigned int c, const unsigned int d) const
    {
      return n + (c == d ? 1 : 0);
    }

    /// Number of the first entry of component @p c of owned patch @p p.
    std::size_t first_dof(const unsigned int p, const unsigned int c) const
    {
      return static_cast<std::size_t>(p) * n_dofs_per_patch() + c * dofs_per_component;
    }

    /// Distance between entries of component @p c that are neighbours in direction @p d.
    unsigned int stride(const unsigned int c, const unsigned int d) const
    {
      unsigned int s = 1;
      for (unsigned int e = 0; e < d; ++e)
        s *= extent(c, e);
      return s;
    }

    /// Position of an entry of an owned patch.
    dealii::Point<dim>
    position(const unsigned int p, const unsigned int c, const Index &i) const;

    /**
     * Position on the domain boundary where a face or ghost value of @p level is
     * judged: the point of side @p side nearest to (component, index).
     */
    dealii::Point<dim> boundary_position(const int level,
                                         const unsigned int c,
                                         const Index &index,
                                         const unsigned int side) const;

    /**
     * Writes component @p c at the grid position @p index of @p level, which may lie
     * outside of the box or where leaves are finer, as a combination of entries.
     * Where leaves are coarser it is interpolated from them (quadratically), unless
     * @p interpolate is false. Returns whether that was possible. With @p coarse_values,
     * the result may refer to auxiliary values.
     */
    bool combination(const int level,
                     const unsigned int c,
                     Index index,
                     const BoundaryExtension extension,
                     const bool interpolate,
                     LinearCombination<dim> &result,
                     CoarseValues<dim> *coarse_values = nullptr) const;

    /**
     * The velocity at a face of a leaf of @p level on a coarse-fine interface,
     * interpolated quadratically along the interface from the coarse faces there, of
     * which the faces of the finer leaves only have the mean and the slopes. Returns
     * whether that was possible.
     */
    bool interface_value(const int level,
                         const unsigned int c,
                         const Index &index,
                         const BoundaryExtension extension,
                         LinearCombination<dim> &result,
                         CoarseValues<dim> *coarse_values = nullptr) const
    {
      Index coarse;
      return interpolate_from_coarser(
        level, c, index, extension, 0, coarse, result, coarse_values);
    }

    /// Gives @p vector the owned entries and the ghosts that the solver needs.
    void initialize_vector(VectorType &vector) const;

    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &partitioner() const
    {
      return vector_partitioner;
    }

    dealii::IndexSet owned_entries() const;

    /// First global number of the owned entries, and the one after the last.
    std::pair<dealii::types::global_dof_index, dealii::types::global_dof_index>
    owned_range() const;

    /// Sets all copies from their masters. Collective.
    void synchronize(VectorType &u) const;

    /**
     * Adds the copies' values to their masters (C^T) and sets the copies to zero.
     * Collective.
     */
    void collect(VectorType &f) const;

    /// The three parts of collect(): fine faces on coarse-fine interfaces, other copies
    /// whose master is on the same rank, and those whose master is not. The first and
    /// the last are collective.
    void collect_interfaces(VectorType &f) const;
    void collect_local_copies(VectorType &f) const;
    void collect_remote_copies(VectorType &f) const;

    /// Pairs of copy and master that collect_local_copies() adds up, as far as @p f is
    /// not zero on the copy.
    std::vector<std::pair<std::size_t, std::size_t>>
    local_copies_among(const VectorType &f) const;

    /// Control volume of a master [cm^dim]; zero for copies.
    const VectorType &volumes() const
    {
      return master_volumes;
    }

    /// One over volumes(), and zero for copies and for faces with given velocity.
    const VectorType &inverse_volumes() const
    {
      return free_inverse_volumes;
    }

    struct BoundaryFace
    {
      std::size_t dof;
      unsigned int patch;
      unsigned int side;
      unsigned int cell; ///< cell of the patch that has the face
      unsigned int condition;
      dealii::Point<dim> x;
    };

    /// Faces on the domain boundary whose normal velocity is given (masters).
    const std::vector<BoundaryFace> &fixed_faces() const
    {
      return fixed;
    }

    /// Faces on the domain boundary with given traction.
    const std::vector<BoundaryFace> &open_faces() const
    {
      return open;
    }

    /// Sets the entries with given velocity to zero.
    void zero_fixed_faces(VectorType &u) const;

    /// Fine faces on coarse-fine interfaces, by their number in a patch, and what they
    /// follow from.
    const RowTable<dim> &coarse_fine_faces() const
    {
      return interface_faces;
    }

    /// Coarse faces on coarse-fine interfaces: patch and side.
    const std::vector<std::pair<unsigned int, unsigned int>> &coarse_sides() const
    {
      return coarse_interface_sides;
    }

    /**
     * Builds the solver's partitioner; to be called once with the entries that the
     * one-layer halo needs, before vectors are made.
     */
    void finalize(std::vector<dealii::types::global_dof_index> &&ghosts);

  private:
    dealii::types::global_dof_index
    find_entry(const int level, const unsigned int c, const Index &index) const;

    /**
     * The value of a face of @p level where leaves are one level finer, by interpolation
     * along the face that is exact for parabolas (with one-sided stencils next to where
     * the finer leaves end). False if there are not enough finer faces.
     */
    bool combine_finer(const int level,
                       const unsigned int c,
                       const Index &index,
                       LinearCombination<dim> &result) const;

    /// Adds @p weight times the face of @p level, which is on coarser leaves or beside
    /// them. Returns whether that was possible.
    bool add_coarse_value(const int level,
                          const unsigned int c,
                          const Index &index,
                          const BoundaryExtension extension,
                          const double weight,
                          LinearCombination<dim> &result,
                          CoarseValues<dim> *coarse_values) const;

    /// The same for all points of a tensor product of lines of up to three points.
    bool add_coarse_values(
      const int level,
      const unsigned int c,
      const Index &first,
      const std::array<std::pair<unsigned int, std::array<double, 3>>, dim> &lines,
      const BoundaryExtension extension,
      LinearCombination<dim> &result,
      CoarseValues<dim> *coarse_values) const;

    bool interpolate_from_coarser(const int level,
                                  const unsigned int c,
                                  const Index &index,
                                  const BoundaryExtension extension,
                                  const unsigned int d,
                                  Index &coarse,
                                  LinearCombination<dim> &result,
                                  CoarseValues<dim> *coarse_values) const;

    void build_copies();
    void build_interfaces();
    std::shared_ptr<const PatchRows<dim>> interface_rows(const unsigned int p,
                                                         const unsigned int side) const;
    void build_boundary();
    void copy_from_masters(VectorType &u) const;
    void follow_interfaces(VectorType &u) const;

    const PatchGrid<dim> &patch_grid;
    const BoundaryKinds<dim> kinds;
    const std::shared_ptr<RowCache<dim>> cache;
    const unsigned int n;
    const unsigned int dofs_per_component;

    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> vector_partitioner;

    /// Upper planes whose master is the lower plane of a patch of this rank.
    struct PlaneCopy
    {
      std::size_t copy, master;
      unsigned int c;
    };
    std::vector<PlaneCopy> plane_copies;
    template <typename Operation>
    void for_each_local_copy(const Operation &operation) const;

    /// The same where the master belongs to another rank.
    std::vector<std::pair<std::size_t, dealii::types::global_dof_index>> remote_copies;
    std::vector<unsigned int> remote_masters;

    RowTable<dim> interface_faces;
    std::vector<std::pair<unsigned int, unsigned int>> coarse_interface_sides;
    std::vector<BoundaryFace> fixed, open;
    VectorType master_volumes, free_inverse_volumes;
  };
} // namespace mitre::grid

#endif
