#include <deal.II/base/index_set.h>
#include <deal.II/base/partitioner.h>
#include <deal.II/base/utilities.h>

#include <algorithm>

#include <mitre/grid/cell_halo.h>

namespace mitre::grid
{
  using namespace dealii;

  template <int dim, typename Number>
  CellHalo<dim, Number>::CellHalo(const PatchGrid<dim> &grid,
                                  const unsigned int cells_per_side)
    : patch_grid(grid)
    , m(cells_per_side)
    , cells_per_patch(Utilities::fixed_power<dim>(m))
    , cells_per_plane(Utilities::fixed_power<dim - 1>(m))
  {
    std::vector<types::global_dof_index> global;

    const auto cell_entry = [&](const int level, Index cell) {
      Index where;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const int size = grid.n_patches(level, d) * static_cast<int>(m);
          cell[d]        = (cell[d] + size) % size;
          where[d]       = cell[d] / static_cast<int>(m);
        }
      const unsigned int q = grid.find(level, where);
      AssertThrow(q != numbers::invalid_unsigned_int, ExcInternalError());
      types::global_dof_index entry = 0;
      for (int d = dim - 1; d >= 0; --d)
        entry = entry * m + (cell[d] - where[d] * static_cast<int>(m));
      return grid.patch(q).global_id * cells_per_patch + entry;
    };

    for (unsigned int p = 0; p < grid.n_owned_patches(); ++p)
      for (unsigned int side = 0; side < 2 * dim; ++side)
        {
          const unsigned int d = side / 2;
          Side s;
          s.kind           = grid.neighbor(p, side);
          s.whole          = false;
          s.patch_or_start = global.size();
          if (s.kind == Neighbor::same)
            {
              Index offset{};
              offset[d]            = (side % 2 == 1 ? 1 : -1);
              const unsigned int q = grid.neighbor_patch(p, offset);
              if (q < grid.n_owned_patches())
                {
                  s.whole          = true;
                  s.patch_or_start = q;
                }
            }
          if (s.kind != Neighbor::boundary && !s.whole)
            for (unsigned int i = 0; i < cells_per_plane; ++i)
              {
                const Patch<dim> &patch = grid.patch(p);
                Index beyond;
                unsigned int rest = i;
                for (unsigned int e = 0; e < dim; ++e)
                  if (e == d)
                    beyond[e] = patch.index[e] * static_cast<int>(m) +
                                (side % 2 == 1 ? static_cast<int>(m) : -1);
                  else
                    {
                      beyond[e] = patch.index[e] * static_cast<int>(m) + rest % m;
                      rest /= m;
                    }
                if (s.kind == Neighbor::same)
                  global.push_back(cell_entry(patch.level, beyond));
                else if (s.kind == Neighbor::coarser)
                  {
                    Index parent;
                    for (unsigned int e = 0; e < dim; ++e)
                      parent[e] = (beyond[e] < 0 ? -1 : beyond[e] / 2);
                    global.push_back(cell_entry(patch.level - 1, parent));
                  }
                else
                  for (unsigned int k = 0; k < (1u << (dim - 1)); ++k)
                    {
                      Index child;
                      unsigned int bit = 0;
                      for (unsigned int e = 0; e < dim; ++e)
                        if (e == d)
                          child[e] = 2 * beyond[e] + (side % 2 == 1 ? 0 : 1);
                        else
                          child[e] = 2 * beyond[e] + static_cast<int>((k >> bit++) & 1u);
                      global.push_back(cell_entry(patch.level + 1, child));
                    }
              }
          sides.push_back(s);
        }

