// Flows that the scheme reproduces to solver tolerance (1e-12; claims of 1e-8), because
// they are linear in space and time and their pressure is at most quadratic: stagnation
// flow u = (1 + t/2) (x, -y) with the velocity given everywhere as a function of place
// and time; rotation u = (-y, x); and a plug between slipping walls that the pressure
// difference of a table accelerates: with a pressure linear in time the midpoint rule is
// exact, U = s t^2 / (2 rho L), also with finer patches at the inlet. What is wrong with
// a set of conditions is told by a UserError that names it.

#include <cstdio>
#include <fstream>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/base/units.h>

#include "fluid_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

template <int dim, typename Exact>
void
linear_flow(const std::string &name, const Exact &exact, const unsigned int steps)
{
  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, unit_box<dim>(16, 1, ""));
  fluid::BoundaryConditions<dim> conditions;
  std::vector<unsigned int> sides(2 * dim);
  for (unsigned int side = 0; side < 2 * dim; ++side)
    sides[side] = side;
  conditions.add("all", sides, given_velocity<dim>(exact));
  fluid::FluidParameters parameters;
  parameters.viscosity                 = 0.1;
  parameters.solver.relative_tolerance = 1e-12;
  fluid::NavierStokes<dim> flow(patch_grid, conditions, parameters);
  flow.set_velocity(
    [&](const Point<dim> &x, const unsigned int c) { return exact(x, c, 0.); }, 0.);
  grid::VectorType force;
  flow.operators().initialize_velocity(force);
  const double dt = 0.01;
  for (unsigned int step = 0; step < steps; ++step)
    flow.advance(step * dt, dt, force);
  out() << dim << "D, " << name << ": "
        << below(velocity_error(flow,
                                [&](const Point<dim> &x, const unsigned int c) {
                                  return exact(x, c, steps * dt);
                                }),
                 1e-8)
        << std::endl;
}

template <int dim>
void
plug()
{
  const std::string file = "boundary_conditions_hold_" + std::to_string(dim) + ".csv";
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::ofstream(file) << "time [s],pump [mmHg]\n-1,-0.01\n0,0\n1,0.01\n2,0.02\n";
  MPI_Barrier(MPI_COMM_WORLD);
  ParameterHandler prm;
  const std::string text = "set Conditions = inlet, outlet, sides\n"
                           "subsection Condition inlet\n"
                           "  set Faces = x min\n"
                           "  set Type = pressure\n"
                           "  set Table file = " +
                           file +
                           "\n"
                           "  set Table column = pump\n"
                           "  set Table extension = clamped\n"
                           "end\n"
                           "subsection Condition outlet\n"
                           "  set Faces = x max\n"
                           "  set Type = pressure\n"
                           "  set Pressure = t\n"
                           "end\n"
                           "subsection Condition sides\n"
                           "  set Faces = all\n"
                           "  set Type = slip\n"
                           "end\n";
  base::parse_parameter_text(
    prm, text, "test", fluid::BoundaryConditions<dim>::declare_parameters);
  fluid::BoundaryConditions<dim> conditions;
  conditions.parse_parameters(prm);

  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, unit_box<dim>(16, 2, ""));
  patch_grid.adapt([&](const BoundingBox<dim> &box) {
    return static_cast<int>(box.center()[0] < 0.5 ? patch_grid.maximum_level()
                                                  : patch_grid.minimum_level());
  });
  fluid::FluidParameters parameters;
  parameters.density                   = 1.25;
  parameters.solver.relative_tolerance = 1e-12;
  fluid::NavierStokes<dim> flow(patch_grid, conditions, parameters);
  grid::VectorType force;
  flow.operators().initialize_velocity(force);
  const double dt = 0.02;
  for (unsigned int step = 0; step < 25; ++step)
    flow.advance(step * dt, dt, force);
  const double slope = (13.3322 - 1.) / parameters.density;
  const double speed = 0.5 * slope * 0.5 * 0.5;
  // the pressure is that of the middle of the last step
  const double time = 0.49;
  out() << dim << "D, plug: velocity "
        << below(velocity_error(flow,
                                [&](const Point<dim> &, const unsigned int c) {
                                  return c == 0 ? speed : 0.;
                                }) /
                   speed,
                 1e-8)
        << ", pressure "
        << below(pressure_error(flow,
                                [&](const Point<dim> &x) {
                                  return time * (13.3322 * (1. - x[0]) + x[0]);
                                }) /
                   (time * 13.3322),
                 1e-8)
        << std::endl;
}

template <typename Action>
void
expect_error(const std::string &what, const Action &action)
{
  try
    {
      action();
      out() << what << ": no error: FAILED" << std::endl;
    }
  catch (const base::UserError &error)
    {
      out() << what << ": " << error.what() << std::endl;
    }
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  linear_flow<2>(
    "stagnation flow",
    [](const Point<2> &x, const unsigned int c, const double t) {
      return (1. + 0.5 * t) * (c == 0 ? x[0] : -x[1]);
    },
    20);
  linear_flow<3>(
    "stagnation flow",
    [](const Point<3> &x, const unsigned int c, const double t) {
      return (1. + 0.5 * t) * (c == 2 ? -2. * x[2] : x[c]);
    },
    5);
  linear_flow<2>(
    "rotation",
    [](const Point<2> &x, const unsigned int c, const double) {
      return c == 0 ? -x[1] : x[0];
    },
    20);
  plug<2>();
  plug<3>();

  expect_error("no condition", [] {
    grid::PatchGrid<2> patch_grid(MPI_COMM_WORLD, unit_box<2>(16, 1, "x"));
    fluid::BoundaryConditions<2> conditions;
    conditions.add("floor", {2}, wall<2>());
    fluid::NavierStokes<2> flow(patch_grid, conditions, fluid::FluidParameters());
  });
  expect_error("no z in 2D", [] {
    ParameterHandler prm;
    base::parse_parameter_text(prm,
                               "set Conditions = a\nsubsection Condition a\n"
                               "  set Faces = z min\nend\n",
                               "test",
                               fluid::BoundaryConditions<2>::declare_parameters);
    fluid::BoundaryConditions<2> conditions;
    conditions.parse_parameters(prm);
  });
  expect_error("no column", [] {
    ParameterHandler prm;
    base::parse_parameter_text(prm,
                               "set Conditions = a\nsubsection Condition a\n"
                               "  set Faces = all\n  set Type = pressure\n"
                               "  set Table extension = clamped\n"
                               "  set Table file = boundary_conditions_hold_2.csv\nend\n",
                               "test",
                               fluid::BoundaryConditions<2>::declare_parameters);
    fluid::BoundaryConditions<2> conditions;
    conditions.parse_parameters(prm);
  });
  expect_error("no advection scheme", [] { fluid::advection_scheme("upwind"); });
}
