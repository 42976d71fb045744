// Stress and strain of a box under F = diag(2, 1/2 (, 1)), on each shape and degree of
// elements. With W = C1 (I1 - 3 - 2 ln J), C1 = 3 and J = 1: P = 2 C1 (F - F^-T) =
// diag(9, -9, 0), sigma = P F^T = diag(18, -4.5, 0), E = diag(1.5, -0.375, 0), twice the
// stresses where the time factor is 2. Fibres at 45 degrees: stretch sqrt(4.25 / 2)
// = 1.457738, direction (2, 0.5) / sqrt(4.25), stress (4 18 - 0.25 4.5) / 4.25
// = 16.676471, angle with the first principal direction atan(1/4) = 14.036243 degrees. A
// bulk modulus, whose J is projected, changes nothing at J = 1, and at F = diag(2, 1, 1)
// with kappa = 5 and U = (kappa/2) (ln J)^2 it adds kappa ln J / J = 1.732868 to sigma:
// that is 9 + 1.732868, 1.732868, 1.732868.

#include "structure_tests.h"

using namespace structure_tests;

/// The field in all elements if it is the same, else "differs"; round-off becomes 0.
std::string
show(const std::vector<double> &field, const unsigned int n_components)
{
  std::string text;
  for (unsigned int k = 0; k < field.size(); ++k)
    if (std::abs(field[k] - field[k % n_components]) > 1e-10)
      return " differs";
  for (unsigned int k = 0; k < n_components; ++k)
    {
      std::ostringstream number;
      number.precision(8);
      number << (std::abs(field[k]) < 1e-10 ? 0. : field[k]);
      text += " " + number.str();
    }
  return text;
}

template <int dim>
void
check(const ElementShape shape, const unsigned int degree)
{
  std::cout << element_name(dim, shape, degree) << std::endl;
  Mesh<dim> mesh = make_box_of_degree<dim>(shape, degree, 2);
  for (auto &fibre : mesh.fibres[0])
    fibre = dealii::Point<dim>::unit_vector(0) * std::sqrt(0.5) +
            dealii::Point<dim>::unit_vector(1) * std::sqrt(0.5);
  BodyParameters<dim> parameters;
  parameters.name = "box";
  parameters.materials.push_back(
    {"solid",
     {1, 2},
     make_law<dim>("neo-Hookean", "set C1 = 3\nset Bulk modulus = 5\n"),
     mitre::base::TimeExpression("1 + t", "factor")});
  const FiniteElementBody<dim> body(parameters, mesh, MPI_COMM_SELF);
  VectorType X;
  body.initialize_vector(X);

  std::vector<std::string> names;
  for (const auto &quantity : stress_quantities<dim>())
    if (quantity.name.find("direction of") == std::string::npos)
      names.push_back(quantity.name);
  const auto deform = [&](const double across) {
    for (unsigned int i = 0; i < X.size(); i += dim)
      {
        const dealii::Point<dim> &s = mesh.nodes[i / dim];
        for (unsigned int d = 0; d < dim; ++d)
          X[i + d] = (d == 0 ? 2 : d == 1 ? across : 1) * s[d] + 3;
      }
  };
  deform(0.5);
  const auto fields  = body.compute_element_fields(names, X, 0.);
  const auto doubled = body.compute_element_fields({"Cauchy stress"}, X, 1.);
  for (unsigned int k = 0; k < names.size(); ++k)
    std::cout << "  " << names[k] << ':'
              << show(fields[k], find_stress_quantity<dim>(names[k]).n_components)
              << std::endl;
  std::cout << "  at twice the stiffness:" << show(doubled[0], 9) << std::endl;

  // Either sign of a direction is right.
  for (auto &value : body.compute_element_fields(
         {"direction of first principal stress", "direction of first principal strain"},
         X,
         0.))
    {
      for (double &component : value)
        component = std::abs(component);
      std::cout << "  direction:" << show(value, 3) << std::endl;
    }
  deform(1.);
  std::cout << "  with a change of volume:"
            << show(body.compute_element_fields({"principal stresses"}, X, 0.)[0], 3)
            << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const unsigned int degree : {1, 2})
    for (const auto shape : {ElementShape::simplex, ElementShape::hypercube})
      {
        check<2>(shape, degree);
        check<3>(shape, degree);
      }
}
