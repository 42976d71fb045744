// The mean of the pressure p = 2 + 3 x - y (+ 4 z) over a cross-section at x is its value
// in the middle of the cross-section, and over one at y that in the middle at y: the mean
// over cell columns and the straight line along the axis are exact for linear functions,
// on any levels, at the sides of patches and at the ends of the box. So is that over a
// disc around which cells lie symmetrically. The pressure at points is exact too,
// wherever they lie, and at two points outside of the box it is not a number.

#include <mitre/instruments/pressure_point.h>
#include <mitre/instruments/pressure_station.h>

#include "instrument_tests.h"

using namespace instrument_tests;

template <int dim>
double
pressure(const Point<dim> &x)
{
  return 2. + 3. * x[0] - x[1] + (dim == 3 ? 4. * x[dim - 1] : 0.);
}

template <int dim>
void
test()
{
  Case<dim> flow([](const Point<dim> &, const unsigned int, double) { return 0.; });
  grid::VectorType p;
  flow.fluid->operators().initialize_pressure(p);
  const unsigned int n       = flow.patch_grid.n_cells_per_side();
  const unsigned int n_cells = dealii::Utilities::fixed_power<dim>(n);
  for (unsigned int q = 0; q < flow.patch_grid.n_owned_patches(); ++q)
    for (unsigned int i = 0; i < n_cells; ++i)
      {
        const auto &patch = flow.patch_grid.patch(q);
        Point<dim> x;
        unsigned int rest = i;
        for (unsigned int d = 0; d < dim; ++d)
          {
            x[d] = patch.lower[d] + (rest % n + 0.5) * patch.h[d];
            rest /= n;
          }
        p.local_element(q * n_cells + i) = pressure(x);
      }

  if (prints())
    std::cout << dim << "D" << std::endl;
  instruments::MeasuringDisc<dim> disc;
  const auto mean = [&]() {
    return instruments::compute_mean_pressure(disc, flow.patch_grid, p, "station");
  };
  Point<dim> middle;
  middle[0] = 1.;
  for (unsigned int d = 1; d < dim; ++d)
    middle[d] = 0.5;
  for (const auto &[axis, position] : {std::make_pair(0u, 0.),
                                       std::make_pair(0u, 0.37),
                                       std::make_pair(0u, 0.5),
                                       std::make_pair(0u, 0.51),
                                       std::make_pair(0u, 1.25),
                                       std::make_pair(0u, 1.499),
                                       std::make_pair(0u, 2.),
                                       std::make_pair(1u, 0.2),
                                       std::make_pair(1u, 0.5),
                                       std::make_pair(1u, 0.497)})
    {
      disc.axis     = axis;
      disc.position = position;
      Point<dim> x  = middle;
      x[axis]       = position;
      check(std::string("mean at ") + "xyz"[axis] + " = " + std::to_string(position),
            mean(),
            pressure(x),
            1e-12);
    }

  disc.axis     = 0;
  disc.position = 0.4;
  disc.centre   = middle;
  disc.radius   = 0.2;
  middle[0]     = 0.4;
  check("mean over a disc", mean(), pressure(middle), 1e-12);
  disc.radius = 1e-3;
  expect_error(mean);

  unsigned int n_nan = 0;
  for (const auto &[x, y] : {std::make_pair(0., 0.),
                             std::make_pair(2., 1.),
                             std::make_pair(0.5, 0.5),
                             std::make_pair(0.499, 0.501),
                             std::make_pair(1.013, 0.27),
                             std::make_pair(1.5, 0.25),
                             std::make_pair(-1e-3, 0.5),
                             std::make_pair(1., 1.001)})
    {
      middle[0]          = x;
      middle[1]          = y;
      const double found = instruments::compute_pressure_at(middle, flow.patch_grid, p);
      if (std::isnan(found))
        ++n_nan;
      else
        check("pressure at (" + std::to_string(x) + ", " + std::to_string(y) + ")",
              found,
              pressure(middle),
              1e-12);
    }
  check("points outside", n_nan, 2, 0);
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test<2>();
  test<3>();
}
