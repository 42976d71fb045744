// On composite grids W grad = -(div)^T V on all velocities that vanish on faces with
// given velocity: the pressure does no work on a divergence-free flow, also across levels
// and at open boundaries. Both sides are sums of about 1e5 products of numbers without
// pattern; they agree to 1e-13 of the sum of the absolute values.

#include <mitre/fluid/stokes_operators.h>

#include "../grid/grid_tests.h"

using namespace grid_tests;

template <int dim>
void
check(const std::string &name,
      const std::string &periodic,
      const grid::BoundaryKind x_sides,
      const grid::BoundaryKind other_sides,
      const unsigned int n,
      const unsigned int levels)
{
  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, unit_box<dim>(n, levels, periodic));
  Point<dim> center = diagonal_point<dim>(0.45);
  center[0]         = 0.95; // at an x side
  patch_grid.adapt(refine_ball(patch_grid, center, 0.1));
  grid::StaggeredSpace<dim> space(patch_grid, [&](const unsigned int side, const auto &) {
    return grid::BoundaryInfo{side < 2 ? x_sides : other_sides, 0};
  });
  fluid::StokesOperators<dim> operators(space);

  grid::VectorType u, gradient, p, divergence;
  operators.initialize_velocity(u);
  operators.initialize_velocity(gradient);
  operators.initialize_pressure(p);
  operators.initialize_pressure(divergence);
  interpolate(space, noise<dim>, u);
  space.zero_fixed_faces(u);
  space.synchronize(u);
  for_each_cell(
    patch_grid,
    [&](const std::size_t entry, const unsigned int, const Point<dim> &x, const double) {
      p.local_element(entry) = noise(x, dim);
    });

  operators.apply_gradient(gradient, p, false);
  operators.apply_divergence(divergence, u);
  double power = 0., work = 0., size = 0.;
  for_each_face(space,
                [&](const std::size_t entry,
                    const unsigned int,
                    const unsigned int,
                    const Point<dim> &) {
                  power += space.volumes().local_element(entry) *
                           gradient.local_element(entry) * u.local_element(entry);
                });
  for_each_cell(patch_grid,
                [&](const std::size_t entry,
                    const unsigned int,
                    const Point<dim> &,
                    const double volume) {
                  const double product =
                    volume * p.local_element(entry) * divergence.local_element(entry);
                  work -= product;
                  size += std::abs(product);
                });
  power = Utilities::MPI::sum(power, MPI_COMM_WORLD);
  work  = Utilities::MPI::sum(work, MPI_COMM_WORLD);
  size  = Utilities::MPI::sum(size, MPI_COMM_WORLD);
  // nothing is shown by two zeros
  out() << dim << "D, " << levels << " levels, " << name << ": "
        << below(std::abs(power - work) / size, 1e-13) << ", work "
        << above(std::abs(work) / size, 1e-6) << std::endl;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  using grid::BoundaryKind;
  for (const unsigned int levels : {1, 3})
    {
      check<2>(
        "periodic", "xy", BoundaryKind::velocity, BoundaryKind::velocity, 32, levels);
      check<2>("walls", "", BoundaryKind::velocity, BoundaryKind::velocity, 32, levels);
      check<2>("open", "", BoundaryKind::traction, BoundaryKind::velocity, 32, levels);
      check<2>("slip", "", BoundaryKind::traction, BoundaryKind::slip, 32, levels);
    }
  for (const unsigned int levels : {1, 2})
    {
      check<3>(
        "periodic", "xyz", BoundaryKind::velocity, BoundaryKind::velocity, 32, levels);
      check<3>("walls", "z", BoundaryKind::velocity, BoundaryKind::velocity, 32, levels);
      check<3>("open", "", BoundaryKind::traction, BoundaryKind::velocity, 32, levels);
    }
}
