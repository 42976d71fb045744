// For irregular nodal forces F and velocities u, (S F, u) on the grid equals F . b with
// the velocity moments b_a = int phi_a u ds, and (F, R u) with the mass matrix and the
// projected velocity; to round-off, 1e-13 of the sum of |F_a b_a|. Bodies of
// all shapes straddle patches, ranks, levels of the grid, walls, open and symmetric sides
// and periodic faces; two bodies at a time, the second with IB_3, and all kernels for one
// of the bodies.
//
// The total force on the grid is the integral of F, and, away from boundaries, the total
// torque that of X x F (X and F are linear in simplices, multilinear in hypercubes):
// 1e-11 of the sum over all nodes. Quadratic elements, which are bent in the box, keep
// both as well, whether they are bent undeformed or not. Also after the bodies have moved
// by half a patch, with the ranks that have the points, but not the nodes, of before.
// Where nodes are the points, the force is the sum of F times the row sums of the mass
// matrix.

#include "coupling_tests.h"

using namespace coupling_tests;

template <int dim>
double
sum_of(const double value)
{
  return dealii::Utilities::MPI::sum(value, MPI_COMM_WORLD);
}

/// Force and torque (in 2D its one component, in 3D about the last axis) of values at
/// places.
struct Totals
{
  double force[3] = {}, torque = 0, magnitude = 0;

  template <int dim>
  void add(const Point<dim> &x, const unsigned int c, const double value)
  {
    force[c] += value;
    if (c < 2)
      torque += c == 0 ? -x[1] * value : x[0] * value;
    magnitude += std::abs(value);
  }

  void sum_over_ranks()
  {
    for (double *value : {&force[0], &force[1], &force[2], &torque, &magnitude})
      *value = dealii::Utilities::MPI::sum(*value, MPI_COMM_WORLD);
  }
};

struct Case
{
  std::string name, periodic;
  grid::BoundaryKind kind = grid::BoundaryKind::velocity;
  bool at_boundary        = false;
};

template <int dim>
void
check(const Grid<dim> &grid,
      const Case &test,
      const ElementShape shape,
      const Point<dim> &lower,
      const std::string &kernel,
      const coupling::PointChoice points = coupling::PointChoice::quadrature,
      const unsigned int degree          = 1,
      const bool bent                    = false)
{
  const Point<dim> other = grid_tests::diagonal_point<dim>(0.3);
  BodyInBox<dim> a(shape, degree == 1 ? 3 : 2, lower, 0.3, 1e-14, degree, bent),
    b(ElementShape::simplex, 2, other, 0.3);

  coupling::FECoupling<dim> coupling(grid.patches);
  coupling::CouplingParameters parameters;
  parameters.kernel = kernel;
  parameters.points = points;
  coupling.add_part(*a.body, parameters);
  parameters.kernel = "IB_3";
  parameters.points = coupling::PointChoice::quadrature;
  coupling.add_part(*b.body, parameters);
  for (BodyInBox<dim> *body : {&a, &b})
    body->body->distribute([&](const auto &x) { return coupling.owners_of(x); }, body->X);
  coupling.reinit(*grid.halo);

  VectorType u = grid.make_vector(), f = grid.make_vector(), total = grid.make_vector();
  grid_tests::interpolate(*grid.space, grid_tests::noise<dim>, u);
  grid.space->zero_fixed_faces(u);
  grid.space->synchronize(u);
  const VectorType Fa = make_nodal_field(*a.body), Fb = make_nodal_field(*b.body);

  double adjoint = 0, densities = 0, projections = 0, forces = 0, torques = 0;
  for (unsigned int move = 0; move < 2; ++move)
    {
      if (move == 1)
        for (VectorType *X : {&a.X, &b.X})
          for (unsigned int i = 0; i < X->locally_owned_size(); i += dim)
            X->local_element(i) += test.at_boundary ? 0.04 : -0.12;
      coupling.update_points({&a.X, &b.X});

      // Step 1: spread.
      coupling.spread({&Fa, &Fb}, f, &total);
      const double on_grid = total * u;
      double density       = 0;
      Totals spread, expected;
      grid_tests::for_each_face(*grid.space,
                                [&](const std::size_t entry,
                                    const unsigned int,
                                    const unsigned int c,
                                    const Point<dim> &x) {
                                  spread.add(x, c, total.local_element(entry));
                                  density += f.local_element(entry) *
                                             u.local_element(entry) *
                                             grid.space->volumes().local_element(entry);
                                });
      spread.sum_over_ranks();
      density = sum_of<dim>(density);

      // Step 2: forces of the bodies.
      for (const auto &[body, F] : {std::make_pair(&a, &Fa), std::make_pair(&b, &Fb)})
        {
          VectorType G = *F;
          body->body->mass_matrix().vmult(G, *F);
          if (body == &a && points == coupling::PointChoice::nodes)
            for (unsigned int i = 0; i < G.locally_owned_size(); ++i)
              G.local_element(i) =
                F->local_element(i) * body->body->mass_matrix().lumped()[i / dim];
          for (unsigned int i = 0; i < G.locally_owned_size(); ++i)
            {
              Point<dim> x;
              for (unsigned int d = 0; d < dim; ++d)
                x[d] = body->X.local_element(i / dim * dim + d);
              expected.add(x, i % dim, G.local_element(i));
            }
        }
      expected.sum_over_ranks();

      // Step 3: interpolate.
      VectorType Ba = Fa, Bb = Fb, Ua = Fa, Ub = Fb;
      coupling.compute_velocity_moments(u, {&Ba, &Bb});
      const VectorType moments_a = Ba, moments_b = Bb;
      const double moments = Fa * Ba + Fb * Bb;
      coupling.interpolate(u, {&Ua, &Ub});
      a.body->mass_matrix().vmult(Ba, Ua);
      if (points == coupling::PointChoice::nodes)
        for (unsigned int i = 0; i < Ba.locally_owned_size(); ++i)
          Ba.local_element(i) =
            Ua.local_element(i) * a.body->mass_matrix().lumped()[i / dim];
      b.body->mass_matrix().vmult(Bb, Ub);
      const double projected = Fa * Ba + Fb * Bb;

      double scale = 0;
      for (const auto &[F, B] :
           {std::make_pair(&Fa, &moments_a), std::make_pair(&Fb, &moments_b)})
        for (unsigned int i = 0; i < F->locally_owned_size(); ++i)
          scale += std::abs(F->local_element(i) * B->local_element(i));
      scale       = sum_of<dim>(scale);
      adjoint     = std::max(adjoint, std::abs(on_grid - moments) / scale);
      densities   = std::max(densities, std::abs(density - moments) / scale);
      projections = std::max(projections, std::abs(on_grid - projected) / scale);
      for (unsigned int c = 0; c < dim; ++c)
        forces = std::max(
          forces, std::abs(spread.force[c] - expected.force[c]) / expected.magnitude);
      torques =
        std::max(torques, std::abs(spread.torque - expected.torque) / expected.magnitude);
    }

  out() << structure_tests::element_name(dim, shape, degree) << (bent ? ", bent, " : ", ")
        << kernel << (points == coupling::PointChoice::nodes ? ", nodes" : "") << ", "
        << test.name << ": moments " << below(adjoint, 1e-13) << ", densities "
        << below(densities, 1e-13) << ", velocities " << below(projections, 1e-12);
  if (!test.at_boundary)
    {
      out() << ", force " << below(forces, 1e-11);
      if (test.periodic.empty())
        out() << ", torque " << below(torques, 1e-11);
    }
  out() << std::endl;
}

