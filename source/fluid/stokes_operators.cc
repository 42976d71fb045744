#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <mitre/fluid/stokes_operators.h>

namespace mitre::fluid
{
  using namespace dealii;
  using grid::Neighbor;
  using grid::VectorType;

  template <int dim>
  StokesOperators<dim>::StokesOperators(grid::StaggeredSpace<dim> &space)
    : space(space)
    , patch_grid(space.grid())
    , n(patch_grid.n_cells_per_side())
    , velocity_halo(space, 1, grid::HaloShape::star, grid::BoundaryExtension::quadratic)
    , viscous_fluxes(space)
    , cell_halo(patch_grid, n)
  {
    std::vector<types::global_dof_index> ghosts;
    velocity_halo.add_ghosts(ghosts);
    viscous_fluxes.add_ghosts(ghosts);
    space.finalize(std::move(ghosts));
    velocity_halo.localize(space.partitioner());
    viscous_fluxes.localize(*space.partitioner());
    if (!patch_grid.has_coarse_fine_interfaces())
      return;

    space.initialize_vector(interface_forces);
    const unsigned int cells_per_patch = cell_halo.n_cells_per_patch();
    // the cell of a patch that touches an outermost face, and the face's signed area
    const auto cell_at = [&](const std::size_t dof, const unsigned int side) {
      const unsigned int p = dof / space.n_dofs_per_patch();
      const unsigned int c = side / 2;
      unsigned int rest = dof - space.first_dof(p, c), cell = 0, stride = 1;
      double area = (side % 2 == 0 ? 1. : -1.);
      for (unsigned int d = 0; d < dim; ++d)
        {
          const unsigned int i = rest % space.extent(c, d);
          rest /= space.extent(c, d);
          cell += std::min(i, n - 1) * stride;
          stride *= n;
          if (d != c)
            area *= patch_grid.patch(p).h[d];
        }
      return std::make_pair(p * cells_per_patch + cell, area);
    };
    const auto &table = space.coarse_fine_faces();
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      for (unsigned int part = table.begin(p); part < table.end(p); ++part)
        for (unsigned int row = 0; row < table.n_rows(part, 0); ++row)
          {
            const unsigned int entry = table.destination(part, 0, row);
            const unsigned int c     = entry / space.n_dofs_per_component();
            const unsigned int plane =
              (entry % space.n_dofs_per_component() / space.stride(c, c)) % (n + 1);
            const std::size_t dof   = space.first_dof(p, 0) + entry;
            const auto [cell, area] = cell_at(dof, 2 * c + (plane == 0 ? 0 : 1));
            interface_faces.push_back({dof, cell, area});
          }
    for (const auto &[p, side] : space.coarse_sides())
      {
        const unsigned int c = side / 2, s = space.stride(c, c);
        for (unsigned int i = 0; i < Utilities::fixed_power<dim - 1>(n); ++i)
          {
            const std::size_t dof =
              space.first_dof(p, c) + (side % 2) * n * s + (i / s) * s * (n + 1) + i % s;
            const auto [cell, area] = cell_at(dof, side);
            interface_faces.push_back({dof, cell, area});
          }
      }

    // What a pressure without pattern reaches is all that any pressure can reach.
    VectorType pressure;
    initialize_pressure(pressure);
    for (const InterfaceFace &face : interface_faces)
      {
        // Numbers without any relation between those of neighbours: the differences of
        // a mere multiple of the cell's number, say, cancel. (Thomas Wang's mixing of
        // bits.)
        std::uint64_t key = face.cell + cells_per_patch * patch_grid.patch(0).global_id;
        key               = (~key) + (key << 21);
        key ^= key >> 24;
        key *= 265;
        key ^= key >> 14;
        key *= 21;
        key ^= key >> 28;
        key += key << 31;
        pressure.local_element(face.cell) = 1. + 0x1p-33 * (key & 0xffffffffu);
      }
    interface_forces = 0.;
    set_interface_forces(pressure);
    space.collect_interfaces(interface_forces);
    interface_copies = space.local_copies_among(interface_forces);
    space.collect_local_copies(interface_forces);
    space.collect_remote_copies(interface_forces);
    for (std::size_t i = 0; i < interface_forces.locally_owned_size(); ++i)
      if (interface_forces.local_element(i) != 0.)
        interface_masters.push_back(i);
  }


  template <int dim>
  void StokesOperators<dim>::finish(VectorType &dst) const
  {
    space.zero_fixed_faces(dst);
    if (patch_grid.has_coarse_fine_interfaces())
      space.synchronize(dst);
  }


