// A meter across the box where the flow is Q = 4.25 (1 - 3/2 t) in 2D: it turns at
// t = 2/3, so that until t = 1 the volume Q(0)/3 has passed forward and Q(0)/12 back;
// integration is exact for a flow that is linear between measurements, here those at
// t = 0 and 1, of which it does not matter that the turn lies between them. At t = 2 the
// flow is twice as strong back as it was forward at first: another 5/4 Q(0) has passed
// back. A meter of the other direction finds the opposite. The mean pressure is that of
// the fluid at rest between two openings at 5 mmHg.

#include <mitre/base/units.h>
#include <mitre/fluid/boundary_conditions/pressure.h>
#include <mitre/fluid/boundary_conditions/wall.h>

#include "instrument_tests.h"

using namespace instrument_tests;

void
test_volumes()
{
  const Velocity<2> velocity =
    [](const Point<2> &x, const unsigned int c, const double t) {
      return linear_velocity(x, c) * (1. - 1.5 * t);
    };
  Case<2> flow(velocity);
  instruments::Instruments<2> meters;
  parse(meters,
        "set Instruments = flow, back\n"
        "subsection Instrument flow\n"
        "  set Type = flow meter\n"
        "  set Position = 1\n"
        "end\n"
        "subsection Instrument back\n"
        "  set Type = flow meter\n"
        "  set Position = 1\n"
        "  set Direction = negative\n"
        "end\n");
  const std::vector<std::string> columns = meters.columns();
  std::vector<std::vector<double>> rows;
  for (const double t : {0., 1., 2.})
    {
      flow.fluid->set_velocity(
        [&](const Point<2> &x, const unsigned int c) { return velocity(x, c, t); }, t);
      rows.push_back(meters.measure({t, t == 0. ? 0. : 1., flow.fluid.get(), {}}));
    }

  const double Q = 4.25;
  for (const auto &[row, column, expected] : {std::make_tuple(0, 0, Q),
                                              std::make_tuple(0, 1, 0.),
                                              std::make_tuple(0, 2, 0.),
                                              std::make_tuple(1, 0, -0.5 * Q),
                                              std::make_tuple(1, 1, Q / 3.),
                                              std::make_tuple(1, 2, Q / 12.),
                                              std::make_tuple(2, 0, -2. * Q),
                                              std::make_tuple(2, 1, Q / 3.),
                                              std::make_tuple(2, 2, Q / 12. + 1.25 * Q),
                                              std::make_tuple(2, 3, 2. * Q),
                                              std::make_tuple(2, 4, Q / 12. + 1.25 * Q),
                                              std::make_tuple(2, 5, Q / 3.)})
    check(columns[column] + " at t = " + std::to_string(row),
          rows[row][column],
          expected,
          1e-11);
}

void
test_pressure()
{
  grid::PatchGrid<2> patch_grid(MPI_COMM_WORLD, Case<2>::parameters());
  fluid::BoundaryConditions<2> conditions;
  dealii::ParameterHandler prm;
  fluid::PressureCondition<2>::declare_parameters(prm);
  prm.set("Pressure", "5 * mmHg");
  const auto open = std::make_shared<fluid::PressureCondition<2>>();
  open->parse_parameters(prm, "open");
  conditions.add("open", {0, 1}, open);
  conditions.add("walls", {2, 3}, std::make_shared<fluid::WallCondition<2>>());
  fluid::NavierStokes<2> flow(patch_grid, conditions, fluid::FluidParameters());
  grid::VectorType force;
  flow.operators().initialize_velocity(force);
  flow.advance(0., 0.01, force);

  instruments::Instruments<2> stations;
  parse(stations,
        "set Instruments = upstream pressure\n"
        "subsection Instrument upstream pressure\n"
        "  set Type = pressure station\n"
        "  set Position = 0.3\n"
        "end\n");
  check(stations.columns()[0], stations.measure({0.01, 0.01, &flow, {}})[0], 5., 1e-4);
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test_volumes();
  test_pressure();
}
