#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <mitre/coupling/kernels.h>
#include <mitre/coupling/point_rules.h>
#include <mitre/coupling/refinement.h>

namespace mitre::coupling
{
  template <int dim>
  RefinementMap<dim>::RefinementMap(const grid::PatchGrid<dim> &grid)
    : grid(grid)
  {
    for (unsigned int d = 0; d < dim; ++d)
      {
        n_bins[d]   = grid.n_patches(grid.maximum_level(), d);
        bin_size[d] = grid.cell_width(grid.maximum_level(), d) * grid.n_cells_per_side();
      }
  }


  template <int dim>
  std::pair<typename RefinementMap<dim>::Index, typename RefinementMap<dim>::Index>
  RefinementMap<dim>::bins_of(const dealii::Point<dim> &lower,
                              const dealii::Point<dim> &upper) const
  {
    std::pair<Index, Index> range;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double origin = grid.box().get_boundary_points().first[d];
        const auto bin      = [&](const double x) {
          return static_cast<int>(std::floor((x - origin) / bin_size[d]));
        };
        range.first[d]  = bin(lower[d]);
        range.second[d] = bin(upper[d]);
        if (!grid.periodic()[d])
          {
            range.first[d]  = std::min(std::max(range.first[d], 0), n_bins[d] - 1);
            range.second[d] = std::min(std::max(range.second[d], 0), n_bins[d] - 1);
          }
        else
          range.second[d] = std::min(range.second[d], range.first[d] + n_bins[d] - 1);
      }
    return range;
  }


  template <int dim>
  std::uint64_t RefinementMap<dim>::key(Index index) const
  {
    std::uint64_t result = 0;
    for (unsigned int d = 0; d < dim; ++d)
      {
        index[d] = ((index[d] % n_bins[d]) + n_bins[d]) % n_bins[d];
        result   = result * n_bins[d] + index[d];
      }
    return result;
  }


  template <int dim>
  template <typename Function>
  void RefinementMap<dim>::for_each_bin(const std::pair<Index, Index> &range,
                                        const Function &function) const
  {
    Index index = range.first;
    while (true)
      {
        function(key(index));
        unsigned int d = 0;
        while (d < dim && ++index[d] > range.second[d])
          {
            index[d] = range.first[d];
            ++d;
          }
        if (d == dim)
          return;
      }
  }


  template <int dim>
  void RefinementMap<dim>::add(const structure::Body<dim> &body,
                               const VectorType &X,
                               const CouplingParameters &parameters,
                               const double buffer)
  {
    const structure::Mesh<dim> &mesh = body.mesh();
    const unsigned int n_nodes       = mesh.nodes_per_element;
    const std::vector<double> x      = body.to_mesh_order(X);
    const int finest                 = grid.maximum_level();
    const int level = parameters.level < 0 ? finest : std::min(parameters.level, finest);

    double smallest_h = std::numeric_limits<double>::max();
    for (unsigned int d = 0; d < dim; ++d)
      smallest_h = std::min(smallest_h, grid.cell_width(level, d));
    const double kernel_reach = kernel_halo_width(parameters.kernel);
    const double beyond_nodes = overshoot(dim, mesh.shape, mesh.degree);
    const Exactness exactness = needed_exactness(dim, mesh.shape, mesh.degree, true);
    std::vector<double> rule_sizes;

    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      {
        // Step 1: the box that kernels at its points reach.
        dealii::Point<dim> lower, upper;
        double longest = 0;
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
            longest             = std::max(longest, upper[d] - lower[d]);
            const double growth = beyond_nodes * (upper[d] - lower[d]);
            lower[d] -= growth;
            upper[d] += growth;
          }
        const dealii::Point<dim> centroid(0.5 * (lower + upper));
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double reach = (kernel_reach + buffer) * grid.cell_width(level, d);
            lower[d] -= reach;
            upper[d] += reach;
          }

        // Step 2: its bins.
        for_each_bin(bins_of(lower, upper), [&](const std::uint64_t k) {
          Bin &bin  = bins[k];
          bin.level = std::max(bin.level, level);
        });

        // Step 3: its points, at about the density that PartPoints will choose.
        const unsigned int k =
          std::min(64u,
                   std::max(exactness.points_per_edge,
                            static_cast<unsigned int>(std::ceil(parameters.point_density *
                                                                longest / smallest_h))));
        if (k >= rule_sizes.size())
          rule_sizes.resize(k + 1, 0.);
        if (rule_sizes[k] == 0)
          rule_sizes[k] =
            parameters.points == PointChoice::nodes
              ? 1
              : make_point_rule<dim>(mesh.shape, k, exactness.degree).size();
        for_each_bin(bins_of(centroid, centroid), [&](const std::uint64_t key) {
          bins[key].n_points += rule_sizes[k];
        });
      }
  }


  template <int dim>
  int RefinementMap<dim>::wanted_level(const dealii::BoundingBox<dim> &leaf) const
  {
    // Shrunk, so that neighbours which share a face do not count.
    dealii::Point<dim> lower = leaf.get_boundary_points().first;
    dealii::Point<dim> upper = leaf.get_boundary_points().second;
    for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d] += 1e-3 * bin_size[d];
        upper[d] -= 1e-3 * bin_size[d];
      }
    int level = grid.minimum_level();
    for_each_bin(bins_of(lower, upper), [&](const std::uint64_t k) {
      const auto bin = bins.find(k);
      if (bin != bins.end())
        level = std::max(level, bin->second.level);
    });
    return level;
  }


  template <int dim>
  double RefinementMap<dim>::n_points(const dealii::BoundingBox<dim> &leaf) const
  {
    dealii::Point<dim> lower = leaf.get_boundary_points().first;
    dealii::Point<dim> upper = leaf.get_boundary_points().second;
    for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d] += 1e-3 * bin_size[d];
        upper[d] -= 1e-3 * bin_size[d];
      }
    double n = 0;
    for_each_bin(bins_of(lower, upper), [&](const std::uint64_t k) {
      const auto bin = bins.find(k);
      if (bin != bins.end())
        n += bin->second.n_points;
    });
    return n;
  }


  template class RefinementMap<2>;
  template class RefinementMap<3>;
} // namespace mitre::coupling
