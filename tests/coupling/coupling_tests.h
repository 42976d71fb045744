#ifndef mitre_tests_coupling_tests_h
#define mitre_tests_coupling_tests_h

// Grids with a refined middle, and bodies in them, that several tests of coupling use.

#include <memory>

#include <mitre/coupling/fe_coupling.h>
#include <mitre/coupling/kernels.h>
#include <mitre/coupling/refinement.h>

#include "../grid/grid_tests.h"
#include "../structure/structure_tests.h"

namespace coupling_tests
{
  using namespace mitre;
  using dealii::Point;
  using grid_tests::below;
  using grid_tests::out;
  using structure::ElementShape;
  using structure::VectorType;


  /// A body in the unit box: unit box of the structure tests, deformed, scaled by @p size
  /// and moved to @p lower. "bent": its undeformed elements are bent, too.
  template <int dim>
  struct BodyInBox
  {
    std::unique_ptr<structure::FiniteElementBody<dim>> body;
    VectorType X;

    BodyInBox(const ElementShape shape,
              const unsigned int n,
              const Point<dim> &lower,
              const double size,
              const double mass_tolerance = 1e-14,
              const unsigned int degree   = 1,
              const bool bent             = false)
    {
      auto parameters           = structure_tests::make_parameters<dim>();
      parameters.mass_tolerance = mass_tolerance;
      structure::Mesh<dim> mesh =
        structure_tests::make_box_of_degree<dim>(shape, degree, n);
      if (bent)
        for (Point<dim> &s : mesh.nodes)
          s = structure_tests::deform(s);
      body = std::make_unique<structure::FiniteElementBody<dim>>(
        parameters, mesh, MPI_COMM_WORLD);
      body->initialize_vector(X);
      std::vector<double> positions;
      for (const Point<dim> &s : body->mesh().nodes)
        {
          const Point<dim> x = structure_tests::deform(s);
          for (unsigned int d = 0; d < dim; ++d)
            positions.push_back(lower[d] + size * x[d]);
        }
      body->from_mesh_order(positions, X);
    }
  };


  /// Everything about a grid that spreading and interpolating need.
  template <int dim>
  struct Grid
  {
    grid::PatchGrid<dim> patches;
    std::unique_ptr<grid::StaggeredSpace<dim>> space;
    std::unique_ptr<grid::VelocityHalo<dim>> halo;

    Grid(const unsigned int n,
         const unsigned int levels,
         const std::string &periodic,
         const std::function<int(const grid::PatchGrid<dim> &,
                                 const dealii::BoundingBox<dim> &)> &wanted_level,
         const unsigned int width      = 3,
         const grid::BoundaryKind kind = grid::BoundaryKind::velocity)
      : patches(MPI_COMM_WORLD, grid_tests::unit_box<dim>(n, levels, periodic))
    {
      patches.adapt(
        [&](const dealii::BoundingBox<dim> &box) { return wanted_level(patches, box); });
      space = std::make_unique<grid::StaggeredSpace<dim>>(
        patches, grid_tests::all_sides<dim>(kind));
      halo = std::make_unique<grid::VelocityHalo<dim>>(
        *space, width, grid::HaloShape::full, grid::BoundaryExtension::reflection);
      halo->make_own_partitioner();
      space->finalize({});
    }

    VectorType make_vector() const
    {
      VectorType v;
      space->initialize_vector(v);
      return v;
    }
  };


  /// The finest level where x + y < 1.05, so that a body in the middle straddles levels.
  template <int dim>
  int half_refined(const grid::PatchGrid<dim> &patches,
                   const dealii::BoundingBox<dim> &box)
  {
    return box.center()[0] + box.center()[1] < 1.05 ? patches.maximum_level()
                                                    : patches.minimum_level();
  }


  /// Irregular nodal values.
  template <int dim>
  VectorType make_nodal_field(const structure::Body<dim> &body)
  {
    std::vector<double> values;
    for (const Point<dim> &s : body.mesh().nodes)
      for (unsigned int c = 0; c < dim; ++c)
        values.push_back(0.3 + grid_tests::noise(s, c));
    VectorType v;
    body.initialize_vector(v);
    body.from_mesh_order(values, v);
    return v;
  }
} // namespace coupling_tests

#endif
