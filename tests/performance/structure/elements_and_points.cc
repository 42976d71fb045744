// Times on one core, or on each of several ranks: the elastic force of tetrahedra in
// nanoseconds an element, a mass solve, and finding, interpolating to and spreading from
// quadrature points in nanoseconds a point. The body fills a large part of a uniform
// grid.
//
// Usage: elements_and_points [elements an edge = 24] [cells an edge = 64] [cells an edge
// of a patch = 8]

#include <cstdio>
#include <ctime>

#include "../../coupling/coupling_tests.h"

using namespace coupling_tests;

// The least of seven times of the processor, which other processes do not add to.
template <typename Function>
double
seconds(const Function &function)
{
  function();
  double best = 1e9;
  for (unsigned int repetition = 0; repetition < 7; ++repetition)
    {
      const std::clock_t start = std::clock();
      function();
      best = std::min(best, double(std::clock() - start) / CLOCKS_PER_SEC);
    }
  return best;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  constexpr int dim = 3;

  const unsigned int n       = argc > 1 ? std::atoi(argv[1]) : 24;
  const unsigned int n_cells = argc > 2 ? std::atoi(argv[2]) : 64;
  const unsigned int n_patch = argc > 3 ? std::atoi(argv[3]) : 8;

  auto box           = grid_tests::unit_box<dim>(n_cells, 1, "");
  box.cells_per_side = n_patch;
  box.minimum_level = box.maximum_level = 0;
  while ((n_patch << box.minimum_level) < n_cells)
    ++box.minimum_level;
  box.maximum_level = box.minimum_level;
  grid::PatchGrid<dim> patches(MPI_COMM_WORLD, box);
  grid::StaggeredSpace<dim> space(
    patches, grid_tests::all_sides<dim>(grid::BoundaryKind::velocity));
  grid::VelocityHalo<dim> halo(
    space, 2, grid::HaloShape::full, grid::BoundaryExtension::reflection);
  halo.make_own_partitioner();
  space.finalize({});

  BodyInBox<dim> part(
    ElementShape::simplex, n, grid_tests::diagonal_point<dim>(0.1), 0.6, 1e-10);

  coupling::FECoupling<dim> coupling(patches);
  coupling.add_part(*part.body, coupling::CouplingParameters());
  VectorType &X = part.X;
  part.body->distribute([&](const auto &x) { return coupling.owners_of(x); }, X);
  coupling.reinit(halo);

  VectorType u, f, F, G, U;
  space.initialize_vector(u);
  space.initialize_vector(f);
  for (VectorType *v : {&F, &G, &U})
    part.body->initialize_vector(*v);
  grid_tests::interpolate(space, grid_tests::noise<dim>, u);

  // Positions are those of the unit box scaled by 0.6: scale back for the force.
  VectorType Y = X;
  Y *= 1 / 0.6;
  const double force = seconds([&]() { part.body->compute_elastic_force(Y, 0., G); });
  unsigned int iterations = 0;
  const double mass       = seconds([&]() {
    F          = 0;
    iterations = part.body->project(F, G);
  });
  const double update     = seconds([&]() { coupling.update_points({&X}); });
  const double interpolate =
    seconds([&]() { coupling.compute_velocity_moments(u, {&U}); });
  const double spread = seconds([&]() { coupling.spread({&F}, f); });

  // Moving the grid's data to and from padded patches, without any points.
  std::vector<double> padded(halo.size(0));
  const auto &imported = halo.import(u);
  const double gather  = seconds([&]() {
    halo.import(u);
    for (unsigned int p = 0; p < patches.n_owned_patches(); ++p)
      if (coupling.n_points(p) > 0)
        for (unsigned int c = 0; c < dim; ++c)
          halo.gather(imported, p, c, padded.data());
  });
  const double scatter = seconds([&]() {
    halo.begin_scatter();
    for (unsigned int p = 0; p < patches.n_owned_patches(); ++p)
      if (coupling.n_points(p) > 0)
        for (unsigned int c = 0; c < dim; ++c)
          halo.scatter_add(p, c, padded.data());
    halo.end_scatter(f);
  });

  const double n_elements = part.body->elements().n_elements();
  const double n_points   = coupling.n_points();
  std::printf("rank %u: %.0f elements, %.0f points\n"
              "  elastic force  %7.1f ns an element\n"
              "  mass solve     %7.2f ms, %u iterations\n"
              "  finding points %7.1f ns a point\n"
              "  interpolation  %7.1f ns a point, %5.1f without the halo\n"
              "  spreading      %7.1f ns a point, %5.1f without the halo\n",
              dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
              n_elements,
              n_points,
              force / n_elements * 1e9,
              mass * 1e3,
              iterations,
              update / n_points * 1e9,
              interpolate / n_points * 1e9,
              (interpolate - gather) / n_points * 1e9,
              spread / n_points * 1e9,
              (spread - scatter) / n_points * 1e9);
}
