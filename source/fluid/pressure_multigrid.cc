#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <cmath>
#include <numeric>
#include <type_traits>
#include <vector>

#include <mitre/fluid/pressure_multigrid.h>

namespace mitre::fluid
{
  using namespace dealii;
  using grid::Neighbor;

  namespace
  {
    /// Flux across a side relative to that between cells of equal size.
    template <typename Number>
    constexpr Number flux_factor(const Neighbor kind)
    {
      return kind == Neighbor::coarser ? Number(2. / 3.)
             : kind == Neighbor::finer ? Number(4. / 3.)
                                       : Number(1.);
    }

    /// An entry of the coarsest level's matrix.
    struct Entry
    {
      types::global_dof_index row, column;
      double value;
    };


    /// The entries of all ranks, byte by byte: Utilities::MPI::all_gather() compresses
    /// them, which takes longer than to factorize the matrix.
    std::vector<Entry> gather_entries(const std::vector<Entry> &own,
                                      const MPI_Comm communicator)
    {
      static_assert(std::is_trivially_copyable<Entry>::value, "sent as bytes");
      std::vector<int> counts = Utilities::MPI::all_gather(
                         communicator, static_cast<int>(own.size() * sizeof(Entry))),
                       starts(counts.size(), 0);
      std::partial_sum(counts.begin(), counts.end() - 1, starts.begin() + 1);
      std::vector<Entry> all((starts.back() + counts.back()) / sizeof(Entry));
      const int ierr = MPI_Allgatherv(own.data(),
                                      own.size() * sizeof(Entry),
                                      MPI_BYTE,
                                      all.data(),
                                      counts.data(),
                                      starts.data(),
                                      MPI_BYTE,
                                      communicator);
      AssertThrowMPI(ierr);
      return all;
    }


    /// Strides of a padded array of (m+2)^dim entries.
    struct Strides
    {
      unsigned int y, z, first;
    };

    template <int dim>
    Strides padded_strides(const unsigned int m)
    {
      const unsigned int w = m + 2;
      return {w, w * w, 1 + w + (dim == 3 ? w * w : 0)};
    }
  } // namespace


  template <int dim>
  PressureMultigrid<dim>::PressureMultigrid(const grid::StaggeredSpace<dim> &space,
                                            const unsigned int smoothing_steps)
    : space(space)
    , patch_grid(space.grid())
    , n_smoothing_steps(smoothing_steps)
    , singular(Utilities::MPI::max(space.open_faces().empty() ? 0 : 1,
                                   patch_grid.communicator()) == 0)
  {
    for (unsigned int m = patch_grid.n_cells_per_side(); m >= 1; m /= 2)
      {
        levels.push_back(std::make_unique<Level>());
        build_level(*levels.back(),
                    m,
                    levels.size() > 1 ? levels[levels.size() - 2].get() : nullptr);
      }
    build_coarse_solver();
  }


