#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

#include <mitre/fluid/vorticity_map.h>

namespace mitre::fluid
{
  using namespace dealii;
  using grid::VectorType;

  template <int dim>
  double compute_largest_vorticity(const grid::StaggeredSpace<dim> &space,
                                   const VectorType &u,
                                   const unsigned int p)
  {
    const auto &patch = space.grid().patch(p);
    const int n       = space.grid().n_cells_per_side();
    double largest    = 0.;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a + 1; b < dim; ++b)
        {
          // d u_b / d x_a - d u_a / d x_b where faces of both kinds meet
          const double *u_a         = u.begin() + space.first_dof(p, a);
          const double *u_b         = u.begin() + space.first_dof(p, b);
          const unsigned int across = 3 - a - b; // third direction, in 3D
          const int layers          = dim == 3 ? n : 1;
          for (int k = 0; k < layers; ++k)
            for (int j = 1; j < n; ++j)
              for (int i = 1; i < n; ++i)
                {
                  std::size_t at_a = i * space.stride(a, a) + j * space.stride(a, b),
                              at_b = i * space.stride(b, a) + j * space.stride(b, b);
                  if (dim == 3)
                    {
                      at_a += k * space.stride(a, across);
                      at_b += k * space.stride(b, across);
                    }
                  const double vorticity =
                    (u_b[at_b] - u_b[at_b - space.stride(b, a)]) / patch.h[a] -
                    (u_a[at_a] - u_a[at_a - space.stride(a, b)]) / patch.h[b];
                  largest = std::max(largest, std::abs(vorticity));
                }
        }
    return largest;
  }


  template <int dim>
  VorticityMap<dim>::VorticityMap(const grid::StaggeredSpace<dim> &space,
                                  const VectorType &u,
                                  const double change,
                                  const int maximum_level)
    : box(space.grid().box())
  {
    const grid::PatchGrid<dim> &patch_grid = space.grid();
    for (unsigned int d = 0; d < dim; ++d)
      base_patches[d] = patch_grid.n_patches(0, d);

    // index, level, wanted level
    std::vector<std::array<int, dim + 2>> own;
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        const auto &patch    = patch_grid.patch(p);
        const double measure = compute_largest_vorticity(space, u, p) *
                               *std::min_element(patch.h.begin(), patch.h.end());
        std::array<int, dim + 2> entry;
        std::copy(patch.index.begin(), patch.index.end(), entry.begin());
        entry[dim]     = patch.level;
        entry[dim + 1] = measure > change        ? patch.level + 1
                         : measure < change / 3. ? patch.level - 1
                                                 : patch.level;
        entry[dim + 1] = std::min(entry[dim + 1], maximum_level);
        own.push_back(entry);
      }
    wanted.resize(patch_grid.maximum_level() + 1);
    for (const auto &entries : Utilities::MPI::all_gather(patch_grid.communicator(), own))
      for (const auto &entry : entries)
        {
          Index index;
          std::copy(entry.begin(), entry.begin() + dim, index.begin());
          for (int level = entry[dim]; level >= 0; --level)
            {
              const auto place = wanted[level].emplace(index, entry[dim + 1]).first;
              place->second    = std::max(place->second, entry[dim + 1]);
              for (unsigned int d = 0; d < dim; ++d)
                index[d] /= 2;
            }
        }
  }


  template <int dim>
  typename VorticityMap<dim>::Index VorticityMap<dim>::index_of(const Point<dim> &x,
                                                                const int level) const
  {
    Index index;
    for (unsigned int d = 0; d < dim; ++d)
      index[d] = static_cast<int>(std::floor(
        (x[d] - box.lower_bound(d)) / box.side_length(d) * (base_patches[d] << level)));
    return index;
  }


  template <int dim>
  int VorticityMap<dim>::wanted_level(const BoundingBox<dim> &leaf) const
  {
    int level = std::lround(
      std::log2(box.side_length(0) / (base_patches[0] * leaf.side_length(0))));
    for (level = std::min(level, static_cast<int>(wanted.size()) - 1); level >= 0;
         --level)
      {
        const auto place = wanted[level].find(index_of(leaf.center(), level));
        if (place != wanted[level].end())
          return place->second;
      }
    return 0;
  }


  template double compute_largest_vorticity(const grid::StaggeredSpace<2> &,
                                            const VectorType &,
                                            const unsigned int);
  template double compute_largest_vorticity(const grid::StaggeredSpace<3> &,
                                            const VectorType &,
                                            const unsigned int);
  template class VorticityMap<2>;
  template class VorticityMap<3>;
} // namespace mitre::fluid
