// The feedback force takes, in every step, the fraction s (1 + cos(pi z / w)) / 2 of the
// difference from the boundary's velocity away, at the distance z < w, and nothing
// beyond. Without viscosity and advection a velocity along an open boundary or a wall
// therefore decays as a power of one minus that, to solver tolerance; also on a grid that
// was refined at one end after the start. With regions, corners and levels, the force on
// random velocities is that of the formula. A uniform stream that enters through an open
// boundary with backflow damping s is slowed as a whole by the fraction s (w / 2) / L in
// each step, w / 2 being the integral of the ramp; one that leaves is not.

#include <mitre/base/parameters.h>

#include "fluid_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

template <int dim>
fluid::BoundaryConditions<dim>
parse(const std::string &text)
{
  ParameterHandler prm;
  base::parse_parameter_text(
    prm, text, "test", fluid::BoundaryConditions<dim>::declare_parameters);
  fluid::BoundaryConditions<dim> conditions;
  conditions.parse_parameters(prm);
  return conditions;
}

double
ramp(const double cells, const double width)
{
  return cells < width ? 0.5 * (1. + std::cos(numbers::PI * cells / width)) : 0.;
}

fluid::FluidParameters
inviscid()
{
  fluid::FluidParameters parameters;
  parameters.density                   = 1.25;
  parameters.viscosity                 = 0.;
  parameters.advection                 = fluid::AdvectionScheme::none;
  parameters.solver.relative_tolerance = 1e-12;
  return parameters;
}

template <int dim>
void
decay(const bool refined)
{
  const auto conditions = parse<dim>("set Conditions = open, plate\n"
                                     "subsection Condition open\n"
                                     "  set Faces = x min\n"
                                     "  set Type = pressure\n"
                                     "  set Feedback strength = 0.5\n"
                                     "end\n"
                                     "subsection Condition plate\n"
                                     "  set Faces = x max\n"
                                     "  set Type = velocity\n"
                                     "  set Velocity y = 3\n"
                                     "  set Feedback strength = 1\n"
                                     "  set Feedback width = 2.5\n"
                                     "end\n");
  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD,
                                  unit_box<dim>(16, refined ? 2 : 1, "yz"));
  fluid::NavierStokes<dim> flow(patch_grid, conditions, inviscid());
  const auto initial = [](const Point<dim> &, const unsigned int c) {
    return c == 0 ? 0. : c;
  };
  flow.set_velocity(initial, 0.);
  grid::VectorType force;
  flow.operators().initialize_velocity(force);
  flow.advance(0., 0.01, force);
  if (refined)
    {
      flow.regrid(
        [](const BoundingBox<dim> &box) { return box.center()[0] < 0.5 ? 2 : 1; }, 0.);
      flow.operators().initialize_velocity(force);
      flow.set_velocity(initial, 0.);
      flow.advance(0., 0.01, force);
    }
  for (unsigned int step = 1; step < 5; ++step)
    flow.advance(0.01 * step, 0.01, force);

  const double h0 = 1. / (refined ? 32 : 16), h1 = 1. / 16;
  const auto exact = [&](const Point<dim> &x, const unsigned int c) {
    if (c == 0)
      return 0.;
    const double plate = (c == 1 ? 3. : 0.);
    const double near  = std::pow(1. - 0.5 * ramp(x[0] / h0, 4.), 5);
    const double far   = std::pow(1. - ramp((1. - x[0]) / h1, 2.5), 5);
    return x[0] < 0.5 ? c * near : plate + (c - plate) * far;
  };
  out() << dim << "D, along open boundary and plate" << (refined ? ", refined" : "")
        << ": " << below(velocity_error(flow, exact), 1e-9) << std::endl;
}

