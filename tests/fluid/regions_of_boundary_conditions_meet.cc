// Where boundary conditions of different kinds meet, at edges of the box and in the
// middle of its faces. Exact flows (to solver tolerance, claims of 1e-8; the axes are
// exchanged too): stagnation flow u = (x, -y) or (x, y, -2 z) between symmetry planes and
// given velocities; a plug between slipping walls of which parts move with it, driven by
// pressures; Couette and Poiseuille flow through ends of which parts have a given
// velocity and the rest a given pressure; a fluid at rest in which a body force holds a
// linear pressure, behind walls, slipping walls and open parts, also with finer patches
// along a face.
//
// A flow that is not simple, through an inlet in the middle of one face and an opening in
// another: dividing faces into more regions changes nothing, with finer patches at the
// opening too; on one level, mirroring or exchanging axes mirrors the flow (claims: 1e-9
// of the speed). Where levels meet it does not quite, as interpolation from coarser faces
// prefers stencils towards the upper end (1.5e-3 here).

#include <algorithm>
#include <map>

#include <mitre/base/parameters.h>

#include "fluid_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

struct Condition
{
  std::string faces, region, type, values;
};

template <int dim>
fluid::BoundaryConditions<dim>
make_conditions(const std::vector<Condition> &list)
{
  std::string names, sections;
  for (unsigned int i = 0; i < list.size(); ++i)
    {
      const std::string name = "number " + std::to_string(i);
      names += (i == 0 ? "" : ", ") + name;
      sections += "subsection Condition " + name + "\n  set Faces = " + list[i].faces +
                  "\n  set Region = " + list[i].region +
                  "\n  set Type = " + list[i].type + "\n" + list[i].values + "end\n";
    }
  ParameterHandler prm;
  base::parse_parameter_text(prm,
                             "set Conditions = " + names + "\n" + sections,
                             "test",
                             fluid::BoundaryConditions<dim>::declare_parameters);
  fluid::BoundaryConditions<dim> conditions;
  conditions.parse_parameters(prm);
  return conditions;
}

/// Velocity condition with the components as expressions.
std::string
velocity(const std::vector<std::string> &components)
{
  std::string text;
  for (unsigned int c = 0; c < components.size(); ++c)
    text += std::string("  set Velocity ") + "xyz"[c] + " = " + components[c] + "\n";
  return text;
}

/// The text with the axes exchanged: what is said of x holds for y and so on.
std::string
permuted(std::string text, const std::string &axes)
{
  std::string result;
  const auto is_letter = [](const char c) { return std::isalpha(c) != 0; };
  for (unsigned int i = 0; i < text.size(); ++i)
    {
      const bool alone = (i == 0 || !is_letter(text[i - 1])) &&
                         (i + 1 == text.size() || !is_letter(text[i + 1]));
      const auto at = std::string("xyz").find(text[i]);
      result +=
        (alone && at != std::string::npos && at < axes.size() ? axes[at] : text[i]);
    }
  return result;
}

std::vector<Condition>
permuted(const std::vector<Condition> &list, const std::string &axes)
{
  std::vector<Condition> result;
  for (const Condition &condition : list)
    result.push_back({permuted(condition.faces, axes),
                      permuted(condition.region, axes),
                      condition.type,
                      permuted(condition.values, axes)});
  return result;
}

/// A flow given in coordinates whose axis d is the box's axis axes[d].
template <int dim>
struct Flow
{
  std::vector<Condition> conditions;
  std::function<double(const Point<dim> &, unsigned int, double)> velocity;
  std::function<double(const Point<dim> &, double)> pressure; // may be empty
  std::function<double(unsigned int)> force;
};

