#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <mitre/base/exceptions.h>
#include <mitre/coupling/part_points.h>

namespace mitre::coupling
{
  namespace
  {
    constexpr unsigned int invalid = dealii::numbers::invalid_unsigned_int;

    /// More points an edge than this mean that something has gone wrong.
    constexpr unsigned int max_points_per_edge = 64;


    /// Pairs of nodes that an edge joins.
    template <int dim>
    std::vector<std::pair<unsigned int, unsigned int>>
    element_edges(const structure::ElementShape shape)
    {
      std::vector<std::pair<unsigned int, unsigned int>> edges;
      if (shape == structure::ElementShape::segment)
        edges.emplace_back(0, 1);
      else if (shape == structure::ElementShape::simplex)
        {
          for (unsigned int a = 0; a <= dim; ++a)
            for (unsigned int b = 0; b < a; ++b)
              edges.emplace_back(a, b);
        }
      else
        for (unsigned int a = 0; a < (1u << dim); ++a)
          for (unsigned int d = 0; d < dim; ++d)
            if ((a & (1u << d)) == 0)
              edges.emplace_back(a, a | (1u << d));
      return edges;
    }


    /// Whether an element has the shape that a linear map gives to the reference element.
    template <int dim>
    bool is_parallelepiped(const structure::Mesh<dim> &mesh, const unsigned int e)
    {
      const auto node = [&](const unsigned int a) -> const dealii::Point<dim> & {
        return mesh.nodes[mesh.elements[e * mesh.nodes_per_element + a]];
      };
      double difference = 0;
      for (unsigned int a = 1; a < (1u << dim); ++a)
        {
          dealii::Tensor<1, dim> offset = node(a) - node(0);
          for (unsigned int d = 0; d < dim; ++d)
            if ((a & (1u << d)) != 0)
              offset -= node(1u << d) - node(0);
          difference = std::max(difference, offset.norm());
        }
      return difference < 1e-10 * (node((1u << dim) - 1) - node(0)).norm();
    }
  } // namespace


  template <int dim>
  PartPoints<dim>::PartPoints(const grid::PatchGrid<dim> &grid,
                              const structure::Body<dim> &body,
                              const double density,
                              const PointChoice choice)
    : grid(grid)
    , body_(body)
    , density(density)
    , choice(choice)
  {
    if (const auto *elements =
          dynamic_cast<const structure::FiniteElementBody<dim> *>(&body))
      rules_ = std::make_unique<PointRules<dim>>(body.mesh().shape,
                                                 elements->reference_element());
    else
      AssertThrow(choice == PointChoice::nodes, dealii::ExcInternalError());
    AssertThrow(body.mesh().degree == 1,
                base::UserError("Part " + body.name() + ": the elements of " +
                                body.mesh().source +
                                " are of second order, which cannot be coupled to the "
                                "fluid yet; expected elements of first order."));
  }


  template <int dim>
  void PartPoints<dim>::reinit()
  {
    elements_are_known = false;
    n_points_          = 0;
    runs_.clear();
    run_starts_.assign(grid.n_owned_patches() + 1, 0);
  }


  template <int dim>
  bool PartPoints<dim>::is_in_box(const dealii::Point<dim> &x) const
  {
    const auto &corners = grid.box().get_boundary_points();
    for (unsigned int d = 0; d < dim; ++d)
      if (!grid.periodic()[d] && !(x[d] >= corners.first[d] && x[d] <= corners.second[d]))
        return false;
    return true;
  }


  // The elements whose box, grown by a margin, touches a patch of this rank. Replicated
  // work, linear in the size of the mesh, but rare.
  template <int dim>
  void PartPoints<dim>::find_elements(const VectorType &X)
  {
    const structure::Mesh<dim> &mesh = body_.mesh();
    const unsigned int n_nodes       = mesh.nodes_per_element;
    const std::vector<double> x      = body_.to_mesh_order(X);

    int highest_level = 0;
    for (unsigned int p = 0; p < grid.n_owned_patches(); ++p)
      highest_level = std::max(highest_level, grid.patch(p).level);
    highest_level = dealii::Utilities::MPI::max(highest_level, grid.communicator());

    // A box no larger than a patch touches those patches only that hold its corners.
    std::array<double, dim> step;
    double smallest_h = std::numeric_limits<double>::max();
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double h = grid.cell_width(highest_level, d);
        step[d]        = h * grid.n_cells_per_side();
        smallest_h     = std::min(smallest_h, h);
      }
    margin = 2 * smallest_h;

