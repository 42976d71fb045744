// On irregular meshes of each shape and degree of elements, whose volumetric energy sees
// a projected change of volume: the elastic forces of a deformed body add up to no force
// and no torque (round-off of a sum over the nodes); they are minus the derivative of the
// strain energy by the nodes' positions (central differences with step 1e-5, relative
// error of order 1e-9); and under a linear map of a body of one material they vanish at
// inner nodes (patch test).

#include "structure_tests.h"

using namespace structure_tests;

template <int dim>
void
check(const ElementShape shape, const unsigned int degree)
{
  Mesh<dim> mesh = make_box_of_degree<dim>(shape, degree, degree == 1 ? 4 : 2);
  const FiniteElementBody<dim> body(make_parameters<dim>(), mesh, MPI_COMM_SELF);

  VectorType X, G, Y;
  body.initialize_vector(X);
  body.initialize_vector(G);
  set_positions(body, X);
  const double t = 0.5;
  body.compute_elastic_force(X, t, G);

  // Step 1: force and torque.
  dealii::Tensor<1, dim> force;
  dealii::Tensor<2, dim> torque;
  double size = 0;
  for (unsigned int i = 0; i < mesh.nodes.size(); ++i)
    for (unsigned int c = 0; c < dim; ++c)
      {
        force[c] += G[i * dim + c];
        size += std::abs(G[i * dim + c]);
        for (unsigned int d = 0; d < dim; ++d)
          torque[c][d] +=
            X[i * dim + c] * G[i * dim + d] - X[i * dim + d] * G[i * dim + c];
      }

  // Step 2: the derivative of the energy.
  double error = 0, largest = 0;
  Y = X;
  for (unsigned int k = 0; k < X.size(); k += 7)
    {
      const double step = 1e-5;
      Y[k] += step;
      const double plus = body.compute_elastic_energy(Y, t);
      Y[k] -= 2 * step;
      const double minus = body.compute_elastic_energy(Y, t);
      Y[k]               = X[k];
      error              = std::max(error, std::abs((plus - minus) / (2 * step) + G[k]));
      largest            = std::max(largest, std::abs(G[k]));
    }

  // Step 3: the patch test.
  for (dealii::Tensor<1, dim> &f : mesh.fibres[0])
    {
      f    = 0;
      f[1] = 1;
    }
  for (unsigned int &id : mesh.material_ids)
    id = 1;
  BodyParameters<dim> parameters = make_parameters<dim>();
  parameters.materials.pop_back();
  parameters.materials[0].law = make_law<dim>("transversely isotropic",
                                              "set C1 = 3\n"
                                              "set a_f = 5\n"
                                              "set b_f = 2\n"
                                              "set Bulk modulus = 40\n");
  const FiniteElementBody<dim> patch(parameters, mesh, MPI_COMM_SELF);
  for (unsigned int i = 0; i < mesh.nodes.size(); ++i)
    for (unsigned int c = 0; c < dim; ++c)
      X[i * dim + c] = 1.1 * mesh.nodes[i][c] + 0.2 * mesh.nodes[i][(c + 1) % dim] + 0.5;
  patch.compute_elastic_force(X, t, G);
  double inner = 0, outer = 0;
  for (unsigned int i = 0; i < mesh.nodes.size(); ++i)
    {
      bool is_inner = true;
      for (unsigned int d = 0; d < dim; ++d)
        is_inner = is_inner && mesh.nodes[i][d] > 1e-6 && mesh.nodes[i][d] < 1 - 1e-6;
      for (unsigned int c = 0; c < dim; ++c)
        (is_inner ? inner : outer) =
          std::max(is_inner ? inner : outer, std::abs(G[i * dim + c]));
    }

  std::cout << element_name(dim, shape, degree) << ": force "
            << below(force.norm() / size, 1e-15) << ", torque "
            << below(torque.norm() / size, 1e-15) << ", energy "
            << below(error / largest, 1e-7) << ", patch test "
            << below(inner / outer, 1e-13) << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const unsigned int degree : {1, 2})
    {
      check<2>(ElementShape::simplex, degree);
      check<2>(ElementShape::hypercube, degree);
      check<3>(ElementShape::simplex, degree);
      check<3>(ElementShape::hypercube, degree);
    }
}
