#ifndef mitre_coupling_part_points_h
#define mitre_coupling_part_points_h

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <mitre/coupling/point_rules.h>
#include <mitre/grid/patch_grid.h>
#include <mitre/structure/body.h>

namespace mitre::coupling
{
  using structure::VectorType;


  /// Where a body meets the grid.
  enum class PointChoice : unsigned char
  {
    quadrature, ///< at quadrature points in its elements, as dense as these are large
    nodes       ///< at its nodes, with structure::Body::node_weights()
  };


  /**
   * The quadrature points of one body that lie in patches of this rank, at given node
   * positions. A rank works on all elements that may have points in its patches; each
   * point belongs to the one rank that owns its patch.
   *
   * Points are kept as runs: points of one element in one patch. Their positions follow
   * from those of the nodes when they are needed. Where nodes are the points, a run is a
   * node.
   */
  template <int dim>
  class PartPoints
  {
  public:
    struct Run
    {
      unsigned int patch;

      /// Local number of the element, or of the node.
      unsigned int element;

      /// Number of the rule, see PointRules.
      unsigned int rule;

      unsigned int n_points;

      /// Where the run's points begin in weights().
      std::size_t first_point;

      /// The points of the rule: n_points from this one on, if list is false; else the
      /// members of selected() from this one on.
      unsigned int first : 31;
      unsigned int list : 1;
    };

    /**
     * Throws base::UserError if the nodes of quadratic simplices shall be the points.
     *
     * @param density points for each grid spacing along the longest edge of an element
     */
    PartPoints(const grid::PatchGrid<dim> &grid,
               const structure::Body<dim> &body,
               const double density,
               const PointChoice choice = PointChoice::quadrature);

    const structure::Body<dim> &body() const
    {
      return body_;
    }

    /// Forget all that depends on the grid and on the numbering of the body.
    void reinit();

    /**
     * Find the points for node positions @p X. Linear in the number of points; elements
     * are looked up anew only when a node has moved by more than two of the smallest grid
     * spacings. Collective. Throws base::UserError on all ranks if a point is outside of
     * the box, if an element is so stretched that it needs more than 64 points an edge,
     * or if there are points that no rank has.
     */
    void update(const VectorType &X);

    /// Look up the elements for node positions @p X, as update() does. Collective.
    void find_elements(const VectorType &X);

    /// The node positions for which elements have last been looked up; null if they have
    /// not been since reinit().
    const VectorType *lookup_positions() const
    {
      return elements_are_known ? &positions_at_lookup : nullptr;
    }

    /// Runs of patch p: run_starts()[p] <= i < run_starts()[p + 1].
    const std::vector<unsigned int> &run_starts() const
    {
      return run_starts_;
    }

    const std::vector<Run> &runs() const
    {
      return runs_;
    }

    const std::vector<std::uint16_t> &selected() const
    {
      return selected_;
    }

    /// Quadrature weight times reference Jacobian of each point [cm^dim].
    const std::vector<double> &weights() const
    {
      return weights_;
    }

    const structure::ElementSet<dim> &elements() const
    {
      return elements_;
    }

    /// Local numbers of the nodes on which the points of @p run depend, and how many.
    const unsigned int *nodes(const Run &run) const
    {
      return choice == PointChoice::nodes ? &run.element : elements_.nodes(run.element);
    }

    unsigned int nodes_per_run() const
    {
      return choice == PointChoice::nodes ? 1 : body_.mesh().nodes_per_element;
    }

    const PointRule<dim> &rule(const Run &run)
    {
      return choice == PointChoice::nodes ? node_rule : rules_->get(run.rule);
    }

    /**
     * The largest distance of points along an edge of an element in spacings of the grid
     * there: length over number of points at the last update() (for bent edges of
     * quadratic elements: where they are stretched most). Fluid passes between points
     * that are more than about one spacing apart. Collective.
     */
    double largest_spacing() const;

    /// Node positions of update(), by local node and component.
    const double *positions() const
    {
      return positions_.begin();
    }

    std::size_t n_points() const
    {
      return n_points_;
    }

  private:
    void find_runs();

    void find_nodes();

    /// The square of the length of the longest edge of an element with these nodes. An
    /// edge with a node in between is as long as it would be if its parameter had
    /// everywhere the largest speed that it has.
    double longest_edge_squared(const unsigned int *nodes) const;

    /// Whether a box lies in owned patch @p p, away from its faces, where round-off would
    /// decide.
    bool lies_in_patch(const dealii::Point<dim> &lower,
                       const dealii::Point<dim> &upper,
                       const unsigned int p) const;

    void find_points_one_by_one(const unsigned int i,
                                const unsigned int number,
                                const PointRule<dim> &rule);

    bool is_in_box(const dealii::Point<dim> &x) const;

    const grid::PatchGrid<dim> &grid;
    const structure::Body<dim> &body_;
    const double density;
    const PointChoice choice;
    std::unique_ptr<PointRules<dim>> rules_; ///< of finite elements
    const PointRule<dim> node_rule;

    /// Lines of nodes along which points are counted: the ends, and the node between them
    /// of quadratic elements.
    struct Edge
    {
      unsigned int begin, end, middle;
    };
    const std::vector<Edge> edges;

    /// How far points may be beyond the box of an element's nodes (overshoot()).
    const double overshoot_;

    /// The elements that may have points here, the smallest spacing about each of them,
    /// the least k with which its rule keeps force and torque, whether this rank counts
    /// its points, and its reference Jacobian (0 if that is not constant).
    structure::ElementSet<dim> elements_;
    std::vector<double> spacings;
    std::vector<unsigned char> smallest_k;
    std::vector<bool> counted;
    std::vector<double> jacobians;
    bool elements_are_known = false;
    double margin           = 0;
    VectorType positions_at_lookup;

    /// The owned positions of the last update() of a rigid body.
    std::vector<double> positions_at_update;

    VectorType positions_;
    std::vector<unsigned int> patch_hints;
    std::vector<Run> unsorted_runs, runs_;
    std::vector<unsigned int> run_starts_;
    std::vector<std::uint16_t> selected_;
    std::vector<double> weights_;
    std::size_t n_points_   = 0;
    double largest_spacing_ = 0;

    /// Weights by local node, where nodes are the points.
    VectorType node_weights;

    /// Number of points that counted elements have on all ranks together, and what went
    /// wrong.
    std::uint64_t n_expected_points = 0;
    std::string error;

    /// Work space: patch of each point of an element, and the patches found so far.
    std::vector<unsigned int> point_patches, candidates;
  };
} // namespace mitre::coupling

#endif
