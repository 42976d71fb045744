// Seconds a time step of the fluid alone, by phase: ABC flow, periodic, viscosity 0.01,
// time step 2.5e-5 s, PPM, relative residual 1e-6 from extrapolated starts; 64^3 and
// 128 x 64 x 64 cells on one level, 64^3 with finer patches in an eighth of the box
// ("adaptive"), and 64 x 32 x 32 with finer patches across a quarter of the length, as
// about a heart valve ("valve", 180,224 cells).
// In the same run, for scale: the bandwidth of a STREAM-like triad and the time of the
// plain 7-point loop over one contiguous array of as many cells, each on all ranks at
// once.
//
// Usage: mpirun -np N seconds_a_step [cells a patch side = 16] [steps = 20]
// [relative tolerance = 1e-6] [cube|box|adaptive|valve|all = all]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <vector>

#include "../../fluid/exact_flows.h"

using namespace exact_flows;

namespace
{
  using Clock = std::chrono::steady_clock;

  double seconds_since(const Clock::time_point start)
  {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

  /// Memory of this process in bytes.
  double resident_memory()
  {
    std::ifstream file("/proc/self/statm");
    double pages = 0., resident = 0.;
    file >> pages >> resident;
    return resident * 4096.;
  }

  /// Bytes a second of a = b + s c on all ranks together, arrays of 32 MB a rank.
  double triad_bandwidth()
  {
    const std::size_t size = 1u << 22;
    std::vector<double> a(size, 0.), b(size, 1.), c(size, 2.);
    double best = 1e300;
    for (unsigned int repetition = 0; repetition < 10; ++repetition)
      {
        MPI_Barrier(MPI_COMM_WORLD);
        const auto start = Clock::now();
        for (std::size_t i = 0; i < size; ++i)
          a[i] = b[i] + 3. * c[i];
        b[repetition] = a[size - 1 - repetition];
        best = std::min(best, Utilities::MPI::max(seconds_since(start), MPI_COMM_WORLD));
      }
    return 24. * size / best * Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  }

  /// Seconds of a sweep of the 7-point stencil over this rank's share of the cells,
  /// stored as one array with a layer around it.
  double
  seven_point_seconds(const unsigned int nx, const unsigned int ny, const unsigned int nz)
  {
    const std::size_t sy = nx + 2, sz = sy * (ny + 2);
    std::vector<double> u(sz * (nz + 2), 1.), v(u.size(), 0.);
    double best = 1e300;
    for (unsigned int repetition = 0; repetition < 50; ++repetition)
      {
        MPI_Barrier(MPI_COMM_WORLD);
        const auto start = Clock::now();
        for (unsigned int k = 1; k <= nz; ++k)
          for (unsigned int j = 1; j <= ny; ++j)
            {
              const double *in = u.data() + k * sz + j * sy + 1;
              double *out      = v.data() + k * sz + j * sy + 1;
              for (unsigned int i = 0; i < nx; ++i)
                out[i] = 6. * in[i] - *(in + i - 1) - in[i + 1] - *(in + i - sy) -
                         in[i + sy] - *(in + i - sz) - in[i + sz];
            }
        best = std::min(best, Utilities::MPI::max(seconds_since(start), MPI_COMM_WORLD));
        u[repetition + sz] = v[repetition + sz];
      }
    return best;
  }

  void run_case(const std::string &name,
                const unsigned int n_patch,
                const unsigned int n_steps,
                const double tolerance)
  {
    const double memory_before       = resident_memory();
    grid::PatchGridParameters<3> box = grid_tests::unit_box<3>(
      name == "valve" ? 32 : 64, name == "adaptive" || name == "valve" ? 2 : 1, "xyz");
    box.cells_per_side = n_patch;
    box.minimum_level -= (n_patch == 16 ? 1 : 0);
    box.maximum_level -= (n_patch == 16 ? 1 : 0);
    if (name == "box" || name == "valve")
      {
        box.upper[0]        = 2.;
        box.base_patches[0] = 2;
      }
    grid::PatchGrid<3> patch_grid(MPI_COMM_WORLD, box);
    if (name == "adaptive")
      patch_grid.adapt(refine_quarter(patch_grid));
    if (name == "valve")
      patch_grid.adapt([&](const BoundingBox<3> &leaf) {
        const bool inside = leaf.center()[0] > 0.375 && leaf.center()[0] < 1.125;
        return static_cast<int>(inside ? patch_grid.maximum_level()
                                       : patch_grid.minimum_level());
      });

    const ABC exact{0.01};
    fluid::FluidParameters parameters;
    parameters.viscosity                 = exact.nu;
    parameters.solver.relative_tolerance = tolerance;
    fluid::BoundaryConditions<3> none;
    fluid::NavierStokes<3> flow(patch_grid, none, parameters);
    flow.set_velocity(
      [&](const Point<3> &x, const unsigned int c) { return exact(x, c, 0.); }, 0.);
    grid::VectorType force;
    flow.operators().initialize_velocity(force);

    const double dt = 2.5e-5;
    std::vector<double> times, iterations;
    std::array<double, fluid::n_phases> phases{};
    for (unsigned int step = 0; step < n_steps; ++step)
      {
        MPI_Barrier(MPI_COMM_WORLD);
        const_cast<fluid::StokesSolver<3> &>(flow.solver()).phase_times().reset();
        const auto start       = Clock::now();
        const unsigned int its = flow.advance(step * dt, dt, force);
        const double seconds = Utilities::MPI::max(seconds_since(start), MPI_COMM_WORLD);
        if (step < 5)
          continue;
        times.push_back(seconds);
        iterations.push_back(its);
        for (unsigned int i = 0; i < fluid::n_phases; ++i)
          phases[i] += flow.solver().phase_times()[static_cast<fluid::Phase>(i)];
      }
    const double memory =
      Utilities::MPI::sum(resident_memory() - memory_before, MPI_COMM_WORLD);
    const double cells = patch_grid.n_global_cells();

    double error[3] = {0., 0., 0.};
    grid_tests::for_each_face(
      flow.space(),
      [&](const std::size_t entry,
          const unsigned int,
          const unsigned int c,
          const Point<3> &x) {
        const double w = flow.space().volumes().local_element(entry);
        if (w == 0.)
          return;
        const double e =
          std::abs(flow.velocity().local_element(entry) - exact(x, c, n_steps * dt));
        error[0] += e * w;
        error[1] += e * e * w;
        error[2] = std::max(error[2], e);
      });
    const double l1  = Utilities::MPI::sum(error[0], MPI_COMM_WORLD),
                 l2  = std::sqrt(Utilities::MPI::sum(error[1], MPI_COMM_WORLD)),
                 max = Utilities::MPI::max(error[2], MPI_COMM_WORLD);

    // patches of each rank, and those of them that touch another level
    std::array<unsigned int, 2> n_here = {{patch_grid.n_owned_patches(), 0}};
    for (unsigned int p = 0; p < n_here[0]; ++p)
      n_here[1] += patch_grid.touches_other_level(p) ? 1 : 0;
    const auto n_by_rank = Utilities::MPI::gather(MPI_COMM_WORLD, n_here);

    // changes of the grid: finer patches in one more box, which moves on to places where
    // it has not been, as a valve's do, and back to the first
    std::vector<double> regrids;
    if (name == "adaptive")
      for (const double place : {0.5, 0.75, 1.5, 1.75, 2.5, 2.75, 0.5})
        {
          const auto wanted = refine_quarter(patch_grid);
          MPI_Barrier(MPI_COMM_WORLD);
          const auto start = Clock::now();
          flow.regrid(
            [&](const BoundingBox<3> &leaf) {
              const double x = std::fmod(place, 1.), y = 0.25 * std::floor(place);
              const Point<3> c = leaf.center();
              const bool inside =
                c[0] > x && c[0] < x + 0.25 && c[1] > y && c[1] < y + 0.25 && c[2] < 0.25;
              return inside ? static_cast<int>(patch_grid.maximum_level()) : wanted(leaf);
            },
            n_steps * dt);
          regrids.push_back(Utilities::MPI::max(seconds_since(start), MPI_COMM_WORLD));
        }

    const double memory_after =
      Utilities::MPI::sum(resident_memory() - memory_before, MPI_COMM_WORLD);

    std::sort(times.begin(), times.end());
    std::sort(iterations.begin(), iterations.end());
    const double median = times[times.size() / 2];
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      {
        std::printf("%-8s %7.0f cells: %.3f / %.3f / %.3f s a step, %.0f ns a cell, %.0f "
                    "iterations, %.2f KiB a cell, velocity error %.2e %.2e %.2e\n",
                    name.c_str(),
                    cells,
                    times.front(),
                    median,
                    times.back(),
                    1e9 * median / cells,
                    iterations[iterations.size() / 2],
                    memory / 1024. / cells,
                    l1,
                    l2,
                    max);
        const char *names[fluid::n_phases] = {
          "advection", "velocity", "pressure", "operators", "krylov"};
        double rest = 0.;
        for (const double t : times)
          rest += t;
        for (unsigned int i = 0; i < fluid::n_phases; ++i)
          {
            std::printf("         %-10s %6.1f ms a step, %5.1f ns a cell\n",
                        names[i],
                        1e3 * phases[i] / times.size(),
                        1e9 * phases[i] / times.size() / cells);
            rest -= phases[i];
          }
        std::printf("         %-10s %6.1f ms a step, %5.1f ns a cell\n",
                    "other",
                    1e3 * rest / times.size(),
                    1e9 * rest / times.size() / cells);
        for (const auto &n : n_by_rank)
          std::printf("         %u patches on a rank, %u of them beside another level\n",
                      n[0],
                      n[1]);
        if (!regrids.empty())
          std::printf("         %.2f KiB a cell after all changes of the grid\n",
                      memory_after / 1024. / cells);
        for (const double seconds : regrids)
          std::printf("         change of the grid %.3f s, %.1f steps\n",
                      seconds,
                      seconds / median);
        std::fflush(stdout);
      }
  }
} // namespace


int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int n_patch = argc > 1 ? std::atoi(argv[1]) : 16;
  const unsigned int n_steps = argc > 2 ? std::atoi(argv[2]) : 20;
  const double tolerance     = argc > 3 ? std::atof(argv[3]) : 1e-6;
  const std::string which    = argc > 4 ? argv[4] : "all";
  const unsigned int ranks   = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);

  const double bandwidth = triad_bandwidth();
  const double sweep     = seven_point_seconds(128, 64, 64 / ranks);
  grid_tests::out() << ranks << " ranks, triad " << bandwidth / 1e9
                    << " GB/s, 7-point sweep over 128 x 64 x 64 cells " << 1e3 * sweep
                    << " ms" << std::endl;
  for (const std::string name : {"cube", "box", "adaptive", "valve"})
    if (which == "all" || which == name)
      run_case(name, n_patch, n_steps, tolerance);
}