  template <int dim>
  void StokesOperators<dim>::helmholtz_on_patch(VectorType &dst,
                                                const VectorType &u,
                                                const unsigned int p,
                                                const double a,
                                                const double b,
                                                const bool inhomogeneous,
                                                std::vector<double> &padded) const
  {
    const auto &patch = patch_grid.patch(p);
    std::array<double, dim> w;
    double center_weight = a;
    for (unsigned int d = 0; d < dim; ++d)
      {
        w[d] = b / (patch.h[d] * patch.h[d]);
        center_weight -= 2. * w[d];
      }
    for (unsigned int c = 0; c < dim; ++c)
      {
        velocity_halo.gather(u, p, c, padded.data(), inhomogeneous);
        const auto e          = velocity_halo.extents(c);
        const unsigned int nx = space.extent(c, 0), ny = space.extent(c, 1),
                           nz   = (dim == 3 ? space.extent(c, dim - 1) : 1);
        const std::ptrdiff_t sy = e[0], sz = e[0] * e[1];
        double *out = dst.begin() + space.first_dof(p, c);
        for (unsigned int k = 0; k < nz; ++k)
          for (unsigned int j = 0; j < ny; ++j, out += nx)
            {
              const double *in =
                padded.data() + 1 + (j + 1) * sy + (dim == 3 ? (k + 1) * sz : 0);
              for (unsigned int i = 0; i < nx; ++i)
                {
                  double sum = center_weight * in[i] +
                               w[0] * (*(in + i - 1) + in[i + 1]) +
                               w[1] * (*(in + i - sy) + in[i + sy]);
                  if constexpr (dim == 3)
                    sum += w[2] * (*(in + i - sz) + in[i + sz]);
                  out[i] = sum;
                }
            }
      }
  }


  template <int dim>
  void StokesOperators<dim>::gradient_on_patch(VectorType &dst,
                                               const VectorType &pressure,
                                               const unsigned int p,
                                               const bool add,
                                               const double scale,
                                               std::vector<double> &padded) const
  {
    const std::ptrdiff_t sy = n + 2, sz = sy * sy;
    cell_halo.gather(pressure, p, padded.data());
    for (unsigned int c = 0; c < dim; ++c)
      {
        const double factor       = scale / patch_grid.patch(p).h[c];
        const std::ptrdiff_t back = (c == 0 ? 1 : (c == 1 ? sy : sz));
        const unsigned int nx = space.extent(c, 0), ny = space.extent(c, 1),
                           nz = (dim == 3 ? space.extent(c, dim - 1) : 1);

        // planes of faces on the boundary are half a cell away from the pressure,
        // those on coarse-fine interfaces come from add_interface_gradient()
        std::array<double, 2> end_factor;
        for (unsigned int upper = 0; upper < 2; ++upper)
          {
            const Neighbor kind = patch_grid.neighbor(p, 2 * c + upper);
            end_factor[upper]   = (kind == Neighbor::same       ? 1.
                                   : kind == Neighbor::boundary ? 2.
                                                                : 0.) *
                                factor;
          }
        double *out = dst.begin() + space.first_dof(p, c);
        for (unsigned int k = 0; k < nz; ++k)
          for (unsigned int j = 0; j < ny; ++j, out += nx)
            {
              const double *in =
                padded.data() + 1 + (j + 1) * sy + (dim == 3 ? (k + 1) * sz : 0);
              double row_factor = factor;
              if (c > 0)
                {
                  const unsigned int plane = (c == 1 ? j : k);
                  if (plane == 0)
                    row_factor = end_factor[0];
                  else if (plane == n)
                    row_factor = end_factor[1];
                }
              if (add)
                for (unsigned int i = 0; i < nx; ++i)
                  out[i] += row_factor * (in[i] - *(in + i - back));
              else
                for (unsigned int i = 0; i < nx; ++i)
                  out[i] = row_factor * (in[i] - *(in + i - back));
              if (c == 0)
                {
                  out[0] += (end_factor[0] - factor) * (in[0] - *(in - 1));
                  out[n] += (end_factor[1] - factor) * (in[n] - in[n - 1]);
                }
            }
      }
  }


