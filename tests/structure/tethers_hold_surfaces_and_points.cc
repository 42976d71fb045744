// Tethers on surfaces and points of the unit box, and moving targets. Displaced by (0.1,
// 0.2), with kappa = 30 on the side y = 1 (length, or area in 3D, 1), the force is
// -(3, 6); on the 5 (25 in 3D) points of it -(3, 6) each; with only y held, -(0, 6). A
// target that has moved by (0.1, 0.2) itself, by expressions 0.2 t and 0.4 t at t = 0.5
// or by a table in mm, leaves nothing but the damping: with eta = 4 at rest, eta times
// the velocity (0.2, 0.4) of the target. In a volume that is the density at each node.

#include <fstream>

#include <mitre/base/exceptions.h>

#include "structure_tests.h"

using namespace structure_tests;

template <int dim>
void
check(const std::string &title, const std::string &values)
{
  BodyParameters<dim> parameters = make_parameters<dim>();
  try
    {
      parameters.constraints.push_back(
        {"hold",
         make_plugin<Constraint<dim>>(
           constraints<dim>(), "tether", "set Stiffness = 30\n" + values)});
      const FiniteElementBody<dim> body(
        parameters, make_box<dim>(ElementShape::hypercube, 4), MPI_COMM_SELF);
      VectorType X, U;
      for (VectorType *v : {&X, &U})
        body.initialize_vector(*v);
      body.set_to_reference_positions(X);
      for (unsigned int i = 0; i < X.size(); i += dim)
        {
          X[i] += 0.1;
          X[i + 1] += 0.2;
        }
      const dealii::Tensor<1, dim> force = body.compute_total_external_force(X, U, 0.5);
      std::cout << dim << "D " << title << ": " << std::round(force[0] * 1e8) / 1e8 + 0.
                << ' ' << std::round(force[1] * 1e8) / 1e8 + 0.;
      if (dim == 3)
        std::cout << ' ' << std::round(force[dim - 1] * 1e8) / 1e8 + 0.;
      std::cout << ", nodes " << parameters.constraints[0].constraint->n_nodes()
                << ", displaced by "
                << std::round(body.compute_constraint_displacements(X, 0.5)[0] * 1e8) /
                     1e8
                << std::endl;
    }
  catch (const mitre::base::UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
}

template <int dim>
void
check_all()
{
  const std::string side = "set Region = y > 0.99\n", surface = "set Acts on = surface\n",
                    moving =
                      "set Displacement x = 0.2 * t\nset Displacement y = 0.4 * t\n";
  check<dim>("surface", surface + side);
  check<dim>("points", "set Acts on = points\n" + side);
  check<dim>("volume", "");
  check<dim>("component", surface + side + "set Components = y\n");
  check<dim>("moving", surface + side + moving + "set Damping = 4\n");
  check<dim>("moving volume", moving + "set Damping = 4\n");
  check<dim>("table",
             surface + side + "set Displacement table = tether.csv\n" +
               (dim == 2 ? "set Displacement columns = x, y\n"
                         : "set Displacement columns = x, y, z\n"));
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::ofstream("tether.csv") << "time [s],x [mm],y [mm],z [mm]\n0,0,0,0\n1,2,4,0\n";
  check_all<2>();
  check_all<3>();
  check<2>("", "set Displacement table = tether.csv\nset Displacement columns = x\n");
  check<2>("",
           "set Displacement table = tether.csv\nset Displacement columns = x, y\n"
           "set Displacement x = t\n");
  check<2>("", "set Boundary ids = 3\n");
  check<2>("", "set Acts on = surface\nset Region = x > 2\n");
}
