// Forces of springs, beams and target points node by node against what the format of
// their files says: a spring pulls with kappa (l - l_0) along itself, a beam with
// -kappa (1, -2, 1) times the second difference less its value at rest, a target point
// with -kappa (X - X_0) - eta U. Then, on an irregular network with all laws: total force
// and torque are zero (1e-11 of the sum of the magnitudes; without curvature at rest,
// which is a vector in space), forces are minus the derivative of the energy (central
// differences, 1e-7), and those of nodes dealt out to all ranks are the same to the last
// bit as on one.

#include <mitre/structure/fibre_body.h>

#include "structure_tests.h"

using namespace structure_tests;

namespace
{
  bool root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }


  NamedSpringLaw make_spring_law(const std::string &type,
                                 const unsigned int force_function,
                                 const bool carries_compression,
                                 const std::string &values = "")
  {
    return {type,
            force_function,
            carries_compression,
            make_plugin(spring_laws(), type, values)};
  }


  template <int dim>
  Spring make_spring(const unsigned int a,
                     const unsigned int b,
                     const double stiffness,
                     const double rest_length,
                     const unsigned int force_function     = 0,
                     const std::vector<double> &parameters = {})
  {
    Spring spring;
    spring.nodes          = {{a, b}};
    spring.stiffness      = stiffness;
    spring.rest_length    = rest_length;
    spring.force_function = force_function;
    spring.parameters     = parameters;
    return spring;
  }
} // namespace


// Four nodes on a right angle, by hand.
void
check_by_hand()
{
  FibreNetwork<2> network;
  network.source = "by hand";
  network.nodes  = {{0., 0.}, {3., 0.}, {3., 4.}, {7., 4.}};
  network.springs.push_back(make_spring<2>(0, 1, 2., 2.5)); // T = 1 along x
  network.springs.push_back(make_spring<2>(2, 1, 3., 0.));  // T = 12 along y
  network.springs.push_back(make_spring<2>(0, 2, 10., 6.)); // T = -10 along (3, 4) / 5
  Beam<2> beam;
  beam.nodes        = {{0, 1, 2}}; // (0,0) - 2 (3,0) + (3,4) = (-3,4)
  beam.stiffness    = 0.5;
  beam.curvature[0] = -1; // less (-1,1): (-2,3)
  beam.curvature[1] = 1;
  network.beams.push_back(beam);
  network.targets.push_back({3, 5., 0.25});

  FibreParameters<2> parameters;
  parameters.name = "hand";
  FibreBody<2> body(parameters, network, MPI_COMM_SELF);
  VectorType X, U, F;
  for (VectorType *v : {&X, &U, &F})
    body.initialize_vector(*v);
  body.set_to_reference_positions(X);
  X.local_element(6) += 0.2;
  U.local_element(7) = 8;
  body.compute_force_density(X, U, 0., F);
  if (root())
    for (unsigned int i = 0; i < 4; ++i)
      std::cout << "force on node " << i << ": " << F.local_element(2 * i) << ' '
                << F.local_element(2 * i + 1) << std::endl;

  // Node by itself, ends of a spring in one place: no force.
  body.set_to_reference_positions(X);
  X.local_element(2) = X.local_element(4);
  X.local_element(3) = X.local_element(5);
  body.compute_elastic_force(X, 0., F, 0);
  if (root())
    std::cout << "ends in one place: " << F.local_element(2) << ' ' << F.local_element(3)
              << std::endl;
}


template <int dim>
FibreNetwork<dim>
make_network()
{
  FibreNetwork<dim> network;
  network.source       = "network";
  const unsigned int n = 7;
  for (unsigned int j = 0; j < n; ++j)
    for (unsigned int i = 0; i < n; ++i)
      {
        dealii::Point<dim> x;
        x[0] = (i + 0.2 * std::sin(3. * i + 5. * j)) / n;
        x[1] = (j + 0.2 * std::sin(7. * i + 2. * j)) / n;
        if (dim == 3)
          x[dim - 1] = 0.1 * std::sin(2. * i + 3. * j);
        network.nodes.push_back(x);
      }
  const auto node = [n](const unsigned int i, const unsigned int j) { return i + n * j; };
  for (unsigned int j = 0; j < n; ++j)
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int d = 0; d < 2; ++d)
        {
          const unsigned int a = node(i, j);
          if ((d == 0 ? i : j) + 1 < n)
            {
              const unsigned int b   = d == 0 ? node(i + 1, j) : node(i, j + 1);
              const double length    = network.nodes[a].distance(network.nodes[b]);
              const unsigned int law = (i + 2 * j + d) % 5;
              network.springs.push_back(
                make_spring<dim>(a,
                                 b,
                                 3. + i,
                                 (0.8 + 0.05 * ((3 * i + j) % 8)) * length,
                                 law,
                                 law == 2 && i % 2 == 0 ? std::vector<double>{2.5}
                                                        : std::vector<double>()));
            }
          if ((d == 0 ? i : j) + 2 < n)
            {
              Beam<dim> beam;
              beam.nodes =
                d == 0 ? std::array<unsigned int, 3>{{a, node(i + 1, j), node(i + 2, j)}}
                       : std::array<unsigned int, 3>{{a, node(i, j + 1), node(i, j + 2)}};
              beam.stiffness = 1. + 0.3 * j;
              network.beams.push_back(beam);
            }
        }
  return network;
}


