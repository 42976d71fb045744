#include <algorithm>
#include <limits>
#include <set>

#include <mitre/grid/patch_rows.h>

namespace mitre::grid
{
  using namespace dealii;

  template <int dim>
  std::size_t PatchRows<dim>::Set::memory_consumption() const
  {
    return 12 * (destinations.size() + entries.size()) + 8 * leaves.size() +
           10 * auxiliary_columns.size() +
           sizeof(boundary_terms[0]) * boundary_terms.size();
  }


  template <int dim>
  std::size_t PatchRows<dim>::memory_consumption() const
  {
    std::size_t sum = leaves.size() * sizeof(RelativeLeaf);
    for (const Set &set : sets)
      sum += set.memory_consumption();
    return sum;
  }


  namespace
  {
    /// Position among the leaves that are @p levels finer (or coarser if negative).
    int shifted(const int index, const int levels)
    {
      return levels >= 0 ? index * (1 << levels) : index >> -levels;
    }
  } // namespace


  template <int dim>
  PatchRowsBuilder<dim>::PatchRowsBuilder(const PatchGrid<dim> &grid,
                                          const unsigned int patch,
                                          const unsigned int n_dofs_per_patch,
                                          const unsigned int n_sets)
    : grid(grid)
    , patch(grid.patch(patch))
    , n_dofs_per_patch(n_dofs_per_patch)
    , rows(std::make_shared<PatchRows<dim>>())
  {
    rows->sets.resize(n_sets);
    for (auto &set : rows->sets)
      set.entry_starts = {0};
  }


  template <int dim>
  unsigned int
  PatchRowsBuilder<dim>::leaf_number(const types::global_dof_index global_patch)
  {
    const auto [entry, is_new] =
      leaf_numbers.try_emplace(global_patch, rows->leaves.size());
    if (is_new)
      {
        const Patch<dim> &other = grid.patch(grid.local_patch(global_patch));
        typename PatchRows<dim>::RelativeLeaf leaf;
        leaf.level = other.level - patch.level;
        for (unsigned int d = 0; d < dim; ++d)
          leaf.offset[d] = other.index[d] - shifted(patch.index[d], leaf.level);
        rows->leaves.push_back(leaf);
      }
    return entry->second;
  }


  template <int dim>
  void PatchRowsBuilder<dim>::append(const unsigned int set,
                                     const unsigned int destination,
                                     LinearCombination<dim> &row)
  {
    auto &to = rows->sets[set];
    for (const auto &[value, weight] : row.auxiliary)
      {
        Assert(value <= std::numeric_limits<unsigned short int>::max(),
               ExcInternalError());
        to.auxiliary_columns.push_back(value);
        to.auxiliary_weights.push_back(weight);
      }
    to.auxiliary_starts.push_back(to.auxiliary_columns.size());
    if (row.repeats)
      {
        sum.add(row, 1.);
        sum.move_to(row);
      }
    for (const auto &term : row.boundary)
      to.boundary_terms.emplace_back(to.destinations.size(), term);
    to.destinations.push_back(destination);

    // entries of a leaf follow each other, the leaves in the order in which they come up
    entries.clear();
    types::global_dof_index first = 0, last = 0; // of the last entry's leaf
    unsigned int leaf = 0;
    for (const auto &[unknown, weight] : row.entries)
      {
        if (unknown < first || unknown >= last)
          {
            const types::global_dof_index global_patch = unknown / n_dofs_per_patch;
            first                                      = global_patch * n_dofs_per_patch;
            last                                       = first + n_dofs_per_patch;
            leaf                                       = leaf_number(global_patch);
          }
        entries.emplace_back(leaf, unknown - first, weight);
      }
    std::stable_sort(entries.begin(), entries.end(), [](const auto &a, const auto &b) {
      return std::get<0>(a) < std::get<0>(b);
    });
    for (std::size_t k = 0; k < entries.size(); ++k)
      {
        const auto &[entry_leaf, number, weight] = entries[k];
        if (k == 0 || entry_leaf != to.leaves.back())
          {
            to.leaves.push_back(entry_leaf);
            to.entry_starts.push_back(to.entry_starts.back());
          }
        to.entries.push_back(number);
        to.weights.push_back(weight);
        ++to.entry_starts.back();
      }
    to.starts.push_back(to.leaves.size());
  }