template <int dim>
void
check_all()
{
  const auto at = [](const double x, const double y) {
    Point<dim> point;
    point[0] = x;
    point[1] = y;
    if (dim == 3)
      point[dim - 1] = 0.3;
    return point;
  };
  {
    const Case test{"inside", ""};
    const Grid<dim> grid(16, 2, "", half_refined<dim>);
    for (const ElementShape shape : {ElementShape::simplex, ElementShape::hypercube})
      {
        check<dim>(grid, test, shape, at(0.35, 0.4), "IB_4");
        check<dim>(
          grid, test, shape, at(0.35, 0.4), "IB_4", coupling::PointChoice::nodes);
      }
    for (const std::string &kernel : coupling::kernel_names())
      check<dim>(grid, test, ElementShape::hypercube, at(0.35, 0.4), kernel);
    for (const ElementShape shape : {ElementShape::simplex, ElementShape::hypercube})
      for (const bool bent : {false, true})
        check<dim>(grid,
                   test,
                   shape,
                   at(0.35, 0.4),
                   "IB_4",
                   coupling::PointChoice::quadrature,
                   2,
                   bent);
    check<dim>(grid,
               test,
               ElementShape::hypercube,
               at(0.35, 0.4),
               "IB_4",
               coupling::PointChoice::nodes,
               2);
  }
  {
    const Case test{"periodic", dim == 2 ? "xy" : "xyz"};
    const Grid<dim> grid(16, 2, test.periodic, half_refined<dim>);
    for (const std::string kernel : {"IB_4", "IB_6", "CBS43"})
      for (const ElementShape shape : {ElementShape::simplex, ElementShape::hypercube})
        for (const unsigned int degree : {1, 2})
          if (degree == 1 || kernel == "IB_6")
            check<dim>(grid,
                       test,
                       shape,
                       at(0.85, -0.1),
                       kernel,
                       coupling::PointChoice::quadrature,
                       degree);
  }
  for (const auto &[name, kind] : {std::make_pair("walls", grid::BoundaryKind::velocity),
                                   std::make_pair("open", grid::BoundaryKind::traction),
                                   std::make_pair("slip", grid::BoundaryKind::slip)})
    {
      const Case test{name, "", kind, true};
      const Grid<dim> grid(16, 2, "", half_refined<dim>, 3, kind);
      for (const std::string kernel : {"IB_4", "IB_6", "CBS32"})
        check<dim>(grid, test, ElementShape::simplex, at(0.5, 0.01), kernel);
    }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_all<2>();
  check_all<3>();
}
