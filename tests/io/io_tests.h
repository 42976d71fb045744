#ifndef mitre_tests_io_tests_h
#define mitre_tests_io_tests_h

// A grid with a refined region that carries a linear velocity and pressure.

#include <deal.II/base/mpi.h>

#include <cmath>

#include <mitre/base/units.h>
#include <mitre/grid/cell_halo.h>
#include <mitre/grid/patch_grid.h>
#include <mitre/grid/staggered_space.h>

namespace io_tests
{
  using namespace mitre;
  using dealii::Point;

  template <int dim>
  double velocity(const Point<dim> &x, const unsigned int c)
  {
    return 1. + c + (c == 0 ? 2. : -1.) * x[0] + 0.5 * x[1] + (c + 1.) * x[dim - 1];
  }

  /// [mmHg]
  template <int dim>
  double pressure(const Point<dim> &x)
  {
    return 10. + 20. * x[0] - 5. * x[1] + 3. * x[dim - 1];
  }

  template <int dim>
  grid::PatchGridParameters<dim> parameters()
  {
    grid::PatchGridParameters<dim> p;
    for (unsigned int d = 0; d < dim; ++d)
      {
        p.lower[d]        = 0.;
        p.upper[d]        = d == 0 ? 2. : 1.;
        p.base_patches[d] = d == 0 ? 2 : 1;
        p.periodic[d]     = false;
      }
    p.cells_per_side = 8;
    p.minimum_level  = 1;
    p.maximum_level  = 2;
    return p;
  }

  /// The box (0,2) x (0,1)^(dim-1), refined where 1/2 < x < 3/2 and y < 1/2.
  template <int dim>
  struct Case
  {
    Case()
      : patch_grid(MPI_COMM_WORLD, parameters<dim>())
    {
      patch_grid.adapt([](const dealii::BoundingBox<dim> &box) {
        return std::abs(box.center()[0] - 1.) < 0.5 && box.center()[1] < 0.5 ? 2 : 1;
      });
      space = std::make_unique<grid::StaggeredSpace<dim>>(
        patch_grid, [](const unsigned int, const Point<dim> &) {
          return grid::BoundaryInfo{grid::BoundaryKind::velocity, 0};
        });
      space->finalize({});
      space->initialize_vector(u);
      for (unsigned int q = 0; q < patch_grid.n_owned_patches(); ++q)
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int i = 0; i < space->n_dofs_per_component(); ++i)
            {
              std::array<int, dim> index;
              unsigned int rest = i;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  index[d] = rest % space->extent(c, d);
                  rest /= space->extent(c, d);
                }
              u.local_element(space->first_dof(q, c) + i) =
                velocity(space->position(q, c, index), c);
            }
      space->synchronize(u);

      const unsigned int n = patch_grid.n_cells_per_side();
      const grid::CellHalo<dim> halo(patch_grid, n);
      halo.initialize_vector(p);
      for (unsigned int q = 0; q < patch_grid.n_owned_patches(); ++q)
        for (unsigned int i = 0; i < halo.n_cells_per_patch(); ++i)
          {
            const auto &patch = patch_grid.patch(q);
            Point<dim> x;
            unsigned int rest = i;
            for (unsigned int d = 0; d < dim; ++d)
              {
                x[d] = patch.lower[d] + (rest % n + 0.5) * patch.h[d];
                rest /= n;
              }
            p.local_element(q * halo.n_cells_per_patch() + i) = pressure(x) * base::mmHg;
          }
    }

    grid::PatchGrid<dim> patch_grid;
    std::unique_ptr<grid::StaggeredSpace<dim>> space;
    grid::VectorType u, p;
  };
} // namespace io_tests

#endif
