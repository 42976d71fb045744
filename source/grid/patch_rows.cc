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
  const typename PatchRows<dim>::Reads &PatchRows<dim>::reads() const
  {
    if (known_reads)
      return *known_reads;
    auto reads = std::make_unique<Reads>();

    // Step 1: what is read, by leaf. Between calls the table is zero.
    unsigned int n_entries = 0;
    for (const Set &set : sets)
      for (const unsigned int entry : set.entries)
        n_entries = std::max(n_entries, entry + 1);
    thread_local std::vector<unsigned int> table;
    if (table.size() < leaves.size() * n_entries)
      table.resize(leaves.size() * n_entries, 0);
    std::vector<std::vector<unsigned int>> by_leaf(leaves.size());
    for (const Set &set : sets)
      for (unsigned int s = 0; s < set.leaves.size(); ++s)
        for (unsigned int k = set.entry_starts[s]; k < set.entry_starts[s + 1]; ++k)
          {
            unsigned int &mark = table[set.leaves[s] * n_entries + set.entries[k]];
            if (mark == 0)
              by_leaf[set.leaves[s]].push_back(set.entries[k]);
            mark = 1;
          }
    reads->starts = {0};
    for (unsigned int leaf = 0; leaf < leaves.size(); ++leaf)
      {
        std::sort(by_leaf[leaf].begin(), by_leaf[leaf].end());
        for (const unsigned int entry : by_leaf[leaf])
          {
            table[leaf * n_entries + entry] = reads->entries.size();
            reads->entries.push_back(entry);
          }
        reads->starts.push_back(reads->entries.size());
      }

    // Step 2: where each entry of a row is among them.
    for (const Set &set : sets)
      {
        auto &of_set = reads->of_set.emplace_back();
        of_set.reserve(set.entries.size());
        for (unsigned int s = 0; s < set.leaves.size(); ++s)
          for (unsigned int k = set.entry_starts[s]; k < set.entry_starts[s + 1]; ++k)
            of_set.push_back(table[set.leaves[s] * n_entries + set.entries[k]]);
      }
    for (unsigned int leaf = 0; leaf < leaves.size(); ++leaf)
      for (const unsigned int entry : by_leaf[leaf])
        table[leaf * n_entries + entry] = 0;
    known_reads = std::move(reads);
    return *known_reads;
  }


  template <int dim>
  std::size_t PatchRows<dim>::memory_consumption() const
  {
    std::size_t sum = leaves.size() * sizeof(RelativeLeaf);
    for (const Set &set : sets)
      sum += set.memory_consumption();
    if (known_reads)
      {
        sum += 4 * (known_reads->starts.size() + known_reads->entries.size());
        for (const auto &of_set : known_reads->of_set)
          sum += 4 * of_set.size();
      }
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
    const auto by_leaf = [](const auto &a, const auto &b) {
      return std::get<0>(a) < std::get<0>(b);
    };
    if (!std::is_sorted(entries.begin(), entries.end(), by_leaf))
      std::stable_sort(entries.begin(), entries.end(), by_leaf);
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
    if (!any)
      return nullptr;
    // they may be kept for the rest of the run
    for (auto &set : rows->sets)
      {
        const auto shrink = [](auto &...vectors) { (vectors.shrink_to_fit(), ...); };
        shrink(set.destinations,
               set.starts,
               set.leaves,
               set.entry_starts,
               set.entries,
               set.weights,
               set.auxiliary_starts,
               set.auxiliary_columns,
               set.auxiliary_weights,
               set.boundary_terms);
      }
    return rows;
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
        const bool is_owned = q < grid.n_owned_patches();
        first_entries.push_back(is_owned ? q * n_dofs_per_patch
                                         : numbers::invalid_unsigned_int);
        remote = remote || !is_owned;
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
  void RowTable<dim>::for_each_remote_leaf(const Operation &operation) const
  {
    for (const unsigned int p : remote_parts)
      for (unsigned int leaf = 0; leaf < parts[p].rows->leaves.size(); ++leaf)
        {
          const unsigned int q = leaf_patches[parts[p].leaves + leaf];
          if (q >= grid.n_owned_patches())
            operation(p, leaf, q - grid.n_owned_patches());
        }
  }


  template <int dim>
  void RowTable<dim>::collect_ghosts(std::vector<types::global_dof_index> &ghosts) const
  {
    // marked by ghost leaf and entry, as each is read by many rows
    const unsigned int n_owned = grid.n_owned_patches();
    std::vector<std::vector<bool>> is_read(grid.n_local_patches() - n_owned);
    for_each_remote_leaf(
      [&](const unsigned int p, const unsigned int leaf, const unsigned int ghost) {
        const auto &reads = parts[p].rows->reads();
        is_read[ghost].resize(n_dofs_per_patch, false);
        for (unsigned int k = reads.starts[leaf]; k < reads.starts[leaf + 1]; ++k)
          is_read[ghost][reads.entries[k]] = true;
      });
    for (unsigned int ghost = 0; ghost < is_read.size(); ++ghost)
      for (unsigned int entry = 0; entry < is_read[ghost].size(); ++entry)
        if (is_read[ghost][entry])
          ghosts.push_back(grid.patch(n_owned + ghost).global_id * n_dofs_per_patch +
                           entry);
  }


  template <int dim>
  void RowTable<dim>::localize(const Utilities::MPI::Partitioner &partitioner)
  {
    if (remote_parts.empty())
      return;

    // Step 1: the entries of each ghost leaf, ascending, and the local number of its
    // first.
    const unsigned int n_owned = grid.n_owned_patches();
    const unsigned int n_ghost = grid.n_local_patches() - n_owned;
    std::vector<std::vector<unsigned int>> entries(n_ghost);
    std::vector<unsigned int> local(n_ghost, 0);
    unsigned int next = partitioner.locally_owned_size(), ghost = 0;
    types::global_dof_index first = 0, last = 0; // of this leaf
    for (const types::global_dof_index unknown : partitioner.ghost_indices())
      {
        if (unknown < first || unknown >= last)
          {
            first        = unknown / n_dofs_per_patch * n_dofs_per_patch;
            last         = first + n_dofs_per_patch;
            ghost        = grid.local_patch(unknown / n_dofs_per_patch) - n_owned;
            local[ghost] = next;
          }
        entries[ghost].push_back(unknown - first);
        ++next;
      }

    // Step 2: where each part finds what it reads of them.
    for_each_remote_leaf(
      [&](const unsigned int p, const unsigned int leaf, const unsigned int ghost) {
        const auto &reads = parts[p].rows->reads();
        parts[p].places.resize(reads.entries.size(), numbers::invalid_unsigned_int);
        std::size_t at = 0;
        for (unsigned int k = reads.starts[leaf]; k < reads.starts[leaf + 1]; ++k)
          {
            while (entries[ghost][at] < reads.entries[k])
              ++at;
            parts[p].places[k] = local[ghost] + at;
          }
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
        sum += 4 * part.places.size();
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
            configuration.in_use         = true;
            configurations[p][direction] = &configuration;
          }
      }

    // what is not there any more is kept, as it may come back, in twice the memory of
    // what is
    std::size_t memory_used = 0, memory_unused = 0;
    for (const auto &entry : known)
      for (const auto &rows : entry.second.rows)
        if (rows.second != nullptr)
          (entry.second.in_use ? memory_used : memory_unused) +=
            rows.second->memory_consumption();
    if (memory_unused > 2 * memory_used)
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
