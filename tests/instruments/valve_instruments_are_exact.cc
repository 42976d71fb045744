// What is measured at a valve.
//
// Gorlin's formula: 5 L/min (83.33 mL/s) at 10 mmHg give 5 / (0.7 44.5 0.06 sqrt(10)) =
// 0.8459 cm^2, the constant with 0.06 being that for litres a minute. In a stream of 3
// cm/s through a section of 1 cm^2 with the pressure 2e4 - 3e4 x, stations at x = 0.3
// and 1.6 differ by 3.9e4 dyn/cm^2, whatever the levels of the grid.
//
// Open area: cones of fibres of which the narrow end is a polygon of 48 corners and the
// radius 0.6, seen from both ends, enclose 24 r^2 sin(2 pi / 48), and so does a cylinder,
// which is seen edge on; the error of pixels of 0.005 is below 0.2 % (an eighth of what
// one layer of pixels on the rim would be). A sheet over one half leaves half, a
// strand of springs hides nothing, and a surface with a slit encloses nothing. A ring of
// eight cubes about a hole encloses a ninth of the square, exactly if pixels fit into it.
// In 2D gaps add up.
//
// Energy budget: of a parabolic flow between plates, which is exact on the grid,
// pressures do the work that viscosity dissipates, the fall of pressure times the flow.
//
// Chordal tension: chordae of linear springs that are stretched by 10 and 30 % and a
// slack one.

#include <mitre/instruments/chordal_tension.h>
#include <mitre/instruments/flow_meter.h>
#include <mitre/instruments/gorlin_area.h>
#include <mitre/instruments/orifice_area.h>

#include "../structure/structure_tests.h"
#include "instrument_tests.h"

using namespace instrument_tests;

namespace
{
  using dealii::numbers::PI;

  structure::Spring make_spring(const unsigned int a,
                                const unsigned int b,
                                const double stiffness,
                                const double rest_length,
                                const unsigned int force_function)
  {
    structure::Spring spring;
    spring.nodes          = {{a, b}};
    spring.stiffness      = stiffness;
    spring.rest_length    = rest_length;
    spring.force_function = force_function;
    return spring;
  }


  std::unique_ptr<structure::FibreBody<3>>
  make_body(const std::string &name, const structure::FibreNetwork<3> &network)
  {
    dealii::ParameterHandler prm;
    base::parse_parameter_text(prm,
                               "set Spring laws = sheet, chordae\n"
                               "subsection Spring law chordae\n"
                               "  set Force function = 1\n"
                               "  set Compression = false\n"
                               "end\n",
                               "test.prm",
                               structure::FibreParameters<3>::declare_parameters);
    structure::FibreParameters<3> parameters;
    parameters.parse_parameters(prm, name);
    return std::make_unique<structure::FibreBody<3>>(
      std::move(parameters), network, MPI_COMM_WORLD);
  }


