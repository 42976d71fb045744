// Rows of weights that patches share because the leaves around them are the same
// (grid::RowCache) are those that each patch would have made for itself, to the last
// bit: values gathered by halos of all kinds, faces on interfaces between levels, and
// viscous terms with their fluxes matched do not differ at all, on grids of three levels
// without pattern, with walls, open sides and periodic ones, also where the rows were
// made for another grid, before a change. That rows are shared is seen by their number:
// there are fewer different surroundings than sides, edges and corners that have some.

#include <mitre/fluid/stokes_operators.h>
#include <mitre/grid/velocity_halo.h>

#include "grid_tests.h"

using namespace grid_tests;

template <int dim>
struct Rows
{
  Rows(const grid::PatchGrid<dim> &patch_grid,
       const grid::BoundaryKind kind,
       const std::shared_ptr<grid::RowCache<dim>> &cache)
    : space(patch_grid, all_sides<dim>(kind), cache)
    , operators(space)
  {
    using grid::BoundaryExtension;
    using grid::HaloShape;
    const std::vector<std::tuple<unsigned int, HaloShape, BoundaryExtension>> kinds = {
      {1, HaloShape::star, BoundaryExtension::quadratic},
      {3, HaloShape::star, BoundaryExtension::reflection},
      {2, HaloShape::full, BoundaryExtension::reflection},
      {3, HaloShape::full, BoundaryExtension::reflection}};
    for (const auto &[width, shape, extension] : kinds)
      {
        if (2 * width > patch_grid.n_cells_per_side())
          continue;
        halos.push_back(
          std::make_unique<grid::VelocityHalo<dim>>(space, width, shape, extension));
        halos.back()->make_own_partitioner();
        halos.back()->set_boundary_values(prescribed);
      }
    operators.set_boundary_values(prescribed);
  }

  static double prescribed(const grid::BoundaryTerm<dim> &term)
  {
    return noise(term.x, term.component);
  }

  /// All that the rows make of a velocity without pattern.
  std::vector<double> results()
  {
    grid::VectorType u, laplace;
    operators.initialize_velocity(u);
    operators.initialize_velocity(laplace);
    interpolate(space, noise<dim>, u);
    std::vector<double> all(u.begin(), u.begin() + u.locally_owned_size());
    for (const auto &halo : halos)
      {
        const auto &imported = halo->import(u);
        for (unsigned int p = 0; p < space.grid().n_owned_patches(); ++p)
          for (unsigned int c = 0; c < dim; ++c)
            {
              std::vector<double> padded(halo->size(c), 0.);
              halo->gather(imported, p, c, padded.data(), true);
              all.insert(all.end(), padded.begin(), padded.end());
            }
      }
    operators.apply_helmholtz(laplace, u, 0.3, 0.7, true);
    all.insert(
      all.end(), laplace.begin(), laplace.begin() + laplace.locally_owned_size());
    return all;
  }

  grid::StaggeredSpace<dim> space;
  fluid::StokesOperators<dim> operators;
  std::vector<std::unique_ptr<grid::VelocityHalo<dim>>> halos;
};

template <int dim>
void
check(const std::string &periodic,
      const grid::BoundaryKind kind,
      const unsigned int cells_per_side)
{
  grid::PatchGridParameters<dim> box = unit_box<dim>(dim == 2 ? 64 : 16, 3, periodic);
  box.cells_per_side                 = cells_per_side;
  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, box);
  const auto cache = std::make_shared<grid::RowCache<dim>>();
  out() << dim << "D, " << (periodic.empty() ? "not periodic" : "periodic " + periodic)
        << ", boundary kind " << static_cast<int>(kind) << ", patches of "
        << cells_per_side << " cells:" << std::endl;
  for (unsigned int change = 0; change < 3; ++change)
    {
      // levels that the place decides without pattern
      patch_grid.adapt([&](const BoundingBox<dim> &leaf) {
        const double value = noise(leaf.center(), 7 + change);
        return static_cast<int>(box.minimum_level) +
               (value > 0.93 ? 2 : (value > 0.6 ? 1 : 0));
      });
      Rows<dim> shared(patch_grid, kind, cache);
      const auto own_cache = std::make_shared<grid::RowCache<dim>>();
      own_cache->may_share = false;
      Rows<dim> own(patch_grid, kind, own_cache);

      const std::vector<double> a = shared.results(), b = own.results();
      double difference = (a.size() == b.size() ? 0. : 1e300);
      for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        difference = std::max(difference, std::abs(a[i] - b[i]));
      difference = Utilities::MPI::max(difference, MPI_COMM_WORLD);

      out() << "  difference " << difference << ", levels meet: "
            << (patch_grid.has_coarse_fine_interfaces() ? "yes" : "no, FAILED")
            << std::endl;
    }
}

void
count_along_interfaces(const unsigned int n_cells)
{
  grid::PatchGrid<2> patch_grid(MPI_COMM_WORLD, unit_box<2>(n_cells, 2, "xy"));
  patch_grid.adapt([&](const BoundingBox<2> &leaf) {
    return static_cast<int>(leaf.center()[0] < 0.5 ? patch_grid.maximum_level()
                                                   : patch_grid.minimum_level());
  });
  const auto cache = std::make_shared<grid::RowCache<2>>();
  const grid::StaggeredSpace<2> space(
    patch_grid, all_sides<2>(grid::BoundaryKind::velocity), cache);
  unsigned int n_irregular = 0;
  for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
    n_irregular += (cache->is_regular(p) ? 0 : 1);
  out() << "Straight interfaces, " << Utilities::MPI::sum(n_irregular, MPI_COMM_WORLD)
        << " patches beside them: "
        << Utilities::MPI::max(static_cast<unsigned int>(cache->size()), MPI_COMM_WORLD)
        << " different surroundings" << std::endl;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  count_along_interfaces(64);
  count_along_interfaces(128);
  check<2>("xy", grid::BoundaryKind::velocity, 8);
  check<2>("", grid::BoundaryKind::velocity, 8);
  check<2>("y", grid::BoundaryKind::traction, 16);
  check<2>("", grid::BoundaryKind::slip, 4);
  check<3>("xyz", grid::BoundaryKind::velocity, 8);
  check<3>("x", grid::BoundaryKind::velocity, 8);
}
