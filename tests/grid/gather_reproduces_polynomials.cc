// Padded patches hold what a linear field has at their places, exactly (1e-13:
// round-off), also from finer and from coarser patches; and what a quadratic one has if
// all neighbours have the same level. At coarse-fine interfaces so do components along
// the interface; fine faces on it follow a linear rule that is off by a multiple of h^2,
// so that the error falls by 4 when h is halved (order 2; the claim is 1.99). At a
// boundary with given velocity the one layer of tangential components that the viscous
// term uses is exact for quadratic fields, and the reflection that advection uses for
// linear ones.

#include <mitre/grid/velocity_halo.h>

#include "grid_tests.h"

using namespace grid_tests;

struct Choice
{
  bool linear, with_boundary;
};

/// Largest error of padded patches that do not touch the boundary, or of all.
template <int dim>
double
error(const grid::StaggeredSpace<dim> &space,
      const unsigned int width,
      const grid::HaloShape shape,
      const grid::BoundaryExtension extension,
      const Choice choice)
{
  const auto field = (choice.linear ? linear<dim> : quadratic<dim>);
  grid::VelocityHalo<dim> halo(space, width, shape, extension);
  halo.make_own_partitioner();
  grid::VectorType u;
  space.initialize_vector(u);
  interpolate(space, field, u);
  const auto &imported = halo.import(u);
  if (choice.with_boundary)
    halo.set_boundary_values(
      [&](const grid::BoundaryTerm<dim> &term) { return field(term.x, term.component); });

  const auto &patch_grid = space.grid();
  double largest         = 0.;
  std::vector<double> values(halo.size(0));
  for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
    {
      if (!choice.with_boundary && at_boundary(patch_grid, p))
        continue;
      for (unsigned int c = 0; c < dim; ++c)
        {
          halo.gather(imported, p, c, values.data(), choice.with_boundary);
          for (unsigned int i = 0; i < halo.size(c); ++i)
            {
              Point<dim> x;
              unsigned int rest = i, outside = 0;
              bool normal = false;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  const int at =
                    static_cast<int>(rest % halo.extents(c)[d]) - static_cast<int>(width);
                  if (at < 0 || at >= static_cast<int>(space.extent(c, d)))
                    {
                      ++outside;
                      normal =
                        normal ||
                        (d == c && patch_grid.neighbor(p, 2 * d + (at < 0 ? 0 : 1)) ==
                                     grid::Neighbor::boundary);
                    }
                  x[d] = patch_grid.patch(p).lower[d] +
                         (at + (d == c ? 0. : 0.5)) * patch_grid.patch(p).h[d];
                  rest /= halo.extents(c)[d];
                }
              if (shape == grid::HaloShape::full || (outside <= 1 && !normal))
                largest = std::max(largest, std::abs(values[i] - field(x, c)));
            }
        }
    }
  return Utilities::MPI::max(largest, MPI_COMM_WORLD);
}

template <int dim>
struct Grid
{
  grid::PatchGrid<dim> patch_grid;
  std::unique_ptr<grid::StaggeredSpace<dim>> space;

  /// The box from 1/4 to 3/4 is refined to the highest level.
  Grid(const unsigned int n, const unsigned int levels)
    : patch_grid(MPI_COMM_WORLD, unit_box<dim>(n, levels, ""))
  {
    patch_grid.adapt([&](const BoundingBox<dim> &box) {
      bool inside = true;
      for (unsigned int d = 0; d < dim; ++d)
        inside = inside && std::abs(box.center()[d] - 0.5) < 0.25;
      return static_cast<int>(inside ? patch_grid.maximum_level()
                                     : patch_grid.minimum_level());
    });
    space = std::make_unique<grid::StaggeredSpace<dim>>(
      patch_grid, all_sides<dim>(grid::BoundaryKind::velocity));
    space->finalize({});
  }
};

template <int dim>
void
check(const unsigned int n, const unsigned int levels)
{
  using grid::BoundaryExtension;
  using grid::HaloShape;
  const Grid<dim> mixed(n, levels), uniform(32, 1);
  const auto reflection = BoundaryExtension::reflection;
  for (const HaloShape shape : {HaloShape::star, HaloShape::full})
    {
      out() << dim << "D, " << (shape == HaloShape::star ? "star" : "full") << std::endl;
      for (unsigned int width = 1; width <= 4; ++width)
        out() << "  width " << width << ": linear "
              << below(error(*mixed.space, width, shape, reflection, {true, false}),
                       1e-13)
              << ", quadratic, same level "
              << below(error(*uniform.space, width, shape, reflection, {false, false}),
                       1e-13)
              << std::endl;
      if (dim == 2)
        {
          const Grid<dim> fine(2 * n, levels);
          out() << "  order at interfaces "
                << above(
                     std::log2(error(*mixed.space, 3, shape, reflection, {false, false}) /
                               error(*fine.space, 3, shape, reflection, {false, false})),
                     1.99)
                << std::endl;
        }
    }
  const auto parabola = BoundaryExtension::quadratic;
  const auto star     = HaloShape::star;
  out() << dim << "D, boundaries" << std::endl
        << "  parabola: linear "
        << below(error(*mixed.space, 1, star, parabola, {true, true}), 1e-13)
        << ", quadratic, same level "
        << below(error(*uniform.space, 1, star, parabola, {false, true}), 1e-13)
        << std::endl
        << "  reflection: linear "
        << below(error(*mixed.space, 3, star, reflection, {true, true}), 1e-13)
        << std::endl;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check<2>(64, 3);
  check<3>(32, 2);
}