    const types::global_dof_index begin =
      grid.n_owned_patches() == 0 ? 0 : grid.patch(0).global_id * cells_per_patch;
    const types::global_dof_index end =
      begin +
      static_cast<types::global_dof_index>(grid.n_owned_patches()) * cells_per_patch;
    IndexSet owned(grid.n_global_patches() * cells_per_patch);
    owned.add_range(begin, end);
    std::vector<types::global_dof_index> ghosts;
    for (const types::global_dof_index entry : global)
      if (entry < begin || entry >= end)
        ghosts.push_back(entry);
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
    IndexSet ghost_set(owned.size());
    ghost_set.add_indices(ghosts.begin(), ghosts.end());
    ghost_set.subtract_set(owned);
    partitioner = std::make_shared<Utilities::MPI::Partitioner>(
      owned, ghost_set, grid.communicator());
    entries.resize(global.size());
    for (std::size_t i = 0; i < global.size(); ++i)
      entries[i] = partitioner->global_to_local(global[i]);
  }


  template <int dim, typename Number>
  void CellHalo<dim, Number>::gather(const Vector &v,
                                     const unsigned int p,
                                     Number *padded) const
  {
    const Number *values  = v.begin();
    const Number *own     = values + static_cast<std::size_t>(p) * cells_per_patch;
    const unsigned int w  = m + 2;
    constexpr bool three  = (dim == 3);
    const unsigned int mz = three ? m : 1;
    const unsigned int wz = w * w;
    Number *first         = padded + 1 + w + (three ? wz : 0);

    for (unsigned int k = 0; k < mz; ++k)
      for (unsigned int j = 0; j < m; ++j)
        for (unsigned int i = 0; i < m; ++i)
          first[i + j * w + k * wz] = own[i + (j + k * m) * m];

    for (unsigned int side = 0; side < 2 * dim; ++side)
      {
        const unsigned int d = side / 2;
        const bool upper     = (side % 2 == 1);
        const Side &s        = sides[p * 2 * dim + side];

        // strides along the plane (a, b) and to the layer beyond the side
        const unsigned int a_to = (d == 0 ? w : 1), b_to = (d == 2 ? w : wz);
        const unsigned int normal = (d == 0 ? 1 : (d == 1 ? w : wz));
        Number *to                = first;
        if (upper)
          to += m * normal;
        else
          to -= normal;
        const unsigned int nb = three ? m : 1;

        if (s.whole)
          {
            const unsigned int a_from = (d == 0 ? m : 1), b_from = (d == 2 ? m : m * m);
            const unsigned int from_normal = (d == 0 ? 1 : (d == 1 ? m : m * m));
            const Number *from =
              values + static_cast<std::size_t>(s.patch_or_start) * cells_per_patch +
              (upper ? 0 : (m - 1) * from_normal);
            for (unsigned int b = 0; b < nb; ++b)
              for (unsigned int a = 0; a < m; ++a)
                to[a * a_to + b * b_to] = from[a * a_from + b * b_from];
          }
        else if (s.kind == Neighbor::boundary)
          {
            for (unsigned int b = 0; b < nb; ++b)
              for (unsigned int a = 0; a < m; ++a)
                to[a * a_to + b * b_to] = Number(0);
          }
        else if (s.kind == Neighbor::finer)
          {
            constexpr unsigned int n_fine = 1u << (dim - 1);
            const unsigned int *entry     = entries.data() + s.patch_or_start;
            for (unsigned int b = 0; b < nb; ++b)
              for (unsigned int a = 0; a < m; ++a, entry += n_fine)
                {
                  Number sum = 0;
                  for (unsigned int k = 0; k < n_fine; ++k)
                    sum += values[entry[k]];
                  to[a * a_to + b * b_to] = sum * Number(1. / n_fine);
                }
          }
        else
          {
            const unsigned int *entry = entries.data() + s.patch_or_start;
            for (unsigned int b = 0; b < nb; ++b)
              for (unsigned int a = 0; a < m; ++a)
                to[a * a_to + b * b_to] = values[*entry++];
          }
      }
  }


  template <int dim, typename Number>
  std::size_t CellHalo<dim, Number>::memory_consumption() const
  {
    return sides.size() * sizeof(Side) + entries.size() * sizeof(unsigned int);
  }


  template class CellHalo<2, double>;
  template class CellHalo<3, double>;
  template class CellHalo<2, float>;
  template class CellHalo<3, float>;
} // namespace mitre::grid
