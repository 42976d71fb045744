#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

#include <mitre/fluid/feedback_forcing.h>

namespace mitre::fluid
{
  using namespace dealii;
  using grid::VectorType;

  template <int dim>
  FeedbackForcing<dim>::FeedbackForcing(const grid::StaggeredSpace<dim> &space,
                                        const BoundaryConditions<dim> &conditions)
    : space(space)
    , conditions(conditions)
  {
    double widest = 0.;
    for (unsigned int i = 0; i < conditions.size(); ++i)
      {
        const FeedbackParameters feedback = conditions.condition(i).feedback();
        if (feedback.active())
          {
            is_active = true;
            widest    = std::max(widest, feedback.width);
          }
      }
    if (!is_active)
      return;

    const grid::PatchGrid<dim> &patch_grid = space.grid();
    const auto &[lower, upper]             = patch_grid.box().get_boundary_points();
    typename grid::StaggeredSpace<dim>::Index index;
    // whether any of a patch's faces is near enough to a side of the box
    const auto is_near = [&](const grid::Patch<dim> &patch) {
      for (unsigned int d = 0; d < dim; ++d)
        if (!patch_grid.periodic()[d] &&
            std::min(patch.lower[d] - lower[d],
                     upper[d] - patch.lower[d] -
                       patch.h[d] * patch_grid.n_cells_per_side()) <
              (widest + 1.) * patch.h[d])
          return true;
      return false;
    };
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      for (unsigned int c = 0; c < (is_near(patch_grid.patch(p)) ? dim : 0); ++c)
        for (unsigned int i = 0; i < space.n_dofs_per_component(); ++i)
          {
            unsigned int rest = i;
            for (unsigned int d = 0; d < dim; ++d)
              {
                index[d] = rest % space.extent(c, d);
                rest /= space.extent(c, d);
              }
            const Point<dim> x = space.position(p, c, index);

            const std::size_t n_before = faces.size();
            for (unsigned int side = 0; side < 2 * dim; ++side)
              {
                const unsigned int d = side / 2;
                if (patch_grid.periodic()[d])
                  continue;
                const double distance =
                  (side % 2 == 0 ? x[d] - lower[d] : upper[d] - x[d]) /
                  patch_grid.patch(p).h[d];
                if (distance >= widest)
                  continue;
                Point<dim> nearest;
                for (unsigned int e = 0; e < dim; ++e)
                  nearest[e] = std::min(std::max(x[e], lower[e]), upper[e]);
                nearest[d]                    = (side % 2 == 0 ? lower[d] : upper[d]);
                const grid::BoundaryInfo info = conditions.info(side, nearest);
                const FeedbackParameters feedback =
                  conditions.condition(info.condition).feedback();
                const bool normal_and_open =
                  (info.kind == grid::BoundaryKind::traction && c == d);
                const double strength = (info.kind == grid::BoundaryKind::slip ? 0.
                                         : normal_and_open ? feedback.backflow_damping
                                                           : feedback.strength);
                if (strength == 0. || distance >= feedback.width)
                  continue;
                const double ramp =
                  0.5 +
                  0.5 * std::cos(numbers::PI * std::max(distance, 0.) / feedback.width);
                faces.push_back({space.first_dof(p, c) + i,
                                 strength * ramp,
                                 !normal_and_open ? 0. : (side % 2 == 0 ? 1. : -1.),
                                 c,
                                 info.condition,
                                 nearest});
              }
            std::stable_sort(
              faces.begin() + n_before, faces.end(), [](const Face &a, const Face &b) {
                return a.weight > b.weight;
              });
          }
  }


  template <int dim>
  void FeedbackForcing<dim>::compute_force(VectorType &force,
                                           const VectorType &u,
                                           const double time,
                                           const double rho_over_dt) const
  {
    force            = 0.;
    std::size_t last = static_cast<std::size_t>(-1);
    for (const Face &face : faces)
      {
        // the first that applies is the strongest
        const double value = u.local_element(face.dof);
        if (face.dof == last || (face.inward != 0. && face.inward * value <= 0.))
          continue;
        last = face.dof;
        // open boundaries give no velocity other than zero
        const double wanted =
          (face.inward != 0. ? 0.
                             : conditions.condition(face.condition)
                                 .velocity(face.x, face.component, time));
        force.local_element(face.dof) = rho_over_dt * face.weight * (wanted - value);
      }
    // copies follow their masters exactly, also where round-off in a place decides
    space.synchronize(force);
  }


  template class FeedbackForcing<2>;
  template class FeedbackForcing<3>;
} // namespace mitre::fluid
