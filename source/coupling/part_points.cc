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


    /**
     * The edges of an element; of quadratic hypercubes all lines of three nodes, as those
     * in the middle of faces and cells may be longer than edges.
     */
    template <int dim, typename Edge>
    std::vector<Edge> element_edges(const structure::ElementShape shape,
                                    const unsigned int degree,
                                    const std::vector<dealii::Point<dim>> &nodes)
    {
      if (shape == structure::ElementShape::segment)
        return {{0, 1, invalid}};
      const auto find = [&](const dealii::Point<dim> &x) -> unsigned int {
        for (unsigned int a = 0; a < nodes.size(); ++a)
          if (nodes[a].distance(x) < 1e-10)
            return a;
        return invalid;
      };
      std::vector<Edge> edges;
      for (unsigned int a = 0; a < nodes.size(); ++a)
        for (unsigned int b = 0; b < nodes.size(); ++b)
          {
            bool is_edge = a < b && b <= dim;
            if (shape == structure::ElementShape::hypercube)
              {
                const dealii::Tensor<1, dim> line = nodes[b] - nodes[a];
                unsigned int n_directions         = 0;
                for (unsigned int d = 0; d < dim; ++d)
                  n_directions += std::abs(line[d]) > 1e-10;
                is_edge =
                  n_directions == 1 && std::abs(line.norm_square() - 1) < 1e-10 && a < b;
              }
            if (is_edge)
              edges.push_back(
                {a,
                 b,
                 degree == 1 ? invalid
                             : find(dealii::Point<dim>(0.5 * (nodes[a] + nodes[b])))});
          }
      return edges;
    }


    /// Whether an element is the image of the reference element by an affine map.
    template <int dim>
    bool is_affine(const structure::Mesh<dim> &mesh,
                   const unsigned int e,
                   const std::vector<dealii::Point<dim>> &reference_nodes)
    {
      const bool simplex = mesh.shape == structure::ElementShape::simplex;
      if (simplex && mesh.degree == 1)
        return true;
      const auto node = [&](const unsigned int a) -> const dealii::Point<dim> & {
        return mesh.nodes[mesh.elements[e * mesh.nodes_per_element + a]];
      };
      double difference = 0, size = 0;
      for (unsigned int a = 1; a < mesh.nodes_per_element; ++a)
        {
          dealii::Tensor<1, dim> offset = node(a) - node(0);
          size                          = std::max(size, offset.norm());
          for (unsigned int d = 0; d < dim; ++d)
            offset -= reference_nodes[a][d] * (node(simplex ? d + 1 : 1u << d) - node(0));
          difference = std::max(difference, offset.norm());
        }
      return difference < 1e-10 * size;
    }
  } // namespace


  namespace
  {
    /// The nodes of the reference element; none of a body of fibres.
    template <int dim>
    std::vector<dealii::Point<dim>> reference_nodes(const structure::Body<dim> &body)
    {
      const auto *elements =
        dynamic_cast<const structure::FiniteElementBody<dim> *>(&body);
      return elements == nullptr ? std::vector<dealii::Point<dim>>()
                                 : elements->reference_element().nodes();
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
    , edges(element_edges<dim, Edge>(body.mesh().shape,
                                     body.mesh().degree,
                                     reference_nodes(body)))
    , overshoot_(overshoot(dim, body.mesh().shape, body.mesh().degree))
  {
    AssertThrow(
      choice == PointChoice::quadrature || body.mesh().degree == 1 ||
        body.mesh().shape == structure::ElementShape::hypercube,
      base::UserError(
        "Part " + body.name() + ": \"Coupling\" is 'nodal', but the elements of " +
        body.mesh().source + " are quadratic " + (dim == 2 ? "triangles" : "tetrahedra") +
        ", at whose corners the row sums of the mass matrix are " +
        (dim == 2 ? "zero" : "negative") + "; expected 'elemental', or other elements."));
    if (const auto *elements =
          dynamic_cast<const structure::FiniteElementBody<dim> *>(&body))
      rules_ = std::make_unique<PointRules<dim>>(
        body.mesh().shape, body.mesh().degree, elements->reference_element());
    else
      AssertThrow(choice == PointChoice::nodes, dealii::ExcInternalError());
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
                lower[d]           = std::min(lower[d], value);
                upper[d]           = std::max(upper[d], value);
              }
            // Nodes that have moved by the margin in opposite directions make the box
            // wider, too.
            const double growth =
              margin + overshoot_ * (upper[d] - lower[d] + 2 * margin);
            lower[d] -= growth;
            upper[d] += growth;
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
    const std::vector<dealii::Point<dim>> nodes_of_element = reference_nodes(body_);
    for (const unsigned int e : relevant)
      {
        double h = std::numeric_limits<double>::max();
        for (unsigned int d = 0; d < dim; ++d)
          h = std::min(h, grid.cell_width(levels[e], d));
        spacings.push_back(h);
        counted.push_back(counting_rank[e] == rank);
        if (choice == PointChoice::nodes)
          continue;
        const bool affine = is_affine(mesh, e, nodes_of_element);
        jacobians.push_back(
          affine
            ? determinant(
                rules_->get(PointRules<dim>::number(2, true)).table.jacobian(mesh, e, 0))
            : 0.);
        smallest_k.push_back(
          mesh.shape == structure::ElementShape::simplex
            ? 2
            : needed_exactness(dim, mesh.shape, mesh.degree, affine).points_per_edge);
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
    positions_at_update.clear();
  }


  template <int dim>
  void PartPoints<dim>::update(const VectorType &X)
  {
    // Step 1: the elements to look at. Rigid bodies often stay where they are.
    bool must_find = !elements_are_known;
    bool moved =
      must_find || !body_.is_rigid() ||
      !std::equal(
        X.begin(), X.end(), positions_at_update.begin(), positions_at_update.end());
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
    const std::array<unsigned int, 2> flags_here = {
      {must_find ? 1u : 0u, moved ? 1u : 0u}};
    std::array<unsigned int, 2> flags;
    dealii::Utilities::MPI::max(
      dealii::ArrayView<const unsigned int>(flags_here.data(), 2),
      grid.communicator(),
      dealii::ArrayView<unsigned int>(flags.data(), 2));
    if (flags[0] == 0 && flags[1] == 0)
      return;
    if (flags[0] != 0)
      find_elements(X);
    if (body_.is_rigid())
      positions_at_update.assign(X.begin(), X.end());

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
        const PointRule<dim> &rule = rules_->get(run.rule);
        const double jacobian      = jacobians[run.element];
        for (unsigned int i = 0; i < run.n_points; ++i, ++next)
          {
            const unsigned int q = run.list ? selected_[run.first + i] : run.first + i;
            weights_[next] =
              rule.table.weights[q] *
              (jacobian != 0 ? jacobian
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
    const bool simplices       = body_.mesh().shape == structure::ElementShape::simplex;
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
        const double length = std::sqrt(longest_edge_squared(nodes)) / spacings[i];
        if (choice == PointChoice::nodes)
          {
            largest_spacing_ = std::max(largest_spacing_, length / body_.mesh().degree);
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
        largest_spacing_ = std::max(largest_spacing_, length / k);
        const unsigned int number =
          PointRules<dim>::number(k, !simplices || jacobians[i] != 0);
        const PointRule<dim> &rule = rules_->get(number);
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
            centroid[d]         = 0.5 * (lower[d] + upper[d]);
            const double growth = overshoot_ * (upper[d] - lower[d]);
            lower[d] -= growth;
            upper[d] += growth;
          }
        bool whole = lies_in_patch(lower, upper, patch_hints[i]);
        if (!whole)
          {
            patch_hints[i] = grid.locate(centroid);
            whole          = lies_in_patch(lower, upper, patch_hints[i]);
          }
        if (whole)
          {
            unsorted_runs.push_back(
              {patch_hints[i], i, number, rule.n_points, 0, 0u, false});
            n_points_ += rule.n_points;
          }
        else
          find_points_one_by_one(i, number, rule);
        if (!error.empty())
          return;
      }
    if (choice == PointChoice::nodes)
      find_nodes();
  }


  template <int dim>
  double PartPoints<dim>::longest_edge_squared(const unsigned int *nodes) const
  {
    const double *x       = positions_.begin();
    const bool quadratic  = body_.mesh().degree == 2;
    double longest_square = 0;
    for (const Edge &edge : edges)
      {
        const double *a = x + nodes[edge.begin] * dim, *b = x + nodes[edge.end] * dim;
        double square = 0;
        for (unsigned int d = 0; d < dim; ++d)
          square += (b[d] - a[d]) * (b[d] - a[d]);
        longest_square = std::max(longest_square, square);
        if (quadratic)
          {
            // The derivative is linear in the parameter, so largest at an end.
            const double *m = x + nodes[edge.middle] * dim;
            double at_begin = 0, at_end = 0;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const double bend = 4 * (m[d] - 0.5 * (a[d] + b[d])), chord = b[d] - a[d];
                at_begin += (chord + bend) * (chord + bend);
                at_end += (chord - bend) * (chord - bend);
              }
            longest_square = std::max({longest_square, at_begin, at_end});
          }
      }
    return longest_square;
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
            unsorted_runs.push_back({patch_hints[i], i, 0, 1, 0, 0u, false});
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
                                               const unsigned int number,
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
        Run run{p, i, number, 0, 0, static_cast<unsigned int>(selected_.size()), true};
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
