// The transport of one velocity component by a uniform stream, which is an exact inviscid
// flow without pressure: u = (U, v(x - U t)), and in 3D obliquely (U, V, w(x - U t, y - V
// t)).
//
// Order: a sine, steps of third order (Shu and Osher's) so that the error is the
// schemes'. The divergence is of fourth (PPM), third (CUI) and second order (centered)
// away from extrema. PPM keeps these; with monotone PPM and CUI limiters flatten the sine
// there, which leaves 2.2 and 2.3 in L1, 2.0 in L2 and 1.8 and 1.6 at the worst face.
//
// Boundedness: a square wave gets no new extrema with Adams-Bashforth steps up to a
// Courant number (summed over directions) of 4/9 * 1/3 = 0.148, see fluid::Advection;
// 0.14 is checked, to round-off. Centered differences, and monotone PPM with a Courant
// number of 0.5, overshoot, which shows that the check can fail.
//
// Neither the direction of the stream nor its sign nor the component matter.
//
// The sum of momentum over a periodic box with refined parts stays, for any velocity,
// to round-off.
//
// A doubly periodic shear layer (Bell, Colella and Glaz, J. Comput. Phys. 85 (1989)
// 257-283: tanh profiles of width 1/30, disturbance 0.05), without viscosity: with PPM
// the kinetic energy does not exceed that at the start (but for 2e-7 in the first steps),
// and until t = 0.4, when the strips between the vortices become too thin for the grid,
// the vorticity exceeds its first extrema by 8 % at most on 64 x 64 cells (measured
// 7.2 %), not at all on 128 x 128. With centered differences the energy grows in every
// step, and the vorticity by 12 %.

#include "momentum.h"

using namespace grid_tests;
using namespace fluid_tests;

/// A periodic box of n cells and length 1 in the directions that @p axes names, of 16
/// cells of the same size in the others.
template <int dim>
grid::PatchGridParameters<dim>
channel(const unsigned int n, const std::string &axes)
{
  grid::PatchGridParameters<dim> parameters = unit_box<dim>(8, 1, "xyz");
  for (unsigned int d = 0; d < dim; ++d)
    {
      const bool is_long         = axes.find("xyz"[d]) != std::string::npos;
      parameters.base_patches[d] = is_long ? n / 8 : 2;
      parameters.upper[d]        = is_long ? 1. : 16. / n;
    }
  return parameters;
}

enum class Stepping
{
  runge_kutta,
  adams_bashforth
};

template <int dim>
class Transport
{
public:
  Transport(const unsigned int n,
            const std::string &axes,
            const fluid::AdvectionScheme scheme)
    : patch_grid(MPI_COMM_WORLD, channel<dim>(n, axes))
    , space(patch_grid, all_sides<dim>(grid::BoundaryKind::velocity))
    , operators(space)
    , advection(space, scheme)
  {
    for (grid::VectorType *v : {&u, &start, &rate, &old_rate})
      space.initialize_vector(*v);
  }

  void run(const std::function<double(const Point<dim> &, unsigned int)> &initial,
           const Stepping stepping,
           const double dt,
           const unsigned int n_steps)
  {
    interpolate(space, initial, u);
    for (unsigned int step = 0; step < n_steps; ++step)
      if (stepping == Stepping::runge_kutta)
        {
          start = u;
          euler(dt);
          euler(dt);
          u.sadd(0.25, 0.75, start);
          euler(dt);
          u.sadd(2. / 3., 1. / 3., start);
        }
      else
        {
          advection.apply(rate, u);
          u.add(step == 0 ? -dt : -1.5 * dt, rate);
          if (step > 0)
            u.add(0.5 * dt, old_rate);
          old_rate.swap(rate);
        }
  }

  struct Errors
  {
    double l1, l2, max;
  };

