#ifndef mitre_grid_linear_combination_h
#define mitre_grid_linear_combination_h

#include <deal.II/base/point.h>
#include <deal.II/base/types.h>

#include <array>
#include <utility>
#include <vector>

#include <mitre/grid/hash_map.h>

namespace mitre::grid
{
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
} // namespace mitre::grid

#endif
