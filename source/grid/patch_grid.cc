#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <mitre/base/exceptions.h>
#include <mitre/grid/patch_grid.h>

namespace mitre::grid
{
  using namespace dealii;

  namespace
  {
    /// Levels with more patches than this are looked up in a hash table.
    constexpr std::uint64_t dense_limit = 1u << 22;

    template <int dim>
    BoundingBox<dim> make_box(const Point<dim> &a, const Point<dim> &b)
    {
      return BoundingBox<dim>(std::make_pair(a, b));
    }

    template <typename T, int dim>
    std::array<T, dim> read_array(ParameterHandler &prm, const std::string &name)
    {
      const std::string text                 = prm.get(name);
      const std::vector<std::string> entries = Utilities::split_string_list(text, ',');
      if (entries.size() != dim)
        throw base::UserError("Parameter \"Grid / " + name + "\" needs " +
                              std::to_string(dim) +
                              " numbers, one a direction, but is \"" + text + "\".");
      std::array<T, dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = static_cast<T>(Utilities::string_to_double(entries[d]));
      return result;
    }
  } // namespace


  template <int dim>
  void PatchGridParameters<dim>::declare_parameters(ParameterHandler &prm)
  {
    const auto repeat = [](const std::string &entry) {
      std::string text = entry;
      for (unsigned int d = 1; d < dim; ++d)
        text += ", " + entry;
      return text;
    };
    prm.declare_entry("Lower corner",
                      repeat("0"),
                      Patterns::List(Patterns::Double(), dim, dim),
                      "Corner of the fluid box with the smallest coordinates [cm].");
    prm.declare_entry("Upper corner",
                      repeat("1"),
                      Patterns::List(Patterns::Double(), dim, dim),
                      "Corner of the fluid box with the largest coordinates [cm].");
    prm.declare_entry("Base patches",
                      repeat("1"),
                      Patterns::List(Patterns::Integer(1), dim, dim),
                      "Number of patches along each direction at refinement level 0. "
                      "A grid of level L has base patches x 2^L x cells per patch side "
                      "cells along a direction.");
    prm.declare_entry("Cells per patch side",
                      "8",
                      Patterns::Integer(4, 64),
                      "Number of fluid cells along a side of a patch, a power of two. "
                      "8 adapts better, 16 computes faster.");
    prm.declare_entry("Minimum level",
                      "0",
                      Patterns::Integer(0, 12),
                      "Refinement level that every patch has at least.");
    prm.declare_entry("Maximum level",
                      "0",
                      Patterns::Integer(0, 12),
                      "Refinement level that no patch exceeds; the \"finest\" level.");
    prm.declare_entry("Periodic directions",
                      "",
                      Patterns::List(Patterns::Selection("x|y|z"), 0, dim),
                      "Directions in which the box repeats, a list of x, y, z.");
  }


