// The nodal forces of loads on the unit box, for each shape and degree of elements.
//
// Follower pressure p on the whole surface of a body that is bent and sheared: no force
// and no torque (relative to the sum of the nodal forces, round-off), and the force on
// each node is minus p times the derivative of the body's volume by its position; as a
// determinant is linear in one coordinate, differences are exact.
//
// After the map X = A s with A = [[2, 0.5], [0.2, 1]] (and 1.5 along z in 3D), the side
// x = 1, of normal e_x and area 1, has area times normal cof(A) e_x: (1, -0.5) in 2D,
// (1.5, -0.75, 0) in 3D. With p = 6 the force is -6 times that; a dead pressure of 6
// stays at (-6, 0). A traction (3, x + y, 0) with time factor 2 on y = 1 is in total
// (6, 3): the integral of x + 1 over the side is 3/2. A body force (0, 4 x) in x > 0.5 is
// (0, 1.5), as x has the mean 3/4 on half of the volume. Damping with eta = 5 at the
// velocity (0, x) gives (0, -2.5). The pressure of the table at 0.5 s is 3 mmHg.
//
// The torque of the traction about the origin in the reference configuration,
// x T_y - y T_x, is int x (x + 1) 2 dx - 6 = 5/3 - 6 = -13/3 (in 3D its z component).
// Projected to a force density, the load has the same total.

#include <deal.II/base/quadrature_lib.h>

#include <cstdio>
#include <fstream>

#include <mitre/base/exceptions.h>

#include "structure_tests.h"

using namespace structure_tests;

template <int dim>
struct Case
{
  Case(const Mesh<dim> &mesh, const std::string &name, const std::string &values)
    : body(
        [&]() {
          BodyParameters<dim> parameters = make_parameters<dim>();
          parameters.loads.push_back(
            {"load", make_plugin<Load<dim>>(loads<dim>(), name, values)});
          return parameters;
        }(),
        mesh,
        MPI_COMM_SELF)
  {
    for (VectorType *v : {&X, &U, &G})
      body.initialize_vector(*v);
    body.set_to_reference_positions(X);
  }

  dealii::Tensor<1, dim> total(const double t = 0)
  {
    body.compute_external_forces(X, U, t, G);
    dealii::Tensor<1, dim> sum;
    for (unsigned int i = 0; i < G.size(); ++i)
      sum[i % dim] += G[i];
    return sum;
  }

  FiniteElementBody<dim> body;
  VectorType X, U, G;
};

template <int dim>
double
volume(const FiniteElementBody<dim> &body, const VectorType &X)
{
  Mesh<dim> deformed = body.mesh();
  for (unsigned int i = 0; i < X.size(); ++i)
    deformed.nodes[i / dim][i % dim] = X[i];
  // exact for the determinant of a map of degree 2
  const ShapeTable<dim> shape(
    body.reference_element(),
    deformed.shape == ElementShape::simplex
      ? dealii::Quadrature<dim>(dealii::QWitherdenVincentSimplex<dim>(3))
      : dealii::Quadrature<dim>(dealii::QGauss<dim>(5)));
  double sum = 0;
  for (unsigned int e = 0; e < deformed.n_elements(); ++e)
    for (unsigned int q = 0; q < shape.n_points; ++q)
      sum += shape.weights[q] * determinant(shape.jacobian(deformed, e, q));
  return sum;
}

template <int dim>
std::string
show(const dealii::Tensor<1, dim> &force)
{
  std::string text;
  for (unsigned int d = 0; d < dim; ++d)
    {
      char number[40];
      std::snprintf(number,
                    40,
                    "%s%.9f",
                    d == 0 ? "(" : ", ",
                    std::abs(force[d]) < 1e-12 ? 0 : force[d]);
      text += number;
    }
  return text + ")";
}