  Errors
  errors(const std::function<double(const Point<dim> &, unsigned int)> &exact) const
  {
    double sum = 0., squares = 0., largest = 0., volume = 0.;
    for_each_face(space,
                  [&](const std::size_t entry,
                      const unsigned int,
                      const unsigned int c,
                      const Point<dim> &x) {
                    const double w = space.volumes().local_element(entry) / dim;
                    const double error =
                      w == 0. ? 0. : std::abs(u.local_element(entry) - exact(x, c));
                    sum += w * error;
                    squares += w * error * error;
                    largest = std::max(largest, error);
                    volume += w;
                  });
    volume = Utilities::MPI::sum(volume, MPI_COMM_WORLD);
    return {Utilities::MPI::sum(sum, MPI_COMM_WORLD) / volume,
            std::sqrt(Utilities::MPI::sum(squares, MPI_COMM_WORLD) / volume),
            Utilities::MPI::max(largest, MPI_COMM_WORLD)};
  }

  /// Largest error of the divergence of a sine where it is less than half its amplitude.
  double divergence_error()
  {
    const auto sine = [](const Point<dim> &x, const unsigned int c) {
      return c == 0 ? 1. : std::sin(2. * numbers::PI * x[0]);
    };
    interpolate(space, sine, u);
    advection.apply(rate, u);
    double largest = 0.;
    for_each_face(space,
                  [&](const std::size_t entry,
                      const unsigned int,
                      const unsigned int c,
                      const Point<dim> &x) {
                    if (c == 1 && std::abs(sine(x, c)) < 0.5)
                      largest = std::max(
                        largest,
                        std::abs(rate.local_element(entry) -
                                 2. * numbers::PI * std::cos(2. * numbers::PI * x[0])));
                  });
    return Utilities::MPI::max(largest, MPI_COMM_WORLD);
  }

  /// How far component @p c leaves the interval (-1, 1).
  double overshoot(const unsigned int component) const
  {
    double largest = 0.;
    for_each_face(space,
                  [&](const std::size_t entry,
                      const unsigned int,
                      const unsigned int c,
                      const Point<dim> &) {
                    if (c == component)
                      largest = std::max(largest, std::abs(u.local_element(entry)) - 1.);
                  });
    return Utilities::MPI::max(largest, MPI_COMM_WORLD);
  }

private:
  void euler(const double dt)
  {
    advection.apply(rate, u);
    u.add(-dt, rate);
  }

  grid::PatchGrid<dim> patch_grid;
  grid::StaggeredSpace<dim> space;
  fluid::StokesOperators<dim> operators;
  fluid::Advection<dim> advection;
  grid::VectorType u, start, rate, old_rate;
};

/// Component @p carried is transported along @p axis with speed @p speed.
template <int dim>
std::function<double(const Point<dim> &, unsigned int)>
sine_wave(const unsigned int axis,
          const unsigned int carried,
          const double speed,
          const double t)
{
  return [=](const Point<dim> &x, const unsigned int c) {
    return c == axis      ? speed
           : c == carried ? std::sin(2. * numbers::PI * (x[axis] - speed * t))
                          : 0.;
  };
}

template <int dim>
std::function<double(const Point<dim> &, unsigned int)>
square_wave(const unsigned int axis, const unsigned int carried, const double speed)
{
  return [=](const Point<dim> &x, const unsigned int c) {
    return c == axis      ? speed
           : c == carried ? (std::abs(x[axis] - 0.5) < 0.2 ? 1. : -1.)
                          : 0.;
  };
}

void
check_order(const std::string &name, const std::array<double, 4> &least)
{
  std::array<Transport<2>::Errors, 2> errors;
  std::array<double, 2> divergence;
  const double time = 0.5;
  for (unsigned int k = 0; k < 2; ++k)
    {
      const unsigned int n = 64 << k, steps = n * 2;
      Transport<2> transport(n, "x", fluid::advection_scheme(name));
      transport.run(
        sine_wave<2>(0, 1, 1., 0.), Stepping::runge_kutta, time / steps, steps);
      errors[k]     = transport.errors(sine_wave<2>(0, 1, 1., time));
      divergence[k] = transport.divergence_error();
    }
  out() << name << ": order in L1 "
        << above(std::log2(errors[0].l1 / errors[1].l1), least[0]) << ", L2 "
        << above(std::log2(errors[0].l2 / errors[1].l2), least[1]) << ", maximum "
        << above(std::log2(errors[0].max / errors[1].max), least[2])
        << ", of the divergence away from extrema "
        << above(std::log2(divergence[0] / divergence[1]), least[3]) << std::endl;
}

