#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/coupling/fe_coupling.h>
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
    prm.declare_entry(
      "Normal",
      "",
      dealii::Patterns::List(dealii::Patterns::Double(), 0, dim),
      "A vector across the disc, if that lies across none of the axes. "
      "\"Centre\" then has all coordinates, and \"Axis\" and \"Position\" "
      "have no meaning. The run must have a part.");
  }


  template <int dim>
  void FlowMeter<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                        const std::string &instrument)
  {
    name   = instrument;
    sign   = prm.get("Direction") == "positive" ? 1 : -1;
    normal = 0.;
    points.clear();
    if (prm.get("Normal").empty())
      {
        disc.parse_parameters(prm, name);
        return;
      }
    const std::string of = "Instrument " + name + ", ";
    normal               = base::parse_point<dim>(prm.get("Normal"), of + "Normal");
    disc.centre          = base::parse_point<dim>(prm.get("Centre"), of + "Centre");
    disc.radius          = prm.get_double("Radius");
    AssertThrow(normal.norm() > 0.,
                base::UserError(of + "Normal is zero; expected is a vector across the "
                                     "disc."));
    AssertThrow(disc.radius > 0.,
                base::UserError(of + "Radius is 0; a disc with a \"Normal\" needs one."));
    normal /= normal.norm();
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
  double FlowMeter<dim>::flow_through_inclined_disc(const Observation<dim> &observation)
  {
    AssertThrow(observation.coupling != nullptr,
                base::UserError("Instrument " + name +
                                ": a disc with a \"Normal\" needs a run with a part."));
    const grid::PatchGrid<dim> &patch_grid = observation.fluid->space().grid();

    if (points.empty())
      {
        // Step 1: whether it lies in the box.
        const dealii::BoundingBox<dim> &box = patch_grid.box();
        double h                            = std::numeric_limits<double>::max();
        for (unsigned int d = 0; d < dim; ++d)
          {
            h = std::min(h, patch_grid.cell_width(patch_grid.maximum_level(), d));
            const double reach =
              disc.radius * std::sqrt(std::max(0., 1. - normal[d] * normal[d]));
            AssertThrow(patch_grid.periodic()[d] ||
                          (disc.centre[d] - reach >= box.lower_bound(d) &&
                           disc.centre[d] + reach <= box.upper_bound(d)),
                        base::UserError("Instrument " + name + ": " + disc.describe() +
                                        " reaches beyond the fluid's box."));
          }

        // Step 2: two directions in it, and its points.
        const unsigned int k =
          std::max(3, static_cast<int>(std::ceil(2. * disc.radius / h)));
        const dealii::QGauss<1> rule(k);
        if constexpr (dim == 2)
          for (unsigned int i = 0; i < k; ++i)
            {
              const double s = (2. * rule.point(i)[0] - 1.) * disc.radius;
              points.push_back(disc.centre + s * dealii::cross_product_2d(normal));
              weights.push_back(2. * disc.radius * rule.weight(i));
            }
        else
          {
            dealii::Tensor<1, dim> other;
            const unsigned int least =
              std::min_element(normal.begin_raw(),
                               normal.end_raw(),
                               [](const double a, const double b) {
                                 return std::abs(a) < std::abs(b);
                               }) -
              normal.begin_raw();
            other[least]                 = 1.;
            dealii::Tensor<1, dim> along = dealii::cross_product_3d(normal, other);
            along /= along.norm();
            const dealii::Tensor<1, dim> across = dealii::cross_product_3d(normal, along);
            const unsigned int n_angles         = 8 * k;
            for (unsigned int i = 0; i < k; ++i)
              for (unsigned int j = 0; j < n_angles; ++j)
                {
                  const double r     = rule.point(i)[0] * disc.radius;
                  const double angle = 2. * dealii::numbers::PI * (j + 0.5) / n_angles;
                  points.push_back(disc.centre + r * std::cos(angle) * along +
                                   r * std::sin(angle) * across);
                  weights.push_back(2. * dealii::numbers::PI / n_angles * r *
                                    rule.weight(i) * disc.radius);
                }
          }
      }

    double flow = 0;
    for (const auto &[i, u] :
         observation.coupling->velocities_at(observation.fluid->velocity(), points))
      flow += weights[i] * (u * normal);
    return dealii::Utilities::MPI::sum(flow, patch_grid.communicator());
  }


  template <int dim>
  std::vector<double> FlowMeter<dim>::measure(const Observation<dim> &observation)
  {
    const double flow =
      sign *
      (normal.norm() > 0.
         ? flow_through_inclined_disc(observation)
         : compute_flow(
             disc, observation.fluid->space(), observation.fluid->velocity(), name));
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
