#ifndef mitre_grid_patch_rows_h
#define mitre_grid_patch_rows_h

#include <deal.II/base/partitioner.h>

#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include <mitre/grid/linear_combination.h>
#include <mitre/grid/patch_grid.h>

namespace mitre::grid
{
  /// A neighbour of a patch, itself included: the base three digits are one more than the
  /// offset in each direction.
  template <int dim>
  struct Direction
  {
    static constexpr unsigned int count = (dim == 2 ? 9 : 27);

    /// That of the patch itself.
    static constexpr unsigned int center = count / 2;

    static std::array<int, dim> offset(unsigned int direction)
    {
      std::array<int, dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        {
          result[d] = static_cast<int>(direction % 3) - 1;
          direction /= 3;
        }
      return result;
    }

    static unsigned int number(const std::array<int, dim> &offset)
    {
      unsigned int result = 0;
      for (int d = dim - 1; d >= 0; --d)
        result = 3 * result + static_cast<unsigned int>(offset[d] + 1);
      return result;
    }
  };


  /**
   * Rows of weights that belong to one side, edge or corner of a patch, each a linear
   * combination of entries of leaves around it and of prescribed boundary values.
   *
   * Entries are written by leaf, relative to the patch, and by their number in the leaf.
   * So the rows serve all patches that have the same leaves around them there
   * (RowCache), and reading them costs the processor's caches less than rows of their
   * own would.
   */
  template <int dim>
  struct PatchRows
  {
    /// The position of a leaf among the patches of its level, less that of the patch
    /// there (rounded down if the leaf is coarser, of the first child if it is finer).
    struct RelativeLeaf
    {
      int level; ///< less that of the patch
      std::array<int, dim> offset;
    };

    /// Compressed rows; they may refer to values of another set, which are computed
    /// before, by their numbers there.
    struct Set
    {
      std::vector<unsigned int> destinations;

      /// Segments of each row: entries of one leaf.
      std::vector<unsigned int> starts = {0};
      std::vector<unsigned int> leaves;       ///< by segment
      std::vector<unsigned int> entry_starts; ///< by segment, and one more at the end
      std::vector<unsigned int> entries;      ///< numbers in the leaf
      std::vector<double> weights;

      std::vector<unsigned int> auxiliary_starts = {0};
      std::vector<unsigned short int> auxiliary_columns;
      std::vector<double> auxiliary_weights;

      std::vector<std::pair<unsigned int, BoundaryTerm<dim>>> boundary_terms;

      unsigned int n_rows() const
      {
        return destinations.size();
      }

      std::size_t memory_consumption() const;
    };

    /// The different entries that the rows of all sets read.
    struct Reads
    {
      std::vector<unsigned int> starts;  ///< by leaf, and one more at the end
      std::vector<unsigned int> entries; ///< numbers in the leaf, ascending

      /// Which of them an entry of a row is, by set and entry.
      std::vector<std::vector<unsigned int>> of_set;
    };

    std::vector<RelativeLeaf> leaves;
    std::vector<Set> sets;

    /// Made when first asked for, as only rows that read leaves of other ranks need it.
    const Reads &reads() const;

    std::size_t memory_consumption() const;

  private:
    mutable std::unique_ptr<const Reads> known_reads;
  };


  /**
   * Writes the rows of a patch relative to it.
   */
  template <int dim>
  class PatchRowsBuilder
  {
  public:
    PatchRowsBuilder(const PatchGrid<dim> &grid,
                     const unsigned int patch,
                     const unsigned int n_dofs_per_patch,
                     const unsigned int n_sets);

    /// Adds a row to set @p set, with one entry an unknown.
    void append(const unsigned int set,
                const unsigned int destination,
                LinearCombination<dim> &row);

    /// The rows, or nothing if there are none.
    std::shared_ptr<const PatchRows<dim>> finish();

  private:
    unsigned int leaf_number(const dealii::types::global_dof_index global_patch);

    const PatchGrid<dim> &grid;
    const Patch<dim> &patch;
    const unsigned int n_dofs_per_patch;
    std::shared_ptr<PatchRows<dim>> rows;
    std::unordered_map<dealii::types::global_dof_index, unsigned int> leaf_numbers;
    CombinationSum<dim> sum;
    /// A row's entries: leaf, number in the leaf, weight.
    std::vector<std::tuple<unsigned int, unsigned int, double>> entries;
  };


  /**
   * Rows of all patches of a rank; each patch has some parts (PatchRows).
   *
   * After all patches have been filled, collect_ghosts() says which entries of other
   * ranks a vector must have, and localize() which vectors there are.
   */
  template <int dim>
  class RowTable
  {
  public:
    RowTable(const PatchGrid<dim> &grid, const unsigned int n_dofs_per_patch);

    /// Adds a part to the patch that is being filled; it may be nothing.
    void append(std::shared_ptr<const PatchRows<dim>> rows);

