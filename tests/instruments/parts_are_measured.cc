// A unit cube of which every element is deformed by X = A s + b, with A = diag(2, 3/4
// (, 1)) and a shear of X_0 along s_1: J = 3/2 everywhere, and the corners say what the
// extents are: 0.5 <= x <= 0.5 + 2 + 0.3 for all of it, 0.5 + 1 + 0.3 for the half
// s_0 < 1/2, which is material 1. Its strain energy is C1 (I1 - 3 - 2 ln J), with
// I1 = 4 + 9/16 + 0.09 + 1 and C1 = 2, times its volume and the number of parts. The
// kinetic energy of a uniform stream in a volume of 2 is rho |u|^2 with rho = 1.5. A
// tether holds the first part: with the mean displacement d and the mean velocity v (here
// that of the vector X) the fluid's force on it is kappa d + eta v, kappa = 30, eta = 4.
// The node at a corner of the other part is followed.

#include <mitre/structure/library.h>

#include "../structure/structure_tests.h"
#include "instrument_tests.h"

using namespace instrument_tests;

template <int dim>
structure::VectorType
deformed(const structure::FiniteElementBody<dim> &body)
{
  std::vector<double> values;
  for (const Point<dim> &s : body.mesh().nodes)
    for (unsigned int d = 0; d < dim; ++d)
      values.push_back(d == 0   ? 0.5 + 2. * s[0] + 0.3 * s[1]
                       : d == 1 ? 1. + 0.75 * s[1]
                                : s[d]);
  structure::VectorType X;
  body.initialize_vector(X);
  body.from_mesh_order(values, X);
  return X;
}

