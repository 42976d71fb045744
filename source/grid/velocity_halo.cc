#include <deal.II/base/index_set.h>
#include <deal.II/base/partitioner.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cstring>

#include <mitre/grid/velocity_halo.h>

namespace mitre::grid
{
  using namespace dealii;

  template <int dim>
  VelocityHalo<dim>::VelocityHalo(const StaggeredSpace<dim> &space,
                                  const unsigned int width,
                                  const HaloShape shape,
                                  const BoundaryExtension extension)
    : space(space)
    , n(space.grid().n_cells_per_side())
    , g(width)
    , halo_shape(shape)
    , extension(extension)
    , rows(space.grid(), space.n_dofs_per_patch())
  {
    AssertThrow(2 * g <= n,
                ExcMessage("A halo of " + std::to_string(g) +
                           " layers needs patches of at least " + std::to_string(2 * g) +
                           " cells a side."));
    build();
  }


  template <int dim>
  std::array<unsigned int, dim> VelocityHalo<dim>::extents(const unsigned int c) const
  {
    std::array<unsigned int, dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = space.extent(c, d) + 2 * g;
    return result;
  }


  template <int dim>
  std::size_t VelocityHalo<dim>::size(const unsigned int c) const
  {
    std::size_t product = 1;
    for (const unsigned int e : extents(c))
      product *= e;
    return product;
  }


  template <int dim>
  void VelocityHalo<dim>::build()
  {
    const PatchGrid<dim> &grid = space.grid();

    shapes.resize(Direction<dim>::count);
    for (unsigned int direction = 0; direction < Direction<dim>::count; ++direction)
      for (unsigned int c = 0; c < dim; ++c)
        {
          const auto offset     = Direction<dim>::offset(direction);
          BlockShape &shape     = shapes[direction][c];
          shape.size            = {{1, 1, 1}};
          shape.from            = 0;
          shape.to              = 0;
          std::size_t to_stride = 1;
          for (unsigned int d = 0; d < dim; ++d)
            {
              const unsigned int own = space.extent(c, d);
              unsigned int from, to;
              if (offset[d] == 0)
                {
                  shape.size[d] = own;
                  from          = 0;
                  to            = g;
                }
              else if (offset[d] < 0)
                {
                  shape.size[d] = g;
                  from          = n - g;
                  to            = 0;
                }
              else
                {
                  shape.size[d] = g;
                  from          = own - n;
                  to            = g + own;
                }
              shape.from += static_cast<std::size_t>(from) * space.stride(c, d);
              shape.to += to * to_stride;
              to_stride *= own + 2 * g;
            }
        }

    block_starts  = {0};
    single_starts = {0};
    // width, shape and extension as a number
    const unsigned int kind = RowKind::halos + static_cast<unsigned int>(extension) +
                              2 * (static_cast<unsigned int>(halo_shape) + 2 * g);

    std::vector<std::pair<unsigned int, unsigned int>> from_ghosts;
    for (unsigned int p = 0; p < grid.n_owned_patches(); ++p)
      {
        from_ghosts.clear();
        for (unsigned int direction = 0; direction < Direction<dim>::count; ++direction)
          {
            if (!has_neighbor(direction))
              continue;
            const unsigned int q =
              grid.neighbor_patch(p, Direction<dim>::offset(direction));
            if (q < grid.n_owned_patches())
              blocks.push_back({q, static_cast<unsigned short int>(direction)});
            else if (q != numbers::invalid_unsigned_int)
              from_ghosts.emplace_back(direction, q);
          }
        block_starts.push_back(blocks.size());
        for (unsigned int c = 0; c < dim; ++c)
          {
            for (const auto &[direction, q] : from_ghosts)
              {
                const types::global_dof_index first =
                  grid.patch(q).global_id * space.n_dofs_per_patch() +
                  c * space.n_dofs_per_component();
                for_each_entry(
                  direction,
                  c,
                  [&](const unsigned int to, const unsigned int from, const Index &) {
                    single_to.push_back(to);
                    single_from_global.push_back(first + from);
                  });
              }
            single_starts.push_back(single_to.size());
          }
        space.row_cache().append_to(rows, p, kind, [&](const unsigned int direction) {
          return build_rows(p, direction);
        });
        rows.finish_patch();
      }
    auxiliary.resize(rows.most_rows(auxiliary_set(0)));
  }