template <int dim>
void
check(const std::string &name, const Flow<dim> &exact, const unsigned int n_steps)
{
  std::string axes(&"xyz"[0], dim);
  double u_error = 0., p_error = 0.;
  do
    {
      // axis of the flow for each axis of the box
      std::array<unsigned int, dim> of_box;
      for (unsigned int d = 0; d < dim; ++d)
        of_box[axes[d] - 'x'] = d;
      const auto turned = [&](const Point<dim> &x) {
        Point<dim> y;
        for (unsigned int d = 0; d < dim; ++d)
          y[of_box[d]] = x[d];
        return y;
      };
      const auto conditions = make_conditions<dim>(permuted(exact.conditions, axes));
      grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, unit_box<dim>(16, 1, ""));
      fluid::FluidParameters parameters;
      parameters.density                   = 1.25;
      parameters.viscosity                 = 0.1;
      parameters.solver.relative_tolerance = 1e-12;
      fluid::NavierStokes<dim> flow(patch_grid, conditions, parameters);
      const auto velocity_at = [&](const double t) {
        return [&, t](const Point<dim> &x, const unsigned int c) {
          return exact.velocity(turned(x), of_box[c], t);
        };
      };
      flow.set_velocity(velocity_at(0.), 0.);
      grid::VectorType force;
      flow.operators().initialize_velocity(force);
      if (exact.force)
        interpolate(
          flow.space(),
          [&](const Point<dim> &, const unsigned int c) {
            return exact.force(of_box[c]);
          },
          force);
      const double dt = 0.02;
      for (unsigned int step = 0; step < n_steps; ++step)
        flow.advance(step * dt, dt, force);
      u_error = std::max(u_error, velocity_error(flow, velocity_at(n_steps * dt)));
      if (exact.pressure)
        p_error = std::max(p_error, pressure_error(flow, [&](const Point<dim> &x) {
                             return exact.pressure(turned(x), (n_steps - 0.5) * dt);
                           }));
  } while (std::next_permutation(axes.begin(), axes.end()));
  out() << dim << "D, " << name << ": velocity " << below(u_error, 1e-8);
  if (exact.pressure)
    out() << ", pressure " << below(p_error, 1e-8);
  out() << std::endl;
}

void
exact_flows_2d()
{
  check<2>("stagnation between symmetry planes",
           {{{"x min, y min", "1", "slip", ""},
             {"all", "1", "velocity", velocity({"(1+t/2)*x", "-(1+t/2)*y"})}},
            [](const Point<2> &x, const unsigned int c, const double t) {
              return (1. + 0.5 * t) * (c == 0 ? x[0] : -x[1]);
            },
            {},
            {}},
           10);
  // dp/dx = -1: U = t / rho
  check<2>(
    "plug, parts of the walls move",
    {{{"x min", "1", "pressure", "  set Pressure = 1\n"},
      {"x max", "1", "pressure", ""},
      {"y min, y max", "x > 0.4 && x + y < 1.7", "velocity", velocity({"t/1.25", "0"})},
      {"all", "1", "slip", ""}},
     [](const Point<2> &, const unsigned int c, const double t) {
       return c == 0 ? t / 1.25 : 0.;
     },
     [](const Point<2> &x, const double) { return 1. - x[0]; },
     {}},
    10);
  check<2>("Couette, parts of the ends open",
           {{{"x min", "y < 0.4", "velocity", velocity({"y", "0"})},
             {"x max", "y > 0.7", "velocity", velocity({"y", "0"})},
             {"x min, x max", "1", "pressure", ""},
             {"y max", "1", "velocity", velocity({"1", "0"})},
             {"y min", "1", "wall", ""}},
            [](const Point<2> &x, const unsigned int c, const double) {
              return c == 0 ? x[1] : 0.;
            },
            [](const Point<2> &, const double) { return 0.; },
            {}},
           10);
  check<2>("Poiseuille, part of the inlet open",
           {{{"x min", "y < 0.3", "velocity", velocity({"4*y*(1-y)", "0"})},
             {"x min, x max", "1", "pressure", "  set Pressure = 0.8*(1-x)\n"},
             {"y max", "x < 0.6", "velocity", velocity({"0", "0"})},
             {"y min, y max", "1", "wall", ""}},
            [](const Point<2> &x, const unsigned int c, const double) {
              return c == 0 ? 4. * x[1] * (1. - x[1]) : 0.;
            },
            [](const Point<2> &x, const double) { return 0.8 * (1. - x[0]); },
            {}},
           10);
  check<2>("fluid at rest",
           {{{"x max", "y > 0.3 && y < 0.8", "pressure", "  set Pressure = x+2*y\n"},
             {"y min", "x > 0.6", "pressure", "  set Pressure = x+2*y\n"},
             {"x min, y min", "x + y < 0.4", "slip", ""},
             {"all", "1", "wall", ""}},
            [](const Point<2> &, const unsigned int, const double) { return 0.; },
            [](const Point<2> &x, const double) { return x[0] + 2. * x[1]; },
            [](const unsigned int c) { return c + 1.; }},
           5);
}

