#include <deal.II/base/mpi.h>

#include <algorithm>
#include <tuple>

#include <mitre/fluid/chebyshev.h>
#include <mitre/fluid/velocity_multigrid.h>

namespace mitre::fluid
{
  using namespace dealii;
  using grid::VectorType;

  template <int dim>
  VelocityMultigrid<dim>::VelocityMultigrid(const StokesOperators<dim> &operators,
                                            const unsigned int smoothing_steps)
    : n_smoothing_steps(smoothing_steps)
  {
    const grid::StaggeredSpace<dim> &space = operators.velocity_space();
    for (unsigned int m = space.grid().n_cells_per_side(); m >= 2; m /= 2)
      {
        auto level = std::make_unique<Level>();
        if (levels.empty())
          level->operators = &operators;
        else
          {
            level->own_grid  = std::make_unique<grid::PatchGrid<dim>>(space.grid(), m);
            level->own_space = std::make_unique<grid::StaggeredSpace<dim>>(
              *level->own_grid, space.boundary_kinds());
            level->own_operators =
              std::make_unique<StokesOperators<dim>>(*level->own_space);
            level->operators = level->own_operators.get();
          }
        for (VectorType *vector : {&level->solution,
                                   &level->rhs,
                                   &level->update,
                                   &level->product,
                                   &level->inverse_diagonal})
          level->operators->initialize_velocity(*vector);
        levels.push_back(std::move(level));
      }
  }


  template <int dim>
  void VelocityMultigrid<dim>::set_coefficients(const double new_a, const double new_b)
  {
    a = new_a;
    b = new_b;
    for (const auto &level : levels)
      {
        const grid::StaggeredSpace<dim> &space = level->operators->velocity_space();
        const unsigned int per_patch           = space.n_dofs_per_patch();
        double largest                         = 0.;
        for (unsigned int p = 0; p < space.grid().n_owned_patches(); ++p)
          {
            double sum = 0.;
            for (const double h : space.grid().patch(p).h)
              sum -= b / (h * h);
            largest = std::max(largest, sum / a);
            std::fill_n(level->inverse_diagonal.begin() +
                          static_cast<std::size_t>(p) * per_patch,
                        per_patch,
                        1. / (a + 2. * sum));
          }
        if (space.grid().has_coarse_fine_interfaces())
          space.synchronize(level->inverse_diagonal);
        largest = Utilities::MPI::max(largest, space.grid().communicator());
        std::tie(level->lower, level->upper) = viscous_spectrum(largest);
      }

    // reduces the error on the coarsest level by 10
    const Level &coarsest = *levels.back();
    coarsest_degree       = chebyshev_degree(coarsest.lower, coarsest.upper, 0.1, 100);
  }


  template <int dim>
  void VelocityMultigrid<dim>::smooth(Level &level,
                                      const unsigned int degree,
                                      const double lower,
                                      const bool zero_start)
  {
    const double theta = 0.5 * (level.upper + lower);
    const double delta = std::max(0.5 * (level.upper - lower), 1e-12 * theta);
    const double sigma = theta / delta;
    double rho         = 1. / sigma;

    const std::size_t size = level.solution.locally_owned_size();
    double *x = level.solution.begin(), *update = level.update.begin();
    const double *rhs = level.rhs.begin(), *inverse = level.inverse_diagonal.begin();
    const double *product = level.product.begin();
    for (unsigned int step = 0; step < degree; ++step)
      {
        if (step == 0 && zero_start)
          {
            for (std::size_t i = 0; i < size; ++i)
              {
                update[i] = inverse[i] * rhs[i] / theta;
                x[i]      = update[i];
              }
            continue;
          }
        level.operators->apply_helmholtz(level.product, level.solution, a, b, false);
        const double rho_new = 1. / (2. * sigma - rho);
        const double keep    = step == 0 ? 0. : rho_new * rho;
        const double gain    = step == 0 ? 1. / theta : 2. * rho_new / delta;
        if (step > 0)
          rho = rho_new;
        for (std::size_t i = 0; i < size; ++i)
          {
            update[i] = (step == 0 ? 0. : keep * update[i]) +
                        gain * inverse[i] * (rhs[i] - product[i]);
            x[i] += update[i];
          }
      }
  }


