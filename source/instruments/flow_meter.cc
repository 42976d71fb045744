#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <mitre/base/exceptions.h>
#include <mitre/fluid/navier_stokes.h>
#include <mitre/instruments/flow_meter.h>

namespace mitre::instruments
{
  namespace
  {
    /**
     * The number, among those of cells of the returned level, of the plane of the grid
     * that is nearest to a disc. The level is the lowest of the patches that hold the
     * disc.
     */
    template <int dim>
    std::pair<int, int> find_plane(const MeasuringDisc<dim> &disc,
                                   const grid::PatchGrid<dim> &patch_grid)
    {
      const unsigned int n = patch_grid.n_cells_per_side();
      const unsigned int a = disc.axis;
      int level            = std::numeric_limits<int>::max();
      for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
        {
          const grid::Patch<dim> &patch = patch_grid.patch(p);
          const double cells            = (disc.position - patch.lower[a]) / patch.h[a];
          if (cells > -1e-6 && cells < n + 1e-6 && disc.may_touch(patch, n))
            level = std::min(level, patch.level);
        }
      level = dealii::Utilities::MPI::min(level, patch_grid.communicator());
      if (level == std::numeric_limits<int>::max())
        return {0, 0};
      const double cells = (disc.position - patch_grid.box().lower_bound(a)) /
                           patch_grid.cell_width(level, a);
      return {static_cast<int>(std::lround(cells)), level};
    }
  } // namespace


  template <int dim>
  double compute_flow(const MeasuringDisc<dim> &disc,
                      const grid::StaggeredSpace<dim> &space,
                      const grid::VectorType &u,
                      const std::string &instrument)
  {
    const grid::PatchGrid<dim> &patch_grid = space.grid();
    disc.check_inside(patch_grid.box(), instrument);
    const int n               = patch_grid.n_cells_per_side();
    const unsigned int a      = disc.axis;
    const auto [plane, level] = find_plane(disc, patch_grid);

    std::array<double, 2> flow_and_area{{0, 0}};
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        const grid::Patch<dim> &patch = patch_grid.patch(p);

        // Step 1: the number of the plane in this patch. Of two patches that share it,
        // the upper one has it, so that each face counts once whatever its level.
        const int ratio = 1 << std::abs(patch.level - level);
        if (patch.level < level && plane % ratio != 0)
          continue;
        int own_plane     = patch.level < level ? plane / ratio : plane * ratio;
        const int n_cells = patch_grid.n_patches(patch.level, a) * n;
        if (own_plane == n_cells && patch_grid.periodic()[a])
          own_plane = 0;
        const int i         = own_plane - patch.index[a] * n;
        const bool at_upper = own_plane == n_cells && i == n;
        if (!(0 <= i && i < n) && !at_upper)
          continue;

        // Step 2: its faces in the disc.
        double area = 1;
        for (unsigned int d = 0; d < dim; ++d)
          area *= d == a ? 1 : patch.h[d];
        std::array<int, dim> index;
        index[a] = i;
        for (int face = 0; face < dealii::Utilities::fixed_power<dim - 1>(n); ++face)
          {
            int rest        = face;
            std::size_t dof = space.first_dof(p, a) + i * space.stride(a, a);
            for (unsigned int d = 0; d < dim; ++d)
              if (d != a)
                {
                  index[d] = rest % n;
                  rest /= n;
                  dof += index[d] * space.stride(a, d);
                }
            if (disc.contains(space.position(p, a, index)))
              {
                flow_and_area[0] += area * u.local_element(dof);
                flow_and_area[1] += area;
              }
          }
      }
    dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(flow_and_area.data(), 2),
                                patch_grid.communicator(),
                                dealii::ArrayView<double>(flow_and_area.data(), 2));
    AssertThrow(flow_and_area[1] > 0,
                base::UserError("Instrument " + instrument +
                                ": no face of the grid has its centre in " +
                                disc.describe() + "."));
    return flow_and_area[0];
  }


  template <int dim>
  void FlowMeter<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    MeasuringDisc<dim>::declare_parameters(prm);
    prm.declare_entry("Direction",
                      "positive",
                      dealii::Patterns::Selection("positive|negative"),
                      "Whether flow in the positive or in the negative direction of the "
                      "axis counts as forward.");
  }


  template <int dim>
  void FlowMeter<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                        const std::string &instrument)
  {
    name = instrument;
    disc.parse_parameters(prm, name);
    sign = prm.get("Direction") == "positive" ? 1 : -1;
  }


  template <int dim>
  std::vector<std::string> FlowMeter<dim>::columns() const
  {
    const std::string volume = dim == 3 ? "mL" : "cm^2";
    return {name + " [" + volume + "/s]",
            name + " forward volume [" + volume + "]",
            name + " regurgitant volume [" + volume + "]"};
  }


  template <int dim>
  std::vector<double> FlowMeter<dim>::measure(const Observation<dim> &observation)
  {
    const double flow =
      sign *
      compute_flow(disc, observation.fluid->space(), observation.fluid->velocity(), name);
    if (has_previous)
      {
        const double dt      = observation.time - previous_time;
        const double forward = std::max(flow, 0.), previous = std::max(previous_flow, 0.);
        const double backward = std::max(-flow, 0.), back = std::max(-previous_flow, 0.);
        const double sum = forward + previous + backward + back;
        // If the flow turns, the share of the time in which it is forward is
        // forward / (forward + backward).
        if (sum > 0)
          {
            const double share = (forward + previous) / sum;
            forward_volume += 0.5 * dt * share * (forward + previous);
            backward_volume += 0.5 * dt * (1 - share) * (backward + back);
          }
      }
    has_previous  = true;
    previous_time = observation.time;
    previous_flow = flow;
    return {flow, forward_volume, backward_volume};
  }


  template <int dim>
  std::vector<double> FlowMeter<dim>::state() const
  {
    return {has_previous ? 1. : 0.,
            previous_time,
            previous_flow,
            forward_volume,
            backward_volume};
  }


  template <int dim>
  void FlowMeter<dim>::set_state(const std::vector<double> &state)
  {
    AssertDimension(state.size(), 5);
    has_previous    = state[0] != 0.;
    previous_time   = state[1];
    previous_flow   = state[2];
    forward_volume  = state[3];
    backward_volume = state[4];
  }


  template double compute_flow(const MeasuringDisc<2> &,
                               const grid::StaggeredSpace<2> &,
                               const grid::VectorType &,
                               const std::string &);
  template double compute_flow(const MeasuringDisc<3> &,
                               const grid::StaggeredSpace<3> &,
                               const grid::VectorType &,
                               const std::string &);
  template class FlowMeter<2>;
  template class FlowMeter<3>;
} // namespace mitre::instruments