double
overshoot_1d(const std::string &name, const double courant, const double speed)
{
  const unsigned int n = 64;
  Transport<2> transport(n, "x", fluid::advection_scheme(name));
  const unsigned int steps = std::lround(n / courant);
  transport.run(
    square_wave<2>(0, 1, speed), Stepping::adams_bashforth, 1. / steps, steps);
  return transport.overshoot(1);
}

/// A column with a square base in an oblique stream.
double
overshoot_oblique(const std::string &name, const double courant, const double sign)
{
  const unsigned int n = 32;
  const double u = sign, v = -0.6 * sign;
  Transport<3> transport(n, "xy", fluid::advection_scheme(name));
  const double dt = courant / n / (std::abs(u) + std::abs(v));
  transport.run(
    [&](const Point<3> &x, const unsigned int c) {
      return c == 0                                                       ? u
             : c == 1                                                     ? v
             : std::abs(x[0] - 0.5) < 0.25 && std::abs(x[1] - 0.5) < 0.25 ? 1.
                                                                          : -1.;
    },
    Stepping::adams_bashforth,
    dt,
    std::lround(0.5 / dt));
  return transport.overshoot(2);
}

/// Spread of the errors of a square wave over all axes, components and signs.
double
asymmetry(const std::string &name)
{
  double least = 1e300, most = 0.;
  for (unsigned int axis = 0; axis < 3; ++axis)
    {
      Transport<3> transport(
        32, std::string(1, "xyz"[axis]), fluid::advection_scheme(name));
      for (unsigned int carried = 0; carried < 3; ++carried)
        for (const double speed : {1., -1.})
          if (carried != axis)
            {
              transport.run(square_wave<3>(axis, carried, speed),
                            Stepping::runge_kutta,
                            0.25 / 32,
                            20);
              const double error =
                transport.errors(square_wave<3>(axis, carried, speed)).l1;
              least = std::min(least, error);
              most  = std::max(most, error);
            }
    }
  return (most - least) / most;
}

/// Change of momentum by advection in a periodic box, relative to the sum of what all
/// control volumes gain or lose.
template <int dim>
double
momentum_change(const std::string &name, const unsigned int levels)
{
  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD,
                                  unit_box<dim>(dim == 2 ? 32 : 16, levels, "xyz"));
  patch_grid.adapt(refine_ball(patch_grid, diagonal_point<dim>(0.4), 0.1));
  grid::StaggeredSpace<dim> space(patch_grid,
                                  all_sides<dim>(grid::BoundaryKind::velocity));
  fluid::StokesOperators<dim> operators(space);
  fluid::Advection<dim> advection(space, fluid::advection_scheme(name));
  grid::VectorType u, rate;
  space.initialize_vector(u);
  space.initialize_vector(rate);
  interpolate(space, noise<dim>, u);
  advection.apply(rate, u);
  return relative_momentum(space, rate);
}

struct ShearLayer
{
  double energy_growth, vorticity_growth; ///< over the start, largest at any time
};

