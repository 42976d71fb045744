// The compressed block of Reese, Wriggers and Reddy (2000), Computers and Structures 75,
// as Vadala-Roth et al. (2020), CMAME 365, use it: 20 x 10 cm, plane strain, neo-Hookean
// with G = 80.194 dyn/cm^2, a dead pressure of 200 dyn/cm^2 on the middle half of the
// top, whose nodes keep their x, those of the bottom their y.
//
// Here without fluid, with nu = 0.499 (compression then adds up to 0.5 per cent of
// volume), at rest after kinetic damping. With the volumetric energy of a projection of J
// the middle of the top sinks by 3.95 cm, to 2 per cent, with each kind of element that
// can have one. Linear quadrilaterals without the projection, and linear triangles, lock:
// they miss more than 1 cm of it.

#include "structure_tests.h"

using namespace structure_tests;

/// How far the middle of the top sinks.
double
compress(const ElementShape shape,
         const unsigned int degree,
         const unsigned int n,
         const bool project)
{
  Mesh<2> linear = make_box<2>(shape, n, 0.);
  for (auto &node : linear.nodes)
    node = dealii::Point<2>(20 * node[0], 10 * node[1]);
  const Mesh<2> mesh = degree == 1 ? linear : make_quadratic(linear);

  constexpr double nu = 0.499, G = 80.194;
  BodyParameters<2> parameters;
  parameters.name = "block";
  parameters.materials.push_back(
    {"rubber",
     {1, 2},
     make_law<2>("neo-Hookean",
                 "set C1 = " + std::to_string(G / 2) + "\nset Isochoric split = true\n" +
                   "set Bulk modulus = " + std::to_string(bulk_modulus_of(G, nu))),
     mitre::base::TimeExpression("1", "factor")});
  parameters.materials[0].project_volume = project;
  parameters.loads.push_back(
    {"press",
     make_plugin<Load<2>>(loads<2>(),
                          "pressure",
                          "set Pressure = 200 * min(1, t)\nset Surface = reference\n"
                          "set Region = y > 9.99 && x > 5 && x < 15\n")});
  const FiniteElementBody<2> body(parameters, mesh, MPI_COMM_SELF);

  // Explicit motion with equal shares of the elements' volumes as masses, and a step from
  // the highest frequency.
  VectorType X, V, U, G_elastic, G_load;
  for (VectorType *v : {&X, &V, &U, &G_elastic, &G_load})
    body.initialize_vector(*v);
  body.set_to_reference_positions(X);
  std::vector<double> mass(mesh.nodes.size());
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    for (unsigned int a = 0; a < mesh.nodes_per_element; ++a)
      mass[mesh.elements[e * mesh.nodes_per_element + a]] +=
        200. / mesh.n_elements() / mesh.nodes_per_element;
  const auto accelerate = [&](VectorType &A, const VectorType &at, const double t) {
    body.compute_elastic_force(at, t, A);
    body.compute_external_forces(at, U, t, G_load);
    A += G_load;
    for (unsigned int i = 0; i < mesh.nodes.size(); ++i)
      {
        A[2 * i] *= mesh.nodes[i][1] > 9.99 ? 0 : 1 / mass[i];
        A[2 * i + 1] *= mesh.nodes[i][1] < 0.01 ? 0 : 1 / mass[i];
      }
  };
  VectorType Y = X, A;
  body.initialize_vector(A);
  for (unsigned int i = 0; i < V.size(); ++i)
    V[i] = std::sin(17. * i * i);
  double square = 0;
  for (unsigned int iteration = 0; iteration < 60; ++iteration)
    {
      V *= 1 / V.l2_norm();
      Y = X;
      Y.add(1e-6, V);
      accelerate(A, Y, 0.);
      square = A.l2_norm() / 1e-6;
      V      = A;
    }
  const double dt = 0.5 / std::sqrt(square);

  // The load grows in two thousand steps; the body stops whenever its energy of motion
  // has passed a maximum.
  V                    = 0;
  double kinetic       = 0;
  unsigned int n_steps = 0;
  for (; n_steps < 100000; ++n_steps)
    {
      accelerate(A, X, n_steps / 2000.);
      if (n_steps > 2500 && n_steps % 100 == 0)
        {
          double residual = 0;
          for (unsigned int i = 0; i < A.size(); ++i)
            residual = std::max(residual, std::abs(A[i] * mass[i / 2]));
          if (residual < 1e-3)
            break;
        }
      V.add(dt, A);
      double now = 0;
      for (unsigned int i = 0; i < V.size(); ++i)
        now += mass[i / 2] * V[i] * V[i];
      if (now < kinetic)
        {
          V   = 0;
          now = 0;
        }
      kinetic = now;
      X.add(dt, V);
    }

  for (unsigned int i = 0; i < mesh.nodes.size(); ++i)
    if (mesh.nodes[i].distance(dealii::Point<2>(10, 10)) < 1e-6)
      return mesh.nodes[i][1] - X[2 * i + 1];
  return 0;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const auto quadrilateral = ElementShape::hypercube, triangle = ElementShape::simplex;
  const auto deviation = [](const double displacement) {
    return below(std::abs(displacement / 3.95 - 1), 0.02);
  };
  std::cout << "quadrilaterals: " << deviation(compress(quadrilateral, 1, 16, true))
            << "\nquadratic triangles: " << deviation(compress(triangle, 2, 8, true))
            << "\nquadratic quadrilaterals: "
            << deviation(compress(quadrilateral, 2, 8, true)) << std::endl;
  for (const auto shape : {quadrilateral, triangle})
    std::cout << element_name(2, shape, 1) << " without projection: "
              << (compress(shape, 1, 16, false) < 2.95 ? "lock" : "do not lock")
              << std::endl;
}
