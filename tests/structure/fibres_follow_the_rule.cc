// Fibres by rule. In a box the potentials are the coordinates: with the inner surface at
// x = 0 and the outer one at x = 1, start at z = 0 and end at z = 1, e_t = e_x, e_l = e_z
// and e_c = e_z x e_x = e_y. Angles of 60 degrees inside and -30 outside are 60 - 90 x in
// the middle of an element at x. The directions are exact, as linear potentials are.
//
// In a quarter of a tube of radii 1 and 2 e_c is around the axis; with 8 elements across
// and 8 around, directions of both families are within 1 degree for quadrilaterals and
// hexahedra, and within 4 for triangles and tetrahedra, the slopes of which are of first
// order (measured: 3.1).

#include <mitre/base/exceptions.h>

#include "structure_tests.h"

using namespace structure_tests;

template <int dim>
Mesh<dim>
with_rule(const Mesh<dim> &mesh, const std::string &values)
{
  dealii::ParameterHandler prm;
  FibreRule<dim>::declare_parameters(prm);
  prm.parse_input_from_string("set Fibres = by rule\nsubsection Fibre rule\n" + values +
                              "end\n");
  FibreRule<dim> rule;
  rule.parse_parameters(prm, "Part box");
  return rule.apply(mesh);
}

std::string
surface(const std::string &name, const std::string &region)
{
  return "subsection " + name + " surface\nset Region = " + region + "\nend\n";
}

template <int dim>
double
degrees_between(const dealii::Tensor<1, dim> &a, const dealii::Tensor<1, dim> &b)
{
  return std::acos(std::min(1., std::abs(a * b))) * 180 / dealii::numbers::PI;
}

void
check_box(const ElementShape shape, const unsigned int degree)
{
  const Mesh<3> mesh = with_rule(
    make_box_of_degree<3>(shape, degree, 3),
    "set Inner angle = 60\nset Outer angle = -30\nset Second family = transmural\n" +
      surface("Inner", "x < 0.01") + surface("Outer", "x > 0.99") +
      surface("Start", "z < 0.01") + surface("End", "z > 0.99"));
  const ReferenceElement<3> element(shape, degree);
  const ShapeTable<3> middle(element,
                             dealii::Quadrature<3>(shape == ElementShape::simplex
                                                     ? dealii::Point<3>(.25, .25, .25)
                                                     : dealii::Point<3>(.5, .5, .5)));
  double error = 0;
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    {
      double x = 0;
      for (unsigned int a = 0; a < middle.n_nodes; ++a)
        x += middle.values[a] * mesh.nodes[mesh.elements[e * middle.n_nodes + a]][0];
      const double angle = (60 - 90 * x) * dealii::numbers::PI / 180;
      dealii::Tensor<1, 3> fibre;
      fibre[1] = std::cos(angle);
      fibre[2] = std::sin(angle);
      error    = std::max(error, (mesh.fibres[0][e] - fibre).norm());
      fibre    = 0;
      fibre[0] = 1;
      error    = std::max(error, (mesh.fibres[1][e] - fibre).norm());
    }
  std::cout << element_name(3, shape, degree) << ": " << below(error, 1e-7) << std::endl;
}

template <int dim>
void
check_tube(const ElementShape shape)
{
  Mesh<dim> mesh = make_box<dim>(shape, 8, 0.);
  for (auto &node : mesh.nodes)
    {
      const double r = 1 + node[0], angle = node[1] * dealii::numbers::PI / 2;
      node[0] = r * std::cos(angle);
      node[1] = r * std::sin(angle);
    }
  std::string rule =
    surface("Inner", "x^2 + y^2 < 1.01") + surface("Outer", "x^2 + y^2 > 3.9");
  if (dim == 3)
    rule += "set Inner angle = 20\nset Outer angle = 20\nset Second family = mirrored\n" +
            surface("Start", "z < 0.01") + surface("End", "z > 0.99");
  mesh         = with_rule(mesh, rule);
  double error = 0;
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    {
      const dealii::Point<dim> x = mesh.centroid(e);
      dealii::Tensor<1, dim> around;
      around[0] = -x[1];
      around[1] = x[0];
      around /= around.norm();
      if (dim == 2)
        error = std::max(error, degrees_between<dim>(mesh.fibres[0][e], around));
      else
        for (const unsigned int f : {0, 1})
          {
            const double angle = (f == 0 ? 20 : -20) * dealii::numbers::PI / 180;
            dealii::Tensor<1, dim> expected = std::cos(angle) * around;
            // e_c = e_l x e_t runs with the angle around the axis
            expected[dim - 1] = std::sin(angle);
            error = std::max(error, degrees_between<dim>(mesh.fibres[f][e], expected));
          }
    }
  std::cout << "tube of " << element_name(dim, shape, 1) << ": "
            << below(error, shape == ElementShape::simplex ? 4. : 1.) << std::endl;
}

void
expect_error(const std::string &values)
{
  try
    {
      with_rule(make_box<2>(ElementShape::simplex, 3), values);
      std::cout << "no error" << std::endl;
    }
  catch (const mitre::base::UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const unsigned int degree : {1, 2})
    for (const auto shape : {ElementShape::simplex, ElementShape::hypercube})
      check_box(shape, degree);
  for (const auto shape : {ElementShape::simplex, ElementShape::hypercube})
    {
      check_tube<2>(shape);
      check_tube<3>(shape);
    }

  // Only material 2 (x > 0.5), whose inner surface is where material 1 begins.
  Mesh<2> mesh = make_box<2>(ElementShape::hypercube, 4, 0.);
  mesh.fibres[0].clear();
  mesh                   = with_rule(mesh,
                   "set Material ids = 2\n"
                                     "subsection Inner surface\nset Adjacent material ids = 1\nend\n" +
                     surface("Outer", "x > 0.99"));
  unsigned int n_without = 0, n_along_y = 0;
  for (const auto &fibre : mesh.fibres[0])
    {
      n_without += fibre.norm() == 0;
      n_along_y += std::abs(std::abs(fibre[1]) - 1) < 1e-9;
    }
  std::cout << n_without << " elements without fibres, " << n_along_y << " along y"
            << std::endl;

  expect_error(surface("Inner", "x < 0") + surface("Outer", "x > 0.99"));
  expect_error(surface("Inner", "x < 0.01") + surface("Outer", "y > 0.99"));
  expect_error("set Inner angle = 20\n" + surface("Inner", "x < 0.01") +
               surface("Outer", "x > 0.99"));
  expect_error("set Material ids = 6\n" + surface("Inner", "x < 0.01") +
               surface("Outer", "x > 0.99"));
}
