#include <deal.II/base/index_set.h>
#include <deal.II/base/partitioner.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <mitre/base/exceptions.h>
#include <mitre/fluid/advection.h>

namespace mitre::fluid
{
  using namespace dealii;
  using grid::Neighbor;
  using grid::VectorType;

  AdvectionScheme advection_scheme(const std::string &name)
  {
    if (name == "PPM")
      return AdvectionScheme::ppm;
    if (name == "CUI")
      return AdvectionScheme::cui;
    if (name == "centered")
      return AdvectionScheme::centered;
    if (name == "none")
      return AdvectionScheme::none;
    throw base::UserError("There is no advection scheme \"" + name +
                          "\"; known are PPM, CUI, centered and none.");
  }


  namespace
  {
    /// Slope between neighbours, limited so that no new extremum arises.
    inline double limited_slope(const double below, const double here, const double above)
    {
      const double down = here - below, up = above - here;
      const double bound = 2. * std::min(std::abs(down), std::abs(up));
      const double mean  = 0.5 * (down + up);
      const double slope = std::copysign(std::min(std::abs(mean), bound), mean);
      return down * up > 0. ? slope : 0.;
    }

    /**
     * Values at the lower and upper end of each of @p size intervals along a line of
     * values @p q that are @p s apart, written to @p lower and @p upper.
     */
    template <AdvectionScheme scheme>
    inline void
    reconstruct(const double *q, const std::ptrdiff_t s, double &lower, double &upper)
    {
      const double here = *q;
      if constexpr (scheme == AdvectionScheme::ppm)
        {
          const double below = *(q - s), above = q[s];
          const double slope       = limited_slope(below, here, above);
          const double slope_below = limited_slope(*(q - 2 * s), below, here);
          const double slope_above = limited_slope(here, above, q[2 * s]);
          double a                 = 0.5 * (below + here) - (slope - slope_below) / 6.;
          double b                 = 0.5 * (here + above) - (slope_above - slope) / 6.;

          const bool extremum = (b - here) * (here - a) <= 0.;
          const double range = b - a, middle = here - 0.5 * (a + b);
          const double a_steep = 3. * here - 2. * b, b_steep = 3. * here - 2. * a;
          const bool low  = range * middle > range * range / 6.;
          const bool high = -range * range / 6. > range * middle;
          a               = extremum ? here : (low ? a_steep : a);
          b               = extremum ? here : (high ? b_steep : b);
          lower           = a;
          upper           = b;
        }
      else if constexpr (scheme == AdvectionScheme::cui)
        {
          // cubic upwind interpolation in the normalised variable (q - q_up) /
          // (q_down - q_up), limited to be bounded
          const auto face = [](const double up, const double center, const double down) {
            const double range = down - up;
            const double r = (center - up) / (std::abs(range) > 1e-300 ? range : 1e-300);
            double f       = 5. / 6. * r + 1. / 3.;
            f              = r <= 2. / 13. ? 3. * r : f;
            f              = r > 4. / 5. ? 1. : f;
            f              = (r <= 0. || r >= 1.) ? r : f;
            return std::abs(range) > 1e-300 ? up + f * range : center;
          };
          upper = face(*(q - s), here, q[s]);
          lower = face(q[s], here, *(q - s));
        }
      else
        {
          lower = 0.5 * (here + *(q - s));
          upper = 0.5 * (here + q[s]);
        }
    }
  } // namespace


  template <int dim>
  Advection<dim>::Advection(const grid::StaggeredSpace<dim> &space,
                            const AdvectionScheme scheme)
    : space(space)
    , scheme(scheme)
    , halo(space, 3, grid::HaloShape::star, grid::BoundaryExtension::reflection)
  {
    halo.make_own_partitioner();
    if (space.grid().has_coarse_fine_interfaces())
      build_matches();
  }


