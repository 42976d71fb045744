#include <deal.II/base/index_set.h>
#include <deal.II/base/partitioner.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <experimental/simd>

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
    if (name == "monotone PPM")
      return AdvectionScheme::monotone_ppm;
    if (name == "CUI")
      return AdvectionScheme::cui;
    if (name == "centered")
      return AdvectionScheme::centered;
    if (name == "none")
      return AdvectionScheme::none;
    throw base::UserError("There is no advection scheme \"" + name +
                          "\"; known are PPM, monotone PPM, CUI, centered and none.");
  }


  namespace
  {
    // Loops work on as many neighbouring lines at once as the processor has lanes.
    namespace stdx = std::experimental;
    using Lanes    = stdx::native_simd<double>;
    using Mask     = Lanes::mask_type;

    [[gnu::always_inline]] inline Lanes load(const double *x)
    {
      return Lanes(x, stdx::element_aligned);
    }

    [[gnu::always_inline]] inline Lanes
    select(const Mask &mask, const Lanes &yes, const Lanes &no)
    {
      Lanes result        = no;
      where(mask, result) = yes;
      return result;
    }

    /// |x| with the sign of y.
    [[gnu::always_inline]] inline Lanes with_sign(const Lanes &x, const Lanes &y)
    {
      return select(y < 0., -x, x);
    }

    /// Slope between neighbours, limited so that no new extremum arises.
    [[gnu::always_inline]] inline Lanes
    limited_slope(const Lanes &below, const Lanes &here, const Lanes &above)
    {
      const Lanes down = here - below, up = above - here;
      const Lanes bound = 2. * min(abs(down), abs(up));
      const Lanes mean  = 0.5 * (down + up);
      return select(down * up > 0., with_sign(min(abs(mean), bound), mean), 0.);
    }

    /// The argument of least size, or zero where signs differ.
    [[gnu::always_inline]] inline Lanes minmod(const Lanes &a, const Lanes &b)
    {
      return select(a * b > 0., with_sign(min(abs(a), abs(b)), a), 0.);
    }

    /**
     * The difference @p edge from the value of an interval to that at one of its ends,
     * limited to the interval of Suresh and Huynh, which has no values beyond monotone
     * ones but where there is a smooth extremum. @p step and @p back are the differences
     * to the next value beyond that end and from the one on the other side; @p
     * curvature_next and @p curvature_back the second differences at these two.
     */
    [[gnu::always_inline]] inline Lanes limited_edge(const Lanes &edge,
                                                     const Lanes &step,
                                                     const Lanes &back,
                                                     const Lanes &curvature,
                                                     const Lanes &curvature_next,
                                                     const Lanes &curvature_back)
    {
      // how far an edge may be, in differences to the value behind it
      constexpr double steepness = 2.;
      const Mask outside         = edge * (edge - minmod(step, steepness * back)) > 0.;
      if (none_of(outside))
        return edge;
      const auto least = [](const Lanes &a, const Lanes &b) {
        return minmod(minmod(4. * a - b, 4. * b - a), minmod(a, b));
      };
      const Lanes zero = 0., middle = 0.5 * step - 0.5 * least(curvature, curvature_next),
                  upwind = steepness * back,
                  large  = 0.5 * back + (4. / 3.) * least(curvature, curvature_back);
      const Lanes low  = max(min(zero, min(step, middle)), min(zero, min(upwind, large)));
      const Lanes high = min(max(zero, max(step, middle)), max(zero, max(upwind, large)));
      return select(outside, edge + minmod(low - edge, high - edge), edge);
    }

    /// Cubic upwind interpolation to a face in the normalised variable
    /// (q - q_up) / (q_down - q_up), limited to be bounded.
    [[gnu::always_inline]] inline Lanes
    cui_face(const Lanes &up, const Lanes &center, const Lanes &down)
    {
      const Lanes range = down - up;
      const Mask flat   = abs(range) <= 1e-300;
      const Lanes r     = (center - up) / select(flat, 1e-300, range);
      Lanes f           = 5. / 6. * r + 1. / 3.;
      f                 = select(r <= 2. / 13., 3. * r, f);
      f                 = select(r > 4. / 5., 1., f);
      f                 = select(r <= 0. || r >= 1., r, f);
      return select(flat, center, up + f * range);
    }

    /**
     * Reconstructs the values at both ends of the intervals of a line, one interval after
     * the other.
     */
    template <AdvectionScheme scheme>
    class Reconstruction
    {
    public:
      /// Before the first interval, whose value is @p here.
      [[gnu::always_inline]] void start(const Lanes &before,
                                        const Lanes &below,
                                        const Lanes &here,
                                        const Lanes &above)
      {
        if constexpr (scheme == AdvectionScheme::ppm)
          {
            curvature_below = before - 2. * below + here;
            curvature       = below - 2. * here + above;
            edge = 0.5 * (here - below) - (1. / 12.) * (curvature_below + curvature);
          }
        else
          (void)before, (void)below, (void)here, (void)above;
      }

      /// The ends of the interval with the value @p here.
      [[gnu::always_inline]] void next(const Lanes &before,
                                       const Lanes &below,
                                       const Lanes &here,
                                       const Lanes &above,
                                       const Lanes &after,
                                       Lanes &lower,
                                       Lanes &upper)
      {
        if constexpr (scheme == AdvectionScheme::ppm)
          {
            const Lanes curvature_above = here - 2. * above + after;
            const Lanes up = above - here, down = here - below;
            const Lanes next_edge = 0.5 * up - (1. / 12.) * (curvature + curvature_above);
            lower =
              here +
              limited_edge(
                edge - down, -down, -up, curvature, curvature_below, curvature_above);
            upper =
              here + limited_edge(
                       next_edge, up, down, curvature, curvature_above, curvature_below);
            curvature_below = curvature;
            curvature       = curvature_above;
            edge            = next_edge;
          }
        else if constexpr (scheme == AdvectionScheme::monotone_ppm)
          {
            const Lanes slope       = limited_slope(below, here, above);
            const Lanes slope_below = limited_slope(before, below, here);
            const Lanes slope_above = limited_slope(here, above, after);
            const Lanes a           = 0.5 * (below - here) - (slope - slope_below) / 6.;
            const Lanes b           = 0.5 * (above - here) - (slope_above - slope) / 6.;
            const Mask extremum     = a * b >= 0.;
            lower = here + select(extremum, 0., select(abs(a) > 2. * abs(b), -2. * b, a));
            upper = here + select(extremum, 0., select(abs(b) > 2. * abs(a), -2. * a, b));
          }
        else if constexpr (scheme == AdvectionScheme::cui)
          {
            upper = cui_face(below, here, above);
            lower = cui_face(above, here, below);
            (void)before, (void)after;
          }
        else
          {
            lower = 0.5 * (here + below);
            upper = 0.5 * (here + above);
            (void)before, (void)after;
          }
      }

    private:
      /// Of the interval below, of this one, and the value between the two less the
      /// lower one.
      Lanes curvature_below = 0., curvature = 0., edge = 0.;
    };


    /// Writes the first @p count lanes, or all if there are fewer.
    [[gnu::always_inline]] inline void
    store(const Lanes &value, double *to, const int count)
    {
      if (count >= static_cast<int>(Lanes::size()))
        value.copy_to(to, stdx::element_aligned);
      else
        for (int lane = 0; lane < count; ++lane)
          to[lane] = value[lane];
    }

    /// Flux with the mean of two advecting velocities and the upwind one of two values.
    template <AdvectionScheme scheme>
    [[gnu::always_inline]] inline Lanes
    upwind_flux(const Lanes &speed_twice, const Lanes &below, const Lanes &above)
    {
      const Lanes speed = 0.5 * speed_twice;
      if constexpr (scheme == AdvectionScheme::centered)
        return speed * above;
      else
        return speed * select(speed > 0., below, above);
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
    const auto [first_owned, end_owned]    = space.owned_range();
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
                          if (entry < first_owned || entry >= end_owned)
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
      {
        match.coarse = partitioner->global_to_local(match.coarse);
        received.local_element(match.coarse) += std::abs(match.weight);
      }
    received.compress(VectorOperation::add);
    for (unsigned int i = 0; i < received.locally_owned_size(); ++i)
      if (received.local_element(i) != 0.)
        receivers.push_back(i);
    received = 0.;
  }


  /**
   * Where the plane at an end of patch @p p is a coarse-fine interface with the patch on
   * its coarser side, the patch has the inner halves of the control volumes of component
   * @p c, which is normal to it; their fluxes in direction @p d are moved to the middle
   * of these halves. At the ends of such a plane the next patch has halves with the same
   * sides, and moves those fluxes too. The other halves of these sides belong to finer
   * patches, whose fluxes stand in the middle of theirs.
   */
  template <int dim>
  void Advection<dim>::shift_fluxes(const unsigned int p,
                                    const unsigned int c,
                                    const unsigned int d,
                                    std::vector<double> &flux) const
  {
    const grid::PatchGrid<dim> &patch_grid = space.grid();
    const int n                            = patch_grid.n_cells_per_side();
    std::array<std::ptrdiff_t, dim> stride;
    std::ptrdiff_t origin = 0;
    for (unsigned int e = 0; e < dim; ++e)
      {
        stride[e] = (e == 0 ? 1 : stride[e - 1] * halo.extents(c)[e - 1]);
        origin += halo.width() * stride[e];
      }
    // the direction along the plane that is not d
    const unsigned int other = (dim == 3 ? 3 - c - d : d);
    const int n_other        = (dim == 3 ? n : 1);
    for (unsigned int upper = 0; upper < 2; ++upper)
      {
        const Neighbor neighbor = patch_grid.neighbor(p, 2 * c + upper);
        if (neighbor != Neighbor::finer && neighbor != Neighbor::same)
          continue;
        const std::ptrdiff_t plane = origin + (upper == 1 ? n * stride[c] : 0),
                             inner = (upper == 1 ? -stride[c] : stride[c]);
        for (int i = 0; i <= n; ++i)
          {
            if (neighbor == Neighbor::same)
              {
                if (i > 0 && i < n)
                  continue;
                // a finer leaf that touches this edge of the plane
                std::array<int, dim> beyond;
                for (unsigned int e = 0; e < dim; ++e)
                  beyond[e] = 2 * patch_grid.patch(p).index[e];
                beyond[c] += (upper == 1 ? 2 : -1);
                beyond[d] += (i == 0 ? -1 : 2);
                if (patch_grid.neighbor(p, 2 * d + (i == 0 ? 0 : 1)) != Neighbor::same ||
                    patch_grid.find(patch_grid.patch(p).level + 1, beyond) ==
                      numbers::invalid_unsigned_int)
                  continue;
              }
            for (int k = 0; k < n_other; ++k)
              {
                const std::ptrdiff_t at =
                  plane + i * stride[d] + (dim == 3 ? k * stride[other] : 0);
                flux[at] = 0.75 * flux[at] + 0.25 * flux[at + inner];
              }
          }
      }
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
    if (c != d)
      shift_fluxes(p, c, d, flux);
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

    // rows are read, and buffers of rows written, beyond the end by less than two blocks
    constexpr std::size_t slack = 2 * Lanes::size();
    std::array<std::vector<double>, dim> padded;
    for (unsigned int c = 0; c < dim; ++c)
      padded[c].assign(halo.size(c) + slack, 0.);
    std::vector<double> flux(halo.size(0));
    const std::size_t row_size = patch_grid.n_cells_per_side() + 3 + slack;
    std::vector<double> lower(row_size), upper(row_size);

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
                const auto ed = halo.extents(d);
                std::array<std::ptrdiff_t, 3> stride_d{{1, 1, 1}};
                for (unsigned int b = 1; b < dim; ++b)
                  stride_d[b] = stride_d[b - 1] * ed[b - 1];
                std::ptrdiff_t first_d = 0;
                for (unsigned int b = 0; b < dim; ++b)
                  first_d += g * stride_d[b];
                const double *advecting = padded[d].data() + first_d;
                // the advecting velocity is the mean of two values this far apart
                const std::ptrdiff_t back = stride_d[c];

                // Fluxes stand at the lower ends of the control volumes, one more at the
                // end; parabolas are needed on the volumes on both sides of each.
                constexpr int width = Lanes::size();
                if (d == 0)
                  {
                    for (int k = 0; k < size[2]; ++k)
                      for (int j = 0; j < size[1]; ++j)
                        {
                          const std::ptrdiff_t row =
                            j * stride[1] + (dim == 3 ? k * stride[2] : 0);
                          const double *a = advecting + j * stride_d[1] +
                                            (dim == 3 ? k * stride_d[2] : 0);
                          for (int i = 0; i < size[0] + 2; i += width)
                            {
                              const double *x   = q + row + i - 1;
                              const Lanes below = load(x - 1), here = load(x),
                                          above = load(x + 1), before = load(x - 2);
                              Lanes lo, up;
                              Reconstruction<scheme> reconstruction;
                              reconstruction.start(before, below, here, above);
                              reconstruction.next(
                                before, below, here, above, load(x + 2), lo, up);
                              lo.copy_to(lower.data() + i, stdx::element_aligned);
                              up.copy_to(upper.data() + i, stdx::element_aligned);
                            }
                          double *f = flux.data() + first + row;
                          for (int i = 0; i < size[0] + 1; i += width)
                            store(upwind_flux<scheme>(load(a + i) + load(a + i - back),
                                                      load(upper.data() + i),
                                                      load(lower.data() + i + 1)),
                                  f + i,
                                  size[0] + 1 - i);
                        }
                  }
                else
                  {
                    // the direction that is neither that of rows nor that of fluxes
                    const unsigned int o = (dim == 3 ? 3 - d : 2);
                    for (int k = 0; k < (dim == 3 ? size[o] : 1); ++k)
                      for (int i = 0; i < size[0]; i += width)
                        {
                          const std::ptrdiff_t line = i + (dim == 3 ? k * stride[o] : 0);
                          const double *a =
                            advecting + i + (dim == 3 ? k * stride_d[o] : 0);
                          double *f       = flux.data() + first + line;
                          const double *x = q + line - stride[d];
                          Lanes before    = load(x - 2 * stride[d]),
                                below = load(x - stride[d]), here = load(x),
                                above = load(x + stride[d]), lo, up, up_below = 0.;
                          Reconstruction<scheme> reconstruction;
                          reconstruction.start(before, below, here, above);
                          for (int j = -1; j <= size[d]; ++j)
                            {
                              const Lanes after = load(q + line + (j + 2) * stride[d]);
                              reconstruction.next(
                                before, below, here, above, after, lo, up);
                              if (j >= 0)
                                {
                                  const double *speed = a + j * stride_d[d];
                                  store(upwind_flux<scheme>(
                                          load(speed) + load(speed - back), up_below, lo),
                                        f + j * stride[d],
                                        size[0] - i);
                                }
                              up_below = up;
                              before   = below;
                              below    = here;
                              here     = above;
                              above    = after;
                            }
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
    else if (scheme == AdvectionScheme::monotone_ppm)
      apply_scheme<AdvectionScheme::monotone_ppm>(dst, imported, inhomogeneous);
    else if (scheme == AdvectionScheme::cui)
      apply_scheme<AdvectionScheme::cui>(dst, imported, inhomogeneous);
    else
      apply_scheme<AdvectionScheme::centered>(dst, imported, inhomogeneous);
    if (space.grid().has_coarse_fine_interfaces())
      {
        received.compress(VectorOperation::add);
        for (const unsigned int i : receivers)
          {
            dst.local_element(i) += received.local_element(i);
            received.local_element(i) = 0.;
          }
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
