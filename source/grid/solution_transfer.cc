#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cstring>
#include <map>

#include <mitre/grid/solution_transfer.h>

namespace mitre::grid
{
  using namespace dealii;

  namespace
  {
    using Sizes = std::array<unsigned int, 3>;

    template <int dim>
    Sizes component_sizes(const unsigned int n, const unsigned int c)
    {
      Sizes size{{1, 1, 1}};
      for (unsigned int d = 0; d < dim; ++d)
        size[d] = n + (c == d ? 1 : 0);
      return size;
    }

    std::size_t product(const Sizes &size)
    {
      return static_cast<std::size_t>(size[0]) * size[1] * size[2];
    }

    /**
     * Value of fine entry @p i of child @p child from the parent's array @p padded with
     * @p width layers around: linear in all directions; @p c is the direction of the
     * faces' normal, or dim for cell values.
     */
    template <int dim>
    double interpolate(const double *padded,
                       const Sizes &padded_size,
                       const unsigned int width,
                       const unsigned int n,
                       const unsigned int c,
                       const unsigned int child,
                       const Sizes &i)
    {
      std::size_t at         = 0;
      std::size_t stride     = 1;
      double slopes          = 0.;
      std::size_t strides[3] = {0, 0, 0};
      double offset[3]       = {0., 0., 0.};
      bool between           = false;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const unsigned int fine = ((child >> d) & 1) * n + i[d];
          at += (fine / 2 + width) * stride;
          strides[d] = stride;
          if (d == c)
            between = (fine % 2 == 1);
          else
            offset[d] = (fine % 2 == 0 ? -0.25 : 0.25);
          stride *= padded_size[d];
        }
      const auto value_at = [&](const std::size_t position) {
        slopes = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          if (d != c)
            slopes += 0.5 * offset[d] *
                      (padded[position + strides[d]] - padded[position - strides[d]]);
        return padded[position] + slopes;
      };
      return between ? 0.5 * (value_at(at) + value_at(at + strides[c])) : value_at(at);
    }
  } // namespace


  namespace
  {
    /// Where the values of a leaf are that a change of the grid leaves as it is.
    struct OldPlace
    {
      unsigned int rank, patch;
    };

    std::vector<VectorType> take(const std::vector<VectorType *> &vectors)
    {
      std::vector<VectorType> taken(vectors.size());
      for (std::size_t i = 0; i < vectors.size(); ++i)
        taken[i].swap(*vectors[i]);
      return taken;
    }
  } // namespace


  template <int dim>
  SolutionTransfer<dim>::SolutionTransfer(PatchGrid<dim> &grid,
                                          const StaggeredSpace<dim> &space,
                                          VelocityHalo<dim> &halo,
                                          const CellHalo<dim> &cells,
                                          const std::vector<VectorType *> &velocities,
                                          const std::vector<VectorType *> &cell_values)
    : grid(grid)
    , space(space)
    , cells(cells)
    , halo(halo)
    , halo_width(halo.width())
    , original_velocities(velocities)
    , original_cells(cell_values)
    , velocities(take(velocities))
    , cell_values(take(cell_values))
  {
    for (const VectorType &u : this->velocities)
      ghosted_velocities.push_back(halo.import(u));
    // not earlier: copies of vectors have no ghost values
    for (VectorType &u : ghosted_velocities)
      u.update_ghost_values();
    for (VectorType &p : this->cell_values)
      p.update_ghost_values();
    handle = grid.triangulation().register_data_attach(
      [this](const CellIterator &cell, const CellStatus status) {
        return pack(cell, status);
      },
      /*returns_variable_size_data=*/true);
  }


  template <int dim>
  double *SolutionTransfer<dim>::copy_patch(const unsigned int p, double *to) const
  {
    for (const VectorType &u : velocities)
      {
        const double *from = u.begin() + space.first_dof(p, 0);
        to                 = std::copy(from, from + space.n_dofs_per_patch(), to);
      }
    for (const VectorType &values : cell_values)
      {
        const double *from =
          values.begin() + static_cast<std::size_t>(p) * cells.n_cells_per_patch();
        to = std::copy(from, from + cells.n_cells_per_patch(), to);
      }
    return to;
  }


  template <int dim>
  std::vector<char> SolutionTransfer<dim>::pack(const CellIterator &cell,
                                                const CellStatus status) const
  {
    const unsigned int n = grid.n_cells_per_side();
    if (status != Triangulation<dim>::CELL_COARSEN &&
        status != Triangulation<dim>::CELL_REFINE)
      {
        const OldPlace place = {Utilities::MPI::this_mpi_process(grid.communicator()),
                                grid.patch_of(cell)};
        std::vector<char> bytes(sizeof(place));
        std::memcpy(bytes.data(), &place, sizeof(place));
        return bytes;
      }

    std::vector<double> data;
    const auto append = [&](const double *begin, const std::size_t size) {
      data.insert(data.end(), begin, begin + size);
    };

    if (status == Triangulation<dim>::CELL_COARSEN)
      {
        for (const VectorType &u : velocities)
          for (unsigned int c = 0; c < dim; ++c)
            {
              const Sizes size = component_sizes<dim>(n, c);
              std::vector<double> mean(product(size), 0.);
              for (unsigned int child = 0; child < cell->n_children(); ++child)
                {
                  const unsigned int p = grid.patch_of(cell->child(child));
                  const double *v      = u.begin() + space.first_dof(p, c);
                  for (unsigned int k = 0; k < size[2]; ++k)
                    for (unsigned int j = 0; j < size[1]; ++j)
                      for (unsigned int i = 0; i < size[0]; ++i)
                        {
                          const Sizes ijk = {{i, j, k}};
                          std::size_t to = 0, stride = 1;
                          double weight = 1.;
                          for (unsigned int d = 0; d < dim; ++d)
                            {
                              const unsigned int fine = ((child >> d) & 1) * n + ijk[d];
                              if (d == c)
                                {
                                  // only faces on coarse faces count; the plane
                                  // between two children is seen by both
                                  if (fine % 2 == 1)
                                    weight = 0.;
                                  if (fine == n)
                                    weight *= 0.5;
                                }
                              else
                                weight *= 0.5;
                              to += (fine / 2) * stride;
                              stride *= size[d];
                            }
                          if (weight != 0.)
                            mean[to] += weight * v[i + size[0] * (j + size[1] * k)];
                        }
                }
              append(mean.data(), mean.size());
            }
        const unsigned int nz = (dim == 3 ? n : 1);
        for (const VectorType &values : cell_values)
          {
            std::vector<double> mean(cells.n_cells_per_patch(), 0.);
            for (unsigned int child = 0; child < cell->n_children(); ++child)
              {
                const double *v = values.begin() + static_cast<std::size_t>(
                                                     grid.patch_of(cell->child(child))) *
                                                     cells.n_cells_per_patch();
                for (unsigned int k = 0; k < nz; ++k)
                  for (unsigned int j = 0; j < n; ++j)
                    for (unsigned int i = 0; i < n; ++i)
                      {
                        const unsigned int ci = ((child & 1) * n + i) / 2;
                        const unsigned int cj = (((child >> 1) & 1) * n + j) / 2;
                        const unsigned int ck = (((child >> 2) & 1) * n + k) / 2;
                        mean[ci + n * (cj + n * ck)] +=
                          v[i + n * (j + n * k)] / (1u << dim);
                      }
              }
            append(mean.data(), mean.size());
          }
      }
    else
      {
        const unsigned int p = grid.patch_of(cell);
        for (const VectorType &u : ghosted_velocities)
          for (unsigned int c = 0; c < dim; ++c)
            {
              std::vector<double> padded(halo.size(c), 0.);
              halo.gather(u, p, c, padded.data());
              append(padded.data(), padded.size());
            }
        for (const VectorType &values : cell_values)
          {
            std::vector<double> padded(cells.padded_size(), 0.);
            cells.gather(values, p, padded.data());
            // no slope towards a boundary or a neighbour at another distance
            const unsigned int w = n + 2, nz = (dim == 3 ? n : 1);
            const unsigned int wz = w * w;
            double *first         = padded.data() + 1 + w + (dim == 3 ? wz : 0);
            for (unsigned int side = 0; side < 2 * dim; ++side)
              if (grid.neighbor(p, side) != Neighbor::same)
                {
                  const unsigned int d        = side / 2;
                  const std::ptrdiff_t normal = (d == 0 ? 1 : (d == 1 ? w : wz));
                  const unsigned int a_step   = (d == 0 ? w : 1),
                                     b_step   = (d == 2 ? w : wz);
                  double *inside = first + (side % 2 == 1 ? (n - 1) * normal : 0);
                  for (unsigned int b = 0; b < nz; ++b)
                    for (unsigned int a = 0; a < n; ++a)
                      {
                        double *cell_value = inside + a * a_step + b * b_step;
                        *(cell_value + (side % 2 == 1 ? normal : -normal)) = *cell_value;
                      }
                }
            append(padded.data(), padded.size());
          }
      }

    std::vector<char> bytes(data.size() * sizeof(double));
    std::memcpy(bytes.data(), data.data(), bytes.size());
    return bytes;
  }


  template <int dim>
  void SolutionTransfer<dim>::finish(const StaggeredSpace<dim> &new_space,
                                     const std::vector<VectorType *> &new_velocities,
                                     const std::vector<VectorType *> &new_cell_values)
  {
    const unsigned int n              = grid.n_cells_per_side();
    const std::size_t cells_per_patch = Utilities::fixed_power<dim>(n);

    const unsigned int this_rank = Utilities::MPI::this_mpi_process(grid.communicator());

    const auto put = [&](const unsigned int p, const double *from) {
      for (VectorType *u : new_velocities)
        {
          std::copy(from,
                    from + new_space.n_dofs_per_patch(),
                    u->begin() + new_space.first_dof(p, 0));
          from += new_space.n_dofs_per_patch();
        }
      for (VectorType *values : new_cell_values)
        {
          std::copy(from, from + cells_per_patch, values->begin() + p * cells_per_patch);
          from += cells_per_patch;
        }
    };
    std::vector<double> patch_values(velocities.size() * space.n_dofs_per_patch() +
                                     cell_values.size() * cells_per_patch);

    // by rank: old patches that have come here, and what they are now
    std::map<unsigned int, std::vector<unsigned int>> wanted, destinations;
    const auto unpack =
      [&](const CellIterator &cell,
          const CellStatus status,
          const boost::iterator_range<std::vector<char>::const_iterator> &range) {
        if (status == Triangulation<dim>::CELL_PERSIST)
          {
            OldPlace place;
            std::memcpy(&place, &*range.begin(), sizeof(place));
            const unsigned int p = grid.patch_of(cell);
            if (place.rank == this_rank)
              {
                copy_patch(place.patch, patch_values.data());
                put(p, patch_values.data());
              }
            else
              {
                wanted[place.rank].push_back(place.patch);
                destinations[place.rank].push_back(p);
              }
            return;
          }
        std::vector<double> data((range.end() - range.begin()) / sizeof(double));
        std::memcpy(data.data(), &*range.begin(), data.size() * sizeof(double));
        const double *from = data.data();

        if (status == Triangulation<dim>::CELL_REFINE)
          {
            for (VectorType *u : new_velocities)
              for (unsigned int c = 0; c < dim; ++c)
                {
                  const Sizes size = component_sizes<dim>(n, c);
                  Sizes padded{{1, 1, 1}};
                  for (unsigned int d = 0; d < dim; ++d)
                    padded[d] = size[d] + 2 * halo_width;
                  for (unsigned int child = 0; child < cell->n_children(); ++child)
                    {
                      double *to = u->begin() + new_space.first_dof(
                                                  grid.patch_of(cell->child(child)), c);
                      for (unsigned int k = 0; k < size[2]; ++k)
                        for (unsigned int j = 0; j < size[1]; ++j)
                          for (unsigned int i = 0; i < size[0]; ++i)
                            *to++ = interpolate<dim>(
                              from, padded, halo_width, n, c, child, {{i, j, k}});
                    }
                  from += product(padded);
                }
            for (VectorType *values : new_cell_values)
              {
                const Sizes padded = {{n + 2, n + 2, dim == 3 ? n + 2 : 1}};
                for (unsigned int child = 0; child < cell->n_children(); ++child)
                  {
                    double *to = values->begin() +
                                 grid.patch_of(cell->child(child)) * cells_per_patch;
                    for (unsigned int k = 0; k < (dim == 3 ? n : 1); ++k)
                      for (unsigned int j = 0; j < n; ++j)
                        for (unsigned int i = 0; i < n; ++i)
                          *to++ =
                            interpolate<dim>(from, padded, 1, n, dim, child, {{i, j, k}});
                  }
                from += product(padded);
              }
          }
        else
          put(grid.patch_of(cell), from);
      };
    grid.triangulation().notify_ready_to_unpack(handle, unpack);

    std::map<unsigned int, std::vector<double>> sent;
    for (const auto &[rank, patches] :
         Utilities::MPI::some_to_some(grid.communicator(), wanted))
      {
        std::vector<double> &values = sent[rank];
        values.resize(patches.size() * patch_values.size());
        double *to = values.data();
        for (const unsigned int p : patches)
          to = copy_patch(p, to);
      }
    for (const auto &[rank, values] :
         Utilities::MPI::some_to_some(grid.communicator(), sent))
      {
        const double *from = values.data();
        for (const unsigned int p : destinations.at(rank))
          {
            put(p, from);
            from += patch_values.size();
          }
      }
    for (VectorType *u : new_velocities)
      new_space.synchronize(*u);
  }


  template <int dim>
  void SolutionTransfer<dim>::give_back()
  {
    grid.triangulation().notify_ready_to_unpack(
      handle,
      [](const CellIterator &,
         const CellStatus,
         const boost::iterator_range<std::vector<char>::const_iterator> &) {});
    for (VectorType &p : cell_values)
      p.zero_out_ghost_values();
    for (std::size_t i = 0; i < velocities.size(); ++i)
      original_velocities[i]->swap(velocities[i]);
    for (std::size_t i = 0; i < cell_values.size(); ++i)
      original_cells[i]->swap(cell_values[i]);
  }


  template class SolutionTransfer<2>;
  template class SolutionTransfer<3>;
} // namespace mitre::grid
