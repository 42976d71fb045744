#ifndef mitre_geometry_msh_format_h
#define mitre_geometry_msh_format_h

#include <mitre/geometry/tet_mesh.h>

namespace mitre::geometry
{
  /**
   * Write a gmsh file (ASCII, version 2.2): nodes, tetrahedra with the material id as
   * physical tag, and, if any cell has one, the fibre directions as $ElementData named
   * "fibre" with three components for every element (zero where there is no fibre).
   * Coordinates are written with 17 digits. Throws base::UserError if the file cannot be
   * written.
   */
  void write_msh(const TetMesh &mesh, const std::string &file_name);

  /** Read what write_msh() writes; throws base::UserError for anything else. */
  TetMesh read_msh(const std::string &file_name);
} // namespace mitre::geometry

#endif
