#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <mitre/base/exceptions.h>
#include <mitre/base/units.h>
#include <mitre/fluid/navier_stokes.h>
#include <mitre/instruments/pressure_station.h>

namespace mitre::instruments
{
  template <int dim>
  double compute_mean_pressure(const MeasuringDisc<dim> &disc,
                               const grid::PatchGrid<dim> &patch_grid,
                               const grid::VectorType &p,
                               const std::string &instrument)
  {
    disc.check_inside(patch_grid.box(), instrument);
    const int n                    = patch_grid.n_cells_per_side();
    const unsigned int a           = disc.axis;
    const std::size_t cells_a_side = n;
    const std::size_t stride       = dealii::Utilities::pow(cells_a_side, a);
    const std::size_t n_cells      = dealii::Utilities::fixed_power<dim>(cells_a_side);

    std::array<double, 2> integral_and_area{{0, 0}};
    for (unsigned int q = 0; q < patch_grid.n_owned_patches(); ++q)
      {
        const grid::Patch<dim> &patch = patch_grid.patch(q);

        // Widths of cells are exact halves of those of the next level, so that exactly
        // one level finds the position in its patch.
        const double cells = (disc.position - patch_grid.box().lower_bound(a)) /
                             patch_grid.cell_width(patch.level, a);
        const int layer = std::min(static_cast<int>(std::floor(cells)),
                                   patch_grid.n_patches(patch.level, a) * n - 1);
        if (layer / n != patch.index[a])
          continue;

        // position between the centres of layers k and k + 1
        const double above = cells - patch.index[a] * n - 0.5;
        const int k = std::min(std::max(static_cast<int>(std::floor(above)), 0), n - 2);
        const double weight = above - k;

        double area = 1;
        for (unsigned int d = 0; d < dim; ++d)
          area *= d == a ? 1 : patch.h[d];
        for (std::size_t i = 0; i < n_cells / n; ++i)
          {
            const std::size_t cell = i / stride * stride * n + i % stride + k * stride;
            dealii::Point<dim> x;
            std::size_t rest = cell;
            for (unsigned int d = 0; d < dim; ++d)
              {
                x[d] = patch.lower[d] + (rest % n + 0.5) * patch.h[d];
                rest /= n;
              }
            if (disc.contains(x))
              {
                const std::size_t entry = q * n_cells + cell;
                integral_and_area[0] += area * ((1 - weight) * p.local_element(entry) +
                                                weight * p.local_element(entry + stride));
                integral_and_area[1] += area;
              }
          }
      }
    dealii::Utilities::MPI::sum(
      dealii::ArrayView<const double>(integral_and_area.data(), 2),
      patch_grid.communicator(),
      dealii::ArrayView<double>(integral_and_area.data(), 2));
    AssertThrow(integral_and_area[1] > 0,
                base::UserError("Instrument " + instrument +
                                ": no cell of the grid has its centre over " +
                                disc.describe() + "."));
    return integral_and_area[0] / integral_and_area[1];
  }


  template <int dim>
  void PressureStation<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    MeasuringDisc<dim>::declare_parameters(prm);
  }


  template <int dim>
  void PressureStation<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                              const std::string &instrument)
  {
    name = instrument;
    disc.parse_parameters(prm, name);
  }


  template <int dim>
  std::vector<std::string> PressureStation<dim>::columns() const
  {
    return {name + " [mmHg]"};
  }


  template <int dim>
  std::vector<double> PressureStation<dim>::measure(const Observation<dim> &observation)
  {
    return {
      compute_mean_pressure(
        disc, observation.fluid->space().grid(), observation.fluid->pressure(), name) /
      base::mmHg};
  }


  template double compute_mean_pressure(const MeasuringDisc<2> &,
                                        const grid::PatchGrid<2> &,
                                        const grid::VectorType &,
                                        const std::string &);
  template double compute_mean_pressure(const MeasuringDisc<3> &,
                                        const grid::PatchGrid<3> &,
                                        const grid::VectorType &,
                                        const std::string &);
  template class PressureStation<2>;
  template class PressureStation<3>;
} // namespace mitre::instruments
