// A block of which every element is sheared, X = (0.7 + 0.4 s_0 + 0.1 s_1, 0.2 + 0.6 s_1
// (, 0.2 + 0.6 s_2)), in a linear velocity u without divergence, and the nodes' velocity
// U = u/4. Through the face s_0 = 1, whose area vector is (0.6, -0.1) (times 0.6 in 3D),
// flows 3/4 of u in its middle, exactly (1e-10), as composite B-splines reproduce linear
// velocities, and so do ghost values on both sides of where levels meet. Through the
// whole surface nothing flows: the flow through the face s_0 = 0 is that through the
// others. After 0.1 s the same flow has carried a tenth of it; with U = 2 u it turns.

#include <mitre/coupling/fe_coupling.h>
#include <mitre/structure/library.h>

#include "../structure/structure_tests.h"
#include "instrument_tests.h"

using namespace instrument_tests;

template <int dim>
structure::VectorType
nodal_field(const structure::FiniteElementBody<dim> &body,
            const std::function<double(const Point<dim> &, unsigned int)> &value)
{
  std::vector<double> values;
  for (const Point<dim> &s : body.mesh().nodes)
    for (unsigned int d = 0; d < dim; ++d)
      values.push_back(value(s, d));
  structure::VectorType X;
  body.initialize_vector(X);
  body.from_mesh_order(values, X);
  return X;
}

