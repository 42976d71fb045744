// Where the grid changes, linear velocities and cell values are carried exactly (1e-13)
// on patches whose neighbourhood does not touch the boundary or another level, and
// quadratic ones with an error of second order (a multiple of h^2: order 2, claim 1.99,
// measured in 2D). A divergence-free velocity on a grid that becomes coarser everywhere
// stays so (means over faces); one that is carried to finer patches and back is what it
// was.

#include <mitre/fluid/stokes_operators.h>
#include <mitre/grid/solution_transfer.h>

#include "grid_tests.h"

using namespace grid_tests;

/// A grid with velocity and cell values on it that can be changed.
template <int dim>
struct State
{
  grid::PatchGrid<dim> patch_grid;
  const grid::BoundaryKinds<dim> kinds;
  std::unique_ptr<grid::StaggeredSpace<dim>> space;
  std::unique_ptr<fluid::StokesOperators<dim>> operators;
  grid::VectorType u, p;

  State(const grid::PatchGridParameters<dim> &parameters)
    : patch_grid(MPI_COMM_WORLD, parameters)
    , kinds(all_sides<dim>(grid::BoundaryKind::velocity))
  {
    setup();
  }

  void setup()
  {
    space     = std::make_unique<grid::StaggeredSpace<dim>>(patch_grid, kinds);
    operators = std::make_unique<fluid::StokesOperators<dim>>(*space);
    operators->initialize_velocity(u);
    operators->initialize_pressure(p);
  }

  template <typename Function>
  void set(const Function &function)
  {
    interpolate(*space, function, u);
    for_each_cell(patch_grid,
                  [&](const std::size_t entry,
                      const unsigned int,
                      const Point<dim> &x,
                      const double) { p.local_element(entry) = function(x, dim); });
  }

  void change(const std::function<int(const BoundingBox<dim> &)> &wanted_level)
  {
    std::unique_ptr<grid::SolutionTransfer<dim>> transfer;
    std::unique_ptr<grid::VelocityHalo<dim>> halo;
    patch_grid.adapt(
      wanted_level,
      [&] {
        halo = std::make_unique<grid::VelocityHalo<dim>>(
          *space, 1, grid::HaloShape::star, grid::BoundaryExtension::reflection);
        halo->make_own_partitioner();
        transfer = std::make_unique<grid::SolutionTransfer<dim>>(
          patch_grid,
          *space,
          *halo,
          operators->pressure_halo(),
          std::vector<grid::VectorType *>{&u},
          std::vector<grid::VectorType *>{&p});
      },
      [&](const bool changed) {
        if (changed)
          {
            const auto old_space     = std::move(space);
            const auto old_operators = std::move(operators);
            setup();
            transfer->finish(*space, {&u}, {&p});
          }
        else
          transfer->give_back();
        transfer.reset();
      });
  }

  /// Largest errors of velocity and cell values on patches in the middle of the box.
  template <typename Function>
  double error(const Function &function, const double half_width) const
  {
    double largest    = 0.;
    const auto inside = [&](const unsigned int p) {
      const auto &patch = patch_grid.patch(p);
      for (unsigned int d = 0; d < dim; ++d)
        if (std::abs(patch.lower[d] + 0.5 * patch.h[d] * patch_grid.n_cells_per_side() -
                     0.5) > half_width)
          return false;
      return true;
    };
    for_each_face(*space,
                  [&](const std::size_t entry,
                      const unsigned int p,
                      const unsigned int c,
                      const Point<dim> &x) {
                    if (inside(p))
                      largest = std::max(
                        largest, std::abs(u.local_element(entry) - function(x, c)));
                  });
    for_each_cell(patch_grid,
                  [&](const std::size_t entry,
                      const unsigned int q,
                      const Point<dim> &x,
                      const double) {
                    if (inside(q))
                      largest = std::max(
                        largest, std::abs(p.local_element(entry) - function(x, dim)));
                  });
    return Utilities::MPI::max(largest, MPI_COMM_WORLD);
  }
};

template <int dim>
void
check(const unsigned int n)
{
  const auto middle = [](const int low, const int high) {
    return [low, high](const BoundingBox<dim> &box) {
      for (unsigned int d = 0; d < dim; ++d)
        if (std::abs(box.center()[d] - 0.5) > 0.25)
          return low;
      return high;
    };
  };
  double finer_error[2] = {0., 0.}, coarser_error[2] = {0., 0.}, exact_error = 0.;
  for (unsigned int k = 0; k < (dim == 2 ? 2 : 1); ++k)
    {
      State<dim> state(unit_box<dim>(n << k, 2, ""));
      const int low = state.patch_grid.minimum_level();
      state.set(linear<dim>);
      state.change(middle(low, low + 1));
      exact_error = std::max(exact_error, state.error(linear<dim>, 0.25));
      state.set(linear<dim>);
      state.change([&](const BoundingBox<dim> &) { return low; });
      exact_error = std::max(exact_error, state.error(linear<dim>, 0.25));

      state.set(quadratic<dim>);
      state.change(middle(low, low + 1));
      finer_error[k] = state.error(quadratic<dim>, 0.25);
      state.set(quadratic<dim>);
      state.change([&](const BoundingBox<dim> &) { return low; });
      coarser_error[k] = state.error(quadratic<dim>, 0.25);
    }
  out() << dim << "D: linear " << below(exact_error, 1e-13) << std::endl;
  if (dim == 2)
    out() << "2D: order to finer patches "
          << above(std::log2(finer_error[0] / finer_error[1]), 1.99)
          << ", order to coarser patches "
          << above(std::log2(coarser_error[0] / coarser_error[1]), 1.99) << std::endl;

  // There and back, on a periodic box, with a stream of discretely zero divergence.
  State<dim> state(unit_box<dim>(n, 2, "xyz"));
  const int low     = state.patch_grid.minimum_level();
  const auto vortex = [](const Point<dim> &x, const unsigned int c) {
    const double k = 2. * numbers::PI;
    return c == 0   ? std::sin(k * x[0]) * std::cos(k * x[1])
           : c == 1 ? -std::cos(k * x[0]) * std::sin(k * x[1])
                    : std::sin(k * x[0] + 1.);
  };
  state.set(vortex);
  state.change(middle(low, low + 1));
  state.change([&](const BoundingBox<dim> &) { return low; });
  out() << dim << "D: there and back " << below(state.error(vortex, 1.), 1e-13)
        << std::endl;
  State<dim> fine(unit_box<dim>(n, 2, "xyz"));
  fine.change([&](const BoundingBox<dim> &) { return low + 1; });
  fine.set(vortex);
  const double before = fine.operators->max_divergence(fine.u);
  fine.change([&](const BoundingBox<dim> &) { return low; });
  const double after = fine.operators->max_divergence(fine.u);
  out() << dim << "D: divergence before " << below(before, 1e-10)
        << ", with coarser patches " << below(after, 1e-10) << std::endl;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check<2>(32);
  check<3>(32);
}