  template <int dim>
  void PatchGridParameters<dim>::parse_parameters(ParameterHandler &prm)
  {
    const auto a = read_array<double, dim>(prm, "Lower corner");
    const auto b = read_array<double, dim>(prm, "Upper corner");
    base_patches = read_array<unsigned int, dim>(prm, "Base patches");
    for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d] = a[d];
        upper[d] = b[d];
        if (!(a[d] < b[d]))
          throw base::UserError("Parameter \"Grid / Upper corner\" is " +
                                std::to_string(b[d]) + " in direction " +
                                std::to_string(d) +
                                ", but must be larger than \"Lower corner\", which is " +
                                std::to_string(a[d]) + ".");
      }
    cells_per_side = prm.get_integer("Cells per patch side");
    if ((cells_per_side & (cells_per_side - 1)) != 0)
      throw base::UserError("Parameter \"Grid / Cells per patch side\" is " +
                            std::to_string(cells_per_side) +
                            ", but must be a power of two.");
    minimum_level = prm.get_integer("Minimum level");
    maximum_level = prm.get_integer("Maximum level");
    if (minimum_level > maximum_level)
      throw base::UserError("Parameter \"Grid / Minimum level\" is " +
                            std::to_string(minimum_level) +
                            ", larger than \"Maximum level\", which is " +
                            std::to_string(maximum_level) + ".");
    periodic.fill(false);
    for (const std::string &name :
         Utilities::split_string_list(prm.get("Periodic directions"), ','))
      {
        const unsigned int d = (name == "x" ? 0 : (name == "y" ? 1 : 2));
        if (d >= dim)
          throw base::UserError("Parameter \"Grid / Periodic directions\" names " + name +
                                ", which a run in " + std::to_string(dim) +
                                " dimensions does not have.");
        periodic[d] = true;
      }
  }


  namespace
  {
    /// To the base of two; @p n is a power of it.
    unsigned int logarithm(const unsigned int n)
    {
      unsigned int log = 0;
      while ((1u << log) < n)
        ++log;
      AssertThrow((1u << log) == n, ExcInternalError());
      return log;
    }
  } // namespace


  template <int dim>
  PatchGrid<dim>::PatchGrid(MPI_Comm communicator,
                            const PatchGridParameters<dim> &parameters)
    : parameters(parameters)
    , n(parameters.cells_per_side)
    , log_n(logarithm(n))
    , bounding_box(make_box(parameters.lower, parameters.upper))
    , tria(communicator)
  {
    const std::vector<unsigned int> repetitions(parameters.base_patches.begin(),
                                                parameters.base_patches.end());
    GridGenerator::subdivided_hyper_rectangle(
      tria, repetitions, parameters.lower, parameters.upper, /*colorize=*/true);

    std::vector<GridTools::PeriodicFacePair<typename Triangulation<dim>::cell_iterator>>
      pairs;
    for (unsigned int d = 0; d < dim; ++d)
      if (parameters.periodic[d])
        GridTools::collect_periodic_faces(tria, 2 * d, 2 * d + 1, d, pairs);
    if (!pairs.empty())
      tria.add_periodicity(pairs);

    tria.signals.weight.connect(
      [this](
        const typename parallel::distributed::Triangulation<dim>::cell_iterator &cell,
        const typename parallel::distributed::Triangulation<dim>::CellStatus) {
        if (exact_weight)
          return exact_weight(
            leaf_of(cell->level(), index_of(cell->center(), cell->level())));
        return 1000u + (extra_weight ? extra_weight(bounding_box_of(cell)) : 0u);
      });

    if (parameters.minimum_level > 0)
      tria.refine_global(parameters.minimum_level);
    update();
  }


  template <int dim>
  PatchGrid<dim>::PatchGrid(const PatchGrid<dim> &forest,
                            const unsigned int cells_per_side)
    : parameters([&]() {
      PatchGridParameters<dim> changed = forest.parameters;
      changed.cells_per_side           = cells_per_side;
      return changed;
    }())
    , n(cells_per_side)
    , log_n(logarithm(n))
    , bounding_box(forest.bounding_box)
    , tria(forest.communicator())
    , owned_patches(forest.owned_patches)
    , global_patches(forest.global_patches)
    , patches(forest.patches)
    , neighbors(forest.neighbors)
    , mixed_levels(forest.mixed_levels)
    , lowest_level(forest.lowest_level)
    , highest_level(forest.highest_level)
    , dense_lookup(forest.dense_lookup)
    , sparse_lookup(forest.sparse_lookup)
  {
    for (Patch<dim> &patch : patches)
      for (unsigned int d = 0; d < dim; ++d)
        patch.h[d] = cell_width(patch.level, d);
  }


  template <int dim>
  types::global_dof_index PatchGrid<dim>::n_global_cells() const
  {
    return n_global_patches() * Utilities::fixed_power<dim>(n);
  }


  template <int dim>
  BoundingBox<dim> PatchGrid<dim>::bounding_box_of(
    const typename Triangulation<dim>::cell_iterator &cell) const
  {
    return make_box(cell->vertex(0),
                    cell->vertex(GeometryInfo<dim>::vertices_per_cell - 1));
  }


  template <int dim>
  typename PatchGrid<dim>::Index PatchGrid<dim>::index_of(const Point<dim> &x,
                                                          const int level) const
  {
    Index index;
    for (unsigned int d = 0; d < dim; ++d)
      index[d] = static_cast<int>(std::floor((x[d] - parameters.lower[d]) /
                                             (parameters.upper[d] - parameters.lower[d]) *
                                             n_patches(level, d)));
    return index;
  }


  template <int dim>
  bool PatchGrid<dim>::wrap(const int level, Index &index) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      {
        const int size = n_patches(level, d);
        if (index[d] < 0 || index[d] >= size)
          {
            if (!parameters.periodic[d])
              return false;
            index[d] = ((index[d] % size) + size) % size;
          }
      }
    return true;
  }


  template <int dim>
  unsigned int PatchGrid<dim>::find(const int level, Index index) const
  {
    if (level < lowest_level || level > highest_level || !wrap(level, index))
      return numbers::invalid_unsigned_int;

    std::uint64_t key = 0;
    for (int d = dim - 1; d >= 0; --d)
      key = key * n_patches(level, d) + index[d];

    const auto &dense = dense_lookup[level - lowest_level];
    if (!dense.empty())
      return static_cast<unsigned int>(dense[key]);
    const auto &sparse = sparse_lookup[level - lowest_level];
    const auto entry   = sparse.find(key);
    return entry == sparse.end() ? numbers::invalid_unsigned_int : entry->second;
  }


  template <int dim>
  Neighbor PatchGrid<dim>::leaf_at(const int level, Index cell) const
  {
    const int size = n;
    Index finer;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const int cells = n_patches(level, d) * size;
        if (cell[d] < 0 || cell[d] >= cells)
          {
            if (!parameters.periodic[d])
              return Neighbor::boundary;
            cell[d] = (cell[d] + cells) % cells;
          }
        finer[d] = 2 * cell[d];
      }
    if (find(level, position_of_patch(cell)) != numbers::invalid_unsigned_int)
      return Neighbor::same;
    return find(level + 1, position_of_patch(finer)) != numbers::invalid_unsigned_int
             ? Neighbor::finer
             : Neighbor::coarser;
  }


  template <int dim>
  unsigned int PatchGrid<dim>::local_patch(const types::global_dof_index global_id) const
  {
    const auto first_ghost = patches.begin() + owned_patches;
    if (owned_patches > 0 && global_id >= patches[0].global_id &&
        global_id < patches[0].global_id + owned_patches)
      return global_id - patches[0].global_id;
    const auto found =
      std::lower_bound(first_ghost,
                       patches.end(),
                       global_id,
                       [](const Patch<dim> &patch, const types::global_dof_index id) {
                         return patch.global_id < id;
                       });
    Assert(found != patches.end() && found->global_id == global_id, ExcInternalError());
    return found - patches.begin();
  }


  template <int dim>
  bool PatchGrid<dim>::touches_other_level(const unsigned int p) const
  {
    for (unsigned int direction = 0; direction < Utilities::fixed_power<dim>(3u);
         ++direction)
      {
        Index index       = patches[p].index;
        unsigned int rest = direction;
        bool outside      = false;
        for (unsigned int d = 0; d < dim; ++d)
          {
            index[d] += static_cast<int>(rest % 3) - 1;
            rest /= 3;
            outside =
              outside || (!parameters.periodic[d] &&
                          (index[d] < 0 || index[d] >= n_patches(patches[p].level, d)));
          }
        if (!outside && find(patches[p].level, index) == numbers::invalid_unsigned_int)
          return true;
      }
    return false;
  }


  template <int dim>
  unsigned int
  PatchGrid<dim>::patch_of(const typename Triangulation<dim>::cell_iterator &cell) const
  {
    return find(cell->level(), index_of(cell->center(), cell->level()));
  }


  template <int dim>
  unsigned int PatchGrid<dim>::neighbor_patch(const unsigned int p,
                                              const Index &offset) const
  {
    Index index = patches[p].index;
    for (unsigned int d = 0; d < dim; ++d)
      index[d] += offset[d];
    return find(patches[p].level, index);
  }


  template <int dim>
  unsigned int PatchGrid<dim>::locate(const Point<dim> &x) const
  {
    Point<dim> inside = x;
    for (unsigned int d = 0; d < dim; ++d)
      if (!parameters.periodic[d])
        {
          if (x[d] < parameters.lower[d] || x[d] > parameters.upper[d])
            return numbers::invalid_unsigned_int;
          // the upper face of the box belongs to the last patch
          if (x[d] == parameters.upper[d])
            inside[d] -= 0.5 * cell_width(highest_level, d);
        }
    for (int level = highest_level; level >= lowest_level; --level)
      {
        const unsigned int p = find(level, index_of(inside, level));
        if (p != numbers::invalid_unsigned_int)
          return p < owned_patches ? p : numbers::invalid_unsigned_int;
      }
    return numbers::invalid_unsigned_int;
  }


  template <int dim>
  int PatchGrid<dim>::level_at(const Point<dim> &x) const
  {
    for (int level = highest_level; level >= lowest_level; --level)
      if (find(level, index_of(x, level)) != numbers::invalid_unsigned_int)
        return level;
    return -1;
  }


  template <int dim>
  void PatchGrid<dim>::update()
  {
    patches.clear();
    const auto add = [&](const typename Triangulation<dim>::active_cell_iterator &cell,
                         const types::global_dof_index id) {
      Patch<dim> patch;
      patch.level     = cell->level();
      patch.index     = index_of(cell->center(), patch.level);
      patch.global_id = id;
      for (unsigned int d = 0; d < dim; ++d)
        {
          patch.h[d]     = cell_width(patch.level, d);
          patch.lower[d] = parameters.lower[d] + patch.index[d] * patch.h[d] * n;
        }
      patches.push_back(patch);
    };
    const auto by_id = [](const Patch<dim> &a, const Patch<dim> &b) {
      return a.global_id < b.global_id;
    };

    // deal.II numbers the cells of a level in the order in which they were made, which is
    // another one after a restart, so they are numbered anew.
    using ActiveCell = typename Triangulation<dim>::active_cell_iterator;
    std::vector<std::pair<CellId, ActiveCell>> owned;
    types::global_dof_index first_id = numbers::invalid_dof_index;
    for (const auto &cell : tria.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          owned.emplace_back(cell->id(), cell);
          first_id =
            std::min<types::global_dof_index>(first_id, cell->global_active_cell_index());
        }
    std::sort(owned.begin(), owned.end(), [](const auto &a, const auto &b) {
      return a.second->level() != b.second->level()
               ? a.second->level() < b.second->level()
               : a.first < b.first;
    });
    std::vector<types::global_dof_index> ids(tria.n_active_cells());
    for (unsigned int p = 0; p < owned.size(); ++p)
      ids[owned[p].second->active_cell_index()] = first_id + p;
    GridTools::exchange_cell_data_to_ghosts<types::global_dof_index, Triangulation<dim>>(
      tria,
      [&](const ActiveCell &cell) { return ids[cell->active_cell_index()]; },
      [&](const ActiveCell &cell, const types::global_dof_index id) {
        ids[cell->active_cell_index()] = id;
      });

    for (const auto &cell : tria.active_cell_iterators())
      if (cell->is_locally_owned())
        add(cell, ids[cell->active_cell_index()]);
    owned_patches  = patches.size();
    global_patches = tria.n_global_active_cells();
    std::sort(patches.begin(), patches.end(), by_id);
    for (const auto &cell : tria.active_cell_iterators())
      if (cell->is_ghost())
        add(cell, ids[cell->active_cell_index()]);
    std::sort(patches.begin() + owned_patches, patches.end(), by_id);

    lowest_level  = 1000;
    highest_level = 0;
    for (const Patch<dim> &patch : patches)
      {
        lowest_level  = std::min(lowest_level, patch.level);
        highest_level = std::max(highest_level, patch.level);
      }
    if (patches.empty())
      lowest_level = 0;

    dense_lookup.assign(highest_level - lowest_level + 1, {});
    sparse_lookup.assign(highest_level - lowest_level + 1, {});
    for (int level = lowest_level; level <= highest_level; ++level)
      {
        std::uint64_t size = 1;
        for (unsigned int d = 0; d < dim; ++d)
          size *= n_patches(level, d);
        if (size <= dense_limit)
          dense_lookup[level - lowest_level].assign(size, -1);
      }
    for (unsigned int p = 0; p < patches.size(); ++p)
      {
        const Patch<dim> &patch = patches[p];
        std::uint64_t key       = 0;
        for (int d = dim - 1; d >= 0; --d)
          key = key * n_patches(patch.level, d) + patch.index[d];
        auto &dense = dense_lookup[patch.level - lowest_level];
        if (!dense.empty())
          dense[key] = p;
        else
          sparse_lookup[patch.level - lowest_level][key] = p;
      }

    neighbors.resize(owned_patches * 2 * dim);
    bool mixed = false;
    for (unsigned int p = 0; p < owned_patches; ++p)
      for (unsigned int side = 0; side < 2 * dim; ++side)
        {
          const unsigned int d = side / 2;
          Index index          = patches[p].index;
          index[d] += (side % 2 == 1 ? 1 : -1);
          Neighbor &neighbor = neighbors[p * 2 * dim + side];
          if (!wrap(patches[p].level, index))
            {
              neighbor = Neighbor::boundary;
              continue;
            }
          Index parent = index;
          for (int &i : parent)
            i /= 2;
          if (find(patches[p].level, index) != numbers::invalid_unsigned_int)
            neighbor = Neighbor::same;
          else if (patches[p].level > 0 &&
                   find(patches[p].level - 1, parent) != numbers::invalid_unsigned_int)
            neighbor = Neighbor::coarser;
          else
            neighbor = Neighbor::finer;
          mixed = mixed || neighbor == Neighbor::coarser || neighbor == Neighbor::finer;
        }
    mixed_levels = Utilities::MPI::max(mixed ? 1 : 0, tria.get_communicator()) == 1;
  }


  template <int dim>
  Leaf PatchGrid<dim>::leaf_of(const int level, const Index &index)
  {
    Leaf leaf{level, {{0, 0, 0}}};
    std::copy(index.begin(), index.end(), leaf.index.begin());
    return leaf;
  }


  template <int dim>
  std::vector<Leaf> PatchGrid<dim>::owned_leaves() const
  {
    std::vector<Leaf> leaves;
    for (unsigned int p = 0; p < owned_patches; ++p)
      leaves.push_back(leaf_of(patches[p].level, patches[p].index));
    return leaves;
  }


  template <int dim>
  bool PatchGrid<dim>::set_leaves(const std::vector<Leaf> &leaves,
                                  const std::vector<unsigned int> &owners)
  {
    using Key         = std::array<int, 4>;
    const auto key_of = [](const Leaf &leaf) {
      return Key{{leaf.level, leaf.index[0], leaf.index[1], leaf.index[2]}};
    };
    const auto leaf_at = [&](const typename Triangulation<dim>::cell_iterator &cell) {
      return leaf_of(cell->level(), index_of(cell->center(), cell->level()));
    };

    // Step 1: refine all that leaves descend from.
    std::set<Key> refined;
    for (Leaf leaf : leaves)
      while (leaf.level > 0)
        {
          --leaf.level;
          for (int &i : leaf.index)
            i /= 2;
          if (!refined.insert(key_of(leaf)).second)
            break;
        }
    while (true)
      {
        bool flagged = false;
        for (const auto &cell : tria.active_cell_iterators())
          if (cell->is_locally_owned() && refined.count(key_of(leaf_at(cell))) > 0)
            {
              cell->set_refine_flag();
              flagged = true;
            }
        if (!Utilities::MPI::logical_or(flagged, tria.get_communicator()))
          break;
        tria.execute_coarsening_and_refinement();
      }
    AssertThrow(
      tria.n_global_active_cells() == leaves.size(),
      ExcMessage("The leaves are not those of a balanced forest over the box."));

    // Step 2: p4est gives each rank the same weight, and so all leaves of a rank
    // together get the same.
    bool all_there = true;
    if (!owners.empty())
      {
        AssertDimension(owners.size(), leaves.size());
        std::vector<unsigned int> n_leaves(
          Utilities::MPI::n_mpi_processes(tria.get_communicator()), 0);
        for (const unsigned int owner : owners)
          ++n_leaves[owner];
        const unsigned int total = *std::max_element(n_leaves.begin(), n_leaves.end());
        std::map<Key, unsigned int> weights, owner_of;
        std::vector<unsigned int> n_seen(n_leaves.size(), 0);
        for (std::size_t i = 0; i < leaves.size(); ++i)
          {
            const unsigned int n = n_leaves[owners[i]];
            weights[key_of(leaves[i])] =
              total / n + (n_seen[owners[i]]++ < total % n ? 1 : 0);
            owner_of[key_of(leaves[i])] = owners[i];
          }
        exact_weight = [&](const Leaf &leaf) { return weights[key_of(leaf)]; };
        tria.repartition();
        exact_weight = nullptr;
        for (const auto &cell : tria.active_cell_iterators())
          if (cell->is_locally_owned())
            all_there = all_there &&
                        owner_of[key_of(leaf_at(cell))] == tria.locally_owned_subdomain();
        all_there = !Utilities::MPI::logical_or(!all_there, tria.get_communicator());
      }
    else
      tria.repartition();
    update();
    return all_there;
  }


  template <int dim>
  bool
  PatchGrid<dim>::adapt(const std::function<int(const BoundingBox<dim> &)> &wanted_level,
                        const std::function<void()> &before_change,
                        const std::function<void(const bool)> &after_change)
  {
    bool anything = false;
    // one level up or down a pass; a leaf that is coarsened may be refined again by
    // the balance, so the number of passes is bounded
    for (unsigned int pass = 0; pass <= parameters.maximum_level; ++pass)
      {
        bool flagged = false;
        for (const auto &cell : tria.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              cell->clear_refine_flag();
              cell->clear_coarsen_flag();
              const int wanted =
                std::min<int>(std::max<int>(wanted_level(bounding_box_of(cell)),
                                            parameters.minimum_level),
                              parameters.maximum_level);
              if (wanted > cell->level())
                {
                  cell->set_refine_flag();
                  flagged = true;
                }
              else if (wanted < cell->level())
                {
                  cell->set_coarsen_flag();
                  flagged = true;
                }
            }
        if (Utilities::MPI::max(flagged ? 1 : 0, tria.get_communicator()) == 0)
          break;
        tria.prepare_coarsening_and_refinement();
        bool remains = false;
        for (const auto &cell : tria.active_cell_iterators())
          if (cell->is_locally_owned())
            remains = remains || cell->refine_flag_set() || cell->coarsen_flag_set();
        if (Utilities::MPI::max(remains ? 1 : 0, tria.get_communicator()) == 0)
          break;

        std::vector<std::pair<int, Index>> before;
        for (unsigned int p = 0; p < owned_patches; ++p)
          before.emplace_back(patches[p].level, patches[p].index);

        if (before_change)
          before_change();
        tria.execute_coarsening_and_refinement();
        update();

        // p4est's balance may have undone everything that was asked for
        bool same = before.size() == owned_patches;
        for (unsigned int p = 0; same && p < owned_patches; ++p)
          same =
            before[p].first == patches[p].level && before[p].second == patches[p].index;
        const bool changed =
          Utilities::MPI::min(same ? 1 : 0, tria.get_communicator()) == 0;
        if (after_change)
          after_change(changed);
        if (!changed)
          break;
        anything = true;
      }
    return anything;
  }


  template struct PatchGridParameters<2>;
  template struct PatchGridParameters<3>;
  template class PatchGrid<2>;
  template class PatchGrid<3>;
} // namespace mitre::grid
