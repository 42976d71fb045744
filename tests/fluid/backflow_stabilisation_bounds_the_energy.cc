// A box whose right side is open at pressure 0, with a narrow jet that enters there and
// leaves on both sides of itself more slowly, so that more kinetic energy comes in than
// goes out. The boundary does no work, as the flow through it adds up to nothing, and yet
// the jet feeds itself: without stabilisation the energy grows. With it (beta = 1) the
// energy never exceeds that of the beginning, as it should without anything to drive the
// flow. The advection is centered, so that it does not damp.

#include <mitre/fluid/boundary_conditions/pressure.h>

#include "fluid_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

namespace
{
  std::shared_ptr<const fluid::BoundaryCondition<2>> open_side(const std::string &beta)
  {
    ParameterHandler prm;
    fluid::PressureCondition<2>::declare_parameters(prm);
    prm.set("Backflow stabilisation", beta);
    auto condition = std::make_shared<fluid::PressureCondition<2>>();
    condition->parse_parameters(prm, "open");
    return condition;
  }

  /// Largest kinetic energy over a number of steps, divided by that of the beginning.
  double growth(const std::string &beta)
  {
    grid::PatchGrid<2> patch_grid(MPI_COMM_WORLD, unit_box<2>(32, 1, ""));
    fluid::BoundaryConditions<2> conditions;
    conditions.add("open", {1}, open_side(beta));
    conditions.add("walls", {0, 2, 3}, slip<2>());
    fluid::FluidParameters parameters;
    parameters.viscosity                 = 2e-3;
    parameters.advection                 = fluid::AdvectionScheme::centered;
    parameters.solver.relative_tolerance = 1e-8;
    fluid::NavierStokes<2> flow(patch_grid, conditions, parameters);

    // u = f(x) g'(y), v = -f'(x) g(y) with f = x^2 and g' = a - exp(-((y - 1/2)/w)^2)
    const double w = 0.12, half = 0.5 * std::sqrt(numbers::PI) * w;
    const double a  = 2. * half * std::erf(0.5 / w);
    const auto jump = [&](const Point<2> &x, const unsigned int c) {
      const double y = x[1] - 0.5;
      return c == 0 ? x[0] * x[0] * (a - std::exp(-y * y / (w * w)))
                    : -2. * x[0] * (a * y - half * std::erf(y / w));
    };
    flow.set_velocity(jump, 0.);
    grid::VectorType force;
    flow.operators().initialize_velocity(force);

    const auto energy = [&]() {
      double sum = 0.;
      for_each_face(flow.space(),
                    [&](const std::size_t entry,
                        const unsigned int,
                        const unsigned int,
                        const Point<2> &) {
                      const double u = flow.velocity().local_element(entry);
                      sum += 0.5 * flow.space().volumes().local_element(entry) * u * u;
                    });
      return Utilities::MPI::sum(sum, MPI_COMM_WORLD);
    };
    const double start = energy();
    double largest     = 0.;
    const double dt    = 0.005;
    for (unsigned int step = 0; step < 800 && largest < 10.; ++step)
      {
        flow.advance(step * dt, dt, force);
        largest = std::max(largest, energy() / start);
      }
    return largest;
  }
} // namespace

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  out() << "without: energy grows by " << above(growth("0"), 2.) << std::endl
        << "with: energy grows by " << below(growth("1"), 1.) << std::endl;
}