  template <int dim>
  bool VelocityHalo<dim>::has_neighbor(const unsigned int direction) const
  {
    unsigned int n_nonzero = 0;
    for (const int o : Direction<dim>::offset(direction))
      n_nonzero += (o != 0 ? 1 : 0);
    return n_nonzero > 0 && (halo_shape == HaloShape::full || n_nonzero == 1);
  }


  template <int dim>
  template <typename Operation>
  void VelocityHalo<dim>::for_each_entry(const unsigned int direction,
                                         const unsigned int c,
                                         const Operation &operation) const
  {
    const BlockShape &shape = shapes[direction][c];
    const auto ext          = extents(c);
    // first entry of the block, relative to the patch's own entries
    Index start;
    std::size_t rest = shape.to;
    for (unsigned int d = 0; d < dim; ++d)
      {
        start[d] = static_cast<int>(rest % ext[d]) - static_cast<int>(g);
        rest /= ext[d];
      }
    for (unsigned int k = 0; k < shape.size[2]; ++k)
      for (unsigned int j = 0; j < shape.size[1]; ++j)
        for (unsigned int i = 0; i < shape.size[0]; ++i)
          {
            const std::array<unsigned int, 3> ijk = {{i, j, k}};
            unsigned int to = shape.to, to_stride = 1, from = shape.from;
            Index own;
            for (unsigned int d = 0; d < dim; ++d)
              {
                to += ijk[d] * to_stride;
                to_stride *= ext[d];
                from += ijk[d] * space.stride(c, d);
                own[d] = start[d] + static_cast<int>(ijk[d]);
              }
            operation(to, from, own);
          }
  }


  template <int dim>
  std::shared_ptr<const PatchRows<dim>>
  VelocityHalo<dim>::build_rows(const unsigned int p, const unsigned int direction) const
  {
    if (!has_neighbor(direction))
      return nullptr;
    const PatchGrid<dim> &grid = space.grid();
    const Patch<dim> &patch    = grid.patch(p);
    PatchRowsBuilder<dim> builder(grid, p, space.n_dofs_per_patch(), 2 * dim);
    const bool without_leaf = grid.neighbor_patch(p, Direction<dim>::offset(direction)) ==
                              numbers::invalid_unsigned_int;
    const bool has_interfaces =
      extension == BoundaryExtension::quadratic && grid.touches_other_level(p);

    LinearCombination<dim> row;
    CoarseValues<dim> coarse_values;
    std::vector<bool> on_interface(size(0), false);
    for (unsigned int c = 0; c < dim; ++c)
      {
        std::vector<std::pair<unsigned int, Index>> interpolated;
        if (has_interfaces)
          interpolated = interface_faces(p, c, direction);
        for (const auto &face : interpolated)
          on_interface[face.first] = true;
        if (without_leaf)
          for_each_entry(
            direction, c, [&](const unsigned int to, const unsigned int, Index index) {
              if (on_interface[to])
                return;
              for (unsigned int d = 0; d < dim; ++d)
                index[d] += patch.index[d] * static_cast<int>(n);
              row.clear();
              const bool found = space.combination(
                patch.level, c, index, extension, true, row, &coarse_values);
              AssertThrow(found, ExcInternalError());
              builder.append(c, to, row);
            });
        for (const auto &[to, index] : interpolated)
          {
            row.clear();
            const bool found = space.interface_value(
              patch.level, c, index, extension, row, &coarse_values);
            AssertThrow(found, ExcInternalError());
            builder.append(c, to, row);
            on_interface[to] = false;
          }
        unsigned int number = 0;
        for (LinearCombination<dim> value : coarse_values.values())
          builder.append(auxiliary_set(c), number++, value);
        coarse_values.clear();
      }
    return builder.finish();
  }


