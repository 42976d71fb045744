#include <deal.II/base/index_set.h>
#include <deal.II/base/partitioner.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <limits>

#include <mitre/grid/staggered_space.h>

namespace mitre::grid
{
  using namespace dealii;

  template <int dim>
  StaggeredSpace<dim>::StaggeredSpace(const PatchGrid<dim> &grid,
                                      const BoundaryKinds<dim> &boundary_kinds,
                                      const std::shared_ptr<RowCache<dim>> &cache)
    : patch_grid(grid)
    , kinds(boundary_kinds)
    , cache(cache)
    , n(grid.n_cells_per_side())
    , dofs_per_component((n + 1) * Utilities::fixed_power<dim - 1>(n))
    , interface_faces(grid, n_dofs_per_patch())
  {
    cache->update(grid);
    build_copies();
    build_interfaces();
    build_boundary();
  }


  template <int dim>
  Point<dim> StaggeredSpace<dim>::position(const unsigned int p,
                                           const unsigned int c,
                                           const Index &i) const
  {
    const Patch<dim> &patch = patch_grid.patch(p);
    Point<dim> x;
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = patch.lower[d] + (i[d] + (d == c ? 0. : 0.5)) * patch.h[d];
    return x;
  }


  template <int dim>
  Point<dim> StaggeredSpace<dim>::boundary_position(const int level,
                                                    const unsigned int c,
                                                    const Index &index,
                                                    const unsigned int side) const
  {
    const auto &[lower, upper] = patch_grid.box().get_boundary_points();
    Point<dim> x;
    for (unsigned int d = 0; d < dim; ++d)
      if (d == side / 2)
        x[d] = (side % 2 == 0 ? lower[d] : upper[d]);
      else
        {
          const double h = patch_grid.cell_width(level, d);
          x[d] =
            std::min(std::max(lower[d] + (index[d] + (d == c ? 0. : 0.5)) * h, lower[d]),
                     upper[d]);
        }
    return x;
  }


  template <int dim>
  types::global_dof_index StaggeredSpace<dim>::find_entry(const int level,
                                                          const unsigned int c,
                                                          const Index &index) const
  {
    const int in    = n;
    const int faces = patch_grid.n_patches(level, c) * in;

    const auto number = [&](const unsigned int p, const Index &first) {
      types::global_dof_index entry = 0;
      for (int d = dim - 1; d >= 0; --d)
        entry = entry * extent(c, d) + (index[d] - first[d]);
      return patch_grid.patch(p).global_id * n_dofs_per_patch() + c * dofs_per_component +
             entry;
    };

    // the patch above the face, then the one below
    Index where = patch_grid.position_of_patch(index), first;
    for (unsigned int d = 0; d < dim; ++d)
      first[d] = where[d] * in;
    if (index[c] < faces)
      {
        const unsigned int p = patch_grid.find(level, where);
        if (p != numbers::invalid_unsigned_int)
          return number(p, first);
      }
    if (index[c] == first[c] && (index[c] > 0 || patch_grid.periodic()[c]))
      {
        where[c] -= 1;
        first[c] -= in;
        const unsigned int p = patch_grid.find(level, where);
        if (p != numbers::invalid_unsigned_int)
          return number(p, first);
      }
    return numbers::invalid_dof_index;
  }