  template <int dim>
  void PressureMultigrid<dim>::build_level(Level &level,
                                           const unsigned int m,
                                           const Level *finer)
  {
    level.m    = m;
    level.halo = std::make_unique<grid::CellHalo<dim, Number>>(patch_grid, m);
    level.halo->initialize_vector(level.solution);
    level.rhs.reinit(level.solution);
    level.update.reinit(level.solution);
    level.residual.reinit(level.solution);
    level.inverse_diagonal.reinit(level.solution);

    const unsigned int n_owned = patch_grid.n_owned_patches();
    const unsigned int n       = patch_grid.n_cells_per_side();
    const unsigned int plane   = Utilities::fixed_power<dim - 1>(m);
    level.inverse_h2.resize(n_owned);
    level.open_start.assign(n_owned * 2 * dim, -1);
    for (unsigned int p = 0; p < n_owned; ++p)
      {
        for (unsigned int d = 0; d < dim; ++d)
          level.inverse_h2[p][d] =
            Utilities::fixed_power<2>(m / (patch_grid.patch(p).h[d] * n));
        for (unsigned int side = 0; side < 2 * dim; ++side)
          if (patch_grid.neighbor(p, side) == Neighbor::boundary)
            {
              level.open_start[p * 2 * dim + side] = level.open_fraction.size();
              level.open_fraction.resize(level.open_fraction.size() + plane, Number(0));
            }
      }

    if (finer == nullptr)
      for (const auto &face : space.open_faces())
        {
          // position within the side, skipping the normal direction
          unsigned int rest = face.cell, in_side = 0, factor = 1;
          for (unsigned int d = 0; d < dim; ++d)
            {
              if (d != face.side / 2)
                {
                  in_side += (rest % m) * factor;
                  factor *= m;
                }
              rest /= m;
            }
          level
            .open_fraction[level.open_start[face.patch * 2 * dim + face.side] + in_side] =
            Number(1);
        }
    else
      for (std::size_t s = 0; s < level.open_start.size(); ++s)
        if (level.open_start[s] >= 0)
          for (unsigned int i = 0; i < plane; ++i)
            {
              const unsigned int a = i % m, b = i / m;
              Number sum = 0;
              for (unsigned int k = 0; k < (1u << (dim - 1)); ++k)
                sum += finer->open_fraction[finer->open_start[s] + 2 * a + (k & 1) +
                                            (2 * b + (k >> 1)) * 2 * m];
              level.open_fraction[level.open_start[s] + i] =
                sum / Number(1u << (dim - 1));
            }

    // diagonal of the operator
    const unsigned int mz = (dim == 3 ? m : 1);
    for (unsigned int p = 0; p < n_owned; ++p)
      for (unsigned int k = 0; k < mz; ++k)
        for (unsigned int j = 0; j < m; ++j)
          for (unsigned int i = 0; i < m; ++i)
            {
              const std::array<unsigned int, 3> cell = {{i, j, k}};
              Number sum                             = 0;
              for (unsigned int side = 0; side < 2 * dim; ++side)
                {
                  const unsigned int d = side / 2;
                  Number factor        = 1;
                  if (cell[d] == (side % 2 == 0 ? 0 : m - 1))
                    {
                      const Neighbor kind = patch_grid.neighbor(p, side);
                      factor              = flux_factor<Number>(kind);
                      if (kind == Neighbor::boundary)
                        {
                          unsigned int in_side = 0, power = 1;
                          for (unsigned int e = 0; e < dim; ++e)
                            if (e != d)
                              {
                                in_side += cell[e] * power;
                                power *= m;
                              }
                          factor =
                            2 * level.open_fraction[level.open_start[p * 2 * dim + side] +
                                                    in_side];
                        }
                    }
                  sum += factor * level.inverse_h2[p][d];
                }
              level.inverse_diagonal.local_element(
                static_cast<std::size_t>(p) * level.halo->n_cells_per_patch() + i +
                (j + k * m) * m) = sum > 0 ? 1 / sum : 0;
            }
  }


  template <int dim>
  void PressureMultigrid<dim>::build_coarse_solver()
  {
    const Level &level = *levels.back();
    std::vector<Entry> own;
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        const auto &patch = patch_grid.patch(p);
        double diagonal   = 0.;
        for (unsigned int side = 0; side < 2 * dim; ++side)
          {
            const unsigned int d = side / 2;
            const Neighbor kind  = patch_grid.neighbor(p, side);
            double entry         = flux_factor<double>(kind) * level.inverse_h2[p][d];
            if (kind == Neighbor::boundary)
              {
                diagonal += 2 * level.inverse_h2[p][d] *
                            level.open_fraction[level.open_start[p * 2 * dim + side]];
                continue;
              }
            diagonal += entry;
            typename grid::PatchGrid<dim>::Index beyond = patch.index;
            beyond[d] += (side % 2 == 1 ? 1 : -1);
            if (kind == Neighbor::finer)
              for (unsigned int k = 0; k < (1u << (dim - 1)); ++k)
                {
                  auto child       = beyond;
                  unsigned int bit = 0;
                  for (unsigned int e = 0; e < dim; ++e)
                    child[e] =
                      2 * beyond[e] + (e == d ? (side % 2 == 1 ? 0 : 1)
                                              : static_cast<int>((k >> bit++) & 1));
                  const unsigned int q = patch_grid.find(patch.level + 1, child);
                  own.push_back({patch.global_id,
                                 patch_grid.patch(q).global_id,
                                 -entry / (1u << (dim - 1))});
                }
            else
              {
                int neighbor_level = patch.level;
                if (kind == Neighbor::coarser)
                  {
                    --neighbor_level;
                    for (unsigned int e = 0; e < dim; ++e)
                      {
                        const int size = patch_grid.n_patches(patch.level, e);
                        beyond[e]      = ((beyond[e] + size) % size) / 2;
                      }
                  }
                const unsigned int q = patch_grid.find(neighbor_level, beyond);
                own.push_back({patch.global_id, patch_grid.patch(q).global_id, -entry});
              }
          }
        own.push_back({patch.global_id, patch.global_id, diagonal});
      }