  template <int dim>
  std::vector<std::pair<unsigned int, typename VelocityHalo<dim>::Index>>
  VelocityHalo<dim>::interface_faces(const unsigned int p,
                                     const unsigned int c,
                                     const unsigned int direction) const
  {
    const PatchGrid<dim> &grid = space.grid();
    const Patch<dim> &patch    = grid.patch(p);
    const int size             = n;
    const auto ext             = extents(c);
    std::vector<std::pair<unsigned int, Index>> result;

    // the outermost planes of the patch, and what lies beside them
    for (const int plane : {0, size})
      for (unsigned int i = 0; i < Utilities::fixed_power<dim - 1>(n + 2 * g); ++i)
        {
          unsigned int to = 0, to_stride = 1, rest = i, n_outside = 0;
          Index index, beyond{};
          for (unsigned int d = 0; d < dim; ++d)
            {
              int own = plane;
              if (d != c)
                {
                  own = static_cast<int>(rest % (n + 2 * g)) - static_cast<int>(g);
                  rest /= n + 2 * g;
                  beyond[d] = (own < 0 ? -1 : own >= size ? 1 : 0);
                  n_outside += (beyond[d] != 0 ? 1 : 0);
                }
              to += (own + static_cast<int>(g)) * to_stride;
              to_stride *= ext[d];
              index[d] = patch.index[d] * size + own;
            }
          if (n_outside == 0)
            beyond[c] = (plane == 0 ? -1 : 1);
          if (n_outside > (halo_shape == HaloShape::star ? 1 : dim) ||
              Direction<dim>::number(beyond) != direction)
            continue;
          Index lower = index;
          lower[c] -= 1;
          const Neighbor below = grid.leaf_at(patch.level, lower),
                         above = grid.leaf_at(patch.level, index);
          if ((below == Neighbor::same && above == Neighbor::coarser) ||
              (below == Neighbor::coarser && above == Neighbor::same))
            result.emplace_back(to, index);
        }
    return result;
  }


  template <int dim>
  void VelocityHalo<dim>::add_ghosts(std::vector<types::global_dof_index> &ghosts) const
  {
    ghosts.insert(ghosts.end(), single_from_global.begin(), single_from_global.end());
    rows.collect_ghosts(ghosts);
  }


  template <int dim>
  void VelocityHalo<dim>::localize(
    const std::shared_ptr<const Utilities::MPI::Partitioner> &new_partitioner)
  {
    partitioner = new_partitioner;
    single_from.resize(single_from_global.size());
    for (std::size_t i = 0; i < single_from.size(); ++i)
      single_from[i] = partitioner->global_to_local(single_from_global[i]);
    single_from_global.clear();
    single_from_global.shrink_to_fit();
    rows.localize(*partitioner);
  }


  template <int dim>
  void VelocityHalo<dim>::make_own_partitioner()
  {
    const IndexSet owned = space.owned_entries();
    std::vector<types::global_dof_index> ghosts;
    add_ghosts(ghosts);
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
    IndexSet ghost_set(owned.size());
    ghost_set.add_indices(ghosts.begin(), ghosts.end());
    ghost_set.subtract_set(owned);
    localize(std::make_shared<Utilities::MPI::Partitioner>(
      owned, ghost_set, space.grid().communicator()));
    imported.reinit(partitioner);
    accumulator.reinit(partitioner);
  }


  template <int dim>
  const VectorType &VelocityHalo<dim>::import(const VectorType &u)
  {
    std::memcpy(imported.begin(), u.begin(), u.locally_owned_size() * sizeof(double));
    imported.update_ghost_values();
    return imported;
  }


  template <int dim>
  void VelocityHalo<dim>::set_boundary_values(
    const std::function<double(const BoundaryTerm<dim> &)> &prescribed)
  {
    rows.set_boundary_values(prescribed);
  }


  template <int dim>
  void VelocityHalo<dim>::copy_block(const BlockShape &shape,
                                     const unsigned int c,
                                     const double *from,
                                     double *padded) const
  {
    const unsigned int from_y = space.extent(c, 0), from_z = from_y * space.extent(c, 1);
    const unsigned int to_y = from_y + 2 * g, to_z = to_y * (space.extent(c, 1) + 2 * g);
    for (unsigned int k = 0; k < shape.size[2]; ++k)
      for (unsigned int j = 0; j < shape.size[1]; ++j)
        {
          const double *__restrict source = from + shape.from + j * from_y + k * from_z;
          double *__restrict target       = padded + shape.to + j * to_y + k * to_z;
          // rows of patches are copied in blocks whose length the compiler knows
          constexpr unsigned int block = 8;
          const unsigned int whole     = shape.size[0] - shape.size[0] % block;
          for (unsigned int i = 0; i < whole; i += block)
            std::memcpy(target + i, source + i, block * sizeof(double));
          for (unsigned int i = whole; i < shape.size[0]; ++i)
            target[i] = source[i];
        }
  }