  template <int dim>
  bool StaggeredSpace<dim>::combine_finer(const int level,
                                          const unsigned int c,
                                          const Index &index,
                                          LinearCombination<dim> &result) const
  {
    const std::array<std::array<double, 4>, 3> stencils = {
      {{{-1. / 16., 9. / 16., 9. / 16., -1. / 16.}},
       {{0., 3. / 8., 3. / 4., -1. / 8.}},
       {{-1. / 8., 3. / 4., 3. / 8., 0.}}}};

    // Along each direction in turn: the stencil that the other directions' nearest faces
    // allow.
    Index base;
    for (unsigned int d = 0; d < dim; ++d)
      base[d] = 2 * index[d];
    const auto find = [&](Index at) {
      for (unsigned int d = 0; d < dim; ++d)
        {
          const int size = patch_grid.n_patches(level + 1, d) * static_cast<int>(n);
          if (patch_grid.periodic()[d])
            at[d] = (at[d] + size) % size;
          else if (at[d] < 0 || at[d] >= size + (d == c ? 1 : 0))
            return numbers::invalid_dof_index;
        }
      return find_entry(level + 1, c, at);
    };
    std::array<std::array<double, 4>, dim> weights;
    for (unsigned int d = 0; d < dim; ++d)
      {
        if (d == c)
          {
            weights[d] = {{0., 1., 0., 0.}};
            continue;
          }
        std::array<bool, 4> there;
        for (int k = 0; k < 4; ++k)
          {
            Index at = base;
            at[d] += k - 1;
            there[k] = find(at) != numbers::invalid_dof_index;
          }
        if (!there[1] || !there[2] || (!there[0] && !there[3]))
          return false;
        weights[d] = stencils[there[0] && there[3] ? 0 : there[3] ? 1 : 2];
      }

    const std::size_t n_before = result.entries.size();
    result.repeats             = result.repeats || n_before > 0;
    for (unsigned int k = 0; k < (dim == 2 ? 16 : 64); ++k)
      {
        double weight = 1.;
        Index at      = base;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const int step = (k >> (2 * d)) & 3;
            weight *= weights[d][step];
            at[d] += step - 1;
          }
        if (weight == 0.)
          continue;
        const types::global_dof_index entry = find(at);
        if (entry == numbers::invalid_dof_index)
          {
            result.entries.resize(n_before);
            return false;
          }
        result.entries.emplace_back(entry, weight);
      }
    return true;
  }


  template <int dim>
  bool StaggeredSpace<dim>::combination(const int level,
                                        const unsigned int c,
                                        Index index,
                                        const BoundaryExtension extension,
                                        const bool interpolate,
                                        LinearCombination<dim> &result,
                                        CoarseValues<dim> *coarse_values) const
  {
    // outside of the box: periodic image, or extension by the boundary condition
    for (unsigned int d = 0; d < dim; ++d)
      {
        const int size = patch_grid.n_patches(level, d) * static_cast<int>(n);
        if (patch_grid.periodic()[d])
          {
            index[d] = ((index[d] % size) + size) % size;
            continue;
          }
        const bool below = index[d] < 0;
        const bool above = (d == c ? index[d] > size : index[d] >= size);
        if (!below && !above)
          continue;

        const unsigned int side = 2 * d + (above ? 1 : 0);
        const Point<dim> x      = boundary_position(level, c, index, side);
        const BoundaryInfo info = kinds(side, x);

        const auto add = [&](const int depth, const double weight) {
          Index inside = index;
          // depth 0 is the boundary face or the cell next to the boundary
          inside[d] = above ? (d == c ? size - depth : size - 1 - depth) : depth;
          LinearCombination<dim> part;
          if (!combination(level, c, inside, extension, interpolate, part, coarse_values))
            return false;
          result.add(part, weight);
          return true;
        };

        if (d == c)
          {
            const int k = below ? -index[d] : index[d] - size;
            if (info.kind == BoundaryKind::traction)
              return add(k, 1.);
            return add(0, 2.) && add(k, -1.);
          }

        const int k = below ? -index[d] - 1 : index[d] - size;
        if (info.kind == BoundaryKind::slip)
          return add(k, 1.);
        if (extension == BoundaryExtension::quadratic && k == 0)
          {
            result.boundary.push_back({x, c, info.condition, 8. / 3.});
            return add(0, -2.) && add(1, 1. / 3.);
          }
        result.boundary.push_back({x, c, info.condition, 2.});
        return add(k, -1.);
      }

    const types::global_dof_index entry = find_entry(level, c, index);
    if (entry != numbers::invalid_dof_index)
      {
        result.repeats = result.repeats || !result.entries.empty();
        result.entries.emplace_back(entry, 1.);
        return true;
      }

    // where leaves are finer: mean over the fine faces that make up the face, or, where
    // second differences are to be right, the value that is exact for parabolas
    if (extension == BoundaryExtension::quadratic &&
        combine_finer(level, c, index, result))
      return true;
    {
      constexpr unsigned int n_fine = 1u << (dim - 1);
      std::array<types::global_dof_index, n_fine> fine;
      bool all = true;
      for (unsigned int k = 0; k < n_fine && all; ++k)
        {
          Index fine_index;
          unsigned int bit = 0;
          for (unsigned int d = 0; d < dim; ++d)
            fine_index[d] =
              2 * index[d] + (d == c ? 0 : static_cast<int>((k >> bit++) & 1));
          fine[k] = find_entry(level + 1, c, fine_index);
          all     = fine[k] != numbers::invalid_dof_index;
        }
      if (all)
        {
          result.repeats = result.repeats || !result.entries.empty();
          for (const types::global_dof_index f : fine)
            result.entries.emplace_back(f, 1. / n_fine);
          return true;
        }
    }

    if (!interpolate || level == 0)
      return false;
    Index coarse;
    return interpolate_from_coarser(
      level, c, index, extension, 0, coarse, result, coarse_values);
  }


  template <int dim>
  bool StaggeredSpace<dim>::add_coarse_value(const int level,
                                             const unsigned int c,
                                             const Index &index,
                                             const BoundaryExtension extension,
                                             const double weight,
                                             LinearCombination<dim> &result,
                                             CoarseValues<dim> *coarse_values) const
  {
    const auto compute = [&](LinearCombination<dim> &value) {
      return combination(level, c, index, extension, false, value);
    };
    if (coarse_values == nullptr)
      {
        LinearCombination<dim> value;
        if (!compute(value))
          return false;
        result.add(value, weight);
        return true;
      }
    using Place        = typename CoarseValues<dim>::Place;
    const Place &place = coarse_values->find(level, c, index, compute);
    if (place.kind == Place::unknown)
      {
        result.entries.emplace_back(place.number, weight);
      }
    else if (place.kind == Place::auxiliary)
      result.auxiliary.emplace_back(place.number, weight);
    return place.kind != Place::nowhere;
  }


  template <int dim>
  bool StaggeredSpace<dim>::add_coarse_values(
    const int level,
    const unsigned int c,
    const Index &first,
    const std::array<std::pair<unsigned int, std::array<double, 3>>, dim> &lines,
    const BoundaryExtension extension,
    LinearCombination<dim> &result,
    CoarseValues<dim> *coarse_values) const
  {
    const std::size_t n_entries   = result.entries.size(),
                      n_auxiliary = result.auxiliary.size(),
                      n_boundary  = result.boundary.size();
    result.repeats                = result.repeats || n_entries > 0;
    Index index;
    const unsigned int nz = (dim == 3 ? lines[dim - 1].first : 1);
    for (unsigned int k = 0; k < nz; ++k)
      for (unsigned int j = 0; j < lines[1].first; ++j)
        for (unsigned int i = 0; i < lines[0].first; ++i)
          {
            index[0]      = first[0] + static_cast<int>(i);
            index[1]      = first[1] + static_cast<int>(j);
            double weight = lines[0].second[i] * lines[1].second[j];
            if constexpr (dim == 3)
              {
                index[2] = first[2] + static_cast<int>(k);
                weight *= lines[2].second[k];
              }
            if (!add_coarse_value(
                  level, c, index, extension, weight, result, coarse_values))
              {
                result.entries.resize(n_entries);
                result.auxiliary.resize(n_auxiliary);
                result.boundary.resize(n_boundary);
                return false;
              }
          }
    return true;
  }


  namespace
  {
    /// A stencil along a line of coarse faces: offsets from coarser_index(), weights.
    struct Stencil
    {
      unsigned int size;
      std::array<int, 3> offset;
      std::array<double, 3> weight;
    };

    /// The index of the coarse face or cell at or below that of a fine one.
    int coarser_index(const int index)
    {
      return index >= 0 ? index / 2 : (index - 1) / 2;
    }

    /// The stencils that give the value at a fine index, the preferred one first; @p
    /// normal: along the normal of the faces.
    const std::vector<Stencil> &stencils_beside(const int index, const bool normal)
    {
      const auto tangential = [](const int near) { // the coarse neighbour on this side
        const double s = 0.25;
        return std::vector<Stencil>{
          {3, {{-near, 0, near}}, {{0.5 * s * (s - 1), 1 - s * s, 0.5 * s * (s + 1)}}},
          {3,
           {{0, near, 2 * near}},
           {{0.5 * (s - 1) * (s - 2), -s * (s - 2), 0.5 * s * (s - 1)}}},
          {3,
           {{0, -near, -2 * near}},
           {{0.5 * (s + 1) * (s + 2), -s * (s + 2), 0.5 * s * (s + 1)}}},
          {2, {{0, near, 0}}, {{1 - s, s, 0.}}},
          {1, {{0, 0, 0}}, {{1., 0., 0.}}}};
      };
      static const std::vector<Stencil> on_face = {{1, {{0, 0, 0}}, {{1., 0., 0.}}}},
                                        between =
                                          {{3, {{0, 1, 2}}, {{0.375, 0.75, -0.125}}},
                                           {3, {{1, 0, -1}}, {{0.375, 0.75, -0.125}}},
                                           {2, {{0, 1, 0}}, {{0.5, 0.5, 0.}}}},
                                        low_half  = tangential(-1),
                                        high_half = tangential(1);
      const bool odd = (index - 2 * coarser_index(index)) == 1;
      if (normal)
        return odd ? between : on_face;
      return odd ? high_half : low_half;
    }
  } // namespace


  template <int dim>
  bool
  StaggeredSpace<dim>::interpolate_from_coarser(const int level,
                                                const unsigned int c,
                                                const Index &index,
                                                const BoundaryExtension extension,
                                                const unsigned int d,
                                                Index &coarse,
                                                LinearCombination<dim> &result,
                                                CoarseValues<dim> *coarse_values) const
  {
    if (d == dim)
      return add_coarse_value(level - 1, c, coarse, extension, 1., result, coarse_values);
    if (d == 0)
      {
        // the preferred stencils in all directions, nearly everywhere
        Index first;
        std::array<std::pair<unsigned int, std::array<double, 3>>, dim> lines;
        for (unsigned int e = 0; e < dim; ++e)
          {
            const Stencil &stencil = stencils_beside(index[e], e == c)[0];
            const int lowest       = *std::min_element(stencil.offset.begin(),
                                                 stencil.offset.begin() + stencil.size);
            first[e]               = coarser_index(index[e]) + lowest;
            lines[e].first         = stencil.size;
            for (unsigned int j = 0; j < stencil.size; ++j)
              lines[e].second[stencil.offset[j] - lowest] = stencil.weight[j];
          }
        if (add_coarse_values(
              level - 1, c, first, lines, extension, result, coarse_values))
          return true;
      }

    for (const Stencil &stencil : stencils_beside(index[d], d == c))
      {
        LinearCombination<dim> candidate;
        bool possible = true;
        for (unsigned int j = 0; j < stencil.size && possible; ++j)
          {
            coarse[d] = coarser_index(index[d]) + stencil.offset[j];
            LinearCombination<dim> part;
            possible = interpolate_from_coarser(
              level, c, index, extension, d + 1, coarse, part, coarse_values);
            if (possible)
              candidate.add(part, stencil.weight[j]);
          }
        if (possible)
          {
            result.add(candidate, 1.);
            return true;
          }
      }
    return false;
  }


  template <int dim>
  void StaggeredSpace<dim>::build_copies()
  {
    const auto n_plane = Utilities::fixed_power<dim - 1>(n);
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      for (unsigned int c = 0; c < dim; ++c)
        if (patch_grid.neighbor(p, 2 * c + 1) == Neighbor::same)
          {
            Index offset{};
            offset[c]            = 1;
            const unsigned int q = patch_grid.neighbor_patch(p, offset);
            const unsigned int s = stride(c, c);
            const std::size_t to = first_dof(p, c) + n * s;
            if (q < patch_grid.n_owned_patches())
              plane_copies.push_back({to, first_dof(q, c), c});
            else
              {
                const types::global_dof_index from =
                  patch_grid.patch(q).global_id * n_dofs_per_patch() +
                  c * dofs_per_component;
                for (unsigned int i = 0; i < n_plane; ++i)
                  {
                    const std::size_t at = (i / s) * s * (n + 1) + i % s;
                    remote_copies.emplace_back(to + at, from + at);
                  }
              }
          }
  }


  template <int dim>
  void StaggeredSpace<dim>::build_interfaces()
  {
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        for (unsigned int side = 0; side < 2 * dim; ++side)
          if (patch_grid.neighbor(p, side) == Neighbor::finer)
            coarse_interface_sides.emplace_back(p, side);
        cache->append_to(
          interface_faces,
          p,
          RowKind::interface_faces,
          [&](const unsigned int direction) -> std::shared_ptr<const PatchRows<dim>> {
            Index offset{};
            for (unsigned int side = 0; side < 2 * dim; ++side)
              {
                offset[side / 2] = (side % 2 == 0 ? -1 : 1);
                if (direction == Direction<dim>::number(offset) &&
                    patch_grid.neighbor(p, side) == Neighbor::coarser)
                  return interface_rows(p, side);
                offset[side / 2] = 0;
              }
            return nullptr;
          });
        interface_faces.finish_patch();
      }
  }


  template <int dim>
  std::shared_ptr<const PatchRows<dim>>
  StaggeredSpace<dim>::interface_rows(const unsigned int p, const unsigned int side) const
  {
    PatchRowsBuilder<dim> builder(patch_grid, p, n_dofs_per_patch(), 1);
    const Patch<dim> &patch = patch_grid.patch(p);
    const unsigned int c    = side / 2;
    const unsigned int s    = stride(c, c);
    const int plane         = (side % 2 == 0 ? 0 : n);
    for (unsigned int i = 0; i < Utilities::fixed_power<dim - 1>(n); ++i)
      {
        // index of the fine face on the patch and of the coarse face that has it
        Index fine, coarse;
        unsigned int rest = i;
        for (unsigned int d = 0; d < dim; ++d)
          {
            if (d == c)
              fine[d] = plane;
            else
              {
                fine[d] = rest % n;
                rest /= n;
              }
            coarse[d] = (patch.index[d] * static_cast<int>(n) + fine[d]) / 2;
          }

        const auto value_at = [&](const Index &index, LinearCombination<dim> &value) {
          for (unsigned int d = 0; d < dim; ++d)
            if (!patch_grid.periodic()[d] && d != c &&
                (index[d] < 0 || index[d] >= patch_grid.n_patches(patch.level - 1, d) *
                                               static_cast<int>(n)))
              return false;
          return combination(
            patch.level - 1, c, index, BoundaryExtension::reflection, false, value);
        };

        LinearCombination<dim> row, center;
        const bool found = value_at(coarse, center);
        AssertThrow(found, ExcInternalError());
        row.add(center, 1.);
        for (unsigned int d = 0; d < dim; ++d)
          if (d != c)
            {
              const double offset = (fine[d] % 2 == 0 ? -0.25 : 0.25);
              LinearCombination<dim> below, above;
              Index index          = coarse;
              index[d]             = coarse[d] - 1;
              const bool has_below = value_at(index, below);
              index[d]             = coarse[d] + 1;
              const bool has_above = value_at(index, above);
              if (has_below && has_above)
                {
                  row.add(above, 0.5 * offset);
                  row.add(below, -0.5 * offset);
                }
              else if (has_above)
                {
                  row.add(above, offset);
                  row.add(center, -offset);
                }
              else if (has_below)
                {
                  row.add(center, offset);
                  row.add(below, -offset);
                }
            }
        const unsigned int in_plane = (i / s) * s * (n + 1) + i % s;
        builder.append(0, c * dofs_per_component + plane * s + in_plane, row);
      }
    return builder.finish();
  }


  template <int dim>
  void StaggeredSpace<dim>::build_boundary()
  {
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      for (unsigned int side = 0; side < 2 * dim; ++side)
        if (patch_grid.neighbor(p, side) == Neighbor::boundary)
          {
            const unsigned int c = side / 2;
            const int plane      = (side % 2 == 0 ? 0 : n);
            for (unsigned int i = 0; i < Utilities::fixed_power<dim - 1>(n); ++i)
              {
                Index index;
                unsigned int rest = i;
                BoundaryFace face;
                face.patch                   = p;
                face.side                    = side;
                face.dof                     = first_dof(p, c);
                face.cell                    = 0;
                unsigned int stride_of_cells = 1;
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    if (d == c)
                      index[d] = plane;
                    else
                      {
                        index[d] = rest % n;
                        rest /= n;
                      }
                    face.dof += index[d] * stride(c, d);
                    face.cell += std::min<int>(index[d], n - 1) * stride_of_cells;
                    stride_of_cells *= n;
                  }
                face.x                  = position(p, c, index);
                const BoundaryInfo info = kinds(side, face.x);
                face.condition          = info.condition;
                if (info.kind == BoundaryKind::traction)
                  open.push_back(face);
                else
                  fixed.push_back(face);
              }
          }
  }


  template <int dim>
  std::pair<types::global_dof_index, types::global_dof_index>
  StaggeredSpace<dim>::owned_range() const
  {
    const types::global_dof_index n_owned = patch_grid.n_owned_patches();
    const types::global_dof_index begin =
      n_owned == 0 ? 0 : patch_grid.patch(0).global_id * n_dofs_per_patch();
    return {begin, begin + n_owned * n_dofs_per_patch()};
  }


  template <int dim>
  IndexSet StaggeredSpace<dim>::owned_entries() const
  {
    const auto [begin, end] = owned_range();
    IndexSet owned(patch_grid.n_global_patches() * n_dofs_per_patch());
    owned.add_range(begin, end);
    return owned;
  }


  template <int dim>
  void StaggeredSpace<dim>::finalize(std::vector<types::global_dof_index> &&ghosts)
  {
    interface_faces.collect_ghosts(ghosts);
    for (const auto &copy : remote_copies)
      ghosts.push_back(copy.second);

    const IndexSet owned = owned_entries();
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
    IndexSet ghost_set(owned.size());
    ghost_set.add_indices(ghosts.begin(), ghosts.end());
    ghost_set.subtract_set(owned);
    vector_partitioner = std::make_shared<Utilities::MPI::Partitioner>(
      owned, ghost_set, patch_grid.communicator());

    interface_faces.localize(*vector_partitioner);
    remote_masters.clear();
    for (const auto &copy : remote_copies)
      remote_masters.push_back(vector_partitioner->global_to_local(copy.second));

    // control volumes: every patch gives half a cell to its outermost faces
    initialize_vector(master_volumes);
    initialize_vector(free_inverse_volumes);
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        double volume = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          volume *= patch_grid.patch(p).h[d];
        for (unsigned int c = 0; c < dim; ++c)
          {
            double *values = master_volumes.begin() + first_dof(p, c);
            std::fill_n(values, dofs_per_component, volume);
            const unsigned int block = stride(c, c), size = block * (n + 1);
            for (unsigned int i = 0; i < dofs_per_component; i += size)
              for (const unsigned int plane : {0u, n})
                std::fill_n(values + i + plane * block, block, 0.5 * volume);
          }
      }
    collect(master_volumes);
    for (unsigned int i = 0; i < free_inverse_volumes.locally_owned_size(); ++i)
      free_inverse_volumes.local_element(i) =
        master_volumes.local_element(i) == 0. ? 0. : 1. / master_volumes.local_element(i);
    zero_fixed_faces(free_inverse_volumes);
  }


  template <int dim>
  void StaggeredSpace<dim>::initialize_vector(VectorType &vector) const
  {
    Assert(vector_partitioner, ExcMessage("finalize() must be called first."));
    vector.reinit(vector_partitioner);
  }


  template <int dim>
  void StaggeredSpace<dim>::copy_from_masters(VectorType &u) const
  {
    double *values             = u.begin();
    const unsigned int n_plane = Utilities::fixed_power<dim - 1>(n);
    for (const PlaneCopy &copy : plane_copies)
      {
        const unsigned int s = stride(copy.c, copy.c);
        for (unsigned int i = 0; i < n_plane / s; ++i)
          for (unsigned int j = 0; j < s; ++j)
            values[copy.copy + i * s * (n + 1) + j] =
              values[copy.master + i * s * (n + 1) + j];
      }
    for (std::size_t i = 0; i < remote_copies.size(); ++i)
      values[remote_copies[i].first] = values[remote_masters[i]];
  }


  template <int dim>
  void StaggeredSpace<dim>::follow_interfaces(VectorType &u) const
  {
    double *values = u.begin();
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        double *own = values + first_dof(p, 0);
        for (unsigned int part = interface_faces.begin(p); part < interface_faces.end(p);
             ++part)
          interface_faces.apply(
            part,
            0,
            values,
            nullptr,
            false,
            [own](const unsigned int face, const double sum) { own[face] = sum; });
      }
  }


  template <int dim>
  void StaggeredSpace<dim>::synchronize(VectorType &u) const
  {
    u.update_ghost_values();
    copy_from_masters(u);
    if (patch_grid.has_coarse_fine_interfaces())
      {
        u.update_ghost_values();
        follow_interfaces(u);
      }
    u.zero_out_ghost_values();
  }


  template <int dim>
  void StaggeredSpace<dim>::collect(VectorType &f) const
  {
    collect_interfaces(f);
    collect_local_copies(f);
    collect_remote_copies(f);
  }


  template <int dim>
  void StaggeredSpace<dim>::collect_interfaces(VectorType &f) const
  {
    f.zero_out_ghost_values();
    if (!patch_grid.has_coarse_fine_interfaces())
      return;
    double *values = f.begin();
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        double *own = values + first_dof(p, 0);
        for (unsigned int part = interface_faces.begin(p); part < interface_faces.end(p);
             ++part)
          interface_faces.apply_transpose(
            part, 0, values, nullptr, [own](const unsigned int face) {
              const double value = own[face];
              own[face]          = 0.;
              return value;
            });
      }
    f.compress(VectorOperation::add);
  }


  template <int dim>
  template <typename Operation>
  void StaggeredSpace<dim>::for_each_local_copy(const Operation &operation) const
  {
    const unsigned int n_plane = Utilities::fixed_power<dim - 1>(n);
    for (const PlaneCopy &copy : plane_copies)
      {
        const unsigned int s = stride(copy.c, copy.c);
        for (unsigned int i = 0; i < n_plane / s; ++i)
          for (unsigned int j = 0; j < s; ++j)
            operation(copy.copy + i * s * (n + 1) + j, copy.master + i * s * (n + 1) + j);
      }
  }


  template <int dim>
  void StaggeredSpace<dim>::collect_local_copies(VectorType &f) const
  {
    double *values = f.begin();
    for_each_local_copy([values](const std::size_t copy, const std::size_t master) {
      values[master] += values[copy];
      values[copy] = 0.;
    });
  }


  template <int dim>
  std::vector<std::pair<std::size_t, std::size_t>>
  StaggeredSpace<dim>::local_copies_among(const VectorType &f) const
  {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    const double *values = f.begin();
    for_each_local_copy([&](const std::size_t copy, const std::size_t master) {
      if (values[copy] != 0.)
        pairs.emplace_back(copy, master);
    });
    return pairs;
  }


  template <int dim>
  void StaggeredSpace<dim>::collect_remote_copies(VectorType &f) const
  {
    double *values = f.begin();
    for (std::size_t i = 0; i < remote_copies.size(); ++i)
      {
        values[remote_masters[i]] += values[remote_copies[i].first];
        values[remote_copies[i].first] = 0.;
      }
    f.compress(VectorOperation::add);
  }


  template <int dim>
  void StaggeredSpace<dim>::zero_fixed_faces(VectorType &u) const
  {
    for (const BoundaryFace &face : fixed)
      u.local_element(face.dof) = 0.;
  }


  template class StaggeredSpace<2>;
  template class StaggeredSpace<3>;
} // namespace mitre::grid
