// Displaced by (0.1, 0, 0), moving at (0, 2, 0), with kappa = 30 and eta = 4, a tethered
// node feels (-3, -8, 0); nodes out of the region or of elements of other materials feel
// nothing. The unit cube has 5^3 nodes, 25 of them in x < 0.2; elements of material 2
// (x >= 0.5) have nodes at x = 0.5, 0.75 and 1, so 75.

#include "structure_tests.h"

using namespace structure_tests;

void
check(const std::string &values)
{
  dealii::ParameterHandler prm;
  constraints<3>().declare_parameters("tether", prm);
  prm.parse_input_from_string("set Stiffness = 30\nset Damping = 4\n" + values);

  BodyParameters<3> parameters = make_parameters<3>();
  parameters.constraints.push_back({"hold", constraints<3>().create("tether")});
  parameters.constraints[0].constraint->parse_parameters(prm, "Part box, hold");
  try
    {
      const FiniteElementBody<3> body(
        parameters, make_box<3>(ElementShape::simplex, 4), MPI_COMM_SELF);
      VectorType X, U, F;
      for (VectorType *v : {&X, &U, &F})
        body.initialize_vector(*v);
      body.set_to_reference_positions(X);
      for (unsigned int i = 0; i < X.size(); i += 3)
        {
          X[i] += 0.1;
          U[i + 1] = 2;
        }
      parameters.constraints[0].constraint->add_force_density(X, U, 0., F);

      unsigned int n_pulled = 0, n_wrong = 0;
      for (unsigned int i = 0; i < X.size(); i += 3)
        {
          const double difference =
            std::abs(F[i] + 3) + std::abs(F[i + 1] + 8) + std::abs(F[i + 2]);
          if (difference < 1e-12)
            ++n_pulled;
          else if (F[i] != 0 || F[i + 1] != 0 || F[i + 2] != 0)
            ++n_wrong;
        }
      std::cout << n_pulled << " of " << X.size() / 3 << " nodes, " << n_wrong
                << " wrong, largest displacement "
                << body.compute_constraint_displacements(X, 0.)[0] << std::endl;
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
  check("");
  check("set Region = x < 0.2\n");
  check("set Material ids = 2\n");
  check("set Material ids = 1, 2\nset Region = x < 0.2\n");
  check("set Material ids = 2\nset Region = x < 0.2\n");
}
