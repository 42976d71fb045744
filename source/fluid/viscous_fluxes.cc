#include <mitre/fluid/viscous_fluxes.h>

namespace mitre::fluid
{
  using namespace dealii;
  using grid::BoundaryExtension;
  using grid::Neighbor;
  using grid::VectorType;

  template <int dim>
  ViscousFluxes<dim>::ViscousFluxes(const grid::StaggeredSpace<dim> &space)
    : space(space)
    , patch_grid(space.grid())
    , rows(patch_grid, space.n_dofs_per_patch())
  {
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        space.row_cache().append_to(
          rows, p, grid::RowKind::viscous_fluxes, [&](const unsigned int direction) {
            return build_rows(p, direction);
          });
        rows.finish_patch();
      }
  }


  template <int dim>
  std::shared_ptr<const grid::PatchRows<dim>>
  ViscousFluxes<dim>::build_rows(const unsigned int p, const unsigned int direction) const
  {
    const auto offset = grid::Direction<dim>::offset(direction);
    grid::PatchRowsBuilder<dim> builder(patch_grid, p, space.n_dofs_per_patch(), 1);
    const int n       = patch_grid.n_cells_per_side();
    const auto &patch = patch_grid.patch(p);
    Row row;
    unsigned int entry = 0;
    for (unsigned int c = 0; c < dim; ++c)
      {
        std::array<int, 3> own, extent{{1, 1, 1}};
        for (unsigned int d = 0; d < dim; ++d)
          extent[d] = space.extent(c, d);
        for (own[2] = 0; own[2] < extent[2]; ++own[2])
          for (own[1] = 0; own[1] < extent[1]; ++own[1])
            for (own[0] = 0; own[0] < extent[0]; ++own[0], ++entry)
              {
                Index i;
                bool here = true;
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    here = here && offset[d] == (own[d] == 0               ? -1
                                                 : own[d] == extent[d] - 1 ? 1
                                                                           : 0);
                    i[d] = patch.index[d] * n + own[d];
                  }
                if (here && is_corrected(p, c, i))
                  {
                    make_row(p, c, i, row);
                    builder.append(0, entry, row.value);
                  }
              }
      }
    return builder.finish();
  }


  template <int dim>
  bool ViscousFluxes<dim>::is_corrected(const unsigned int p,
                                        const unsigned int c,
                                        const Index &i) const
  {
    const int n       = patch_grid.n_cells_per_side();
    const auto &patch = patch_grid.patch(p);
    // copies follow their masters
    const int plane           = i[c] - patch.index[c] * n;
    const Neighbor below_kind = patch_grid.neighbor(p, 2 * c),
                   above_kind = patch_grid.neighbor(p, 2 * c + 1);
    if ((plane == 0 && below_kind == Neighbor::coarser) ||
        (plane == n && (above_kind == Neighbor::coarser || above_kind == Neighbor::same)))
      return false;
    return touches_finer(p, c, i);
  }


  template <int dim>
  void ViscousFluxes<dim>::make_row(const unsigned int p,
                                    const unsigned int c,
                                    const Index &i,
                                    Row &row) const
  {
    const auto &patch = patch_grid.patch(p);
    double volume     = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      volume *= patch.h[d];
    double control_volume = 0.;
    for (unsigned int half = 0; half < 2; ++half)
      {
        Index cell = i;
        cell[c] -= (half == 0 ? 1 : 0);
        const Neighbor leaf = patch_grid.leaf_at(patch.level, cell);
        if (leaf == Neighbor::boundary)
          continue;
        control_volume += (leaf == Neighbor::finer ? 0.25 : 0.5) * volume;
      }
    for (unsigned int half = 0; half < 2; ++half)
      {
        Index cell = i;
        cell[c] -= (half == 0 ? 1 : 0);
        const Neighbor leaf = patch_grid.leaf_at(patch.level, cell);
        if (leaf == Neighbor::same)
          add_half_balance(patch.level, c, i, half, 1. / control_volume, row);
        else if (leaf == Neighbor::finer)
          for (unsigned int k = 0; k < (1u << (dim - 1)); ++k)
            {
              Index fine;
              unsigned int bit = 0;
              for (unsigned int d = 0; d < dim; ++d)
                fine[d] = 2 * i[d] + (d == c ? 0 : static_cast<int>((k >> bit++) & 1));
              add_half_balance(patch.level + 1, c, fine, half, 1. / control_volume, row);
            }
      }

    // less the second differences
    double center = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double w = 1. / (patch.h[d] * patch.h[d]);
        center += 2. * w;
        for (const int sign : {-1, 1})
          {
            Index beyond = i;
            beyond[d] += sign;
            row.value.clear();
            const bool found = space.combination(patch.level,
                                                 c,
                                                 beyond,
                                                 BoundaryExtension::quadratic,
                                                 true,
                                                 row.value,
                                                 &row.coarse_values);
            AssertThrow(found, ExcInternalError());
            row.sum.add(row.value, -w, row.coarse_values);
          }
      }
    add_value(patch.level, c, i, center, row);
    row.sum.move_to(row.value);
  }


  template <int dim>
  void ViscousFluxes<dim>::add_value(const int level,
                                     const unsigned int c,
                                     const Index &i,
                                     const double factor,
                                     Row &row) const
  {
    bool on_interface = false;
    if (i[c] % static_cast<int>(patch_grid.n_cells_per_side()) == 0)
      {
        Index below = i;
        below[c] -= 1;
        const Neighbor a = patch_grid.leaf_at(level, below),
                       b = patch_grid.leaf_at(level, i);
        on_interface     = (a == Neighbor::same && b == Neighbor::coarser) ||
                       (a == Neighbor::coarser && b == Neighbor::same);
      }
    row.value.clear();
    const bool found =
      on_interface
        ? space.interface_value(
            level, c, i, BoundaryExtension::quadratic, row.value, &row.coarse_values)
        : space.combination(level,
                            c,
                            i,
                            BoundaryExtension::quadratic,
                            true,
                            row.value,
                            &row.coarse_values);
    AssertThrow(found, ExcInternalError());
    row.sum.add(row.value, factor, row.coarse_values);
  }


  template <int dim>
  void ViscousFluxes<dim>::add_side_flux(const int level,
                                         const unsigned int c,
                                         const Index &i,
                                         const unsigned int half,
                                         const unsigned int d,
                                         const int sign,
                                         const double factor,
                                         Row &row) const
  {
    Index beyond = i;
    beyond[c] -= (half == 0 ? 1 : 0);
    beyond[d] += sign;
    if (patch_grid.leaf_at(level, beyond) != Neighbor::finer)
      {
        double weight = 0.5 * factor / patch_grid.cell_width(level, d);
        for (unsigned int e = 0; e < dim; ++e)
          if (e != d)
            weight *= patch_grid.cell_width(level, e);
        Index other = i;
        other[d] += sign;
        add_value(level, c, other, weight, row);
        add_value(level, c, i, -weight, row);
        return;
      }
    // the finer faces of which halves lie beside this half
    for (unsigned int k = 0; k < (1u << (dim - 1)); ++k)
      {
        Index fine;
        unsigned int bit = 0, fine_half = 0;
        for (unsigned int e = 0; e < dim; ++e)
          if (e == d)
            fine[e] = (sign > 0 ? 2 * (i[e] + 1) : 2 * i[e] - 1);
          else
            {
              const int second = (k >> bit++) & 1;
              if (e == c)
                {
                  fine[e]   = 2 * i[e] + (half == 0 ? -second : second);
                  fine_half = (second == 1 ? 1 - half : half);
                }
              else
                fine[e] = 2 * i[e] + second;
            }
        add_side_flux(level + 1, c, fine, fine_half, d, -sign, -factor, row);
      }
  }


  template <int dim>
  void ViscousFluxes<dim>::add_half_balance(const int level,
                                            const unsigned int c,
                                            const Index &i,
                                            const unsigned int half,
                                            const double factor,
                                            Row &row) const
  {
    double weight = factor / patch_grid.cell_width(level, c);
    for (unsigned int e = 0; e < dim; ++e)
      if (e != c)
        weight *= patch_grid.cell_width(level, e);
    Index other = i;
    other[c] += (half == 0 ? -1 : 1);
    add_value(level, c, other, weight, row);
    add_value(level, c, i, -weight, row);
    for (unsigned int d = 0; d < dim; ++d)
      if (d != c)
        for (const int sign : {-1, 1})
          add_side_flux(level, c, i, half, d, sign, factor, row);
  }


  template <int dim>
  bool ViscousFluxes<dim>::touches_finer(const unsigned int p,
                                         const unsigned int c,
                                         const Index &i) const
  {
    const auto &patch  = patch_grid.patch(p);
    const auto leaf_at = [&](const Index &cell) {
      bool inside = true;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const int own =
            cell[d] - patch.index[d] * static_cast<int>(patch_grid.n_cells_per_side());
          inside =
            inside && own >= 0 && own < static_cast<int>(patch_grid.n_cells_per_side());
        }
      return inside ? Neighbor::same : patch_grid.leaf_at(patch.level, cell);
    };
    for (unsigned int half = 0; half < 2; ++half)
      {
        Index cell = i;
        cell[c] -= (half == 0 ? 1 : 0);
        const Neighbor leaf = leaf_at(cell);
        if (leaf == Neighbor::finer)
          return true;
        if (leaf != Neighbor::same)
          continue;
        for (unsigned int d = 0; d < dim; ++d)
          if (d != c)
            for (const int step : {-1, 1})
              {
                Index beyond = cell;
                beyond[d] += step;
                if (leaf_at(beyond) == Neighbor::finer)
                  return true;
              }
      }
    return false;
  }


  template <int dim>
  void ViscousFluxes<dim>::add_correction(VectorType &dst,
                                          const VectorType &u,
                                          const double b,
                                          const bool inhomogeneous) const
  {
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        double *own = dst.begin() + space.first_dof(p, 0);
        for (unsigned int part = rows.begin(p); part < rows.end(p); ++part)
          rows.apply(part,
                     0,
                     u.begin(),
                     nullptr,
                     inhomogeneous,
                     [own, b](const unsigned int face, const double sum) {
                       own[face] += b * sum;
                     });
      }
  }


  template class ViscousFluxes<2>;
  template class ViscousFluxes<3>;
} // namespace mitre::fluid
