// The flow of a linear, divergence-free velocity through a whole cross-section is its
// integral, for the sum over faces with the values at their centres integrates it
// exactly: 3 + (dim-1) x + 1/4 through the plane x, and -2 y through the plane y. Planes
// are those of the coarsest cells (of width 1/16) that are nearest to the position,
// whatever the levels that they cross, and at the ends of the box too. Through a disc in
// a uniform stream of 3 flows 3 times the area of the faces whose centres it holds: four
// coarse faces in 3D (two in 2D), and, around an edge of the refined region, two coarse
// and six fine ones (one and two).

#include <mitre/instruments/flow_meter.h>

#include "instrument_tests.h"

using namespace instrument_tests;

template <int dim>
void
test()
{
  const Velocity<dim> velocity = [](const Point<dim> &x, const unsigned int c, double) {
    return linear_velocity(x, c);
  };
  Case<dim> linear(velocity);
  linear.fluid->set_velocity(linear_velocity<dim>, 0.);

  const auto flow = [](const Case<dim> &c, const instruments::MeasuringDisc<dim> &disc) {
    return instruments::compute_flow(
      disc, c.fluid->space(), c.fluid->velocity(), "meter");
  };
  const auto plane = [](const unsigned int axis, const double position) {
    instruments::MeasuringDisc<dim> disc;
    disc.axis     = axis;
    disc.position = position;
    return disc;
  };

  if (prints())
    std::cout << dim << "D" << std::endl;
  // position and where the plane is
  for (const auto &[position, x] : {std::make_pair(0., 0.),
                                    std::make_pair(0.26, 0.25),
                                    std::make_pair(0.5, 0.5),
                                    std::make_pair(0.77, 0.75),
                                    std::make_pair(0.79, 0.8125),
                                    std::make_pair(1.0, 1.0),
                                    std::make_pair(1.5, 1.5),
                                    std::make_pair(1.99, 2.0),
                                    std::make_pair(2.0, 2.0)})
    check("through x = " + std::to_string(x),
          flow(linear, plane(0, position)),
          3. + (dim - 1.) * x + 0.25,
          1e-12);
  for (const auto &[position, y] : {std::make_pair(0.46, 0.4375),
                                    std::make_pair(0.47, 0.5),
                                    std::make_pair(0.5, 0.5),
                                    std::make_pair(1.0, 1.0)})
    check("through y = " + std::to_string(y),
          flow(linear, plane(1, position)),
          -2. * y,
          1e-12);

  const Velocity<dim> stream = [](const Point<dim> &, const unsigned int c, double) {
    return c == 0 ? 3. : 0.;
  };
  Case<dim> uniform(stream);
  uniform.fluid->set_velocity(
    [&](const Point<dim> &x, const unsigned int c) { return stream(x, c, 0.); }, 0.);
  instruments::MeasuringDisc<dim> disc = plane(0, 0.1);
  for (unsigned int d = 1; d < dim; ++d)
    disc.centre[d] = 0.5;
  disc.radius = 0.06;
  check("through a disc on coarse cells",
        flow(uniform, disc),
        3. * (dim == 2 ? 2. / 16. : 4. / 256.),
        1e-13);
  disc.position = 1.;
  disc.radius   = 0.05;
  check("through a disc on two levels",
        flow(uniform, disc),
        3. * (dim == 2 ? 1. / 16. + 2. / 32. : 2. / 256. + 6. / 1024.),
        1e-13);
  disc.radius = 0.01;
  expect_error([&]() { flow(uniform, disc); });
  expect_error([&]() { flow(uniform, plane(1, 1.5)); });
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test<2>();
  test<3>();
}