ShearLayer
shear_layer(const std::string &name, const unsigned int n, const double end_time)
{
  grid::PatchGrid<2> patch_grid(MPI_COMM_WORLD, unit_box<2>(n, 1, "xy"));
  fluid::FluidParameters parameters;
  parameters.viscosity                 = 0.;
  parameters.advection                 = fluid::advection_scheme(name);
  parameters.solver.relative_tolerance = 1e-7;
  fluid::BoundaryConditions<2> none;
  fluid::NavierStokes<2> flow(patch_grid, none, parameters);
  flow.set_velocity(
    [](const Point<2> &x, const unsigned int c) {
      return c == 0 ? std::tanh(30. * (x[1] < 0.5 ? x[1] - 0.25 : 0.75 - x[1]))
                    : 0.05 * std::sin(2. * numbers::PI * x[0]);
    },
    0.);
  const auto &space = flow.space();
  grid::VelocityHalo<2> halo(
    space, 1, grid::HaloShape::star, grid::BoundaryExtension::reflection);
  halo.make_own_partitioner();

  const auto energy = [&]() {
    double sum = 0.;
    for (unsigned int i = 0; i < flow.velocity().locally_owned_size(); ++i)
      {
        const double u = flow.velocity().local_element(i);
        sum += 0.5 * space.volumes().local_element(i) * u * u;
      }
    return Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  };
  // largest |dv/dx - du/dy|, at the corners of cells; the first extrema are opposite
  const auto vorticity = [&]() {
    const grid::VectorType &u = halo.import(flow.velocity());
    std::array<std::vector<double>, 2> padded;
    for (unsigned int c = 0; c < 2; ++c)
      padded[c].resize(halo.size(c));
    double largest = 0.;
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        const auto &h = patch_grid.patch(p).h;
        for (unsigned int c = 0; c < 2; ++c)
          halo.gather(u, p, c, padded[c].data());
        for (unsigned int j = 1; j < 9; ++j)
          for (unsigned int i = 1; i < 9; ++i)
            {
              // the corner below and to the left of cell (i, j)
              const double *at_u = padded[0].data() + i + j * 11,
                           *at_v = padded[1].data() + i + j * 10;
              largest            = std::max(largest,
                                 std::abs((at_v[0] - *(at_v - 1)) / h[0] -
                                          (at_u[0] - *(at_u - 11)) / h[1]));
            }
      }
    return Utilities::MPI::max(largest, MPI_COMM_WORLD);
  };

  const double first_energy = energy(), first_vorticity = vorticity();
  const unsigned int steps = std::lround(end_time * n / 0.3);
  grid::VectorType force;
  flow.operators().initialize_velocity(force);
  ShearLayer result{-1., -1.};
  for (unsigned int step = 0; step < steps; ++step)
    {
      flow.advance(step * end_time / steps, end_time / steps, force);
      result.energy_growth = std::max(result.energy_growth, energy() / first_energy - 1.);
      result.vorticity_growth =
        std::max(result.vorticity_growth, vorticity() / first_vorticity - 1.);
    }
  return result;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_order("PPM", {{3.8, 3.8, 3.8, 3.8}});
  check_order("monotone PPM", {{2., 1.8, 1.6, 3.8}});
  check_order("CUI", {{2., 1.8, 1.4, 2.8}});
  check_order("centered", {{1.9, 1.9, 1.9, 1.9}});

  for (const std::string name : {"PPM", "monotone PPM", "CUI"})
    {
      out() << name << ", square wave: overshoot "
            << below(
                 std::max(overshoot_1d(name, 0.14, 1.), overshoot_1d(name, 0.14, -1.)),
                 1e-12)
            << ", oblique "
            << below(std::max(overshoot_oblique(name, 0.14, 1.),
                              overshoot_oblique(name, 0.14, -1.)),
                     1e-12)
            << ", asymmetry " << below(asymmetry(name), 1e-12) << std::endl;
    }
  out() << "square wave, centered: overshoot "
        << above(overshoot_1d("centered", 0.14, 1.), 0.2)
        << ", monotone PPM with Courant number 0.5: "
        << above(overshoot_1d("monotone PPM", 0.5, 1.), 0.2) << std::endl;

  for (const std::string name : {"PPM", "monotone PPM", "CUI", "centered"})
    out() << name << ", change of momentum where levels meet: 2D "
          << below(std::max(momentum_change<2>(name, 2), momentum_change<2>(name, 3)),
                   1e-13)
          << ", 3D " << below(momentum_change<3>(name, 2), 1e-13) << std::endl;

  for (const unsigned int n : {64, 128})
    {
      const ShearLayer layer = shear_layer("PPM", n, 0.4);
      out() << "shear layer, " << n << " cells, PPM: growth of energy "
            << below(layer.energy_growth, 1e-6) << ", of vorticity "
            << below(layer.vorticity_growth, n == 64 ? 0.08 : 0.001) << std::endl;
    }
  const ShearLayer layer = shear_layer("centered", 64, 0.4);
  out() << "shear layer, 64 cells, centered: growth of energy "
        << above(layer.energy_growth, 1e-6) << ", of vorticity "
        << above(layer.vorticity_growth, 0.1) << std::endl;
}