template <int dim>
void
formula()
{
  const auto conditions = parse<dim>("set Conditions = open, inlet, wall\n"
                                     "subsection Condition open\n"
                                     "  set Faces = x min, y max\n"
                                     "  set Region = x + y > 0.4\n"
                                     "  set Type = pressure\n"
                                     "  set Feedback strength = 0.5\n"
                                     "  set Backflow damping = 0.3\n"
                                     "end\n"
                                     "subsection Condition inlet\n"
                                     "  set Faces = x min\n"
                                     "  set Type = velocity\n"
                                     "  set Velocity x = x + y + t\n"
                                     "end\n"
                                     "subsection Condition wall\n"
                                     "  set Faces = all\n"
                                     "  set Type = wall\n"
                                     "  set Feedback strength = 0.25\n"
                                     "  set Feedback width = 6\n"
                                     "end\n");
  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, unit_box<dim>(16, 2, "z"));
  patch_grid.adapt(refine_ball(patch_grid, diagonal_point<dim>(0.1), 0.2));
  grid::StaggeredSpace<dim> space(patch_grid, conditions.kinds());
  fluid::StokesOperators<dim> operators(space);
  fluid::FeedbackForcing<dim> feedback(space, conditions);
  grid::VectorType u, force;
  space.initialize_vector(u);
  space.initialize_vector(force);
  interpolate(space, noise<dim>, u);
  const double time = 0.3, rho_over_dt = 7.;
  feedback.compute_force(force, u, time, rho_over_dt);

  double error = 0., inside = 0.;
  for_each_face(
    space,
    [&](const std::size_t entry,
        const unsigned int p,
        const unsigned int c,
        const Point<dim> &x) {
      // faces on interfaces and copies follow from others
      if (space.volumes().local_element(entry) == 0.)
        return;
      const double h = patch_grid.patch(p).h[0], value = u.local_element(entry);
      double weight = 0.;
      // x min
      if (x[1] > 0.4 && c != 0)
        weight = 0.5 * ramp(x[0] / h, 4.);
      else if (x[1] > 0.4 && value > 0.)
        weight = 0.3 * ramp(x[0] / h, 4.);
      // y max
      if (x[0] + 1. > 0.4 && c != 1)
        weight = std::max(weight, 0.5 * ramp((1. - x[1]) / h, 4.));
      else if (value < 0.)
        weight = std::max(weight, 0.3 * ramp((1. - x[1]) / h, 4.));
      // walls
      weight = std::max(weight, 0.25 * ramp((1. - x[0]) / h, 6.));
      weight = std::max(weight, 0.25 * ramp(x[1] / h, 6.));
      error  = std::max(
        error, std::abs(force.local_element(entry) + rho_over_dt * weight * value));
      if (weight == 0.)
        inside += 1.;
    });
  out() << dim << "D, force with corners and levels: "
        << below(Utilities::MPI::max(error, MPI_COMM_WORLD), 1e-12) << ", none inside "
        << above(Utilities::MPI::sum(inside, MPI_COMM_WORLD), 100.) << std::endl;
}

template <int dim>
void
backflow(const double speed)
{
  const auto conditions = parse<dim>("set Conditions = damped, free\n"
                                     "subsection Condition damped\n"
                                     "  set Faces = x min\n"
                                     "  set Type = pressure\n"
                                     "  set Backflow damping = 0.5\n"
                                     "end\n"
                                     "subsection Condition free\n"
                                     "  set Faces = x max\n"
                                     "  set Type = pressure\n"
                                     "end\n");
  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, unit_box<dim>(16, 1, "yz"));
  fluid::NavierStokes<dim> flow(patch_grid, conditions, inviscid());
  flow.set_velocity(
    [&](const Point<dim> &, const unsigned int c) { return c == 0 ? speed : 0.; }, 0.);
  grid::VectorType force;
  flow.operators().initialize_velocity(force);
  for (unsigned int step = 0; step < 5; ++step)
    flow.advance(0.01 * step, 0.01, force);
  const double end_speed = speed * (speed > 0. ? std::pow(1. - 0.5 * 2. / 16., 5) : 1.);
  out() << dim << "D, stream " << (speed > 0. ? "in" : "out") << ": "
        << below(velocity_error(flow,
                                [&](const Point<dim> &, const unsigned int c) {
                                  return c == 0 ? end_speed : 0.;
                                }),
                 1e-9)
        << std::endl;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const bool refined : {false, true})
    {
      decay<2>(refined);
      decay<3>(refined);
    }
  formula<2>();
  formula<3>();
  for (const double speed : {1., -1.})
    {
      backflow<2>(speed);
      backflow<3>(speed);
    }
}