  template <int dim>
  void StokesOperators<dim>::divergence_on_patch(VectorType &dst,
                                                 const VectorType &u,
                                                 const unsigned int p,
                                                 const double factor) const
  {
    const unsigned int nz = (dim == 3 ? n : 1);
    double *out =
      dst.begin() + static_cast<std::size_t>(p) * cell_halo.n_cells_per_patch();
    const auto &patch = patch_grid.patch(p);
    std::array<const double *, 3> in{};
    std::array<double, 3> w{};
    for (unsigned int c = 0; c < dim; ++c)
      {
        in[c] = u.begin() + space.first_dof(p, c);
        w[c]  = factor / patch.h[c];
      }
    for (unsigned int k = 0; k < nz; ++k)
      for (unsigned int j = 0; j < n; ++j, out += n)
        {
          const double *ux = in[0] + (j + k * n) * (n + 1);
          const double *uy = in[1] + (j + k * (n + 1)) * n;
          const double *uz = in[2] + (j + k * n) * n;
          for (unsigned int i = 0; i < n; ++i)
            {
              double sum = w[0] * (ux[i + 1] - ux[i]) + w[1] * (uy[i + n] - uy[i]);
              if constexpr (dim == 3)
                sum += w[2] * (uz[i + n * n] - uz[i]);
              out[i] = sum;
            }
        }
  }


  template <int dim>
  void StokesOperators<dim>::set_interface_forces(const VectorType &pressure) const
  {
    const double *p_value = pressure.begin();
    for (const InterfaceFace &face : interface_faces)
      interface_forces.local_element(face.dof) = face.area * p_value[face.cell];
  }


  template <int dim>
  void StokesOperators<dim>::add_interface_gradient(VectorType &dst,
                                                    const VectorType &pressure,
                                                    const double factor) const
  {
    if (!patch_grid.has_coarse_fine_interfaces())
      return;
    for (const std::size_t master : interface_masters)
      interface_forces.local_element(master) = 0.;
    set_interface_forces(pressure);
    space.collect_interfaces(interface_forces);
    for (const auto &[copy, master] : interface_copies)
      {
        interface_forces.local_element(master) += interface_forces.local_element(copy);
        interface_forces.local_element(copy) = 0.;
      }
    space.collect_remote_copies(interface_forces);
    for (const std::size_t master : interface_masters)
      dst.local_element(master) += factor * interface_forces.local_element(master) *
                                   space.inverse_volumes().local_element(master);
  }


  template <int dim>
  void StokesOperators<dim>::apply_helmholtz(VectorType &dst,
                                             VectorType &u,
                                             const double a,
                                             const double b,
                                             const bool inhomogeneous) const
  {
    u.update_ghost_values();
    std::vector<double> padded(velocity_halo.size(0));
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      helmholtz_on_patch(dst, u, p, a, b, inhomogeneous, padded);
    viscous_fluxes.add_correction(dst, u, b, inhomogeneous);
    u.zero_out_ghost_values();
    finish(dst);
  }


  template <int dim>
  void StokesOperators<dim>::apply_gradient(VectorType &dst,
                                            VectorType &pressure,
                                            const bool add,
                                            const double factor) const
  {
    pressure.update_ghost_values();
    std::vector<double> padded(cell_halo.padded_size());
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      gradient_on_patch(dst, pressure, p, add, factor, padded);
    pressure.zero_out_ghost_values();
    add_interface_gradient(dst, pressure, factor);
    finish(dst);
  }


  template <int dim>
  void StokesOperators<dim>::apply_divergence(VectorType &dst,
                                              const VectorType &u,
                                              const double factor) const
  {
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      divergence_on_patch(dst, u, p, factor);
  }