    const unsigned int rank =
      dealii::Utilities::MPI::this_mpi_process(grid.communicator());
    const unsigned int n_ranks =
      dealii::Utilities::MPI::n_mpi_processes(grid.communicator());
    std::vector<int> levels(mesh.n_elements(), -1);
    std::vector<unsigned int> counting_rank(mesh.n_elements(), n_ranks);
    std::vector<unsigned int> relevant;
    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      {
        dealii::Point<dim> lower, upper;
        std::array<unsigned int, dim> n_steps;
        unsigned int n_samples = 1;
        for (unsigned int d = 0; d < dim; ++d)
          {
            lower[d] = std::numeric_limits<double>::max();
            upper[d] = std::numeric_limits<double>::lowest();
            for (unsigned int a = 0; a < n_nodes; ++a)
              {
                const double value = x[mesh.elements[e * n_nodes + a] * dim + d];
                lower[d]           = std::min(lower[d], value - margin);
                upper[d]           = std::max(upper[d], value + margin);
              }
            if (!grid.periodic()[d])
              {
                lower[d] = std::max(lower[d], grid.box().get_boundary_points().first[d]);
                upper[d] = std::min(upper[d], grid.box().get_boundary_points().second[d]);
                upper[d] = std::max(upper[d], lower[d]);
              }
            // An element that has flown apart gets a bounded number of samples; update()
            // will find what is wrong with it.
            n_steps[d] = static_cast<unsigned int>(
              std::min(1 + std::ceil((upper[d] - lower[d]) / step[d]), 1e3));
            n_samples *= n_steps[d];
          }

        for (unsigned int sample = 0; sample < n_samples; ++sample)
          {
            dealii::Point<dim> position;
            for (unsigned int d = 0, rest = sample; d < dim; ++d, rest /= n_steps[d - 1])
              position[d] = std::min(lower[d] + (rest % n_steps[d]) * step[d], upper[d]);
            const unsigned int p = grid.locate(position);
            if (p != invalid)
              {
                levels[e]        = std::max(levels[e], grid.patch(p).level);
                counting_rank[e] = rank;
              }
          }
        if (counting_rank[e] == rank)
          relevant.push_back(e);
      }
    dealii::Utilities::MPI::max(dealii::ArrayView<const int>(levels),
                                grid.communicator(),
                                dealii::ArrayView<int>(levels));
    dealii::Utilities::MPI::min(dealii::ArrayView<const unsigned int>(counting_rank),
                                grid.communicator(),
                                dealii::ArrayView<unsigned int>(counting_rank));
    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      AssertThrow(counting_rank[e] < n_ranks,
                  base::UserError("Part " + body_.name() + ": the " +
                                  mesh.describe_element(e) +
                                  " is outside of the fluid's box."));

    elements_ = structure::ElementSet<dim>(mesh, body_.numbering(), relevant);
    spacings.clear();
    counted.clear();
    jacobians.clear();
    smallest_k.clear();
    for (const unsigned int e : relevant)
      {
        double h = std::numeric_limits<double>::max();
        for (unsigned int d = 0; d < dim; ++d)
          h = std::min(h, grid.cell_width(levels[e], d));
        spacings.push_back(h);
        counted.push_back(counting_rank[e] == rank);
        if (choice == PointChoice::nodes)
          continue;
        if (mesh.shape == structure::ElementShape::simplex)
          jacobians.push_back(determinant(rules_->get(2).table.jacobian(mesh, e, 0)));
        smallest_k.push_back(mesh.shape == structure::ElementShape::simplex ||
                                 is_parallelepiped(mesh, e)
                               ? 2
                               : dim);
      }

