// Second-order meshes that gmsh has written (the folder gmsh, with the geometries beside
// them): triangles of a disc, quadrilaterals of a quarter of a ring, tetrahedra of an
// eighth of a ball, hexahedra of a quarter of a thick tube. Nodes in a wrong place of an
// element would bend it: with the parabolas that take the place of arcs of the angle a,
// the area of a sector is smaller by a^4/480 (to a twentieth of that), with straight
// edges it would be by a^2/6. All Jacobians are positive, and in the two regular meshes
// no less than half of the mean one of their element.

#include <algorithm>
#include <cmath>

#include <mitre/io/mesh_reader.h>

#include "structure_tests.h"

using namespace mitre;

template <int dim>
void
check(const std::string &name,
      const double exact,
      const double missing,
      const double bound,
      const bool regular)
{
  const structure::Mesh<dim> mesh = io::read_mesh<dim>(
    std::string(SOURCE_DIR) + "/gmsh/" + name + ".msh", MPI_COMM_WORLD);
  const structure::ReferenceElement<dim> element(mesh.shape, mesh.degree);
  const structure::ShapeTable<dim> table(element, element.mass_quadrature());

  double volume = 0, least = 1e9;
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    {
      double sum = 0, weights = 0, smallest = 1e9;
      for (unsigned int q = 0; q < table.n_points; ++q)
        {
          const double J = determinant(table.jacobian(mesh, e, q));
          sum += J * table.weights[q];
          weights += table.weights[q];
          smallest = std::min(smallest, J);
        }
      volume += sum;
      least = std::min(least, smallest / (sum / weights));
    }
  std::cout << name << ": " << structure_tests::element_name(dim, mesh.shape, mesh.degree)
            << ", " << mesh.n_elements() << " elements, " << mesh.nodes.size()
            << " nodes, volume "
            << structure_tests::below(std::abs(volume / exact - 1 + missing), bound)
            << ", Jacobians " << (least > (regular ? 0.5 : 0.) ? "ok" : "FAILED")
            << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  // Eight arcs of 45 degrees on the disc, three of 30 degrees on the ring and the tube.
  const double pi  = std::acos(-1.);
  const double d45 = std::pow(pi / 4, 4) / 480, d30 = std::pow(pi / 6, 4) / 480;
  check<2>("disc", pi, d45, 0.05 * d45, false);
  check<2>("quads", 0.75 * pi, d30, 0.05 * d30, true);
  check<3>("tets", pi / 6, 0., 0.02, false);
  check<3>("hexes", 1.125 * pi, d30, 0.05 * d30, true);
}