  template <int dim>
  std::shared_ptr<const PatchRows<dim>> PatchRowsBuilder<dim>::finish()
  {
    const bool any = std::any_of(rows->sets.begin(),
                                 rows->sets.end(),
                                 [](const auto &set) { return set.n_rows() > 0; });
    return any ? rows : nullptr;
  }


  template <int dim>
  RowTable<dim>::RowTable(const PatchGrid<dim> &grid, const unsigned int n_dofs_per_patch)
    : grid(grid)
    , n_dofs_per_patch(n_dofs_per_patch)
  {
  }


  template <int dim>
  void RowTable<dim>::append(std::shared_ptr<const PatchRows<dim>> rows)
  {
    if (!rows)
      return;
    const Patch<dim> &patch = grid.patch(starts.size() - 1);
    bool remote             = false;
    Part part;
    part.leaves = leaf_patches.size();
    for (const auto &leaf : rows->leaves)
      {
        typename PatchGrid<dim>::Index index;
        for (unsigned int d = 0; d < dim; ++d)
          index[d] = shifted(patch.index[d], leaf.level) + leaf.offset[d];
        const unsigned int q = grid.find(patch.level + leaf.level, index);
        AssertThrow(q != numbers::invalid_unsigned_int, ExcInternalError());
        leaf_patches.push_back(q);
        first_entries.push_back(q * n_dofs_per_patch);
        remote = remote || q >= grid.n_owned_patches();
      }
    if (remote)
      remote_parts.push_back(parts.size());
    for (const auto &set : rows->sets)
      if (!set.boundary_terms.empty())
        {
          parts_at_boundary.push_back(parts.size());
          break;
        }
    part.rows = std::move(rows);
    parts.push_back(std::move(part));
  }


  template <int dim>
  void RowTable<dim>::finish_patch()
  {
    starts.push_back(parts.size());
  }


  template <int dim>
  template <typename Operation>
  void RowTable<dim>::for_each_remote_entry(const Operation &operation) const
  {
    for (const unsigned int p : remote_parts)
      {
        const Part &part = parts[p];
        for (unsigned int set = 0; set < part.rows->sets.size(); ++set)
          {
            const auto &rows = part.rows->sets[set];
            for (unsigned int s = 0; s < rows.leaves.size(); ++s)
              {
                const unsigned int q = leaf_patches[part.leaves + rows.leaves[s]];
                for (unsigned int k = rows.entry_starts[s]; k < rows.entry_starts[s + 1];
                     ++k)
                  operation(p, set, k, q, rows.entries[k]);
              }
          }
      }
  }


  template <int dim>
  void RowTable<dim>::collect_ghosts(std::vector<types::global_dof_index> &ghosts) const
  {
    // marked by ghost leaf and entry, as each is read by many rows
    const unsigned int n_owned = grid.n_owned_patches();
    std::vector<char> is_read(
      (grid.n_local_patches() - n_owned) * static_cast<std::size_t>(n_dofs_per_patch), 0);
    for_each_remote_entry([&](const unsigned int,
                              const unsigned int,
                              const unsigned int,
                              const unsigned int q,
                              const unsigned int entry) {
      if (q >= n_owned)
        is_read[static_cast<std::size_t>(q - n_owned) * n_dofs_per_patch + entry] = 1;
    });
    for (unsigned int q = n_owned; q < grid.n_local_patches(); ++q)
      for (unsigned int entry = 0; entry < n_dofs_per_patch; ++entry)
        if (is_read[static_cast<std::size_t>(q - n_owned) * n_dofs_per_patch + entry])
          ghosts.push_back(grid.patch(q).global_id * n_dofs_per_patch + entry);
  }