  template <int dim>
  void StokesOperators<dim>::apply_stokes(VectorType &momentum,
                                          VectorType &mass,
                                          VectorType &u,
                                          VectorType &pressure,
                                          const double a,
                                          const double b,
                                          const double factor) const
  {
    u.update_ghost_values_start(1);
    pressure.update_ghost_values();
    u.update_ghost_values_finish();
    std::vector<double> padded(std::max(velocity_halo.size(0), cell_halo.padded_size()));
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        helmholtz_on_patch(momentum, u, p, a, b, false, padded);
        gradient_on_patch(momentum, pressure, p, true, 1., padded);
        divergence_on_patch(mass, u, p, factor);
      }
    viscous_fluxes.add_correction(momentum, u, b, false);
    u.zero_out_ghost_values();
    pressure.zero_out_ghost_values();
    add_interface_gradient(momentum, pressure, 1.);
    finish(momentum);
  }


  template <int dim>
  void StokesOperators<dim>::equalize_divergence_in_blocks(VectorType &u) const
  {
    constexpr unsigned int n_cells = 1u << dim;
    std::array<std::array<unsigned int, dim>, dim> stride;
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int d = 0; d < dim; ++d)
        stride[c][d] = space.stride(c, d);
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        const auto &patch = patch_grid.patch(p);
        for (unsigned int block = 0; block < Utilities::fixed_power<dim>(n / 2); ++block)
          {
            // the lowest faces of the block
            std::array<double *, dim> face;
            unsigned int rest = block;
            for (unsigned int c = 0; c < dim; ++c)
              face[c] = u.begin() + space.first_dof(p, c);
            for (unsigned int d = 0; d < dim; ++d)
              {
                for (unsigned int c = 0; c < dim; ++c)
                  face[c] += 2 * (rest % (n / 2)) * stride[c][d];
                rest /= n / 2;
              }
            const auto value = [&](const unsigned int c,
                                   const unsigned int cell,
                                   const unsigned int upper) -> double & {
              unsigned int at = upper * stride[c][c];
              for (unsigned int d = 0; d < dim; ++d)
                at += ((cell >> d) & 1) * stride[c][d];
              return face[c][at];
            };

            // The potential phi whose differences across the faces between the cells of
            // the block have this divergence, but for its mean. Products of signs are the
            // eigenvectors of this Laplacian, 2^dim times the inverse of the transform
            // is the transform.
            std::array<double, n_cells> phi{};
            for (unsigned int cell = 0; cell < n_cells; ++cell)
              for (unsigned int c = 0; c < dim; ++c)
                phi[cell] += (value(c, cell, 1) - value(c, cell, 0)) / patch.h[c];
            const auto transform = [&phi]() {
              for (unsigned int bit = 1; bit < n_cells; bit *= 2)
                for (unsigned int i = 0; i < n_cells; ++i)
                  if ((i & bit) == 0)
                    {
                      const double a = phi[i], b = phi[i | bit];
                      phi[i]       = a + b;
                      phi[i | bit] = a - b;
                    }
            };
            transform();
            phi[0] = 0.;
            for (unsigned int i = 1; i < n_cells; ++i)
              {
                double eigenvalue = 0.;
                for (unsigned int d = 0; d < dim; ++d)
                  eigenvalue += ((i >> d) & 1) * 2. / (patch.h[d] * patch.h[d]);
                phi[i] /= -eigenvalue * n_cells;
              }
            transform();
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int cell = 0; cell < n_cells; ++cell)
                if (((cell >> c) & 1) == 0)
                  value(c, cell, 1) -= (phi[cell | (1u << c)] - phi[cell]) / patch.h[c];
          }
      }
  }


  template <int dim>
  double StokesOperators<dim>::max_divergence(const VectorType &u) const
  {
    VectorType divergence;
    initialize_pressure(divergence);
    apply_divergence(divergence, u);
    return divergence.linfty_norm();
  }


  template <int dim>
  double StokesOperators<dim>::max_courant_number(const VectorType &u,
                                                  const double dt) const
  {
    double largest = 0.;
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      for (unsigned int c = 0; c < dim; ++c)
        {
          const double *values = u.begin() + space.first_dof(p, c);
          double speed         = 0.;
          bool finite          = true;
          for (unsigned int i = 0; i < space.n_dofs_per_component(); ++i)
            {
              speed  = std::max(speed, std::abs(values[i]));
              finite = finite && std::isfinite(values[i]);
            }
          if (!finite)
            speed = std::numeric_limits<double>::infinity();
          largest = std::max(largest, speed * dt / patch_grid.patch(p).h[c]);
        }
    return Utilities::MPI::max(largest, patch_grid.communicator());
  }


  template <int dim>
  double StokesOperators<dim>::mean_pressure(const VectorType &p) const
  {
    double sum[2]                = {0., 0.};
    const unsigned int per_patch = cell_halo.n_cells_per_patch();
    for (unsigned int q = 0; q < patch_grid.n_owned_patches(); ++q)
      {
        double volume = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          volume *= patch_grid.patch(q).h[d];
        for (unsigned int i = 0; i < per_patch; ++i)
          sum[0] += volume * p.local_element(q * per_patch + i);
        sum[1] += volume * per_patch;
      }
    double total[2];
    MPI_Allreduce(sum, total, 2, MPI_DOUBLE, MPI_SUM, patch_grid.communicator());
    return total[0] / total[1];
  }


  template class StokesOperators<2>;
  template class StokesOperators<3>;
} // namespace mitre::fluid
