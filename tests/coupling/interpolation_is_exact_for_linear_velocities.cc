// A linear velocity is interpolated to the quadrature points exactly (the kernels'
// weights sum to 1 with vanishing first moment, ghost values are exact for linear fields
// away from the boundary), and as the fields of an element contain its positions, the
// projection is exact for the velocity u = a + A x at the nodes: an error of round-off,
// 1e-12. The body straddles patches, ranks and levels. The number of points is that of
// the rules, k = ceil(2 h_max/h) points an edge. Elements of first and second order,
// these also with a bent reference configuration.
//
// The same next to a wall that moves with the velocity u, in the last direction: ghost
// values beyond it are linear extrapolations through the wall's velocity. (Those beyond
// two walls, at edges and corners of the box, are not exact.)

#include "coupling_tests.h"

using namespace coupling_tests;

template <int dim>
void
check(const Grid<dim> &grid,
      const ElementShape shape,
      const std::string &kernel,
      const bool at_walls,
      const unsigned int degree = 1,
      const bool bent           = false)
{
  Point<dim> lower = grid_tests::diagonal_point<dim>(0.33);
  if (at_walls)
    lower[dim - 1] = bent ? 0.06 : 0.02;
  BodyInBox<dim> a(shape, degree == 1 ? 3 : 2, lower, 0.3, 1e-14, degree, bent);

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
  if (at_walls)
    grid.halo->set_boundary_values([&](const grid::BoundaryTerm<dim> &term) {
      return velocity(term.x, term.component);
    });
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
  out() << structure_tests::element_name(dim, shape, degree) << (bent ? ", bent, " : ", ")
        << kernel << (at_walls ? ", at a moving wall: " : ": ") << below(error, 1e-12)
        << ", points " << dealii::Utilities::MPI::sum(coupling.n_points(), MPI_COMM_WORLD)
        << std::endl;
}

template <int dim>
void
check_all()
{
  for (const bool at_walls : {false, true})
    {
      // The grid's halo keeps the walls' velocity once it has been told.
      const Grid<dim> grid(16, 2, "", half_refined<dim>);
      for (const ElementShape shape : {ElementShape::simplex, ElementShape::hypercube})
        for (const std::string &kernel : coupling::kernel_names())
          if (shape == ElementShape::hypercube || kernel == "IB_4")
            check<dim>(grid, shape, kernel, at_walls);
      for (const ElementShape shape : {ElementShape::simplex, ElementShape::hypercube})
        for (const bool bent : {false, true})
          check<dim>(grid, shape, "IB_4", at_walls, 2, bent);
    }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_all<2>();
  check_all<3>();
}