  template <int dim>
  void VelocityHalo<dim>::gather(const VectorType &u,
                                 const unsigned int p,
                                 const unsigned int c,
                                 double *padded,
                                 const bool with_boundary_values) const
  {
    const double *values = u.begin();
    copy_block(
      shapes[Direction<dim>::center][c], c, values + space.first_dof(p, c), padded);
    for (unsigned int b = block_starts[p]; b < block_starts[p + 1]; ++b)
      copy_block(shapes[blocks[b].direction][c],
                 c,
                 values + space.first_dof(blocks[b].patch, c),
                 padded);
    const std::size_t pc = static_cast<std::size_t>(p) * dim + c;
    for (std::size_t i = single_starts[pc]; i < single_starts[pc + 1]; ++i)
      padded[single_to[i]] = values[single_from[i]];
    double *to = auxiliary.data();
    for (unsigned int part = rows.begin(p); part < rows.end(p); ++part)
      {
        rows.apply(
          part,
          auxiliary_set(c),
          values,
          nullptr,
          with_boundary_values,
          [to](const unsigned int number, const double sum) { to[number] = sum; });
        rows.apply(part,
                   c,
                   values,
                   to,
                   with_boundary_values,
                   [padded](const unsigned int destination, const double sum) {
                     padded[destination] = sum;
                   });
      }
  }


  template <int dim>
  void VelocityHalo<dim>::begin_scatter()
  {
    accumulator = 0.;
  }


  template <int dim>
  void VelocityHalo<dim>::scatter_add(const unsigned int p,
                                      const unsigned int c,
                                      const double *padded)
  {
    double *values            = accumulator.begin();
    const unsigned int from_y = space.extent(c, 0), from_z = from_y * space.extent(c, 1);
    const unsigned int to_y = from_y + 2 * g, to_z = to_y * (space.extent(c, 1) + 2 * g);
    const auto add_block = [&](const BlockShape &shape, double *from) {
      for (unsigned int k = 0; k < shape.size[2]; ++k)
        for (unsigned int j = 0; j < shape.size[1]; ++j)
          for (unsigned int i = 0; i < shape.size[0]; ++i)
            from[shape.from + i + j * from_y + k * from_z] +=
              padded[shape.to + i + j * to_y + k * to_z];
    };
    add_block(shapes[Direction<dim>::center][c], values + space.first_dof(p, c));
    for (unsigned int b = block_starts[p]; b < block_starts[p + 1]; ++b)
      add_block(shapes[blocks[b].direction][c],
                values + space.first_dof(blocks[b].patch, c));
    const std::size_t pc = static_cast<std::size_t>(p) * dim + c;
    for (std::size_t i = single_starts[pc]; i < single_starts[pc + 1]; ++i)
      values[single_from[i]] += padded[single_to[i]];
    const double *from = auxiliary.data();
    for (unsigned int part = rows.begin(p); part < rows.end(p); ++part)
      {
        std::fill_n(auxiliary.begin(), rows.n_rows(part, auxiliary_set(c)), 0.);
        rows.apply_transpose(
          part, c, values, auxiliary.data(), [padded](const unsigned int destination) {
            return padded[destination];
          });
        rows.apply_transpose(
          part, auxiliary_set(c), values, nullptr, [from](const unsigned int number) {
            return from[number];
          });
      }
  }


  template <int dim>
  void VelocityHalo<dim>::end_scatter(VectorType &density, VectorType *total)
  {
    accumulator.compress(VectorOperation::add);
    density.zero_out_ghost_values();
    std::memcpy(density.begin(),
                accumulator.begin(),
                density.locally_owned_size() * sizeof(double));
    space.collect(density);
    if (total != nullptr)
      *total = density;
    density.scale(space.inverse_volumes());
    space.synchronize(density);
  }


  template <int dim>
  std::size_t VelocityHalo<dim>::memory_consumption() const
  {
    return rows.memory_consumption() + single_to.size() * 8 + blocks.size() * 8 +
           imported.memory_consumption() + accumulator.memory_consumption();
  }


  template class VelocityHalo<2>;
  template class VelocityHalo<3>;
} // namespace mitre::grid
