#ifndef mitre_grid_staggered_space_h
#define mitre_grid_staggered_space_h

#include <functional>
#include <memory>
#include <vector>

#include <mitre/grid/hash_map.h>
#include <mitre/grid/patch_grid.h>
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

  /// weight * (velocity component that is prescribed at x).
  template <int dim>
  struct BoundaryTerm
  {
    dealii::Point<dim> x;
    unsigned int component;
    unsigned int condition;
    double weight;
  };

  /// A sum of weighted unknowns, prescribed boundary values, and auxiliary values
  /// (CoarseValues), if these are in use.
  template <int dim>
  struct LinearCombination
  {
    std::vector<std::pair<dealii::types::global_dof_index, double>> entries;
    std::vector<std::pair<unsigned int, double>> auxiliary;
    std::vector<BoundaryTerm<dim>> boundary;

    /// Whether an unknown may stand in more than one of the entries.
    bool repeats = false;

    void add(const LinearCombination &other, const double factor);

    /// One entry an unknown, in ascending order.
    void merge();

    /// Nothing, but the memory is kept.
    void clear();
  };


  /**
   * The values of coarser leaves that interpolation to finer ones has used so far, so
   * that each is sought once. One that is not an unknown itself (but a mean of finer
   * faces, say, or an extension by a boundary condition) gets a number, under which
   * combinations refer to it.
   */
  template <int dim>
  class CoarseValues
  {
  public:
    using Index = std::array<int, dim>;

    /// Where the value of a face is found.
    struct Place
    {
      enum Kind : unsigned char
      {
        nowhere,
        unknown,
        auxiliary
      } kind;
      dealii::types::global_dof_index
        number; ///< of the unknown or of the auxiliary value
    };

    /// @param compute fills a combination of unknowns and says whether that was possible
    template <typename Compute>
    const Place &find(const int level,
                      const unsigned int c,
                      const Index &index,
                      const Compute &compute)
    {
      // positions beyond the box are negative, by less than this
      constexpr int offset = 1024;
      std::uint64_t key    = level * 3 + c;
      for (unsigned int d = 0; d < dim; ++d)
        key = (key << 19) + static_cast<std::uint64_t>(index[d] + offset);
      const auto [place, is_new] = places.insert(key);
      if (is_new)
        place = locate(compute);
      return place;
    }

    /// Auxiliary values as combinations of unknowns.
    const std::vector<LinearCombination<dim>> &values() const
    {
      return auxiliary;
    }

    /// Forgets everything; numbers start with 0 again.
    void clear();

  private:
    template <typename Compute>
    Place locate(const Compute &compute)
    {
      value.clear();
      if (!compute(value))
        return {Place::nowhere, 0};
      if (value.entries.size() == 1 && value.entries[0].second == 1. &&
          value.boundary.empty())
        return {Place::unknown, value.entries[0].first};
      auxiliary.push_back(value);
      return {Place::auxiliary,
              static_cast<dealii::types::global_dof_index>(auxiliary.size() - 1)};
    }

    HashMap<Place> places;
    std::vector<LinearCombination<dim>> auxiliary;
    LinearCombination<dim> value;
  };


  /**
   * Adds up combinations of many terms: an unknown's weight is found by hashing, which is
   * faster than to sort all terms.
   */
  template <int dim>
  class CombinationSum
  {
  public:
    void add(const LinearCombination<dim> &terms, const double factor);

    /// The same with the auxiliary values that @p terms refers to written out.
    void add(const LinearCombination<dim> &terms,
             const double factor,
             const CoarseValues<dim> &coarse_values);

    /// The sum, with one entry an unknown; starts anew from nothing.
    void move_to(LinearCombination<dim> &sum);

  private:
    HashMap<unsigned int> numbers;
    LinearCombination<dim> total;
  };

  /// How values beyond a boundary with given velocity follow from those inside.
  enum class BoundaryExtension : unsigned char
  {
    quadratic, ///< parabola through the wall value and two values inside
    reflection ///< straight line through the wall value
  };


  /**
   * Linear combinations of the entries of a distributed vector, and of auxiliary values
   * if there are any, one a destination, stored as compressed rows.
   */
  template <int dim>
  class CombinationTable
  {
  public:
    /// Adds a row, which is merged if it has to be, and returns its number.
    unsigned int append(const unsigned int destination, LinearCombination<dim> &row);

    /// Global numbers of the entries that are not in [begin, end), each once at most: the
    /// ghost entries that a partitioner must have.
    void collect_ghosts(const std::pair<dealii::types::global_dof_index,
                                        dealii::types::global_dof_index> &owned,
                        std::vector<dealii::types::global_dof_index> &ghosts) const;

    /// Replaces global numbers by the local ones of @p partitioner.
    void localize(const dealii::Utilities::MPI::Partitioner &partitioner);

    unsigned int n_rows() const
    {
      return destinations.size();
    }

    unsigned int destination(const unsigned int row) const
    {
      return destinations[row];
    }

    double apply(const unsigned int row, const double *values) const
    {
      double sum = 0.;
      for (unsigned int k = starts[row]; k < starts[row + 1]; ++k)
        sum += weights[k] * values[columns[k]];
      return sum;
    }

    /// The same for rows that may refer to auxiliary values.
    double
    apply(const unsigned int row, const double *values, const double *auxiliary) const
    {
      double sum = apply(row, values);
      for (unsigned int k = auxiliary_starts[row]; k < auxiliary_starts[row + 1]; ++k)
        sum += auxiliary_weights[k] * auxiliary[auxiliary_columns[k]];
      return sum;
    }

    void apply_transpose(const unsigned int row, const double value, double *values) const
    {
      for (unsigned int k = starts[row]; k < starts[row + 1]; ++k)
        values[columns[k]] += weights[k] * value;
    }

    void apply_transpose(const unsigned int row,
                         const double value,
                         double *values,
                         double *auxiliary) const
    {
      apply_transpose(row, value, values);
      for (unsigned int k = auxiliary_starts[row]; k < auxiliary_starts[row + 1]; ++k)
        auxiliary[auxiliary_columns[k]] += auxiliary_weights[k] * value;
    }

    /// Calls @p operation(local number, weight) for the entries of a row.
    template <typename Operation>
    void for_each_entry(const unsigned int row, const Operation &operation) const
    {
      for (unsigned int k = starts[row]; k < starts[row + 1]; ++k)
        operation(columns[k], weights[k]);
    }

    /// Sum of the prescribed part of a row, as set by set_boundary_values().
    double boundary_value(const unsigned int row) const
    {
      return boundary_values.empty() ? 0. : boundary_values[row];
    }

    /// Evaluates the prescribed values of all rows that have some.
    void set_boundary_values(
      const std::function<double(const BoundaryTerm<dim> &)> &prescribed);

    std::size_t memory_consumption() const;

  private:
    std::vector<unsigned int> destinations;
    std::vector<unsigned int> starts = {0};
    std::vector<dealii::types::global_dof_index> global_columns;
    std::vector<unsigned int> columns;
    std::vector<double> weights;

    std::vector<unsigned int> auxiliary_starts = {0};
    std::vector<unsigned short int> auxiliary_columns;
    std::vector<double> auxiliary_weights;

    CombinationSum<dim> sum;

    std::vector<std::pair<unsigned int, BoundaryTerm<dim>>> boundary_terms;
    std::vector<double> boundary_values;
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

    StaggeredSpace(const PatchGrid<dim> &grid, const BoundaryKinds<dim> &boundary_kinds);

    const PatchGrid<dim> &grid() const
    {
      return patch_grid;
    }

    const BoundaryKinds<dim> &boundary_kinds() const
    {
      return kinds;
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

    /// Fine faces on coarse-fine interfaces and what they follow from.
    const CombinationTable<dim> &coarse_fine_faces() const
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
    void build_boundary();
    void copy_from_masters(VectorType &u) const;
    void follow_interfaces(VectorType &u) const;

    const PatchGrid<dim> &patch_grid;
    const BoundaryKinds<dim> kinds;
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

    CombinationTable<dim> interface_faces;
    std::vector<std::pair<unsigned int, unsigned int>> coarse_interface_sides;
    std::vector<BoundaryFace> fixed, open;
    VectorType master_volumes, free_inverse_volumes;
  };
} // namespace mitre::grid

#endif
