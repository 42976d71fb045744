// For irregular nodal forces F and velocities u, (S F, u) on the grid equals F . b with
// the velocity moments b_a = int phi_a u ds, and (F, R u) with the mass matrix and the
// projected velocity; to round-off of sums of some 1e5 terms, 1e-13 of F . b. The total
// force on the grid is the integral of F, 1e-12 of the sum of all nodes' forces. Bodies
// of all shapes straddle patches, ranks, levels of the grid, walls and periodic faces;
// two bodies at a time, the second with the other kernel.

#include "coupling_tests.h"

using namespace coupling_tests;

template <int dim>
void
check(const ElementShape shape, const std::string &periodic, const Point<dim> &lower)
{
  Grid<dim> grid(16, 2, periodic, half_refined<dim>);
  const Point<dim> other = grid_tests::diagonal_point<dim>(0.3);
  BodyInBox<dim> a(shape, 3, lower, 0.3), b(ElementShape::simplex, 2, other, 0.3);

  coupling::FECoupling<dim> coupling(grid.patches);
  coupling::CouplingParameters parameters;
  coupling.add_part(*a.body, parameters);
  parameters.kernel = "IB_3";
  coupling.add_part(*b.body, parameters);
  for (BodyInBox<dim> *body : {&a, &b})
    body->body->distribute([&](const auto &points) { return coupling.owners_of(points); },
                           body->X);
  coupling.reinit(*grid.halo);
  coupling.update_points({&a.X, &b.X});

  VectorType u = grid.make_vector(), f = grid.make_vector(), total = grid.make_vector();
  grid_tests::interpolate(*grid.space, grid_tests::noise<dim>, u);
  grid.space->zero_fixed_faces(u);
  grid.space->synchronize(u);

  // Step 1: spread.
  const VectorType Fa = make_nodal_field(*a.body), Fb = make_nodal_field(*b.body);
  coupling.spread({&Fa, &Fb}, f, &total);
  const double on_grid = total * u;

  dealii::Tensor<1, dim> sum;
  double density = 0;
  grid_tests::for_each_face(*grid.space,
                            [&](const std::size_t entry,
                                const unsigned int,
                                const unsigned int c,
                                const Point<dim> &) {
                              sum[c] += total.local_element(entry);
                              density += f.local_element(entry) * u.local_element(entry) *
                                         grid.space->volumes().local_element(entry);
                            });
  sum     = dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  density = dealii::Utilities::MPI::sum(density, MPI_COMM_WORLD);

  // Step 2: interpolate.
  VectorType Ba = Fa, Bb = Fb, Ua = Fa, Ub = Fb;
  coupling.compute_velocity_moments(u, {&Ba, &Bb});
  const double moments = Fa * Ba + Fb * Bb;
  coupling.interpolate(u, {&Ua, &Ub});
  a.body->mass_matrix().vmult(Ba, Ua);
  b.body->mass_matrix().vmult(Bb, Ub);
  const double projected = Fa * Ba + Fb * Bb;

  const dealii::Tensor<1, dim> force =
    a.body->compute_total(Fa) + b.body->compute_total(Fb);
  out() << structure_tests::shape_name(dim, shape)
        << (periodic.empty() ? "" : ", periodic") << ": moments "
        << below(std::abs(on_grid - moments) / std::abs(moments), 1e-13) << ", densities "
        << below(std::abs(density - moments) / std::abs(moments), 1e-13)
        << ", velocities "
        << below(std::abs(on_grid - projected) / std::abs(moments), 1e-12)
        << ", total force " << below((sum - force).norm() / force.norm(), 1e-12)
        << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const ElementShape shape : {ElementShape::simplex, ElementShape::hypercube})
    {
      check<2>(shape, "", Point<2>(0.35, 0.4));
      check<2>(shape, "xy", Point<2>(0.85, -0.1));
      check<3>(shape, "", Point<3>(0.35, 0.4, 0.3));
      check<3>(shape, "xyz", Point<3>(0.85, -0.1, 0.2));
    }
}