template <int dim>
void
check(const ElementShape shape, const unsigned int degree)
{
  const Mesh<dim> mesh = make_box_of_degree<dim>(shape, degree, 2);
  std::cout << element_name(dim, shape, degree) << std::endl;

  // Step 1: a closed surface.
  Case<dim> closed(mesh, "pressure", "set Pressure = 7\n");
  set_positions(closed.body, closed.X);
  const dealii::Tensor<1, dim> force = closed.total();
  double size = 0, torque = 0;
  dealii::Tensor<2, dim> moments;
  for (unsigned int i = 0; i < closed.G.size(); i += dim)
    for (unsigned int c = 0; c < dim; ++c)
      {
        size += std::abs(closed.G[i + c]);
        for (unsigned int d = 0; d < dim; ++d)
          moments[c][d] +=
            closed.X[i + c] * closed.G[i + d] - closed.X[i + d] * closed.G[i + c];
      }
  torque       = moments.norm();
  double error = 0, largest = 0;
  VectorType Y = closed.X;
  for (unsigned int k = 0; k < Y.size(); k += 5)
    {
      Y[k] += 0.1;
      const double plus = volume(closed.body, Y);
      Y[k] -= 0.2;
      const double derivative = (plus - volume(closed.body, Y)) / 0.2;
      Y[k]                    = closed.X[k];
      error                   = std::max(error, std::abs(7 * derivative + closed.G[k]));
      largest                 = std::max(largest, std::abs(closed.G[k]));
    }
  std::cout << "  closed surface: force " << below(force.norm() / size, 1e-14)
            << ", torque " << below(torque / size, 1e-14) << ", derivative of the volume "
            << below(error / largest, 1e-11) << std::endl;

  // Step 2: a side.
  for (const std::string surface : {"deformed", "reference"})
    {
      Case<dim> side(mesh,
                     "pressure",
                     "set Pressure = 6\nset Region = x > 0.99\nset Surface = " + surface +
                       "\n");
      for (unsigned int i = 0; i < side.X.size(); i += dim)
        {
          const dealii::Point<dim> &s = mesh.nodes[i / dim];
          side.X[i]                   = 2 * s[0] + 0.5 * s[1];
          side.X[i + 1]               = 0.2 * s[0] + s[1];
          if (dim == 3)
            side.X[i + dim - 1] = 1.5 * s[dim - 1];
        }
      std::cout << "  pressure on the " << surface << " side: " << show(side.total())
                << std::endl;
    }

  // Step 3: traction, its torque, and its projection.
  Case<dim> pulled(mesh,
                   "traction",
                   "set Traction x = 3\nset Traction y = x + y\nset Time factor = 4 * t\n"
                   "set Region = y > 0.99\n");
  std::cout << "  traction: " << show(pulled.total(0.5));
  double moment = 0;
  for (unsigned int i = 0; i < pulled.X.size(); i += dim)
    moment += pulled.X[i] * pulled.G[i + 1] - pulled.X[i + 1] * pulled.G[i];
  VectorType F;
  pulled.body.initialize_vector(F);
  pulled.body.compute_force_density(pulled.X, pulled.U, 0.5, F);
  const dealii::Tensor<1, dim> difference =
    pulled.body.compute_total(F) - pulled.total(0.5);
  std::cout << ", torque " << moment << ", projected " << below(difference.norm(), 1e-7)
            << std::endl;

  // Step 4: in the volume.
  Case<dim> heavy(make_box_of_degree<dim>(shape, degree, 2, 0.),
                  "body force",
                  "set Force y = 4 * x\nset Region = x > 0.5\n");
  std::cout << "  body force: " << show(heavy.total()) << std::endl;
  Case<dim> damped(mesh, "damping", "set Damping = 5\n");
  for (unsigned int i = 0; i < damped.X.size(); i += dim)
    damped.U[i + 1] = damped.X[i];
  std::cout << "  damping: " << show(damped.total()) << std::endl;
}

template <int dim>
void
expect_error(const Mesh<dim> &mesh, const std::string &name, const std::string &values)
{
  try
    {
      Case<dim> wrong(mesh, name, values);
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
      {
        check<2>(shape, degree);
        check<3>(shape, degree);
      }

  std::ofstream("loads.csv") << "time [s],p [mmHg]\n0,1\n1,5\n";
  Mesh<2> mesh = make_box<2>(ElementShape::simplex, 2);
  // The sides x = 1, of which one element has the id 8 and the other 9.
  for (unsigned int i = 0; i < mesh.nodes.size(); ++i)
    for (unsigned int k = 0; k < mesh.nodes.size(); ++k)
      if (mesh.nodes[i][0] > 0.99 && mesh.nodes[k][0] > 0.99 &&
          std::abs(mesh.nodes[k][1] - mesh.nodes[i][1] - 0.5) < 1e-9)
        {
          mesh.boundary_elements.push_back(i);
          mesh.boundary_elements.push_back(k);
          mesh.boundary_ids.push_back(mesh.boundary_ids.empty() ? 8 : 9);
        }
  Case<2> table(mesh,
                "pressure",
                "set Pressure table = loads.csv\nset Pressure column = p\n"
                "set Boundary ids = 8\n");
  std::cout << "table: " << table.total(0.5)[0] / 1333.22 << " mmHg cm" << std::endl;
  expect_error(mesh, "pressure", "set Pressure = 1\nset Boundary ids = 8, 7\n");
  expect_error(mesh, "pressure", "set Pressure = 1\nset Region = x > 2\n");
  expect_error(mesh,
               "pressure",
               "set Pressure = 2\nset Pressure table = loads.csv\n"
               "set Pressure column = p\n");
  expect_error(mesh, "body force", "set Material ids = 5\n");
}