    /// Goes on to the next patch; the first one is being filled from the start.
    void finish_patch();

    /// Global numbers of the entries that other ranks own, each once at most.
    void collect_ghosts(std::vector<dealii::types::global_dof_index> &ghosts) const;

    /// Vectors have this partitioner from now on.
    void localize(const dealii::Utilities::MPI::Partitioner &partitioner);

    /// The parts of patch @p p are those from begin(p) to before end(p).
    unsigned int begin(const unsigned int p) const
    {
      return starts[p];
    }

    unsigned int end(const unsigned int p) const
    {
      return starts[p + 1];
    }

    /// Rows in set @p set of a part.
    unsigned int n_rows(const unsigned int part, const unsigned int set) const
    {
      return parts[part].rows->sets[set].n_rows();
    }

    unsigned int destination(const unsigned int part,
                             const unsigned int set,
                             const unsigned int row) const
    {
      return parts[part].rows->sets[set].destinations[row];
    }

    /// Calls operation(destination, sum) for the rows of set @p set of a part in
    /// their order; @p auxiliary are the values that rows may refer to. Prescribed
    /// boundary values are in the sum if @p with_boundary_values.
    template <typename Operation>
    void apply(const unsigned int part,
               const unsigned int set,
               const double *values,
               const double *auxiliary,
               const bool with_boundary_values,
               const Operation &operation) const
    {
      const Set &rows        = parts[part].rows->sets[set];
      const double *boundary = nullptr;
      if (with_boundary_values && !rows.boundary_terms.empty() &&
          !parts[part].boundary_values.empty())
        boundary = parts[part].boundary_values[set].data();
      with_segments(part, set, [&](const auto &segment) {
        for (unsigned int row = 0; row < rows.n_rows(); ++row)
          {
            double sum = (boundary == nullptr ? 0. : boundary[row]);
            for (unsigned int s = rows.starts[row]; s < rows.starts[row + 1]; ++s)
              segment(s, [&](const auto &place) {
                sum += product(rows.weights.data(),
                               rows.entry_starts[s],
                               rows.entry_starts[s + 1],
                               values,
                               place);
              });
            for (unsigned int k = rows.auxiliary_starts[row];
                 k < rows.auxiliary_starts[row + 1];
                 ++k)
              sum += rows.auxiliary_weights[k] * auxiliary[rows.auxiliary_columns[k]];
            operation(rows.destinations[row], sum);
          }
      });
    }

    /// The transpose: adds what operation(destination) returns, times the weights of
    /// the row, to @p values and @p auxiliary.
    template <typename Operation>
    void apply_transpose(const unsigned int part,
                         const unsigned int set,
                         double *values,
                         double *auxiliary,
                         const Operation &operation) const
    {
      const Set &rows = parts[part].rows->sets[set];
      with_segments(part, set, [&](const auto &segment) {
        for (unsigned int row = 0; row < rows.n_rows(); ++row)
          {
            const double value = operation(rows.destinations[row]);
            if (value == 0.)
              continue;
            for (unsigned int s = rows.starts[row]; s < rows.starts[row + 1]; ++s)
              segment(s, [&](const auto &place) {
                for (unsigned int k = rows.entry_starts[s]; k < rows.entry_starts[s + 1];
                     ++k)
                  values[place(k)] += rows.weights[k] * value;
              });
            for (unsigned int k = rows.auxiliary_starts[row];
                 k < rows.auxiliary_starts[row + 1];
                 ++k)
              auxiliary[rows.auxiliary_columns[k]] += rows.auxiliary_weights[k] * value;
          }
      });
    }

    /// Calls operation(local number, weight) for the entries of a row.
    template <typename Operation>
    void for_each_entry(const unsigned int part,
                        const unsigned int set,
                        const unsigned int row,
                        const Operation &operation) const
    {
      const Set &rows = parts[part].rows->sets[set];
      with_segments(part, set, [&](const auto &segment) {
        for (unsigned int s = rows.starts[row]; s < rows.starts[row + 1]; ++s)
          segment(s, [&](const auto &place) {
            for (unsigned int k = rows.entry_starts[s]; k < rows.entry_starts[s + 1]; ++k)
              operation(place(k), rows.weights[k]);
          });
      });
    }

    /// Evaluates the prescribed values of all rows that have some.
    void set_boundary_values(
      const std::function<double(const BoundaryTerm<dim> &)> &prescribed);

    /// The largest number of rows in one of the sets from @p first_set on of any part.
    unsigned int most_rows(const unsigned int first_set) const;

    std::size_t memory_consumption() const;

  private:
    using Set = typename PatchRows<dim>::Set;

