// The vorticity of a rigid rotation, 2 Omega, is found exactly in every patch. A Gaussian
// vortex that a stream carries through a periodic box: with the grid following the
// vorticity the patch at its centre always has the finest level, patches far from it are
// coarse, the grid is coarsened behind it (it needs as many patches at the end as at the
// start, give or take half), no divergence is made, and the vortex arrives as on a
// grid that is fine everywhere (2D): the largest velocity differs by less than 2 %.

#include <mitre/fluid/vorticity_map.h>

#include "fluid_tests.h"

using namespace grid_tests;
using namespace fluid_tests;

template <int dim>
void
check_rotation()
{
  grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, unit_box<dim>(16, 2, ""));
  patch_grid.adapt(refine_ball(patch_grid, diagonal_point<dim>(0.2), 0.1));
  fluid::BoundaryConditions<dim> conditions;
  std::vector<unsigned int> all;
  for (unsigned int side = 0; side < 2 * dim; ++side)
    all.push_back(side);
  conditions.add("all", all, wall<dim>());
  fluid::NavierStokes<dim> flow(patch_grid, conditions, fluid::FluidParameters());
  double worst = 0.;
  for (unsigned int a = 0; a < dim; ++a)
    for (unsigned int b = a + 1; b < dim; ++b)
      {
        grid::VectorType u;
        flow.operators().initialize_velocity(u);
        for_each_face(
          flow.space(),
          [&](const std::size_t entry,
              const unsigned int,
              const unsigned int c,
              const Point<dim> &x) {
            u.local_element(entry) = c == a ? -3. * x[b] : c == b ? 3. * x[a] : 0.;
          });
        for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
          worst = std::max(
            worst, std::abs(fluid::compute_largest_vorticity(flow.space(), u, p) - 6.));
      }
  out() << dim
        << "D, rotation: " << below(Utilities::MPI::max(worst, MPI_COMM_WORLD), 1e-11)
        << std::endl;
}

template <int dim>
double
vortex(const Point<dim> &x, const unsigned int c)
{
  const double stream = c == 0 ? 1. : 0.;
  if (c >= 2)
    return 0.;
  const double a = x[0] - 0.3, b = x[1] - 0.5, r = 0.06;
  const double swirl = 1.5 / r * std::exp(-0.5 * (a * a + b * b) / (r * r));
  return stream + swirl * (c == 0 ? -b : a);
}

template <int dim>
void
check_vortex(const unsigned int n, const double end)
{
  const double dt = 0.25 / (4 * n), change = 0.25;
  fluid::BoundaryConditions<dim> none;
  fluid::FluidParameters parameters;
  parameters.viscosity = 1e-4;

  double speeds[2] = {0., 0.};
  for (const bool adaptive : {true, false})
    {
      if (!adaptive && dim == 3)
        continue;
      grid::PatchGridParameters<dim> box = unit_box<dim>(n, 3, "xyz");
      if (!adaptive)
        box.minimum_level = box.maximum_level;
      grid::PatchGrid<dim> patch_grid(MPI_COMM_WORLD, box);
      fluid::NavierStokes<dim> flow(patch_grid, none, parameters);
      flow.set_velocity(vortex<dim>, 0.);
      const auto follow = [&](const double time) {
        const fluid::VorticityMap<dim> map(flow.space(), flow.velocity(), change, 12);
        return flow.regrid(
          [&](const BoundingBox<dim> &leaf) { return map.wanted_level(leaf); }, time);
      };
      if (adaptive)
        for (unsigned int pass = 0; pass < 2; ++pass)
          {
            follow(0.);
            flow.set_velocity(vortex<dim>, 0.);
          }
      const double patches   = patch_grid.n_global_patches();
      unsigned int n_changes = 0, n_coarse_centers = 0;
      double divergence = 0.;
      grid::VectorType force;
      flow.operators().initialize_velocity(force);
      const unsigned int steps = std::lround(end / dt);
      for (unsigned int step = 0; step < steps; ++step)
        {
          const double before = flow.operators().max_divergence(flow.velocity());
          if (adaptive && step % 5 == 0 && step > 0 && follow(step * dt))
            {
              ++n_changes;
              flow.operators().initialize_velocity(force);
              divergence = std::max(
                divergence, flow.operators().max_divergence(flow.velocity()) - before);
            }
          flow.advance(step * dt, dt, force);
          Point<dim> center = diagonal_point<dim>(0.5 + 1e-6);
          center[0]         = 0.3 + (step + 1) * dt;
          const int level =
            Utilities::MPI::max(patch_grid.level_at(center), MPI_COMM_WORLD);
          if (level < static_cast<int>(patch_grid.maximum_level()))
            ++n_coarse_centers;
        }
      speeds[adaptive ? 0 : 1] = flow.velocity().linfty_norm();
      if (!adaptive)
        continue;
      const double uniform = std::pow(n * 4 / 8., dim);
      out() << dim << "D, vortex: changes " << above(n_changes, dim == 2 ? 2.5 : 0.5)
            << ", centre too coarse " << below(n_coarse_centers, 0.5)
            << ", patches at the start " << below(patches / uniform, 0.6)
            << ", change of their number "
            << below(std::abs(patch_grid.n_global_patches() / patches - 1.), 0.5)
            << ", divergence that changes add " << below(divergence, 1e-7) << std::endl;
    }
  if (dim == 2)
    out() << "  largest velocity as on the fine grid "
          << below(std::abs(speeds[0] / speeds[1] - 1.), 0.02) << std::endl;
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_rotation<2>();
  check_rotation<3>();
  check_vortex<2>(32, 0.3);
  check_vortex<3>(16, 0.08);
}
