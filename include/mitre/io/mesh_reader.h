#ifndef mitre_io_mesh_reader_h
#define mitre_io_mesh_reader_h

#include <deal.II/base/mpi.h>

#include <istream>
#include <string>

#include <mitre/structure/mesh.h>

namespace mitre::io
{
  /**
   * Read a structure mesh: elements of dimension @p dim and of one shape, simplices or
   * hypercubes of first or (gmsh only) second order, their first physical id as material
   * id, and fibre directions. Elements of one dimension less that have a physical id
   * (gmsh only) become boundary elements; others are skipped, and so are nodes that no
   * element has.
   *
   * gmsh's <code>.msh</code> files, ASCII, formats 2.2 and 4.1, are read by
   * read_msh(); for all others the formats of dealii::GridIn are tried by the ending of
   * the name, without fibres.
   *
   * The first rank reads and sends the mesh to the others. Collective. Throws
   * base::UserError on all ranks, which names the file and the line or element.
   */
  template <int dim>
  structure::Mesh<dim> read_mesh(const std::string &file, const MPI_Comm communicator);


  /**
   * Read a mesh in gmsh's <code>.msh</code> format. Fibre directions are
   * <code>$ElementData
   * </code> sections named "fibre" (and "fibre 2" for a second family) with three
   * components for each element number; they need not be of unit length, and (0, 0, 0)
   * stands for no fibres.
   *
   * @param source the file's name for messages
   */
  template <int dim>
  structure::Mesh<dim> read_msh(std::istream &in, const std::string &source);
} // namespace mitre::io

#endif
