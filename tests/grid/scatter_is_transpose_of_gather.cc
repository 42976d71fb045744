// For any masters m and any values f on the padded patches, (G C m) . f = m . (C^T G^T
// f), where C copies masters to the other faces (synchronize) and G gathers the padded
// patches: to round-off of a sum of some 1e5 terms of order 1, 1e-13 of the sum of their
// absolute values. Rows of G sum to one away from boundaries, so that what is scattered
// from there is conserved, total and by component; and on a periodic box from everywhere.
// Dividing by the control volumes, whose sum is the volume of the box, gives a consistent
// density. All of this with refined patches in the middle (two more levels, at a corner
// that ranks share), with walls, open and slipping boundaries, for halos of all widths.

#include <mitre/grid/velocity_halo.h>

#include "grid_tests.h"

using namespace grid_tests;

template <int dim>
void
check(const std::string &periodic,
      const grid::BoundaryKind kind,
      const unsigned int width,
      const grid::HaloShape shape,
      const unsigned int levels)
{
  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, unit_box<dim>(32, levels, periodic));
  patch_grid.adapt(refine_ball(patch_grid, diagonal_point<dim>(0.45), 0.02));
  grid::StaggeredSpace<dim> space(patch_grid, all_sides<dim>(kind));
  grid::VelocityHalo<dim> halo(space, width, shape, grid::BoundaryExtension::reflection);
  halo.make_own_partitioner();
  space.finalize({});

  grid::VectorType u, total, density;
  for (grid::VectorType *vector : {&u, &total, &density})
    space.initialize_vector(*vector);
  interpolate(space, noise<dim>, u);

  // Step 1: f, which depends on the place and the patch's level only, once on all
  // patches and once on those away from the boundary.
  const auto &imported = halo.import(u);
  double gathered[2] = {0., 0.}, size = 0., scattered = 0., conserved = 0.;
  for (const bool interior : {false, true})
    {
      std::array<double, dim> sum{};
      double product = 0.;
      halo.begin_scatter();
      std::vector<double> values(halo.size(0)), f(halo.size(0));
      for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
        if (!interior || !at_boundary(patch_grid, p))
          for (unsigned int c = 0; c < dim; ++c)
            {
              std::fill(values.begin(), values.end(), 0.);
              halo.gather(imported, p, c, values.data());
              for (unsigned int i = 0; i < f.size(); ++i)
                {
                  Point<dim> x;
                  unsigned int rest = i, outside = 0;
                  for (unsigned int d = 0; d < dim; ++d)
                    {
                      const int at = static_cast<int>(rest % halo.extents(c)[d]) -
                                     static_cast<int>(width);
                      outside += at < 0 || at >= static_cast<int>(space.extent(c, d));
                      x[d] = patch_grid.patch(p).lower[d] +
                             (at + (d == c ? 0. : 0.5)) * patch_grid.patch(p).h[d];
                      rest /= halo.extents(c)[d];
                    }
                  // a star has no corners
                  f[i] = (shape == grid::HaloShape::star && outside > 1)
                           ? 0.
                           : noise(x, c + 10 * patch_grid.patch(p).level);
                  product += f[i] * values[i];
                  size += std::abs(f[i]);
                  sum[c] += f[i];
                }
              halo.scatter_add(p, c, f.data());
            }
      halo.end_scatter(density, &total);

      // Step 2: the same product from the other side, and the sums.
      double transposed = 0.;
      std::array<double, dim> masters{};
      for_each_face(space,
                    [&](const std::size_t entry,
                        const unsigned int,
                        const unsigned int c,
                        const Point<dim> &) {
                      transposed += total.local_element(entry) * u.local_element(entry);
                      masters[c] += total.local_element(entry);
                    });
      gathered[0] = std::max(
        gathered[0], std::abs(Utilities::MPI::sum(product - transposed, MPI_COMM_WORLD)));
      for (unsigned int c = 0; c < dim; ++c)
        if (interior || periodic.size() == dim)
          conserved =
            std::max(conserved,
                     std::abs(Utilities::MPI::sum(sum[c] - masters[c], MPI_COMM_WORLD)));
    }
  size = Utilities::MPI::sum(size, MPI_COMM_WORLD);

  // Step 3: total = density * volume on free masters, and copies follow from them.
  grid::VectorType copy = density;
  space.synchronize(copy);
  copy.add(-1., density);
  double volume = 0.;
  for_each_face(space,
                [&](const std::size_t entry,
                    const unsigned int,
                    const unsigned int c,
                    const Point<dim> &) {
                  if (c == 0)
                    volume += space.volumes().local_element(entry);
                  if (space.inverse_volumes().local_element(entry) != 0.)
                    scattered =
                      std::max(scattered,
                               std::abs(total.local_element(entry) -
                                        density.local_element(entry) *
                                          space.volumes().local_element(entry)));
                });
  scattered = Utilities::MPI::max(scattered, MPI_COMM_WORLD);
  out() << dim << "D, " << (periodic.empty() ? "not periodic" : "periodic " + periodic)
        << ", boundary kind " << static_cast<int>(kind) << ", width " << width
        << (shape == grid::HaloShape::star ? " star" : " full") << ": transpose "
        << below(gathered[0] / size, 1e-13) << ", conserved "
        << below(conserved / size, 1e-13) << ", density "
        << below(scattered + copy.linfty_norm() / density.linfty_norm(), 1e-12)
        << ", volumes "
        << below(std::abs(Utilities::MPI::sum(volume, MPI_COMM_WORLD) - 1.), 1e-12)
        << std::endl;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using grid::BoundaryKind;
  using grid::HaloShape;
  for (unsigned int width = 1; width <= 4; ++width)
    {
      check<2>("xy", BoundaryKind::velocity, width, HaloShape::full, 3);
      check<2>("xy", BoundaryKind::velocity, width, HaloShape::star, 3);
    }
  check<2>("", BoundaryKind::velocity, 3, HaloShape::full, 3);
  check<2>("", BoundaryKind::traction, 3, HaloShape::full, 3);
  check<2>("x", BoundaryKind::slip, 3, HaloShape::full, 3);
  check<3>("xyz", BoundaryKind::velocity, 3, HaloShape::full, 2);
  check<3>("", BoundaryKind::velocity, 2, HaloShape::full, 2);
  check<3>("y", BoundaryKind::traction, 1, HaloShape::star, 2);
}