  template <int dim>
  void VelocityMultigrid<dim>::restrict_residual(const Level &fine, Level &coarse) const
  {
    const grid::StaggeredSpace<dim> &from_space = fine.operators->velocity_space();
    const grid::StaggeredSpace<dim> &to_space   = coarse.operators->velocity_space();
    const grid::VelocityHalo<dim> &halo         = fine.operators->helmholtz_halo();
    constexpr unsigned int n_pairs              = 1u << (dim - 1);
    std::vector<double> padded(halo.size(0));

    fine.product.update_ghost_values();
    for (unsigned int p = 0; p < from_space.grid().n_owned_patches(); ++p)
      for (unsigned int c = 0; c < dim; ++c)
        {
          halo.gather(fine.product, p, c, padded.data());
          const auto e                            = halo.extents(c);
          const std::array<std::size_t, 3> stride = {{1, e[0], e[0] * e[1]}};

          // the fine faces next to a coarse one, all beside each other along the others
          std::array<std::size_t, n_pairs> pairs;
          for (unsigned int k = 0; k < n_pairs; ++k)
            {
              pairs[k]         = 0;
              unsigned int bit = 0;
              for (unsigned int d = 0; d < dim; ++d)
                if (d != c)
                  pairs[k] += ((k >> bit++) & 1u) * stride[d];
            }
          const std::size_t normal = stride[c];
          const unsigned int nx = to_space.extent(c, 0), ny = to_space.extent(c, 1),
                             nz = (dim == 3 ? to_space.extent(c, dim - 1) : 1);
          double *to            = coarse.rhs.begin() + to_space.first_dof(p, c);
          for (unsigned int k = 0; k < nz; ++k)
            for (unsigned int j = 0; j < ny; ++j)
              for (unsigned int i = 0; i < nx; ++i)
                {
                  const double *from = padded.data() + 1 + 2 * i +
                                       (1 + 2 * j) * stride[1] +
                                       (dim == 3 ? (1 + 2 * k) * stride[2] : 0);
                  double sum = 0.;
                  for (const std::size_t pair : pairs)
                    sum += 0.5 * from[pair] +
                           0.25 * (from[pair + normal] + *(from + pair - normal));
                  *to++ = sum / n_pairs;
                }
        }
    fine.product.zero_out_ghost_values();
    to_space.zero_fixed_faces(coarse.rhs);
    if (to_space.grid().has_coarse_fine_interfaces())
      to_space.synchronize(coarse.rhs);
  }


  template <int dim>
  void VelocityMultigrid<dim>::prolongate_correction(const Level &coarse,
                                                     Level &fine) const
  {
    const grid::StaggeredSpace<dim> &from_space = coarse.operators->velocity_space();
    const grid::StaggeredSpace<dim> &to_space   = fine.operators->velocity_space();
    const grid::VelocityHalo<dim> &halo         = coarse.operators->helmholtz_halo();
    std::vector<double> padded(halo.size(0));

    coarse.solution.update_ghost_values();
    for (unsigned int p = 0; p < from_space.grid().n_owned_patches(); ++p)
      for (unsigned int c = 0; c < dim; ++c)
        {
          halo.gather(coarse.solution, p, c, padded.data());
          const auto e                               = halo.extents(c);
          const std::array<std::ptrdiff_t, 3> stride = {
            {1, e[0], static_cast<std::ptrdiff_t>(e[0]) * e[1]}};

          // the value of a coarse plane at a fine position
          const auto on_plane = [&](const double *center,
                                    const std::array<unsigned int, 3> &index) {
            double value = center[0];
            for (unsigned int d = 0; d < dim; ++d)
              if (d != c)
                value +=
                  0.25 *
                  (*(center + (index[d] % 2 == 0 ? -stride[d] : stride[d])) - center[0]);
            return value;
          };
          const unsigned int nx = to_space.extent(c, 0), ny = to_space.extent(c, 1),
                             nz = (dim == 3 ? to_space.extent(c, dim - 1) : 1);
          double *to            = fine.solution.begin() + to_space.first_dof(p, c);
          for (unsigned int k = 0; k < nz; ++k)
            for (unsigned int j = 0; j < ny; ++j)
              for (unsigned int i = 0; i < nx; ++i)
                {
                  const std::array<unsigned int, 3> index = {{i, j, k}};
                  const double *center                    = padded.data() + 1 + i / 2 +
                                         (1 + j / 2) * stride[1] +
                                         (dim == 3 ? (1 + k / 2) * stride[2] : 0);
                  const double value = on_plane(center, index);
                  *to++ += index[c] % 2 == 0
                             ? value
                             : 0.5 * (value + on_plane(center + stride[c], index));
                }
        }
    coarse.solution.zero_out_ghost_values();
    to_space.zero_fixed_faces(fine.solution);
    if (to_space.grid().has_coarse_fine_interfaces())
      to_space.synchronize(fine.solution);
  }


  template <int dim>
  void VelocityMultigrid<dim>::cycle(const unsigned int l)
  {
    Level &fine = *levels[l];
    if (l + 1 == levels.size())
      {
        smooth(fine, coarsest_degree, fine.lower, true);
        return;
      }
    // the modes that the next level does not have
    const double lower = std::max(fine.lower, 0.15 * fine.upper);
    smooth(fine, n_smoothing_steps, lower, true);
    fine.operators->apply_helmholtz(fine.product, fine.solution, a, b, false);
    fine.product.sadd(-1., 1., fine.rhs);
    restrict_residual(fine, *levels[l + 1]);
    cycle(l + 1);
    prolongate_correction(*levels[l + 1], fine);
    smooth(fine, n_smoothing_steps, lower, false);
  }


  template <int dim>
  void VelocityMultigrid<dim>::vmult(VectorType &dst, const VectorType &src)
  {
    Level &finest = *levels.front();
    finest.rhs.copy_locally_owned_data_from(src);
    cycle(0);
    dst.copy_locally_owned_data_from(finest.solution);
  }


  template <int dim>
  std::size_t VelocityMultigrid<dim>::memory_consumption() const
  {
    std::size_t sum = 0;
    for (const auto &level : levels)
      sum += 5 * level->solution.memory_consumption();
    return sum;
  }


  template class VelocityMultigrid<2>;
  template class VelocityMultigrid<3>;
} // namespace mitre::fluid
