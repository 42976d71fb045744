// The mass matrix row sums add up to the volume of the unit box, 1; b = M v for a linear
// field v, computed independently from the exact integral over simplices where
// M_ab = V (1 + delta_ab)/((d+1)(d+2)), is projected back to v by the consistent matrix
// (tolerance 1e-13); vmult() is symmetric; the lumped matrix reproduces constants.

#include "structure_tests.h"

using namespace structure_tests;

template <int dim>
void
check(const ElementShape shape)
{
  BodyParameters<dim> parameters = make_parameters<dim>();
  parameters.mass_tolerance      = 1e-13;
  const FiniteElementBody<dim> body(parameters, make_box<dim>(shape, 4), MPI_COMM_WORLD);
  parameters.consistent_mass = false;
  const FiniteElementBody<dim> lumped(
    parameters, make_box<dim>(shape, 4), MPI_COMM_WORLD);

  double volume = 0;
  for (const double m : body.mass_matrix().lumped())
    volume += m;
  volume = dealii::Utilities::MPI::sum(volume, MPI_COMM_WORLD);

  VectorType v, b, w, c;
  for (VectorType *vector : {&v, &b, &w, &c})
    body.initialize_vector(*vector);
  std::vector<double> values;
  for (const dealii::Point<dim> &s : body.mesh().nodes)
    for (unsigned int d = 0; d < dim; ++d)
      values.push_back(1 + s[d] - 2 * s[(d + 1) % dim]);
  body.from_mesh_order(values, v);

  // Step 1: b = M v, for simplices by the formula.
  body.mass_matrix().vmult(b, v);
  double formula = 0;
  if (shape == ElementShape::simplex)
    {
      const Mesh<dim> &mesh = body.mesh();
      std::vector<double> exact(values.size(), 0.);
      for (unsigned int e = 0; e < mesh.n_elements(); ++e)
        {
          const unsigned int *nodes = &mesh.elements[e * (dim + 1)];
          dealii::Tensor<2, dim> edges;
          for (unsigned int a = 0; a < dim; ++a)
            edges[a] = mesh.nodes[nodes[a + 1]] - mesh.nodes[nodes[0]];
          const double V = determinant(edges) / (dim == 2 ? 2 : 6);
          for (unsigned int i = 0; i <= dim; ++i)
            for (unsigned int j = 0; j <= dim; ++j)
              for (unsigned int d = 0; d < dim; ++d)
                exact[nodes[i] * dim + d] += V * (i == j ? 2 : 1) /
                                             ((dim + 1) * (dim + 2)) *
                                             values[nodes[j] * dim + d];
        }
      body.from_mesh_order(exact, c);
      c -= b;
      formula = c.linfty_norm() / b.linfty_norm();
    }

  // Step 2: back.
  const unsigned int n = body.project(w, b);
  w -= v;
  const double projection = w.linfty_norm();

  for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
    w.local_element(i) = std::sin(3. * i);
  body.mass_matrix().vmult(c, w);
  const double vb = w * b, cv = c * v;

  // Step 3: lumped.
  v = 1;
  body.mass_matrix().vmult(b, v);
  lumped.project(w, b);
  w -= v;
  const double lumped_error = w.linfty_norm();

  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::cout << shape_name(dim, shape) << ": volume " << volume << ", formula "
              << below(formula, 1e-14) << ", projection " << below(projection, 1e-11)
              << ", symmetry " << below(std::abs(vb - cv) / std::abs(vb), 1e-12)
              << ", lumped " << below(lumped_error, 1e-13) << ", iterations "
              << (n < 90 ? "ok" : "FAILED") << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check<2>(ElementShape::simplex);
  check<2>(ElementShape::hypercube);
  check<3>(ElementShape::simplex);
  check<3>(ElementShape::hypercube);
}