template <int dim>
void
check_network()
{
  FibreParameters<dim> parameters;
  parameters.name        = "network";
  parameters.spring_laws = {
    make_spring_law("linear", 0, true),
    make_spring_law("linear", 1, false),
    make_spring_law("exponential", 2, true, "set Exponent = 4"),
    make_spring_law("exponential", 3, false, "set Exponent = 0"),
    make_spring_law("toe-linear", 4, true, "set Transition strain = 0.1")};
  const FibreNetwork<dim> network = make_network<dim>();
  FibreBody<dim> alone(parameters, network, MPI_COMM_SELF);
  FibreBody<dim> together(parameters, network, MPI_COMM_WORLD);

  // Step 1: balance.
  VectorType X, G;
  alone.initialize_vector(X);
  alone.initialize_vector(G);
  set_positions(alone, X);
  for (const unsigned int which : {0u, 1u})
    {
      alone.compute_elastic_force(X, 0., G, which);
      dealii::Tensor<1, dim> force;
      dealii::Tensor<2, dim> torque;
      double magnitude = 0;
      for (unsigned int i = 0; i < network.nodes.size(); ++i)
        for (unsigned int c = 0; c < dim; ++c)
          {
            const double f = G.local_element(i * dim + c);
            force[c] += f;
            magnitude += std::abs(f);
            for (unsigned int d = 0; d < dim; ++d)
              {
                torque[c][d] += f * X.local_element(i * dim + d);
                torque[d][c] -= f * X.local_element(i * dim + d);
              }
          }
      if (root())
        std::cout << dim << "D, " << alone.elastic_force_names()[which]
                  << ": total force " << below(force.norm() / magnitude, 1e-11)
                  << ", torque " << below(torque.norm() / magnitude, 1e-11)
                  << ", not without forces " << (magnitude > 1 ? "ok" : "FAILED")
                  << std::endl;
    }

  // Step 2: energy.
  alone.compute_elastic_force(X, 0., G);
  double worst = 0;
  for (unsigned int i = 0; i < X.locally_owned_size(); ++i)
    {
      const double step = 1e-6;
      VectorType moved  = X;
      moved.local_element(i) += step;
      const double after = alone.compute_elastic_energy(moved, 0.);
      moved.local_element(i) -= 2 * step;
      const double before = alone.compute_elastic_energy(moved, 0.);
      worst =
        std::max(worst, std::abs((before - after) / (2 * step) - G.local_element(i)));
    }
  if (root())
    std::cout << dim
              << "D, derivative of the energy: " << below(worst / G.linfty_norm(), 1e-7)
              << std::endl;

  // Step 3: nodes on any rank.
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  VectorType Y, U, F;
  together.initialize_vector(Y);
  together.initialize_vector(U);
  set_positions(together, Y);
  together.distribute(
    [&](const std::vector<dealii::Point<dim>> &points) {
      std::vector<unsigned int> owners;
      for (unsigned int i = 0; i < points.size(); ++i)
        owners.push_back((i * i / 3) % n_ranks);
      return owners;
    },
    Y,
    {&U});
  together.initialize_vector(F);
  together.compute_force_density(Y, U, 0., F);
  const std::vector<double> a = alone.to_mesh_order(G), b = together.to_mesh_order(F);
  const double energy =
    together.compute_elastic_energy(Y, 0.) / alone.compute_elastic_energy(X, 0.) - 1;
  if (root())
    std::cout << dim << "D, on all ranks: forces " << (a == b ? "equal" : "DIFFER")
              << ", energy " << below(std::abs(energy), 1e-13) << std::endl;
}


int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_by_hand();
  check_network<2>();
  check_network<3>();
}