    struct Part
    {
      std::shared_ptr<const PatchRows<dim>> rows;
      /// Where the leaves of the rows start in first_entries.
      unsigned int leaves;
      /// Local numbers of what the rows read (PatchRows::Reads), where not all leaves
      /// belong to this rank; those that do are left out.
      std::vector<unsigned int> places;
      std::vector<std::vector<double>> boundary_values;
    };

    /// The sum of weights times values for entries from @p begin to before @p end, in an
    /// order that does not make each addition wait for the one before.
    template <typename Place>
    [[gnu::always_inline]] static double product(const double *weights,
                                                 const unsigned int begin,
                                                 const unsigned int end,
                                                 const double *values,
                                                 const Place &place)
    {
      double sum[4]  = {0., 0., 0., 0.};
      unsigned int k = begin;
      for (; k + 4 <= end; k += 4)
        for (unsigned int i = 0; i < 4; ++i)
          sum[i] += weights[k + i] * values[place(k + i)];
      for (; k < end; ++k)
        sum[0] += weights[k] * values[place(k)];
      return (sum[0] + sum[1]) + (sum[2] + sum[3]);
    }

    /// Calls operation(segment), where segment(s, use) calls use(place) for the s-th
    /// segment, and place(k) is the local number of the k-th entry, which is in it.
    template <typename Operation>
    void with_segments(const unsigned int part,
                       const unsigned int set,
                       const Operation &operation) const
    {
      const Part &here            = parts[part];
      const Set &rows             = here.rows->sets[set];
      const unsigned int *leaves  = rows.leaves.data();
      const unsigned int *first   = first_entries.data() + here.leaves;
      const unsigned int *entries = rows.entries.data();
      const auto owned_segment    = [=](const unsigned int s, const auto &use) {
        const unsigned int from = first[leaves[s]];
        use([=](const unsigned int k) { return from + entries[k]; });
      };
      if (here.places.empty())
        operation(owned_segment);
      else
        {
          const unsigned int *reads  = here.rows->reads().of_set[set].data();
          const unsigned int *places = here.places.data();
          operation([=](const unsigned int s, const auto &use) {
            if (first[leaves[s]] != dealii::numbers::invalid_unsigned_int)
              owned_segment(s, use);
            else
              use([=](const unsigned int k) { return places[reads[k]]; });
          });
        }
    }

    /// Calls operation(part, leaf of its rows, ghost) for all leaves of other ranks,
    /// which are numbered from the first ghost on.
    template <typename Operation>
    void for_each_remote_leaf(const Operation &operation) const;

    const PatchGrid<dim> &grid;
    const unsigned int n_dofs_per_patch;
    std::vector<Part> parts;
    std::vector<unsigned int> starts = {0};
    /// Local patches of the leaves of all parts, and their first entries, which are
    /// invalid if this rank does not own them.
    std::vector<unsigned int> leaf_patches, first_entries;
    std::vector<unsigned int> remote_parts, parts_at_boundary;
  };


  /// What rows in a RowCache are for: halos have kinds of their own from @p halos on.
  namespace RowKind
  {
    constexpr unsigned int interface_faces = 0, viscous_fluxes = 1, halos = 2;
  }


  /**
   * Rows by the leaves around a side, edge or corner of a patch, so that those of one
   * patch serve all that have the same leaves around them there, and outlive a change of
   * the grid.
   *
   * What rows beyond (or at) a patch in some direction depend on are the level of the
   * patch, what its neighbours in this direction and beside it are, which leaves finer
   * ones consist of, the parity of its position if one of them is coarser, and, next to
   * the boundary of the box, the place itself. One cache belongs to one box, number of
   * cells a patch, and boundary kinds.
   */
  template <int dim>
  class RowCache
  {
  public:
    using Rows = std::shared_ptr<const PatchRows<dim>>;

    /// Finds what all patches of @p grid have around them.
    void update(const PatchGrid<dim> &grid);

    /// Whether owned patch @p p is inside the box, with leaves of its level only around
    /// it.
    bool is_regular(const unsigned int p) const
    {
      return configurations[p].empty();
    }

    /// Appends the rows of kind @p kind of patch @p p to @p table, by direction; those
    /// that are not known yet are made by @p build (direction).
    void append_to(RowTable<dim> &table,
                   const unsigned int p,
                   const unsigned int kind,
                   const std::function<Rows(const unsigned int)> &build);

    /// Builds rows anew for each patch if false, for tests.
    bool may_share = true;

    /// Number of different surroundings that are kept.
    std::size_t size() const
    {
      return known.size();
    }

  private:
    struct Configuration
    {
      std::unordered_map<unsigned int, Rows> rows;
      bool in_use = false;
    };

    std::unordered_map<std::string, Configuration> known;
    /// By patch and direction; nothing for regular patches, nullptr where all leaves
    /// around are of the patch's level.
    std::vector<std::vector<Configuration *>> configurations;
    bool shares = true;
  };
} // namespace mitre::grid

#endif
