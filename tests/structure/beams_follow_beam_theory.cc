// Beams of three nodes with kappa = EI/ds^3 against the theory of Euler and Bernoulli:
//
// * the force on a node of a rod bent to a sine, over ds, is -EI X'''' (second order);
// * the end of a cantilever under a load P moves in the direction of the load, by
//   P L^3/(3 EI) (second order). Two nodes are held, the clamp is midway between them:
//   the sum of the discrete curvatures then gives P L^3/(3 EI) (1 - 1/(4 (n - 1/2)^2))
//   exactly (1e-9), with n segments, L = (n - 1/2) ds;
// * a rod that is curved at rest has no force in that shape.
//
// The static solution is found by Newton's method with a Jacobian by differences, which
// is exact as the force is linear.

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <mitre/structure/fibre_body.h>

#include "structure_tests.h"

using namespace structure_tests;

namespace
{
  constexpr double EI = 3.;


  /// Nodes at given places along x, beams at all but the first and the last.
  template <int dim>
  FibreNetwork<dim> make_rod(const unsigned int n, const double start, const double ds)
  {
    FibreNetwork<dim> network;
    network.source = "rod";
    for (unsigned int i = 0; i <= n; ++i)
      {
        dealii::Point<dim> x;
        x[0] = start + i * ds;
        network.nodes.push_back(x);
      }
    for (unsigned int i = 1; i < n; ++i)
      {
        Beam<dim> beam;
        beam.nodes     = {{i - 1, i, i + 1}};
        beam.stiffness = EI / (ds * ds * ds);
        network.beams.push_back(beam);
      }
    return network;
  }


  template <int dim>
  FibreBody<dim> make_body(const FibreNetwork<dim> &network)
  {
    FibreParameters<dim> parameters;
    parameters.name = "rod";
    return FibreBody<dim>(parameters, network, MPI_COMM_SELF);
  }
} // namespace


/// The largest error of the force density in the middle half of a rod that is a sine.
double
error_of_sine(const unsigned int n)
{
  const double length = 2., k = 5.;
  const double ds         = length / n;
  const FibreBody<2> body = make_body(make_rod<2>(n, 0., ds));
  VectorType X, G;
  body.initialize_vector(X);
  body.initialize_vector(G);
  body.set_to_reference_positions(X);
  for (unsigned int i = 0; i <= n; ++i)
    X.local_element(2 * i + 1) = 0.1 * std::sin(k * i * ds);
  body.compute_elastic_force(X, 0., G);
  double worst = 0;
  for (unsigned int i = n / 4; i <= 3 * n / 4; ++i)
    {
      const double exact = -EI * 0.1 * std::pow(k, 4) * std::sin(k * i * ds);
      worst = std::max(worst, std::abs(G.local_element(2 * i + 1) / ds - exact));
    }
  return worst / (EI * 0.1 * std::pow(k, 4));
}


/// The deflection of the end of a cantilever over that of theory.
double
cantilever(const unsigned int n)
{
  const double length = 1.5, load = 0.02;
  const double ds         = length / (n - 0.5);
  const FibreBody<2> body = make_body(make_rod<2>(n, -0.5 * ds, ds));
  VectorType X, G, before;
  for (VectorType *v : {&X, &G, &before})
    body.initialize_vector(*v);
  body.set_to_reference_positions(X);

  const unsigned int first = 4, size = X.locally_owned_size() - first;
  dealii::FullMatrix<double> stiffness(size);
  dealii::Vector<double> rhs(size), change(size);
  body.compute_elastic_force(X, 0., before);
  for (unsigned int j = 0; j < size; ++j)
    {
      VectorType moved = X;
      moved.local_element(first + j) += ds;
      body.compute_elastic_force(moved, 0., G);
      for (unsigned int i = 0; i < size; ++i)
        stiffness(i, j) =
          -(G.local_element(first + i) - before.local_element(first + i)) / ds;
    }
  for (unsigned int i = 0; i < size; ++i)
    rhs(i) = before.local_element(first + i);
  rhs(size - 1) += load;
  stiffness.gauss_jordan();
  stiffness.vmult(change, rhs);
  return change(size - 1) / (load * std::pow(length, 3) / (3 * EI));
}


int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  double before = 0;
  for (const unsigned int n : {32u, 64u, 128u})
    {
      const double error = error_of_sine(n);
      std::cout << "sine, " << n
                << " segments: " << below(error, 0.17 * std::pow(5. * 2. / n, 2));
      if (before > 0)
        std::cout << ", order "
                  << (std::abs(std::log2(before / error) - 2) < 0.1 ? "2" : "FAILED");
      std::cout << std::endl;
      before = error;
    }

  for (const unsigned int n : {8u, 16u, 32u})
    {
      const double ratio = cantilever(n), discrete = 1 - 1 / (4 * std::pow(n - 0.5, 2));
      std::cout << "cantilever, " << n << " segments: deflection over theory " << ratio
                << ", discrete theory " << below(std::abs(ratio - discrete), 1e-9)
                << std::endl;
    }

  // An arc, at rest in its own shape, with a force towards it from a straight one.
  FibreNetwork<2> arc = make_rod<2>(16, 0., 0.1);
  for (unsigned int i = 0; i <= 16; ++i)
    arc.nodes[i] = dealii::Point<2>(std::sin(0.1 * i), -std::cos(0.1 * i));
  for (Beam<2> &beam : arc.beams)
    beam.curvature = arc.nodes[beam.nodes[0]] - arc.nodes[beam.nodes[1]] +
                     (arc.nodes[beam.nodes[2]] - arc.nodes[beam.nodes[1]]);
  const FibreBody<2> body = make_body(arc);
  VectorType X, G;
  body.initialize_vector(X);
  body.initialize_vector(G);
  body.set_to_reference_positions(X);
  body.compute_elastic_force(X, 0., G);
  std::cout << "arc at rest: " << below(G.linfty_norm() / arc.beams[0].stiffness, 1e-14);
  for (unsigned int i = 0; i <= 16; ++i)
    {
      X.local_element(2 * i)     = 0.1 * i;
      X.local_element(2 * i + 1) = 0;
    }
  body.compute_elastic_force(X, 0., G);
  // Its curvature points up at the first node: the end is pushed up, its neighbour down.
  std::cout << ", straightened: end "
            << (G.local_element(1) > 0 && G.local_element(3) < 0 ? "ok" : "FAILED")
            << std::endl;
}