  template <int dim>
  void Advection<dim>::build_matches()
  {
    const grid::PatchGrid<dim> &patch_grid = space.grid();
    const int n                            = patch_grid.n_cells_per_side();
    match_starts                           = {0};
    std::vector<types::global_dof_index> ghosts;
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int d = 0; d < dim; ++d)
          for (unsigned int upper = 0; upper < 2; ++upper)
            {
              if (patch_grid.neighbor(p, 2 * d + upper) == Neighbor::coarser)
                {
                  const auto &patch = patch_grid.patch(p);
                  auto where        = patch.index;
                  const int size    = patch_grid.n_patches(patch.level, d);
                  where[d]          = (where[d] + (upper == 1 ? 1 : size - 1)) % size;
                  for (int &w : where)
                    w /= 2;
                  const unsigned int q = patch_grid.find(patch.level - 1, where);
                  AssertThrow(q != numbers::invalid_unsigned_int, ExcInternalError());
                  const auto &coarse_patch = patch_grid.patch(q);
                  const types::global_dof_index first =
                    coarse_patch.global_id * space.n_dofs_per_patch() +
                    c * space.n_dofs_per_component();

                  // half of a face of the fine control volume
                  double area = 0.5;
                  for (unsigned int e = 0; e < dim; ++e)
                    if (e != d)
                      area *= patch.h[e];

                  for (unsigned int i = 0;
                       i < space.n_dofs_per_component() / space.extent(c, d);
                       ++i)
                    {
                      std::array<int, dim> fine;
                      unsigned int rest = i;
                      for (unsigned int e = 0; e < dim; ++e)
                        if (e == d)
                          fine[e] = (upper == 1 ? n : 0);
                        else
                          {
                            fine[e] = rest % space.extent(c, e);
                            rest /= space.extent(c, e);
                          }
                      unsigned int at = 0, stride = 1;
                      for (unsigned int e = 0; e < dim; ++e)
                        {
                          at += (fine[e] + halo.width()) * stride;
                          stride *= halo.extents(c)[e];
                        }
                      for (int half = 0; half < 2; ++half)
                        {
                          // the halves beyond the patch's ends belong to its neighbours
                          if (c != d && fine[c] == (half == 0 ? 0 : n))
                            continue;
                          types::global_dof_index entry = first;
                          for (unsigned int e = 0; e < dim; ++e)
                            {
                              int index = patch.index[e] * n + fine[e];
                              if (e == c && index % 2 == 1)
                                index += (half == 0 ? -1 : 1);
                              const int last = space.extent(c, d) - 1;
                              index          = (e == d ? (upper == 1 ? 0 : last)
                                                       : index / 2 - coarse_patch.index[e] * n);
                              entry += index * space.stride(c, e);
                            }
                          matches.push_back({at, entry, upper == 1 ? -area : area});
                          ghosts.push_back(entry);
                        }
                    }
                }
              match_starts.push_back(matches.size());
            }

