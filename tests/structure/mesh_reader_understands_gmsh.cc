// Small meshes in gmsh's formats 2.2 and 4.1: elements, material ids and fibres (scaled
// to unit length, given in another order than the elements, absent for one of them) end
// up where the file says; areas and volumes computed with deal.II's order of nodes are
// those of the shapes, worked out by hand; centroids and ids agree with what
// dealii::GridIn reads from the same text.

#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/tria.h>

#include <sstream>

#include <mitre/io/mesh_reader.h>

#include "structure_tests.h"

using namespace mitre;

template <int dim>
void
check(const std::string &title, const std::string &text)
{
  std::istringstream in(text);
  const structure::Mesh<dim> mesh = io::read_msh<dim>(in, title);

  const structure::ReferenceElement<dim> element(mesh.shape, mesh.degree);
  const structure::ShapeTable<dim> table(element, element.force_quadrature());

  std::cout << title << ": " << mesh.nodes.size() << " nodes, " << mesh.n_elements()
            << " elements of " << mesh.nodes_per_element << " nodes, "
            << mesh.n_fibre_families() << " fibre families" << std::endl;
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    {
      double volume = 0;
      for (unsigned int q = 0; q < table.n_points; ++q)
        volume += determinant(table.jacobian(mesh, e, q)) * table.weights[q];
      std::cout << "  " << mesh.describe_element(e) << ": id " << mesh.material_ids[e]
                << ", volume " << volume << ", centroid " << mesh.centroid(e);
      for (unsigned int f = 0; f < mesh.n_fibre_families(); ++f)
        std::cout << ", fibre " << mesh.fibres[f][e];
      std::cout << std::endl;
    }

  std::istringstream again(text);
  dealii::Triangulation<dim> triangulation;
  dealii::GridIn<dim> reader(triangulation);
  reader.read_msh(again);
  double difference = 0;
  unsigned int e    = 0;
  for (const auto &cell : triangulation.active_cell_iterators())
    {
      dealii::Point<dim> centroid;
      for (const unsigned int v : cell->vertex_indices())
        centroid += cell->vertex(v) / cell->n_vertices();
      difference += centroid.distance(mesh.centroid(e)) +
                    (cell->material_id() != mesh.material_ids[e]);
      ++e;
    }
  std::cout << "  as GridIn: "
            << (e == mesh.n_elements() ? structure_tests::below(difference, 1e-12)
                                       : "FAILED")
            << std::endl;
}

int
main()
{
  const std::string two_triangles = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                                    "$PhysicalNames\n1\n2 7 \"leaf let\"\n"
                                    "$EndPhysicalNames\n"
                                    "$Nodes\n5\n"
                                    "1 0 0 0\n2 2 0 0\n9 2 1 0\n4 0 1 0\n5 9 9 0\n"
                                    "$EndNodes\n"
                                    "$Elements\n3\n"
                                    "1 1 2 5 1 1 2\n"
                                    "20 2 2 7 1 1 2 9\n"
                                    "10 2 2 8 1 1 9 4\n"
                                    "$EndElements\n";
  check<2>("triangles", two_triangles);
  check<2>("triangles with fibres",
           two_triangles + "$ElementData\n1\n\"fibre\"\n1\n0.0\n3\n0\n3\n2\n"
                           "10 0 2 0\n20 3 4 0\n$EndElementData\n"
                           "$ElementData\n1\n\"fibre 2\"\n1\n0.0\n3\n0\n3\n1\n"
                           "10 -1 0 0\n$EndElementData\n"
                           "$ElementData\n1\n\"something else\"\n1\n0.0\n3\n0\n1\n1\n"
                           "10 5\n$EndElementData\n");
  check<2>("quadrilaterals",
           "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
           "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 3 0 0\n4 3 1 0\n5 1 1 0\n6 0 1 0\n$EndNodes\n"
           "$Elements\n2\n1 3 2 1 1 1 2 5 6\n2 3 2 2 1 2 3 4 5\n$EndElements\n");
  check<3>("tetrahedra",
           "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
           "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n"
           "$Elements\n3\n1 2 2 1 1 1 3 2\n2 4 2 3 1 1 2 3 4\n3 4 2 4 1 2 5 3 4\n"
           "$EndElements\n"
           "$ElementData\n1\n\"fibre\"\n1\n0.0\n3\n0\n3\n2\n2 0 0 5\n3 1 1 0\n"
           "$EndElementData\n");
  check<3>("hexahedron",
           "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
           "$Nodes\n8\n1 0 0 0\n2 2 0 0\n3 2 1 0\n4 0 1 0\n"
           "5 0 0 3\n6 2 0 3\n7 2 1 3\n8 0 1 3\n$EndNodes\n"
           "$Elements\n1\n1 5 2 6 1 1 2 3 4 5 6 7 8\n$EndElements\n");
  check<2>("format 4.1",
           "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
           "$Entities\n0 0 2 0\n"
           "1 0 0 0 1 1 0 1 7 0\n2 1 0 0 3 1 0 1 8 0\n$EndEntities\n"
           "$Nodes\n2 6 1 6\n2 1 0 4\n1\n2\n5\n6\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
           "2 2 0 2\n3\n4\n3 0 0\n3 1 0\n$EndNodes\n"
           "$Elements\n2 2 1 2\n2 1 3 1\n1 1 2 5 6\n2 2 3 1\n2 2 3 4 5\n$EndElements\n");
}
