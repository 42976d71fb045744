// Forces of fibres are spread from their nodes with weights of 1 (2.11)-(2.13), and the
// velocity is interpolated to the nodes (2.8)-(2.10): (S F, u) on the grid is the sum of
// F . U over the nodes (1e-13 of the sum of magnitudes), the total force and torque on
// the grid are those of the nodes (1e-11), a velocity that is constant is so at the nodes
// (1e-13). Nodes are on several patches, levels and ranks, some have no neighbours.

#include <mitre/structure/fibre_body.h>

#include "coupling_tests.h"

using namespace coupling_tests;

namespace
{
  double sum(const double value)
  {
    return dealii::Utilities::MPI::sum(value, MPI_COMM_WORLD);
  }
} // namespace


template <int dim>
void
check(const std::string &kernel)
{
  // A helix about the middle, and a few nodes by themselves.
  structure::FibreNetwork<dim> network;
  network.source       = "helix";
  const unsigned int n = 80;
  for (unsigned int i = 0; i < n + 5; ++i)
    {
      Point<dim> x;
      x[0] = 0.5 + (i < n ? 0.2 : 0.1) * std::cos(0.1 * i);
      x[1] = 0.5 + (i < n ? 0.25 : 0.1) * std::sin(0.1 * i);
      if (dim == 3)
        x[dim - 1] = 0.3 + 0.005 * i;
      network.nodes.push_back(x);
    }
  for (unsigned int i = 1; i < n; ++i)
    {
      structure::Spring spring;
      spring.nodes     = {{i - 1, i}};
      spring.stiffness = 1;
      network.springs.push_back(spring);
    }
  structure::FibreParameters<dim> parameters;
  parameters.name = "helix";
  structure::FibreBody<dim> body(parameters, network, MPI_COMM_WORLD);
  VectorType X;
  body.initialize_vector(X);
  body.set_to_reference_positions(X);

  const Grid<dim> grid(16, 2, "", half_refined<dim>);
  coupling::FECoupling<dim> coupling(grid.patches);
  coupling::CouplingParameters coupling_parameters;
  coupling_parameters.kernel = kernel;
  coupling_parameters.points = coupling::PointChoice::nodes;
  coupling.add_part(body, coupling_parameters);
  body.distribute([&](const auto &x) { return coupling.owners_of(x); }, X);
  coupling.reinit(*grid.halo);

  VectorType u = grid.make_vector(), f = grid.make_vector(), total = grid.make_vector(),
             constant = grid.make_vector();
  grid_tests::interpolate(*grid.space, grid_tests::noise<dim>, u);
  grid.space->zero_fixed_faces(u);
  grid.space->synchronize(u);
  grid_tests::interpolate(
    *grid.space,
    [](const Point<dim> &, const unsigned int c) { return 1. + c; },
    constant);
  grid.space->synchronize(constant);
  const VectorType F = make_nodal_field(body);

  double adjoint = 0, forces = 0, torques = 0, constants = 0;
  for (unsigned int move = 0; move < 2; ++move)
    {
      // The second time nodes are on other ranks than those that own them.
      if (move == 1)
        for (unsigned int i = 0; i < X.locally_owned_size(); i += dim)
          X.local_element(i) += 0.11;
      coupling.update_points({&X});
      coupling.spread({&F}, f, &total);
      VectorType U = F;
      coupling.interpolate(u, {&U});

      double scale = 0, torque = 0;
      dealii::Tensor<1, dim> force;
      for (unsigned int i = 0; i < F.locally_owned_size(); ++i)
        {
          scale += std::abs(F.local_element(i) * U.local_element(i));
          force[i % dim] += F.local_element(i);
          if (i % dim < 2)
            torque += (i % dim == 0 ? -X.local_element(i + 1) : X.local_element(i - 1)) *
                      F.local_element(i);
        }
      scale   = sum(scale);
      adjoint = std::max(adjoint, std::abs(total * u - F * U) / scale);

      grid_tests::for_each_face(*grid.space,
                                [&](const std::size_t entry,
                                    const unsigned int,
                                    const unsigned int c,
                                    const Point<dim> &x) {
                                  const double value = total.local_element(entry);
                                  force[c] -= value;
                                  if (c < 2)
                                    torque -= (c == 0 ? -x[1] : x[0]) * value;
                                });
      for (unsigned int c = 0; c < dim; ++c)
        forces = std::max(forces, std::abs(sum(force[c])) / F.l1_norm());
      torques = std::max(torques, std::abs(sum(torque)) / F.l1_norm());

      coupling.interpolate(constant, {&U});
      for (unsigned int i = 0; i < U.locally_owned_size(); ++i)
        constants = std::max(constants, std::abs(U.local_element(i) - 1. - i % dim));
    }
  out() << dim << "D, " << kernel << ": adjoint " << below(adjoint, 1e-13) << ", force "
        << below(forces, 1e-11) << ", torque " << below(torques, 1e-11) << ", constant "
        << below(dealii::Utilities::MPI::max(constants, MPI_COMM_WORLD), 1e-13)
        << std::endl;
}


int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const std::string kernel : {"IB_4", "IB_3", "IB_6", "CBS32"})
    {
      check<2>(kernel);
      check<3>(kernel);
    }
}