    const IndexSet owned = space.owned_entries();
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
    IndexSet ghost_set(owned.size());
    ghost_set.add_indices(ghosts.begin(), ghosts.end());
    ghost_set.subtract_set(owned);
    const auto partitioner = std::make_shared<const Utilities::MPI::Partitioner>(
      owned, ghost_set, patch_grid.communicator());
    received.reinit(partitioner);
    for (Match &match : matches)
      match.coarse = partitioner->global_to_local(match.coarse);
  }


  /**
   * Prepares the fluxes of component @p c (padded values @p u) in direction @p d through
   * the ends of patch @p p for a balance of the parts of control volumes that lie in the
   * patch.
   */
  template <int dim>
  void Advection<dim>::match_fluxes(const unsigned int p,
                                    const unsigned int c,
                                    const unsigned int d,
                                    const std::vector<double> &u,
                                    std::vector<double> &flux)
  {
    std::array<std::ptrdiff_t, 3> stride{{1, 1, 1}};
    std::array<int, 3> end{{1, 1, 1}};
    std::ptrdiff_t first = 0;
    for (unsigned int e = 0; e < dim; ++e)
      {
        end[e] = space.extent(c, e);
        if (e > 0)
          stride[e] = stride[e - 1] * halo.extents(c)[e - 1];
        first += halo.width() * stride[e];
      }
    const std::ptrdiff_t length = end[d] * stride[d];
    end[d]                      = 1;
    for (unsigned int upper = 0; upper < 2; ++upper)
      {
        const Neighbor neighbor = space.grid().neighbor(p, 2 * d + upper);
        if (neighbor == Neighbor::boundary || (c != d && neighbor == Neighbor::same))
          continue;
        if (neighbor == Neighbor::coarser)
          {
            const unsigned int at = ((p * dim + c) * dim + d) * 2 + upper;
            for (unsigned int m = match_starts[at]; m < match_starts[at + 1]; ++m)
              {
                const unsigned int i = matches[m].flux;
                received.local_element(matches[m].coarse) +=
                  matches[m].weight * (c == d ? u[i] * u[i] : flux[i]);
              }
            if (c != d)
              continue;
          }
        // Where the component is normal to the end, its outermost control volume is cut
        // in two; its balance, (flux inside - flux through the cut) / (h/2), is written
        // as a difference over h. The flux through the cut cancels with that of the other
        // part, where levels are equal, or is matched, and so is left out here, but for
        // the finer side, whose balances C^T spreads.
        const std::ptrdiff_t step  = (upper == 1 ? -stride[d] : stride[d]),
                             start = first + (upper == 1 ? length : 0),
                             cut   = (upper == 1 ? -stride[d] : 0);
        for (int k = 0; k < end[2]; ++k)
          for (int j = 0; j < end[1]; ++j)
            for (int i = 0; i < end[0]; ++i)
              {
                const std::ptrdiff_t at =
                  start + i + j * stride[1] + (dim == 3 ? k * stride[2] : 0);
                flux[at] = (c == d ? -flux[at + step] : 0.);
                if (c == d && neighbor == Neighbor::coarser)
                  flux[at] += 2. * u[at + cut] * u[at + cut];
              }
      }
  }


  template <int dim>
  template <AdvectionScheme scheme>
  void Advection<dim>::apply_scheme(VectorType &dst,
                                    const VectorType &imported,
                                    const bool inhomogeneous)
  {
    const grid::PatchGrid<dim> &patch_grid = space.grid();
    const int g                            = halo.width();
    const bool mixed_levels                = patch_grid.has_coarse_fine_interfaces();

    std::array<std::vector<double>, dim> padded;
    for (unsigned int c = 0; c < dim; ++c)
      padded[c].assign(halo.size(c), 0.);
    std::vector<double> lower(halo.size(0)), upper(halo.size(0)), flux(halo.size(0));

    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        const auto &patch = patch_grid.patch(p);
        for (unsigned int c = 0; c < dim; ++c)
          halo.gather(imported, p, c, padded[c].data(), inhomogeneous);

        for (unsigned int c = 0; c < dim; ++c)
          {
            const auto e = halo.extents(c);
            std::array<int, 3> size{{1, 1, 1}};
            std::array<std::ptrdiff_t, 3> stride{{1, 1, 1}};
            for (unsigned int d = 0; d < dim; ++d)
              {
                size[d]   = space.extent(c, d);
                stride[d] = (d == 0 ? 1 : stride[d - 1] * e[d - 1]);
              }
            std::ptrdiff_t first = 0;
            for (unsigned int d = 0; d < dim; ++d)
              first += g * stride[d];
            const double *q            = padded[c].data() + first;
            double *out                = dst.begin() + space.first_dof(p, c);
            const std::ptrdiff_t out_y = size[0],
                                 out_z = static_cast<std::ptrdiff_t>(size[0]) * size[1];

            for (unsigned int d = 0; d < dim; ++d)
              {
                // Fluxes stand at the lower ends of the control volumes, one more at the
                // end; parabolas are needed on the volumes on both sides of each.
                std::array<int, 3> begin{{0, 0, 0}}, end = size;
                begin[d] = -1;
                end[d]   = size[d] + 1;
                for (int k = begin[2]; k < end[2]; ++k)
                  for (int j = begin[1]; j < end[1]; ++j)
                    {
                      const std::ptrdiff_t row =
                        j * stride[1] + (dim == 3 ? k * stride[2] : 0);
                      const double *line = q + row;
                      double *lo         = lower.data() + first + row,
                             *up         = upper.data() + first + row;
                      for (int i = begin[0]; i < end[0]; ++i)
                        reconstruct<scheme>(line + i, stride[d], *(lo + i), *(up + i));
                    }

                // advecting velocity, and upwinding
                const auto ed = halo.extents(d);
                std::array<std::ptrdiff_t, 3> stride_d{{1, 1, 1}};
                for (unsigned int b = 1; b < dim; ++b)
                  stride_d[b] = stride_d[b - 1] * ed[b - 1];
                std::ptrdiff_t first_d = 0;
                for (unsigned int b = 0; b < dim; ++b)
                  first_d += g * stride_d[b];
                const double *advecting = padded[d].data() + first_d;
                // the two values that the advecting velocity is the mean of
                const std::ptrdiff_t back = stride_d[c];

                begin[d] = 0;
                end[d]   = size[d] + 1;
                for (int k = begin[2]; k < end[2]; ++k)
                  for (int j = begin[1]; j < end[1]; ++j)
                    {
                      const std::ptrdiff_t row =
                        first + j * stride[1] + (dim == 3 ? k * stride[2] : 0);
                      const double *a =
                        advecting + j * stride_d[1] + (dim == 3 ? k * stride_d[2] : 0);
                      const double *lo = lower.data() + row, *up = upper.data() + row;
                      double *f = flux.data() + row;
                      for (int i = begin[0]; i < end[0]; ++i)
                        {
                          const double speed = 0.5 * (*(a + i - back) + a[i]);
                          const double below = *(up + i - stride[d]), above = lo[i];
                          if constexpr (scheme == AdvectionScheme::centered)
                            f[i] = speed * above;
                          else
                            f[i] = speed * (speed > 0. ? below : above);
                        }
                    }

                if (mixed_levels)
                  match_fluxes(p, c, d, padded[c], flux);

                const double factor = 1. / patch.h[d];
                for (int k = 0; k < size[2]; ++k)
                  for (int j = 0; j < size[1]; ++j)
                    {
                      const double *f = flux.data() + first + j * stride[1] +
                                        (dim == 3 ? k * stride[2] : 0);
                      double *to = out + j * out_y + k * out_z;
                      if (d == 0)
                        for (int i = 0; i < size[0]; ++i)
                          to[i] = factor * (f[i + 1] - f[i]);
                      else
                        for (int i = 0; i < size[0]; ++i)
                          to[i] += factor * (f[i + stride[d]] - f[i]);
                    }
              }

            if (mixed_levels)
              {
                // balances of the parts of control volumes in the patch
                double volume = 1.;
                for (unsigned int d = 0; d < dim; ++d)
                  volume *= patch.h[d];
                const unsigned int n = patch_grid.n_cells_per_side();
                for (unsigned int i = 0; i < space.n_dofs_per_component(); ++i)
                  {
                    const unsigned int plane = (i / space.stride(c, c)) % (n + 1);
                    out[i] *= (plane == 0 || plane == n ? 0.5 * volume : volume);
                  }
              }
          }
      }
  }


  template <int dim>
  void Advection<dim>::apply(
    VectorType &dst,
    const VectorType &u,
    const std::function<double(const grid::BoundaryTerm<dim> &)> &prescribed)
  {
    if (scheme == AdvectionScheme::none)
      {
        dst = 0.;
        return;
      }
    if (prescribed)
      halo.set_boundary_values(prescribed);
    const VectorType &imported = halo.import(u);
    const bool inhomogeneous   = static_cast<bool>(prescribed);
    if (scheme == AdvectionScheme::ppm)
      apply_scheme<AdvectionScheme::ppm>(dst, imported, inhomogeneous);
    else if (scheme == AdvectionScheme::cui)
      apply_scheme<AdvectionScheme::cui>(dst, imported, inhomogeneous);
    else
      apply_scheme<AdvectionScheme::centered>(dst, imported, inhomogeneous);
    if (space.grid().has_coarse_fine_interfaces())
      {
        received.compress(VectorOperation::add);
        for (unsigned int i = 0; i < dst.locally_owned_size(); ++i)
          dst.local_element(i) += received.local_element(i);
        received = 0.;
        space.collect(dst);
        dst.scale(space.inverse_volumes());
        space.synchronize(dst);
      }
    else
      space.zero_fixed_faces(dst);
  }


  template class Advection<2>;
  template class Advection<3>;
} // namespace mitre::fluid