  template <int dim>
  void RowTable<dim>::localize(const Utilities::MPI::Partitioner &partitioner)
  {
    if (remote_parts.empty())
      return;
    // local numbers by ghost leaf and entry
    const unsigned int n_owned = grid.n_owned_patches();
    std::vector<unsigned int> numbers((grid.n_local_patches() - n_owned) *
                                        static_cast<std::size_t>(n_dofs_per_patch),
                                      dealii::numbers::invalid_unsigned_int);
    unsigned int local = partitioner.locally_owned_size(), q = 0;
    types::global_dof_index first = 0, last = 0; // of the leaf q
    for (const types::global_dof_index ghost : partitioner.ghost_indices())
      {
        if (ghost < first || ghost >= last)
          {
            first = ghost / n_dofs_per_patch * n_dofs_per_patch;
            last  = first + n_dofs_per_patch;
            q     = grid.local_patch(ghost / n_dofs_per_patch) - n_owned;
          }
        numbers[static_cast<std::size_t>(q) * n_dofs_per_patch + (ghost - first)] =
          local++;
      }
    for (const unsigned int p : remote_parts)
      {
        Part &part = parts[p];
        part.places.resize(part.rows->sets.size());
        for (unsigned int set = 0; set < part.places.size(); ++set)
          part.places[set].resize(part.rows->sets[set].entries.size());
      }
    for_each_remote_entry([&](const unsigned int p,
                              const unsigned int set,
                              const unsigned int k,
                              const unsigned int patch,
                              const unsigned int entry) {
      parts[p].places[set][k] =
        patch < n_owned
          ? patch * n_dofs_per_patch + entry
          : numbers[static_cast<std::size_t>(patch - n_owned) * n_dofs_per_patch + entry];
    });
  }


  template <int dim>
  void RowTable<dim>::set_boundary_values(
    const std::function<double(const BoundaryTerm<dim> &)> &prescribed)
  {
    for (const unsigned int p : parts_at_boundary)
      {
        Part &part = parts[p];
        part.boundary_values.resize(part.rows->sets.size());
        for (unsigned int set = 0; set < part.rows->sets.size(); ++set)
          {
            const auto &rows = part.rows->sets[set];
            auto &values     = part.boundary_values[set];
            if (rows.boundary_terms.empty())
              continue;
            values.assign(rows.n_rows(), 0.);
            for (const auto &[row, term] : rows.boundary_terms)
              values[row] += term.weight * prescribed(term);
          }
      }
  }


  template <int dim>
  unsigned int RowTable<dim>::most_rows(const unsigned int first_set) const
  {
    unsigned int most = 0;
    for (const Part &part : parts)
      for (unsigned int set = first_set; set < part.rows->sets.size(); ++set)
        most = std::max(most, part.rows->sets[set].n_rows());
    return most;
  }


  template <int dim>
  std::size_t RowTable<dim>::memory_consumption() const
  {
    std::set<const PatchRows<dim> *> different;
    std::size_t sum = parts.size() * sizeof(Part) + 8 * leaf_patches.size();
    for (const Part &part : parts)
      {
        if (different.insert(part.rows.get()).second)
          sum += part.rows->memory_consumption();
        for (const auto &places : part.places)
          sum += 4 * places.size();
        for (const auto &values : part.boundary_values)
          sum += 8 * values.size();
      }
    return sum;
  }


