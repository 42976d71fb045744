#include <algorithm>
#include <array>
#include <cmath>

#include <mitre/base/exceptions.h>
#include <mitre/fluid/advection.h>

namespace mitre::fluid
{
  using namespace dealii;
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
  }


  template <int dim>
  template <AdvectionScheme scheme>
  void Advection<dim>::apply_scheme(VectorType &dst,
                                    const VectorType &imported,
                                    const bool inhomogeneous) const
  {
    const grid::PatchGrid<dim> &patch_grid = space.grid();
    const int g                            = halo.width();

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
    space.zero_fixed_faces(dst);
    if (space.grid().has_coarse_fine_interfaces())
      space.synchronize(dst);
  }


  template class Advection<2>;
  template class Advection<3>;
} // namespace mitre::fluid