template <int dim>
void
test(const structure::ElementShape shape)
{
  Case<dim> flow([](const Point<dim> &x, const unsigned int c, double) {
    return linear_velocity<dim>(x, c);
  });
  flow.fluid->set_velocity(linear_velocity<dim>, 0.);

  structure::BodyParameters<dim> parameters;
  parameters.name = "block";
  for (const unsigned int id : {1, 2})
    parameters.materials.push_back(
      {"material " + std::to_string(id),
       {id},
       structure_tests::make_law<dim>("neo-Hookean", "set C1 = 2\n"),
       base::TimeExpression("1", "factor")});
  structure::FiniteElementBody<dim> body(
    parameters, structure_tests::make_box<dim>(shape, 3), MPI_COMM_WORLD);

  const auto position = [](const Point<dim> &s) {
    Point<dim> x;
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = d == 0 ? 0.7 + 0.4 * s[0] + 0.1 * s[1] : 0.2 + 0.6 * s[d];
    return x;
  };
  structure::VectorType X = nodal_field<dim>(
    body, [&](const Point<dim> &s, const unsigned int d) { return position(s)[d]; });
  const auto velocity = [&](const double factor) {
    return nodal_field<dim>(body, [&](const Point<dim> &s, const unsigned int d) {
      return factor * linear_velocity<dim>(position(s), d);
    });
  };

  coupling::FECoupling<dim> coupling(flow.patch_grid);
  coupling.add_part(body, coupling::CouplingParameters());
  body.distribute([&](const auto &x) { return coupling.owners_of(x); }, X);
  grid::VelocityHalo<dim> halo(flow.fluid->space(),
                               coupling.halo_width(),
                               grid::HaloShape::full,
                               grid::BoundaryExtension::reflection);
  halo.make_own_partitioner();
  halo.set_boundary_values([](const grid::BoundaryTerm<dim> &term) {
    return linear_velocity<dim>(term.x, term.component);
  });
  coupling.reinit(halo);

  const std::string leak = "  set Type = leak\n  set Part = block\n  set Direction = ";
  std::string names      = "front, back", sections;
  const auto add         = [&](const std::string &name, const std::string &direction) {
    sections += "subsection Instrument " + name + "\n" + leak + direction + "\nend\n";
  };
  const std::string zero = dim == 3 ? ", 0" : "";
  add("front", "2, 0" + zero);
  add("back", "-1, 0" + zero);
  add("top", "0, 1" + zero);
  add("bottom", "0, -1" + zero);
  names += ", top, bottom";
  if (dim == 3)
    {
      add("near", "0, 0, 1");
      add("far", "0, 0, -1");
      names += ", near, far";
    }
  instruments::Instruments<dim> instruments;
  parse(instruments, "set Instruments = " + names + "\n" + sections);

  Point<dim> middle;
  for (unsigned int d = 0; d < dim; ++d)
    middle[d] = d == 0 ? 1. : 0.5;
  const double depth   = dim == 3 ? 0.6 : 1.;
  const double through = depth * (0.6 * linear_velocity<dim>(position(middle), 0) -
                                  0.1 * linear_velocity<dim>(position(middle), 1));

  const structure::VectorType U = velocity(0.25), faster = velocity(2.);
  const auto measure = [&](const double t, const structure::VectorType &V) {
    return instruments.measure({t, 0.1, flow.fluid.get(), {{&body, &X, &V}}, &coupling});
  };
  std::vector<double> values = measure(0., U);
  double surface             = 0;
  for (unsigned int i = 0; i < values.size(); i += 3)
    surface += values[i];
  if (prints())
    std::cout << structure_tests::shape_name(dim, shape) << std::endl;
  check(instruments.columns()[0], values[0], 0.75 * through, 1e-10);
  check("through the whole surface", surface, 0., 1e-10);
  values = measure(0.1, U);
  check(instruments.columns()[1], values[1], 0.075 * through, 1e-10);
  values = measure(0.2, faster);
  check(instruments.columns()[0], values[0], -through, 1e-10);
  check(instruments.columns()[1], values[1], 0.0625 * through, 1e-10);
  check(instruments.columns()[2], values[2], 0.1625 * through, 1e-10);

  // Through a disc across no axis: its area times the velocity at its centre, for that is
  // linear.
  instruments::Instruments<dim> meters;
  const std::string inclined =
    std::string("  set Type = flow meter\n  set Radius = 0.3\n") +
    (dim == 3 ? "  set Normal = 2, 1, 2\n  set Centre = 1, 0.5, 0.45\n"
              : "  set Normal = 0.6, 0.8\n  set Centre = 1, 0.5\n");
  parse(meters,
        "set Instruments = meter\nsubsection Instrument meter\n" + inclined + "end\n");
  Point<dim> centre;
  dealii::Tensor<1, dim> normal;
  for (unsigned int d = 0; d < dim; ++d)
    {
      centre[d] = d == 0 ? 1. : d == 1 ? 0.5 : 0.45;
      normal[d] = dim == 2 ? (d == 0 ? 0.6 : 0.8) : (d == 1 ? 1. / 3. : 2. / 3.);
    }
  double expected = 0;
  for (unsigned int d = 0; d < dim; ++d)
    expected += (dim == 3 ? 0.09 * dealii::numbers::PI : 0.6) * normal[d] *
                linear_velocity<dim>(centre, d);
  check("through an inclined disc",
        meters.measure({0., 0.1, flow.fluid.get(), {{&body, &X, &U}}, &coupling})[0],
        expected,
        1e-10);

  const auto error_of = [&](const std::string &text) {
    expect_error([&]() {
      instruments::Instruments<dim> wrong;
      parse(wrong,
            "set Instruments = hole\nsubsection Instrument hole\n  set Type = leak\n" +
              text + "end\n");
      wrong.measure({0., 0., flow.fluid.get(), {{&body, &X, &U}}, &coupling});
    });
  };
  const auto error_of_meter = [&](const std::string &text) {
    expect_error([&]() {
      instruments::Instruments<dim> wrong;
      parse(wrong,
            "set Instruments = meter\nsubsection Instrument meter\n  set Type = flow "
            "meter\n" +
              text + "end\n");
      wrong.measure({0., 0., flow.fluid.get(), {{&body, &X, &U}}, &coupling});
    });
  };
  const std::string across = "  set Normal = 1, 1" + zero + "\n";
  error_of_meter(across + "  set Centre = 1, 0.5" + zero + "5\n");
  error_of_meter(across + "  set Centre = 1\n  set Radius = 0.1\n");
  error_of_meter(across + "  set Centre = 1, 0.5" + zero + "5\n  set Radius = 3\n");
  error_of_meter("  set Normal = 0, 0" + zero + "\n  set Centre = 1, 0.5" + zero +
                 "5\n  set Radius = 0.1\n");
  error_of("  set Part = valve\n");
  error_of("  set Part = block\n  set Direction = 0, 0" + zero + "\n");
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const auto shape :
       {structure::ElementShape::simplex, structure::ElementShape::hypercube})
    {
      test<2>(shape);
      test<3>(shape);
    }
}