template <int dim>
void
test()
{
  if (prints())
    std::cout << dim << "D" << std::endl;
  const Velocity<dim> stream = [](const Point<dim> &, const unsigned int c, double) {
    return c == 0 ? 3. : 2.;
  };
  Case<dim> flow(stream);
  flow.fluid->set_velocity(
    [&](const Point<dim> &x, const unsigned int c) { return stream(x, c, 0.); }, 0.);

  std::vector<std::unique_ptr<structure::FiniteElementBody<dim>>> bodies;
  std::vector<structure::VectorType> X;
  for (const auto shape :
       {structure::ElementShape::simplex, structure::ElementShape::hypercube})
    {
      structure::BodyParameters<dim> parameters;
      parameters.name = shape == structure::ElementShape::simplex ? "leaflets" : "tube";
      for (const unsigned int id : {1, 2})
        parameters.materials.push_back(
          {"material " + std::to_string(id),
           {id},
           structure_tests::make_law<dim>("neo-Hookean", "set C1 = 2\n"),
           base::TimeExpression("1", "factor")});
      if (shape == structure::ElementShape::simplex)
        {
          dealii::ParameterHandler prm;
          structure::constraints<dim>().declare_parameters("tether", prm);
          prm.parse_input_from_string("set Stiffness = 30\nset Damping = 4\n");
          parameters.constraints.push_back(
            {"hold", structure::constraints<dim>().create("tether")});
          parameters.constraints[0].constraint->parse_parameters(prm, "hold");
        }
      bodies.push_back(std::make_unique<structure::FiniteElementBody<dim>>(
        parameters, structure_tests::make_box<dim>(shape, 4), MPI_COMM_WORLD));
      X.push_back(deformed(*bodies.back()));
    }
  const instruments::Observation<dim> observation{
    0.1,
    0.1,
    flow.fluid.get(),
    {{bodies[0].get(), &X[0], &X[0]}, {bodies[1].get(), &X[1], &X[1]}}};

  const std::string text =
    "set Instruments = whole, half, top, volume, tube, energy, force, corner\n"
    "subsection Instrument whole\n"
    "  set Type = part extent\n"
    "  set Part = leaflets\n"
    "end\n"
    "subsection Instrument half\n"
    "  set Type = part extent\n"
    "  set Part = leaflets\n"
    "  set Material ids = 1\n"
    "end\n"
    "subsection Instrument top\n"
    "  set Type = part extent\n"
    "  set Part = tube\n"
    "  set Axis = y\n"
    "  set Material ids = 1, 2\n"
    "end\n"
    "subsection Instrument volume\n"
    "  set Type = part volume\n"
    "  set Part = leaflets\n"
    "end\n"
    "subsection Instrument tube\n"
    "  set Type = part volume\n"
    "  set Part = tube\n"
    "end\n"
    "subsection Instrument energy\n"
    "  set Type = energy\n"
    "end\n"
    "subsection Instrument force\n"
    "  set Type            = part force\n"
    "  set Part            = leaflets\n"
    "  set Reference force = 10\n"
    "end\n"
    "subsection Instrument corner\n"
    "  set Type  = part point\n"
    "  set Part  = tube\n"
    "  set Point = " +
    std::string(dim == 2 ? "0.99, 1\n" : "0.99, 1, 1\n") + "end\n";
  instruments::Instruments<dim> instruments;
  parse(instruments, text);
  const std::vector<std::string> columns = instruments.columns();
  const std::vector<double> values       = instruments.measure(observation);

  const double J = 1.5, I1 = 4. + 0.5625 + 0.09 + 1.;
  std::vector<double> force{30. * 1.15 + 4. * 1.65, 30. * 0.875 + 4. * 1.375};
  if (dim == 3)
    force.push_back(4. * 0.5);
  std::vector<double> expected{0.5,
                               2.8,
                               0.5,
                               1.8,
                               1.,
                               1.75,
                               J,
                               J,
                               J,
                               J,
                               J,
                               J,
                               1.5 * (dim == 2 ? 13. : 17.),
                               2. * 2. * (I1 - 3. - 2. * std::log(J))};
  expected.insert(expected.end(), force.begin(), force.end());
  for (const double component : force)
    expected.push_back(component / 10.);
  // X = (2.8, 1.75 (, 1)) for s = (1, 1 (, 1)); the velocity is X
  for (const double subtracted : {1., 0.})
    for (const double x : {2.8, 1.75, 1.})
      if (dim == 3 || x != 1.)
        expected.push_back(x - subtracted);
  check("columns", columns.size(), expected.size(), 0);
  for (unsigned int i = 0; i < expected.size(); ++i)
    check(columns[i], values[i], expected[i], 1e-9);

  instruments::Instruments<dim> wrong;
  parse(wrong,
        "set Instruments = gap\n"
        "subsection Instrument gap\n"
        "  set Type = part extent\n"
        "  set Part = leaflet\n"
        "end\n");
  expect_error([&]() { wrong.measure(observation); });
  parse(wrong,
        "set Instruments = gap\n"
        "subsection Instrument gap\n"
        "  set Type = part extent\n"
        "  set Part = tube\n"
        "  set Material ids = 7\n"
        "end\n");
  expect_error([&]() { wrong.measure(observation); });
  parse(wrong,
        "set Instruments = tip\n"
        "subsection Instrument tip\n"
        "  set Type  = part point\n"
        "  set Part  = tube\n"
        "  set Point = " +
          std::string(dim == 2 ? "1, 1.2\n" : "1, 1, 1.2\n") + "end\n");
  expect_error([&]() { wrong.measure(observation); });
  parse(wrong,
        "set Instruments = drag\n"
        "subsection Instrument drag\n"
        "  set Type = part force\n"
        "  set Part = tube\n"
        "end\n");
  expect_error([&]() { wrong.measure(observation); });
  expect_error([&]() {
    parse(wrong,
          "set Instruments = front\n"
          "subsection Instrument front\n"
          "  set Type = pressure point\n"
          "  set Extrapolation distance = 0.1\n"
          "end\n");
  });
  expect_error([&]() {
    parse(wrong,
          "set Instruments = gap\n"
          "subsection Instrument gap\n"
          "  set Type = pressure station\n"
          "  set Radius = 1\n"
          "  set Centre = " +
            std::string(dim == 2 ? "4, 4" : "4") +
            "\n"
            "end\n");
  });
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test<2>();
  test<3>();
}