  template <int dim>
  void RowCache<dim>::update(const PatchGrid<dim> &grid)
  {
    constexpr unsigned int n_directions = Direction<dim>::count;

    // Rows reach less than eight cells beyond a patch.
    shares = may_share && grid.n_cells_per_side() >= 8;

    for (auto &entry : known)
      entry.second.in_use = false;
    configurations.assign(grid.n_owned_patches(), {});
    std::size_t n_used = 0;
    std::string key;
    for (unsigned int p = 0; p < grid.n_owned_patches(); ++p)
      {
        // what is there: a leaf of this level, finer or coarser ones, or the boundary
        const Patch<dim> &patch = grid.patch(p);
        std::array<char, n_directions> kinds, children{};
        bool regular = true;
        for (unsigned int k = 0; k < n_directions; ++k)
          {
            typename PatchGrid<dim>::Index neighbor = Direction<dim>::offset(k), finer;
            bool outside                            = false;
            for (unsigned int d = 0; d < dim; ++d)
              {
                neighbor[d] += patch.index[d];
                finer[d] = 2 * neighbor[d];
                outside =
                  outside ||
                  (!grid.periodic()[d] &&
                   (neighbor[d] < 0 || neighbor[d] >= grid.n_patches(patch.level, d)));
              }
            kinds[k] = 's';
            if (outside)
              kinds[k] = 'b';
            else if (grid.find(patch.level, neighbor) == numbers::invalid_unsigned_int)
              {
                for (unsigned int child = 0; child < (1u << dim); ++child)
                  {
                    typename PatchGrid<dim>::Index at = finer;
                    for (unsigned int d = 0; d < dim; ++d)
                      at[d] += (child >> d) & 1;
                    if (grid.find(patch.level + 1, at) != numbers::invalid_unsigned_int)
                      children[k] |= static_cast<char>(1u << child);
                  }
                kinds[k] = (children[k] != 0 ? 'f' : 'c');
              }
            regular = regular && kinds[k] == 's';
          }
        if (regular)
          continue;

        configurations[p].assign(n_directions, nullptr);
        for (unsigned int direction = 0; direction < n_directions; ++direction)
          {
            if (direction == Direction<dim>::center)
              continue;
            const auto offset = Direction<dim>::offset(direction);
            key = {static_cast<char>(patch.level), static_cast<char>(direction)};
            bool all_same = true, at_boundary = false, any_coarser = false;
            for (unsigned int k = 0; k < n_directions; ++k)
              {
                const auto other = Direction<dim>::offset(k);
                bool beside      = true;
                for (unsigned int d = 0; d < dim; ++d)
                  beside = beside && offset[d] * other[d] >= 0;
                if (!beside)
                  continue;
                key.push_back(kinds[k]);
                key.push_back(children[k]);
                all_same    = all_same && kinds[k] == 's';
                at_boundary = at_boundary || kinds[k] == 'b';
                any_coarser = any_coarser || kinds[k] == 'c';
              }
            if (all_same)
              continue;
            for (unsigned int d = 0; d < dim; ++d)
              if (at_boundary)
                for (unsigned int byte = 0; byte < 3; ++byte)
                  key.push_back(static_cast<char>((patch.index[d] >> (8 * byte)) & 255));
              else if (any_coarser)
                key.push_back(static_cast<char>(patch.index[d] & 1));
            Configuration &configuration = known[key];
            n_used += configuration.in_use ? 0 : 1;
            configuration.in_use         = true;
            configurations[p][direction] = &configuration;
          }
      }

    // what has not been met for long is forgotten
    if (known.size() > 4 * n_used + 10000)
      for (auto entry = known.begin(); entry != known.end();)
        entry = entry->second.in_use ? std::next(entry) : known.erase(entry);
  }


  template <int dim>
  void RowCache<dim>::append_to(RowTable<dim> &table,
                                const unsigned int p,
                                const unsigned int kind,
                                const std::function<Rows(const unsigned int)> &build)
  {
    for (unsigned int direction = 0; direction < configurations[p].size(); ++direction)
      {
        Configuration *configuration = configurations[p][direction];
        if (configuration == nullptr)
          continue;
        if (!shares)
          {
            table.append(build(direction));
            continue;
          }
        const auto [entry, is_new] = configuration->rows.try_emplace(kind, nullptr);
        if (is_new)
          entry->second = build(direction);
        table.append(entry->second);
      }
  }


  template struct PatchRows<2>;
  template struct PatchRows<3>;
  template class PatchRowsBuilder<2>;
  template class PatchRowsBuilder<3>;
  template class RowTable<2>;
  template class RowTable<3>;
  template class RowCache<2>;
  template class RowCache<3>;
} // namespace mitre::grid
