#ifndef mitre_tests_grid_tests_h
#define mitre_tests_grid_tests_h

#include <deal.II/base/mpi.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <sstream>
#include <string>

#include <mitre/grid/cell_halo.h>
#include <mitre/grid/staggered_space.h>

/// What the tests of grid and fluid share: grids, fields, and claims.
namespace grid_tests
{
  using namespace dealii;
  using namespace mitre;

  /// "below 1e-13: ok", or the value and FAILED.
  inline std::string below(const double value, const double bound)
  {
    std::ostringstream text;
    if (value < bound)
      text << "below " << bound << ": ok";
    else
      text << value << " is not below " << bound << ": FAILED";
    return text.str();
  }

  inline std::string above(const double value, const double bound)
  {
    std::ostringstream text;
    if (value > bound)
      text << "above " << bound << ": ok";
    else
      text << value << " is not above " << bound << ": FAILED";
    return text.str();
  }

  /// Standard output on the first rank, nothing on the others.
  inline std::ostream &out()
  {
    static std::ostream nowhere(nullptr);
    return Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0 ? std::cout : nowhere;
  }

  /// Unit box with @p n cells of the lowest level a side, and @p levels - 1 finer levels.
  template <int dim>
  grid::PatchGridParameters<dim>
  unit_box(const unsigned int n, const unsigned int levels, const std::string &periodic)
  {
    grid::PatchGridParameters<dim> parameters;
    for (unsigned int d = 0; d < dim; ++d)
      {
        parameters.lower[d]        = 0.;
        parameters.upper[d]        = 1.;
        parameters.base_patches[d] = 1;
        parameters.periodic[d]     = periodic.find("xyz"[d]) != std::string::npos;
      }
    parameters.cells_per_side = 8;
    parameters.minimum_level  = 0;
    while ((8u << parameters.minimum_level) < n)
      ++parameters.minimum_level;
    parameters.maximum_level = parameters.minimum_level + levels - 1;
    return parameters;
  }

  /// Asks for the highest level in a ball, for the lowest one elsewhere.
  template <int dim>
  std::function<int(const BoundingBox<dim> &)>
  refine_ball(const grid::PatchGrid<dim> &patch_grid,
              const Point<dim> &center,
              const double radius)
  {
    return [&patch_grid, center, radius](const BoundingBox<dim> &box) {
      double square = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double nearest =
            std::min(std::max(center[d], box.lower_bound(d)), box.upper_bound(d));
          square += (nearest - center[d]) * (nearest - center[d]);
        }
      return static_cast<int>(square < radius * radius ? patch_grid.maximum_level()
                                                       : patch_grid.minimum_level());
    };
  }

  /// A point whose coordinates are all @p x.
  template <int dim>
  Point<dim> diagonal_point(const double x)
  {
    Point<dim> point;
    for (unsigned int d = 0; d < dim; ++d)
      point[d] = x;
    return point;
  }

  /// The same kind of boundary everywhere.
  template <int dim>
  grid::BoundaryKinds<dim> all_sides(const grid::BoundaryKind kind)
  {
    return [kind](const unsigned int, const Point<dim> &) {
      return grid::BoundaryInfo{kind, 0};
    };
  }

  /// A number in (-1, 1) without pattern that depends on the place only, so that it is
  /// the same for any number of ranks.
  template <int dim>
  double noise(const Point<dim> &x, const unsigned int c)
  {
    double phase = 1.3 * c + 0.7;
    for (unsigned int d = 0; d < dim; ++d)
      phase += x[d] * (1297.3 + 311.7 * d);
    const double value = 43758.5453 * std::sin(phase);
    return 2. * (value - std::floor(value)) - 1.;
  }

  /// A linear field of position and component.
  template <int dim>
  double linear(const Point<dim> &x, const unsigned int c)
  {
    double value = 0.3 + c;
    for (unsigned int d = 0; d < dim; ++d)
      value += (1. + d - 0.8 * c) * x[d];
    return value;
  }

  /// A quadratic field with mixed terms.
  template <int dim>
  double quadratic(const Point<dim> &x, const unsigned int c)
  {
    double value = linear(x, c);
    for (unsigned int d = 0; d < dim; ++d)
      value +=
        (0.7 - d + 0.4 * c) * x[d] * x[d] + 0.5 * (c + 1.) * x[d] * x[(d + 1) % dim];
    return value;
  }

  /// Calls @p operation(entry, patch, component, position) for all entries of this rank.
  template <int dim, typename Operation>
  void for_each_face(const grid::StaggeredSpace<dim> &space, const Operation &operation)
  {
    for (unsigned int p = 0; p < space.grid().n_owned_patches(); ++p)
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int i = 0; i < space.n_dofs_per_component(); ++i)
          {
            std::array<int, dim> index;
            unsigned int rest = i;
            for (unsigned int d = 0; d < dim; ++d)
              {
                index[d] = rest % space.extent(c, d);
                rest /= space.extent(c, d);
              }
            operation(space.first_dof(p, c) + i, p, c, space.position(p, c, index));
          }
  }

  /// Calls @p operation(entry, patch, center, volume) for all cells of this rank.
  template <int dim, typename Operation>
  void for_each_cell(const grid::PatchGrid<dim> &patch_grid, const Operation &operation)
  {
    const unsigned int n = patch_grid.n_cells_per_side();
    std::size_t entry    = 0;
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      for (unsigned int i = 0; i < Utilities::fixed_power<dim>(n); ++i, ++entry)
        {
          const auto &patch = patch_grid.patch(p);
          Point<dim> x;
          double volume     = 1.;
          unsigned int rest = i;
          for (unsigned int d = 0; d < dim; ++d)
            {
              x[d] = patch.lower[d] + (rest % n + 0.5) * patch.h[d];
              rest /= n;
              volume *= patch.h[d];
            }
          operation(entry, p, x, volume);
        }
  }

  /// Sets all entries from a function of position and component, copies from masters.
  template <int dim, typename Function>
  void interpolate(const grid::StaggeredSpace<dim> &space,
                   const Function &function,
                   grid::VectorType &u)
  {
    for_each_face(space,
                  [&](const std::size_t entry,
                      const unsigned int,
                      const unsigned int c,
                      const Point<dim> &x) { u.local_element(entry) = function(x, c); });
    space.synchronize(u);
  }

  /// True if a patch touches the boundary of the box (periodic sides do not count).
  template <int dim>
  bool at_boundary(const grid::PatchGrid<dim> &patch_grid, const unsigned int p)
  {
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (patch_grid.neighbor(p, side) == grid::Neighbor::boundary)
        return true;
    return false;
  }
} // namespace grid_tests

#endif
