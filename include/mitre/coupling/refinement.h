#ifndef mitre_coupling_refinement_h
#define mitre_coupling_refinement_h

#include <deal.II/base/bounding_box.h>

#include <unordered_map>
#include <vector>

#include <mitre/coupling/fe_coupling.h>

namespace mitre::coupling
{
  /**
   * Where bodies want the grid to be fine, and how much work they bring there. Known to
   * all ranks for the whole box, so that it can be asked for the boxes of leaves before,
   * during and after a change of the grid.
   */
  template <int dim>
  class RefinementMap
  {
  public:
    explicit RefinementMap(const grid::PatchGrid<dim> &grid);

    /**
     * Add a body at node positions @p X. Leaves shall have the level of @p parameters
     * where a kernel at a point of the body, moved by up to @p buffer more grid spacings
     * of that level, reaches. Collective.
     */
    void add(const structure::Body<dim> &body,
             const VectorType &X,
             const CouplingParameters &parameters,
             const double buffer);

    /// The level that the bodies want in a leaf; the smallest of the grid if they want
    /// none.
    int wanted_level(const dealii::BoundingBox<dim> &leaf) const;

    /// About how many quadrature points a leaf has.
    double n_points(const dealii::BoundingBox<dim> &leaf) const;

  private:
    using Index = std::array<int, dim>;

    struct Bin
    {
      int level       = 0;
      double n_points = 0;
    };

    /// First and last bin that a box touches.
    std::pair<Index, Index> bins_of(const dealii::Point<dim> &lower,
                                    const dealii::Point<dim> &upper) const;

    std::uint64_t key(Index index) const;

    template <typename Function>
    void for_each_bin(const std::pair<Index, Index> &range,
                      const Function &function) const;

    const grid::PatchGrid<dim> &grid;
    std::array<double, dim> bin_size;
    Index n_bins;
    std::unordered_map<std::uint64_t, Bin> bins;
  };
} // namespace mitre::coupling

#endif