  /// A network of springs along the lines of a lattice of n x m nodes, closed in the
  /// first direction or not.
  structure::FibreNetwork<3>
  make_lattice(const unsigned int n,
               const unsigned int m,
               const bool closed,
               const std::function<Point<3>(double, double)> &position)
  {
    structure::FibreNetwork<3> network;
    network.source = network.spring_source = "lattice";
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < m; ++j)
        {
          network.nodes.push_back(
            position(double(i) / (closed ? n : n - 1), double(j) / (m - 1)));
          if (i + 1 < n || closed)
            network.springs.push_back(
              make_spring(i * m + j, (i + 1) % n * m + j, 1, 1, 0));
          if (j + 1 < m)
            network.springs.push_back(make_spring(i * m + j, i * m + j + 1, 1, 1, 0));
        }
    return network;
  }


  template <int dim>
  struct Parts
  {
    std::vector<std::unique_ptr<structure::Body<dim>>> bodies;
    std::vector<structure::VectorType> X;

    void add(std::unique_ptr<structure::Body<dim>> body)
    {
      X.emplace_back();
      body->initialize_vector(X.back());
      body->set_to_reference_positions(X.back());
      bodies.push_back(std::move(body));
    }

    instruments::Observation<dim> observation() const
    {
      instruments::Observation<dim> result;
      for (unsigned int i = 0; i < bodies.size(); ++i)
        result.parts.push_back({bodies[i].get(), &X[i], &X[i]});
      return result;
    }
  };


  template <int dim>
  std::vector<double> measure(const instruments::Observation<dim> &observation,
                              const std::string &type,
                              const std::string &parameters)
  {
    instruments::Instruments<dim> instruments;
    parse(instruments,
          "set Instruments = it\nsubsection Instrument it\nset Type = " + type + "\n" +
            parameters + "end\n");
    return instruments.measure(observation);
  }


  void check_gorlin()
  {
    check("Gorlin area of 5 L/min at 10 mmHg",
          instruments::compute_gorlin_area(5e3 / 60, 10),
          5 / (0.7 * 44.5 * 0.06 * std::sqrt(10.)),
          1e-12);

    Case<3> flow(
      [](const Point<3> &, const unsigned int c, double) { return c == 0 ? 3. : 0.; });
    flow.fluid->set_velocity(
      [&](const Point<3> &, const unsigned int c) { return c == 0 ? 3. : 0.; }, 0.);
    typename fluid::NavierStokes<3>::State state;
    flow.fluid->save(state);
    const unsigned int n       = flow.patch_grid.n_cells_per_side();
    const unsigned int n_cells = dealii::Utilities::fixed_power<3>(n);
    for (unsigned int q = 0; q < flow.patch_grid.n_owned_patches(); ++q)
      for (unsigned int i = 0; i < n_cells; ++i)
        {
          const auto &patch = flow.patch_grid.patch(q);
          state.p.local_element(q * n_cells + i) =
            2e4 - 3e4 * (patch.lower[0] + (i % n + 0.5) * patch.h[0]);
        }
    flow.fluid->restore(state);

    instruments::Observation<3> observation;
    observation.fluid          = flow.fluid.get();
    const std::string stations = "set Upstream position = 0.3\n"
                                 "set Downstream position = 1.6\n";
    const double mmHg          = 3e4 * 1.3 / 1333.22;
    check("pressure difference",
          measure(observation, "pressure difference", stations)[0],
          mmHg,
          1e-10);
    check("Gorlin area",
          measure(observation, "Gorlin area", stations + "set Flow position = 1\n")[0],
          3 / (0.7 * 44.5 * std::sqrt(mmHg)),
          1e-12);
    check(
      "Gorlin area, below the smallest difference",
      measure(observation, "Gorlin area", stations + "set Smallest difference = 30\n")[0],
      0,
      0);
    check("Gorlin area, against the pressure",
          measure(observation,
                  "Gorlin area",
                  "set Upstream position = 1.6\nset Downstream position = 0.3\n")[0],
          0,
          0);
    expect_error([&]() {
      measure(observation, "Gorlin area", stations + "set Flow radius = 0.3\n");
    });
  }


  void check_open_area()
  {
    const unsigned int n = 48;
    const auto cone = [&](const double first, const double last, const double opening) {
      return make_lattice(
        n, 6, opening == 0, [=](const double a, const double v) -> Point<3> {
          const double r = first + v * (last - first), angle = (2 * PI - opening) * a;
          return {v, 4 + r * std::cos(angle), 3.003 + r * std::sin(angle)};
        });
    };
    Parts<3> parts;
    parts.add(make_body("funnel", cone(1, 0.6, 0)));
    parts.add(make_body("flare", cone(0.6, 1, 0)));
    parts.add(make_body("cylinder", cone(0.6, 0.6, 0)));
    parts.add(make_body("slit", cone(1, 0.6, 0.2)));
    parts.add(
      make_body("lid", make_lattice(4, 9, false, [](const double a, const double v) {
                  return Point<3>(2, 4 + 0.8 * a, 2 + 2 * v);
                })));
    structure::FibreNetwork<3> strand;
    strand.source = strand.spring_source = "strand";
    for (unsigned int i = 0; i < 9; ++i)
      {
        strand.nodes.emplace_back(2, 3 + 0.25 * i, 3);
        if (i > 0)
          strand.springs.push_back(make_spring(i - 1, i, 1, 0.2, 1));
      }
    parts.add(make_body("strand", strand));
    const instruments::Observation<3> observation = parts.observation();
    const auto open                               = [&](const std::string &names) {
      return measure(
        observation, "orifice area", "set Parts = " + names + "\nset Pixel = 0.005\n")[0];
    };
    const double exact = 0.5 * n * 0.36 * std::sin(2 * PI / n);
    check("funnel", open("funnel"), exact, 2e-3 * exact);
    check("flare", open("flare"), exact, 2e-3 * exact);
    check("cylinder", open("cylinder"), exact, 2e-3 * exact);
    check("funnel under a lid", open("funnel, lid"), 0.5 * exact, 4e-3 * exact);
    check("funnel with a slit", open("slit"), 0, 0);
    expect_error([&]() { open("funnel, strand"); });
    expect_error([&]() { open("funnel, lit"); });

    // eight cubes about a hole
    Parts<3> ring;
    structure::Mesh<3> mesh =
      structure_tests::make_box<3>(structure::ElementShape::hypercube, 3, 0.);
    structure::Mesh<3> with_hole = mesh;
    with_hole.elements.clear();
    with_hole.material_ids.clear();
    with_hole.fibres = {};
    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      if (const Point<3> x = mesh.centroid(e);
          std::abs(x[0] - 0.5) > 0.1 || std::abs(x[1] - 0.5) > 0.1)
        {
          with_hole.material_ids.push_back(mesh.material_ids[e]);
          with_hole.elements.insert(with_hole.elements.end(),
                                    mesh.elements.begin() + 8 * e,
                                    mesh.elements.begin() + 8 * (e + 1));
        }
    const auto surface = instruments::find_surface(with_hole);
    check("pieces of the surface of a ring of cubes", surface.size(), 2 * (16 + 48), 0);
    std::vector<std::array<Point<2>, 3>> triangles;
    for (const auto &nodes : surface)
      {
        triangles.emplace_back();
        for (unsigned int a = 0; a < 3; ++a)
          triangles.back()[a] =
            Point<2>(with_hole.nodes[nodes[a]][0], with_hole.nodes[nodes[a]][1]);
      }
    check("hole of a ring of cubes",
          instruments::compute_open_area(triangles, 1. / 150, "it"),
          1. / 9,
          1e-10);
    expect_error([&]() { instruments::compute_open_area(triangles, 1e-5, "it"); });

    check("gaps on a line",
          instruments::compute_open_length(
            {{{0, 1}}, {{3, 2.5}}, {{0.5, 1.25}}, {{2.75, 2.8}}, {{4, 5}}}),
          1.25 + 1,
          1e-15);
  }


  void check_budget()
  {
    dealii::ParameterHandler prm;
    base::parse_parameter_text(prm,
                               "set Conditions = inlet, outlet, plates\n"
                               "subsection Condition inlet\n"
                               "  set Faces    = x min\n"
                               "  set Type     = pressure\n"
                               "  set Pressure = 6\n"
                               "end\n"
                               "subsection Condition outlet\n"
                               "  set Faces = x max\n"
                               "  set Type  = pressure\n"
                               "end\n"
                               "subsection Condition plates\n"
                               "  set Faces = y min, y max\n"
                               "  set Type  = wall\n"
                               "end\n",
                               "test.prm",
                               fluid::BoundaryConditions<2>::declare_parameters);
    fluid::BoundaryConditions<2> conditions;
    conditions.parse_parameters(prm);
    grid::PatchGrid<2> patch_grid(MPI_COMM_WORLD, Case<2>::parameters());
    patch_grid.adapt([](const dealii::BoundingBox<2> &) { return 1; });
    fluid::FluidParameters parameters;
    parameters.density   = 1.5;
    parameters.viscosity = 0.2;
    fluid::NavierStokes<2> fluid(patch_grid, conditions, parameters);
    // 6 dyn/cm^2 over 2 cm
    fluid.set_velocity(
      [](const Point<2> &x, const unsigned int c) {
        return c == 0 ? 3 / (2 * 0.2) * x[1] * (1 - x[1]) : 0.;
      },
      0.);
    instruments::Observation<2> observation;
    observation.fluid               = &fluid;
    observation.boundary_conditions = &conditions;
    instruments::MeasuringDisc<2> section;
    section.position = 1;
    const double flow =
      instruments::compute_flow(section, fluid.space(), fluid.velocity(), "flow");
    check("flow between plates", flow, 7.5 / 6, 1e-2);
    const std::vector<double> found =
      measure(observation, "energy", "set Budget = true\n");
    check(
      "energy: power less that of pressure times flow", found[2] - 6 * flow, 0, 1e-10);
    check("energy: dissipation less power", found[3] - found[2], 0, 1e-10);
  }


  void check_chordae()
  {
    // a sheet, on which two chordae begin and share its nodes, and a slack chord
    structure::FibreNetwork<3> network = make_lattice(
      3, 3, false, [](const double a, const double v) { return Point<3>(v, a, 0); });
    const auto add_chord = [&](const std::vector<unsigned int> &on_sheet,
                               const double y,
                               const double rest_length) {
      unsigned int last = on_sheet.back();
      for (unsigned int i = 0; i + 1 < on_sheet.size(); ++i)
        network.springs.push_back(make_spring(on_sheet[i], on_sheet[i + 1], 100, 0.5, 1));
      for (unsigned int i = 1; i <= 4; ++i)
        {
          network.nodes.emplace_back(1 + i, y, 0);
          network.springs.push_back(
            make_spring(last, network.nodes.size() - 1, 100, rest_length, 1));
          last = network.nodes.size() - 1;
        }
    };
    add_chord({0, 1, 2}, 0, 1 / 1.1);
    add_chord({6, 7, 8}, 1, 1 / 1.3);
    add_chord({5}, 0.5, 1.2);
    Parts<3> parts;
    parts.add(make_body("valve", network));
    const double first = 100 * (1 - 1 / 1.1), second = 100 * (1 - 1 / 1.3);
    const std::vector<double> expected = {second,
                                          4 * (first / 1.1 + second / 1.3) /
                                            (2 * 1. + 4 / 1.1 + 4 / 1.3 + 4 * 1.2),
                                          first,
                                          second,
                                          0};
    const std::vector<double> found    = measure(parts.observation(),
                                              "chordal tension",
                                              "set Part = valve\n"
                                                 "set Number of chordae = 3\n");
    check("chordal tensions", found.size(), expected.size(), 0);
    for (unsigned int i = 0; i < expected.size(); ++i)
      check("chordal tension " + std::to_string(i), found[i], expected[i], 1e-10);
    check("without a column for each",
          measure(parts.observation(), "chordal tension", "set Part = valve\n").size(),
          2,
          0);
    expect_error([&]() {
      measure(parts.observation(),
              "chordal tension",
              "set Part = valve\nset Number of chordae = 4\n");
    });
    expect_error([&]() {
      measure(parts.observation(),
              "chordal tension",
              "set Part = valve\nset Force functions = 2, 3\n");
    });
  }
} // namespace

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_gorlin();
  check_open_area();
  check_budget();
  check_chordae();
}