    const types::global_dof_index size = patch_grid.n_global_patches();
    const std::vector<Entry> all       = gather_entries(own, patch_grid.communicator());
    DynamicSparsityPattern dynamic(size);
    for (const Entry &entry : all)
      dynamic.add(entry.row, entry.column);
    coarse_sparsity.copy_from(dynamic);
    coarse_matrix.reinit(coarse_sparsity);
    for (const Entry &entry : all)
      coarse_matrix.add(entry.row, entry.column, entry.value);
    // A single closed patch has a diagonal of 0.
    if (singular)
      coarse_matrix.diag_element(0) = size == 1 ? 1. : 2. * coarse_matrix.diag_element(0);
    coarse_inverse.initialize(coarse_matrix);

    std::vector<double> volumes(patch_grid.n_owned_patches(), 1.);
    for (unsigned int p = 0; p < volumes.size(); ++p)
      for (unsigned int d = 0; d < dim; ++d)
        volumes[p] *= patch_grid.patch(p).h[d];
    coarse_values.reinit(size);
    coarse_volumes.reinit(size);
    coarse_counts = Utilities::MPI::all_gather(patch_grid.communicator(),
                                               static_cast<int>(volumes.size()));
    coarse_starts.assign(coarse_counts.size(), 0);
    for (std::size_t r = 1; r < coarse_counts.size(); ++r)
      coarse_starts[r] = coarse_starts[r - 1] + coarse_counts[r - 1];
    MPI_Allgatherv(volumes.data(),
                   volumes.size(),
                   MPI_DOUBLE,
                   coarse_volumes.begin(),
                   coarse_counts.data(),
                   coarse_starts.data(),
                   MPI_DOUBLE,
                   patch_grid.communicator());
    coarse_volumes /= coarse_volumes.l1_norm();
  }


  template <int dim>
  void PressureMultigrid<dim>::solve_coarsest()
  {
    Level &level = *levels.back();
    const std::vector<double> own(level.rhs.begin(),
                                  level.rhs.begin() + level.rhs.locally_owned_size());
    MPI_Allgatherv(own.data(),
                   own.size(),
                   MPI_DOUBLE,
                   coarse_values.begin(),
                   coarse_counts.data(),
                   coarse_starts.data(),
                   MPI_DOUBLE,
                   patch_grid.communicator());
    if (singular)
      coarse_values.add(-(coarse_values * coarse_volumes));
    coarse_inverse.solve(coarse_values);
    if (singular)
      coarse_values.add(-(coarse_values * coarse_volumes));
    const unsigned int rank = Utilities::MPI::this_mpi_process(patch_grid.communicator());
    for (unsigned int p = 0; p < own.size(); ++p)
      level.solution.local_element(p) = coarse_values(coarse_starts[rank] + p);
  }


  template <int dim>
  void PressureMultigrid<dim>::gather(const Level &level,
                                      const LevelVector &v,
                                      const unsigned int p,
                                      Number *padded) const
  {
    level.halo->gather(v, p, padded);

    // where the distance to the neighbour's cell is not one cell width, replace its
    // value by the one that gives the same flux at that distance
    const unsigned int m = level.m;
    const Strides s      = padded_strides<dim>(m);
    for (unsigned int side = 0; side < 2 * dim; ++side)
      {
        const Neighbor kind = patch_grid.neighbor(p, side);
        if (kind == Neighbor::same)
          continue;
        const unsigned int d      = side / 2;
        const bool upper          = (side % 2 == 1);
        const unsigned int normal = (d == 0 ? 1 : (d == 1 ? s.y : s.z));
        const unsigned int a_step = (d == 0 ? s.y : 1), b_step = (d == 2 ? s.y : s.z);
        Number *inside = padded + s.first + (upper ? (m - 1) * normal : 0);
        Number *ghost  = upper ? inside + normal : inside - normal;
        const Number *fraction =
          kind == Neighbor::boundary
            ? level.open_fraction.data() + level.open_start[p * 2 * dim + side]
            : nullptr;
        const Number factor = flux_factor<Number>(kind);
        for (unsigned int b = 0; b < (dim == 3 ? m : 1); ++b)
          for (unsigned int a = 0; a < m; ++a)
            {
              const unsigned int at = a * a_step + b * b_step;
              const Number f        = fraction ? 2 * fraction[a + b * m] : factor;
              ghost[at]             = inside[at] + f * (ghost[at] - inside[at]);
            }
      }
  }


  template <int dim>
  template <typename Operation>
  void PressureMultigrid<dim>::for_each_row(Level &level,
                                            LevelVector &x,
                                            const Operation &operation)
  {
    x.update_ghost_values();
    const unsigned int m = level.m, mz = (dim == 3 ? m : 1);
    const Strides s = padded_strides<dim>(m);
    std::vector<Number> padded(level.halo->padded_size());
    std::vector<Number> product(m);
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        gather(level, x, p, padded.data());
        const auto &c         = level.inverse_h2[p];
        const Number diagonal = 2 * (c[0] + c[1] + (dim == 3 ? c[dim - 1] : 0));
        std::size_t row = static_cast<std::size_t>(p) * level.halo->n_cells_per_patch();
        for (unsigned int k = 0; k < mz; ++k)
          for (unsigned int j = 0; j < m; ++j, row += m)
            {
              const Number *center = padded.data() + s.first + j * s.y + k * s.z;
              Number *Ax           = product.data();
              for (unsigned int i = 0; i < m; ++i)
                {
                  Number sum = diagonal * center[i] -
                               c[0] * (center[i + 1] + *(center + i - 1)) -
                               c[1] * (center[i + s.y] + *(center + i - s.y));
                  if constexpr (dim == 3)
                    sum -= c[2] * (center[i + s.z] + *(center + i - s.z));
                  Ax[i] = sum;
                }
              operation(row, m, Ax);
            }
      }
    x.zero_out_ghost_values();
  }


  template <int dim>
  void PressureMultigrid<dim>::smooth(Level &level, const bool zero_start)
  {
    // eigenvalues of D^-1 A lie in (0, 2]; the upper part is smoothed
    constexpr Number upper = 2.0, lower = 0.3;
    constexpr Number theta = 0.5f * (upper + lower), delta = 0.5f * (upper - lower);
    const Number sigma = theta / delta;
    Number rho         = 1 / sigma;

    const std::size_t size = level.solution.locally_owned_size();
    Number *x = level.solution.begin(), *update = level.update.begin();
    const Number *b = level.rhs.begin(), *inverse = level.inverse_diagonal.begin();

    unsigned int step = 0;
    if (zero_start)
      {
        for (std::size_t i = 0; i < size; ++i)
          {
            update[i] = inverse[i] * b[i] * (1 / theta);
            x[i]      = update[i];
          }
        step = 1;
      }
    for (; step < n_smoothing_steps; ++step)
      {
        const Number rho_new = 1 / (2 * sigma - rho);
        const Number keep    = step == 0 ? 0 : rho_new * rho;
        const Number gain    = step == 0 ? 1 / theta : 2 * rho_new / delta;
        if (step > 0)
          rho = rho_new;
        for_each_row(level,
                     level.solution,
                     [&](const std::size_t row, const unsigned int m, const Number *Ax) {
                       for (unsigned int i = 0; i < m; ++i)
                         update[row + i] = keep * update[row + i] +
                                           gain * inverse[row + i] * (b[row + i] - Ax[i]);
                     });
        for (std::size_t i = 0; i < size; ++i)
          x[i] += update[i];
      }
  }


  template <int dim>
  void PressureMultigrid<dim>::cycle(const unsigned int l)
  {
    if (l + 1 == levels.size())
      {
        solve_coarsest();
        return;
      }
    Level &fine = *levels[l], &coarse = *levels[l + 1];
    smooth(fine, true);

    // the mean of the residual over the cells that make up a coarse one
    const unsigned int m = fine.m, mc = coarse.m;
    coarse.rhs         = 0;
    Number *r          = coarse.rhs.begin();
    const Number *b    = fine.rhs.begin();
    const Number share = Number(1) / Number(1u << dim);
    for_each_row(fine,
                 fine.solution,
                 [&](const std::size_t row, const unsigned int, const Number *Ax) {
                   const std::size_t p     = row / fine.halo->n_cells_per_patch();
                   const unsigned int line = (row % fine.halo->n_cells_per_patch()) / m;
                   const unsigned int j = line % m, k = line / m;
                   Number *to = r + p * coarse.halo->n_cells_per_patch() +
                                (j / 2 + (k / 2) * mc) * mc;
                   for (unsigned int i = 0; i < mc; ++i)
                     to[i] += share * (b[row + 2 * i] - Ax[2 * i] + b[row + 2 * i + 1] -
                                       Ax[2 * i + 1]);
                 });

    cycle(l + 1);

    // linear interpolation within the coarse cells
    coarse.solution.update_ghost_values();
    const Strides s = padded_strides<dim>(mc);
    std::vector<Number> padded(coarse.halo->padded_size());
    Number *x             = fine.solution.begin();
    const unsigned int mz = (dim == 3 ? m : 1);
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        gather(coarse, coarse.solution, p, padded.data());
        Number *to = x + static_cast<std::size_t>(p) * fine.halo->n_cells_per_patch();
        for (unsigned int k = 0; k < mz; ++k)
          for (unsigned int j = 0; j < m; ++j, to += m)
            {
              const Number *center =
                padded.data() + s.first + (j / 2) * s.y + (dim == 3 ? (k / 2) * s.z : 0);
              const std::ptrdiff_t y =
                (j % 2 == 0 ? -static_cast<std::ptrdiff_t>(s.y) : s.y);
              const std::ptrdiff_t z =
                (k % 2 == 0 ? -static_cast<std::ptrdiff_t>(s.z) : s.z);
              for (unsigned int i = 0; i < mc; ++i)
                {
                  const Number e = center[i];
                  const Number cross =
                    e + Number(0.25) * (center[i + y] - e) +
                    (dim == 3 ? Number(0.25) * (center[i + z] - e) : 0);
                  to[2 * i] += cross + Number(0.25) * (*(center + i - 1) - e);
                  to[2 * i + 1] += cross + Number(0.25) * (center[i + 1] - e);
                }
            }
      }
    coarse.solution.zero_out_ghost_values();
    smooth(fine, false);
  }


  template <int dim>
  void PressureMultigrid<dim>::vmult(grid::VectorType &dst, const grid::VectorType &src)
  {
    Level &finest          = *levels.front();
    const std::size_t size = finest.rhs.locally_owned_size();
    const double *from     = src.begin();
    Number *rhs            = finest.rhs.begin();

    // single precision covers far fewer decades than right-hand sides span
    const double scale = src.linfty_norm();
    if (scale == 0. || !std::isfinite(scale))
      {
        dst = scale;
        return;
      }
    for (std::size_t i = 0; i < size; ++i)
      rhs[i] = static_cast<Number>(from[i] / scale);
    cycle(0);
    double *to      = dst.begin();
    const Number *x = finest.solution.begin();
    for (std::size_t i = 0; i < size; ++i)
      to[i] = scale * static_cast<double>(x[i]);
  }


  template <int dim>
  void PressureMultigrid<dim>::apply(grid::VectorType &dst, const grid::VectorType &src)
  {
    Level &finest = *levels.front();
    for (std::size_t i = 0; i < finest.solution.locally_owned_size(); ++i)
      finest.solution.local_element(i) = src.local_element(i);
    for_each_row(finest,
                 finest.solution,
                 [&](const std::size_t row, const unsigned int m, const Number *Ax) {
                   for (unsigned int i = 0; i < m; ++i)
                     dst.local_element(row + i) = Ax[i];
                 });
  }


  template <int dim>
  std::size_t PressureMultigrid<dim>::memory_consumption() const
  {
    std::size_t sum = 0;
    for (const auto &level : levels)
      sum += 5 * level->solution.memory_consumption() + level->halo->memory_consumption();
    return sum;
  }


  template class PressureMultigrid<2>;
  template class PressureMultigrid<3>;
} // namespace mitre::fluid