    positions_.reinit(elements_.partitioner());
    positions_at_lookup = X;
    patch_hints.assign(
      choice == PointChoice::nodes ? elements_.n_nodes() : relevant.size(), 0);
    if (choice == PointChoice::nodes)
      {
        node_weights.reinit(elements_.partitioner());
        const std::vector<double> &weights = body_.node_weights();
        for (unsigned int i = 0; i < weights.size(); ++i)
          node_weights.local_element(i * dim) = weights[i];
        node_weights.update_ghost_values();
      }
    elements_are_known = true;
  }


  template <int dim>
  void PartPoints<dim>::update(const VectorType &X)
  {
    // Step 1: the elements to look at.
    bool must_find = !elements_are_known;
    if (elements_are_known)
      {
        double largest_square = 0;
        for (unsigned int i = 0; i < X.locally_owned_size(); i += dim)
          {
            double square = 0;
            for (unsigned int c = 0; c < dim; ++c)
              {
                const double difference =
                  X.local_element(i + c) - positions_at_lookup.local_element(i + c);
                square += difference * difference;
              }
            // NaN counts as far.
            if (!(square <= largest_square))
              largest_square = square;
          }
        must_find = !(largest_square <= margin * margin);
      }
    if (dealii::Utilities::MPI::logical_or(must_find, grid.communicator()))
      find_elements(X);

    positions_.zero_out_ghost_values();
    for (unsigned int i = 0; i < X.locally_owned_size(); ++i)
      positions_.local_element(i) = grid.pull_into_box(X.local_element(i), i % dim);
    positions_.update_ghost_values();

    // Step 2: which points are in which patch.
    find_runs();

    // Step 3: every point must have been found by exactly one rank.
    if (dealii::Utilities::MPI::logical_or(!error.empty(), grid.communicator()))
      for (const std::string &text :
           dealii::Utilities::MPI::all_gather(grid.communicator(), error))
        AssertThrow(text.empty(), base::UserError(text));
    const std::array<std::uint64_t, 2> n_here = {{n_points_, n_expected_points}};
    std::array<std::uint64_t, 2> n_all;
    dealii::Utilities::MPI::sum(dealii::ArrayView<const std::uint64_t>(n_here.data(), 2),
                                grid.communicator(),
                                dealii::ArrayView<std::uint64_t>(n_all.data(), 2));
    AssertThrow(n_all[0] == n_all[1],
                base::UserError("Part " + body_.name() + ": of " +
                                std::to_string(n_all[1]) + " quadrature points, " +
                                std::to_string(n_all[0]) +
                                " are in patches of the grid. Are positions finite?"));

    // Step 4: runs sorted by patch.
    const unsigned int n_patches = grid.n_owned_patches();
    run_starts_.assign(n_patches + 1, 0);
    for (const Run &run : unsorted_runs)
      ++run_starts_[run.patch + 1];
    for (unsigned int p = 0; p < n_patches; ++p)
      run_starts_[p + 1] += run_starts_[p];
    runs_.resize(unsorted_runs.size());
    for (const Run &run : unsorted_runs)
      runs_[run_starts_[run.patch]++] = run;
    for (unsigned int p = n_patches; p > 0; --p)
      run_starts_[p] = run_starts_[p - 1];
    run_starts_[0] = 0;

    // Step 5: their weights.
    const bool simplices = body_.mesh().shape == structure::ElementShape::simplex;
    weights_.resize(n_points_);
    std::size_t next = 0;
    for (Run &run : runs_)
      {
        run.first_point = next;
        if (choice == PointChoice::nodes)
          {
            weights_[next++] = node_weights.local_element(run.element * dim);
            continue;
          }
        const PointRule<dim> &rule = rules_->get(run.k);
        for (unsigned int i = 0; i < run.n_points; ++i, ++next)
          {
            const unsigned int q = run.list ? selected_[run.first + i] : run.first + i;
            weights_[next] =
              rule.table.weights[q] *
              (simplices ? jacobians[run.element]
                         : determinant(rule.table.jacobian(
                             body_.mesh(), elements_.element(run.element), q)));
          }
      }
  }


  // For most elements, all nodes and so all points are in the patch in which the element
  // was the last time.
  template <int dim>
  void PartPoints<dim>::find_runs()
  {
    const unsigned int n_nodes = body_.mesh().nodes_per_element;
    const auto edges           = element_edges<dim>(body_.mesh().shape);
    const double *x            = positions_.begin();

    unsorted_runs.clear();
    selected_.clear();
    error.clear();
    n_points_         = 0;
    n_expected_points = 0;
    largest_spacing_  = 0;

    for (unsigned int i = 0; i < elements_.n_elements(); ++i)
      {
        const unsigned int *nodes = elements_.nodes(i);

        // Step 1: how many points.
        double longest_square = 0;
        for (const auto &[a, b] : edges)
          {
            double square = 0;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const double difference = x[nodes[a] * dim + d] - x[nodes[b] * dim + d];
                square += difference * difference;
              }
            longest_square = std::max(longest_square, square);
          }
        const double length = std::sqrt(longest_square) / spacings[i];
        if (choice == PointChoice::nodes)
          {
            largest_spacing_ = std::max(largest_spacing_, length);
            continue;
          }
        const double wanted = std::ceil(density * length);
        if (!(wanted <= max_points_per_edge))
          {
            error = "Part " + body_.name() + ": the longest edge of the " +
                    body_.mesh().describe_element(elements_.element(i)) + " is now " +
                    std::to_string(length) + " grid spacings; more than " +
                    std::to_string(max_points_per_edge) +
                    " quadrature points an edge would be needed.";
            return;
          }
        const unsigned int k =
          std::max<unsigned int>(static_cast<unsigned int>(wanted), smallest_k[i]);
        largest_spacing_           = std::max(largest_spacing_, length / k);
        const PointRule<dim> &rule = rules_->get(k);
        if (counted[i])
          n_expected_points += rule.n_points;

        // Step 2: all in one patch?
        dealii::Point<dim> lower, upper, centroid;
        for (unsigned int d = 0; d < dim; ++d)
          {
            lower[d] = upper[d] = x[nodes[0] * dim + d];
            for (unsigned int a = 1; a < n_nodes; ++a)
              {
                lower[d] = std::min(lower[d], x[nodes[a] * dim + d]);
                upper[d] = std::max(upper[d], x[nodes[a] * dim + d]);
              }
            centroid[d] = 0.5 * (lower[d] + upper[d]);
          }
        bool whole = lies_in_patch(lower, upper, patch_hints[i]);
        if (!whole)
          {
            patch_hints[i] = grid.locate(centroid);
            whole          = lies_in_patch(lower, upper, patch_hints[i]);
          }
        if (whole)
          {
            unsorted_runs.push_back({patch_hints[i], i, k, rule.n_points, 0, 0u, false});
            n_points_ += rule.n_points;
          }
        else
          find_points_one_by_one(i, k, rule);
        if (!error.empty())
          return;
      }
    if (choice == PointChoice::nodes)
      find_nodes();
  }


  template <int dim>
  void PartPoints<dim>::find_nodes()
  {
    n_expected_points = elements_.n_owned_nodes();
    for (unsigned int i = 0; i < elements_.n_nodes(); ++i)
      {
        dealii::Point<dim> x;
        for (unsigned int d = 0; d < dim; ++d)
          x[d] = positions_.local_element(i * dim + d);
        if (!lies_in_patch(x, x, patch_hints[i]))
          patch_hints[i] = grid.locate(x);
        if (patch_hints[i] != invalid)
          {
            unsorted_runs.push_back({patch_hints[i], i, 1, 1, 0, 0u, false});
            ++n_points_;
          }
        else if (!is_in_box(x))
          {
            error = "Part " + body_.name() + ": a node is at " + structure::to_string(x) +
                    " cm, which is outside of the fluid's box.";
            return;
          }
      }
  }


  template <int dim>
  bool PartPoints<dim>::lies_in_patch(const dealii::Point<dim> &lower,
                                      const dealii::Point<dim> &upper,
                                      const unsigned int p) const
  {
    if (p >= grid.n_owned_patches())
      return false;
    const grid::Patch<dim> &patch = grid.patch(p);
    bool inside                   = true;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double tolerance = 1e-6 * patch.h[d];
        inside =
          inside && lower[d] >= patch.lower[d] + tolerance &&
          upper[d] <= patch.lower[d] + grid.n_cells_per_side() * patch.h[d] - tolerance;
      }
    return inside;
  }


  template <int dim>
  double PartPoints<dim>::largest_spacing() const
  {
    return dealii::Utilities::MPI::max(largest_spacing_, body_.communicator());
  }


  template <int dim>
  void PartPoints<dim>::find_points_one_by_one(const unsigned int i,
                                               const unsigned int k,
                                               const PointRule<dim> &rule)
  {
    const unsigned int n_nodes = body_.mesh().nodes_per_element;
    const unsigned int *nodes  = elements_.nodes(i);
    const double *x            = positions_.begin();

    point_patches.resize(rule.n_points);
    candidates.clear();
    for (unsigned int q = 0; q < rule.n_points; ++q)
      {
        dealii::Point<dim> point;
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (unsigned int d = 0; d < dim; ++d)
            point[d] += rule.by_point[q * n_nodes + a] * x[nodes[a] * dim + d];
        // Neighbours are mostly in the same patch.
        const auto found =
          std::find_if(candidates.begin(), candidates.end(), [&](const unsigned int p) {
            return lies_in_patch(point, point, p);
          });
        if (found != candidates.end())
          {
            point_patches[q] = *found;
            continue;
          }
        point_patches[q] = grid.locate(point);
        if (point_patches[q] != invalid)
          candidates.push_back(point_patches[q]);
        else if (!is_in_box(point))
          {
            error = "Part " + body_.name() + ": the " +
                    body_.mesh().describe_element(elements_.element(i)) +
                    " has the point " + structure::to_string(point) +
                    ", which is outside of the fluid's box.";
            return;
          }
      }

    // One run for each patch that has some of the points.
    for (unsigned int q = 0; q < rule.n_points; ++q)
      {
        const unsigned int p = point_patches[q];
        if (p == invalid)
          continue;
        Run run{p, i, k, 0, 0, static_cast<unsigned int>(selected_.size()), true};
        for (unsigned int r = q; r < rule.n_points; ++r)
          if (point_patches[r] == p)
            {
              selected_.push_back(r);
              point_patches[r] = invalid;
            }
        run.n_points = selected_.size() - run.first;
        n_points_ += run.n_points;
        unsorted_runs.push_back(run);
      }
  }


  template class PartPoints<2>;
  template class PartPoints<3>;
} // namespace mitre::coupling