void
exact_flows_3d()
{
  check<3>(
    "stagnation between symmetry planes",
    {{{"x min, y min, z min", "1", "slip", ""},
      {"all", "1", "velocity", velocity({"(1+t/2)*x", "(1+t/2)*y", "-2*(1+t/2)*z"})}},
     [](const Point<3> &x, const unsigned int c, const double t) {
       return (1. + 0.5 * t) * (c == 2 ? -2. * x[2] : x[c]);
     },
     {},
     {}},
    2);
  check<3>("plug, parts of the walls move",
           {{{"x min", "1", "pressure", "  set Pressure = 1\n"},
             {"x max", "1", "pressure", ""},
             {"y min, z max",
              "x > 0.4 && y + z < 1.3",
              "velocity",
              velocity({"t/1.25", "0", "0"})},
             {"all", "1", "slip", ""}},
            [](const Point<3> &, const unsigned int c, const double t) {
              return c == 0 ? t / 1.25 : 0.;
            },
            [](const Point<3> &x, const double) { return 1. - x[0]; },
            {}},
           2);
  check<3>("Couette, parts of the ends open",
           {{{"x min", "y < 0.4 && z < 0.6", "velocity", velocity({"y", "0", "0"})},
             {"x max", "y + z > 0.9", "velocity", velocity({"y", "0", "0"})},
             {"x min, x max", "1", "pressure", ""},
             {"y max", "1", "velocity", velocity({"1", "0", "0"})},
             {"z max", "x < 0.5", "velocity", velocity({"y", "0", "0"})},
             {"y min", "1", "wall", ""},
             {"z min, z max", "1", "slip", ""}},
            [](const Point<3> &x, const unsigned int c, const double) {
              return c == 0 ? x[1] : 0.;
            },
            [](const Point<3> &, const double) { return 0.; },
            {}},
           2);
  check<3>("fluid at rest",
           {{{"x max, z max",
              "y > 0.3 && x + z > 1.4",
              "pressure",
              "  set Pressure = x+2*y+3*z\n"},
             {"x min, y min", "x + y < 0.4 && z < 0.5", "slip", ""},
             {"all", "1", "wall", ""}},
            [](const Point<3> &, const unsigned int, const double) { return 0.; },
            [](const Point<3> &x, const double) { return x[0] + 2. * x[1] + 3. * x[2]; },
            [](const unsigned int c) { return c + 1.; }},
           2);
}

/// How a flow lies in the box: coordinate @p d of the flow is that along axes[d], counted
/// from the upper end if mirrored[d].
template <int dim>
struct Placement
{
  std::string axes;
  std::array<bool, dim> mirrored;
};

