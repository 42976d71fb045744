// A linear velocity is interpolated to the quadrature points exactly (the kernels'
// weights sum to 1 with vanishing first moment, ghost values are exact for linear fields
// away from the boundary), and as node positions are linear in each element, the
// projection is exact for the velocity u = a + A x at the nodes: an error of round-off,
// 1e-12. The body straddles patches, ranks and levels. The number of points is that of
// the rules, k = ceil(2 h_max/h) points an edge.

#include "coupling_tests.h"

using namespace coupling_tests;

template <int dim>
void
check(const ElementShape shape, const std::string &kernel)
{
  Grid<dim> grid(16, 2, "", half_refined<dim>);
  BodyInBox<dim> a(shape, 3, grid_tests::diagonal_point<dim>(0.33), 0.3);

  coupling::FECoupling<dim> coupling(grid.patches);
  coupling::CouplingParameters parameters;
  parameters.kernel = kernel;
  coupling.add_part(*a.body, parameters);
  a.body->distribute([&](const auto &points) { return coupling.owners_of(points); }, a.X);
  coupling.reinit(*grid.halo);
  coupling.update_points({&a.X});

  const auto velocity = [](const Point<dim> &x, const unsigned int c) {
    return 1. + c + (2. + c) * x[0] - 3. * x[1] + (c == 0 ? 1. : 0.5) * x[dim - 1];
  };
  VectorType u = grid.make_vector(), U = a.X;
  grid_tests::interpolate(*grid.space, velocity, u);
  U = 0;
  coupling.interpolate(u, {&U});

  double error = 0;
  for (unsigned int i = 0; i < U.locally_owned_size(); i += dim)
    {
      Point<dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = a.X.local_element(i + d);
      for (unsigned int c = 0; c < dim; ++c)
        error = std::max(error, std::abs(U.local_element(i + c) - velocity(x, c)));
    }
  error = dealii::Utilities::MPI::max(error, MPI_COMM_WORLD);
  out() << structure_tests::shape_name(dim, shape) << ", " << kernel << ": "
        << below(error, 1e-12) << ", points "
        << dealii::Utilities::MPI::sum(coupling.n_points(), MPI_COMM_WORLD) << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const ElementShape shape : {ElementShape::simplex, ElementShape::hypercube})
    for (const std::string &kernel : coupling::kernel_names())
      {
        check<2>(shape, kernel);
        check<3>(shape, kernel);
      }
}
