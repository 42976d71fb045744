// Material ids and laws that do not fit the mesh, an element that a run turns inside out
// (a node of the first element mirrored at the opposite face) and a node outside of the
// box end in errors that name part, file, id, element, place and time. The first case has
// no mistake.

#include <mitre/base/exceptions.h>

#include "structure_tests.h"

using namespace structure_tests;

template <typename Function>
void
check(const Function &function)
{
  try
    {
      function();
      std::cout << "no error" << std::endl;
    }
  catch (const mitre::base::UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
}

void
make(const BodyParameters<3> &parameters, const Mesh<3> &mesh)
{
  const FiniteElementBody<3> body(parameters, mesh, MPI_COMM_SELF);
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Mesh<3> mesh                 = make_box<3>(ElementShape::simplex, 2, 0.);
  const BodyParameters<3> parameters = make_parameters<3>();

  check([&]() { make(parameters, mesh); });
  check([&]() {
    BodyParameters<3> p = parameters;
    p.materials.pop_back();
    make(p, mesh);
  });
  check([&]() {
    BodyParameters<3> p = parameters;
    p.materials[1].ids  = {2, 5};
    make(p, mesh);
  });
  check([&]() {
    BodyParameters<3> p = parameters;
    p.materials[1].ids  = {2, 1};
    make(p, mesh);
  });
  check([&]() {
    Mesh<3> m = mesh;
    m.fibres[0].clear();
    make(parameters, m);
  });
  check([&]() {
    Mesh<3> m      = mesh;
    m.fibres[0][3] = 0;
    make(parameters, m);
  });
  check([&]() {
    Mesh<3> m = mesh;
    std::swap(m.elements[0], m.elements[1]);
    make(parameters, m);
  });

  FiniteElementBody<3> body(parameters, mesh, MPI_COMM_SELF);
  VectorType X, G;
  body.initialize_vector(X);
  body.initialize_vector(G);
  body.set_to_reference_positions(X);
  X[0] = 0.9;
  check([&]() { body.compute_elastic_force(X, 0.125, G); });
  X[0] = std::numeric_limits<double>::quiet_NaN();
  check([&]() { body.compute_elastic_force(X, 0.125, G); });
  X[0] = -3;
  check([&]() {
    body.distribute(
      [](const std::vector<dealii::Point<3>> &points) {
        std::vector<unsigned int> owners;
        for (const dealii::Point<3> &x : points)
          owners.push_back(x[0] < -1 ? dealii::numbers::invalid_unsigned_int : 0u);
        return owners;
      },
      X);
  });
}