/// Speeds of the flow through an inlet, in the flow's coordinates: by component and
/// place.
template <int dim>
std::map<std::array<int, dim + 1>, double>
jet(const Placement<dim> &placement, const bool divided, const bool refined)
{
  const auto face = [&](const unsigned int d, const bool upper) {
    return std::string(1, placement.axes[d]) +
           (upper != placement.mirrored[d] ? " max" : " min");
  };
  const auto place = [&](const unsigned int d) {
    return placement.mirrored[d] ? "(1-" + std::string(1, placement.axes[d]) + ")"
                                 : std::string(1, placement.axes[d]);
  };
  std::vector<std::string> inflow(dim, "0");
  inflow[placement.axes[0] - 'x'] = (placement.mirrored[0] ? "-1" : "1");
  const std::string inlet         = place(1) + " > 0.3 && " + place(1) + " < 0.6" +
                            (dim == 3 ? " && " + place(2) + " < 0.4" : std::string()),
                    outlet    = place(0) + " > 0.6";
  std::vector<Condition> list = {
    {face(0, false), inlet, "velocity", velocity(inflow)},
    {face(1, true), outlet, "pressure", "  set Pressure = 1\n"},
    {face(1, false), place(0) + " < 0.5", "slip", ""},
    {"all", "1", "wall", ""}};
  if (divided)
    {
      std::vector<Condition> parts;
      for (Condition condition : list)
        {
          const std::string region = condition.region;
          condition.region = region + " && " + place(0) + " + " + place(1) + " < 0.9";
          parts.push_back(condition);
          condition.region = region + " && " + place(0) + " < 0.7";
          parts.push_back(condition);
          condition.region = region;
          parts.push_back(condition);
        }
      list = parts;
    }
  const auto conditions = make_conditions<dim>(list);

  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, unit_box<dim>(16, refined ? 2 : 1, ""));
  const auto turned = [&](const Point<dim> &x) {
    Point<dim> y;
    for (unsigned int d = 0; d < dim; ++d)
      {
        y[d] = x[placement.axes[d] - 'x'];
        if (placement.mirrored[d])
          y[d] = 1. - y[d];
      }
    return y;
  };
  if (refined)
    patch_grid.adapt([&](const BoundingBox<dim> &box) {
      const Point<dim> x = turned(box.center());
      return x[0] > 0.5 && x[1] > 0.5 ? 2 : 1;
    });
  fluid::FluidParameters parameters;
  parameters.viscosity                 = 0.02;
  parameters.solver.relative_tolerance = 1e-12;
  fluid::NavierStokes<dim> flow(patch_grid, conditions, parameters);
  grid::VectorType force;
  flow.operators().initialize_velocity(force);
  for (unsigned int step = 0; step < (dim == 2 ? 20 : 4); ++step)
    flow.advance(0.02 * step, 0.02, force);

  std::map<std::array<int, dim + 1>, double> result;
  for_each_face(flow.space(),
                [&](const std::size_t entry,
                    const unsigned int,
                    const unsigned int c,
                    const Point<dim> &x) {
                  const Point<dim> y = turned(x);
                  std::array<int, dim + 1> key;
                  for (unsigned int d = 0; d < dim; ++d)
                    key[d] = std::lround(y[d] * 128.);
                  const unsigned int component =
                    placement.axes.find(static_cast<char>('x' + c));
                  key[dim]    = component;
                  result[key] = (placement.mirrored[component] ? -1. : 1.) *
                                flow.velocity().local_element(entry);
                });
  return result;
}

template <int dim>
double
difference(const std::map<std::array<int, dim + 1>, double> &a,
           const std::map<std::array<int, dim + 1>, double> &b)
{
  double largest = (a.size() == b.size() ? 0. : 1e300);
  for (const auto &[key, value] : a)
    {
      const auto other = b.find(key);
      largest =
        std::max(largest, other == b.end() ? 1e300 : std::abs(value - other->second));
    }
  return largest;
}

template <int dim>
void
check_jet(const bool refined)
{
  std::string axes(&"xyz"[0], dim);
  const auto reference = jet<dim>({axes, {}}, false, refined);
  double speed         = 0.;
  for (const auto &[key, value] : reference)
    if (key[dim] == 1)
      speed = std::max(speed, std::abs(value));
  const double of_regions =
    difference<dim>(reference, jet<dim>({axes, {}}, true, refined));
  double of_place = 0.;
  if (!refined)
    {
      unsigned int k = 0;
      do
        {
          // every order of the axes, with different ones mirrored; then all mirrored
          Placement<dim> placement{axes, {}};
          ++k;
          for (unsigned int d = 0; d < dim; ++d)
            placement.mirrored[d] = (k >> d) & 1;
          of_place = std::max(
            of_place, difference<dim>(reference, jet<dim>(placement, false, false)));
      } while (std::next_permutation(axes.begin(), axes.end()));
      Placement<dim> placement{axes, {}};
      placement.mirrored.fill(true);
      of_place =
        std::max(of_place, difference<dim>(reference, jet<dim>(placement, false, false)));
    }
  out() << dim << "D, jet" << (refined ? ", refined" : "") << ": turns "
        << above(speed, 0.05) << ", divided faces " << below(of_regions, 1e-9)
        << (refined ? std::string()
                    : ", mirrored and exchanged axes " + below(of_place, 1e-9))
        << std::endl;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  exact_flows_2d();
  exact_flows_3d();
  for (const bool refined : {false, true})
    check_jet<2>(refined);
  check_jet<3>(false);
}
