#ifndef mitre_geometry_mesh_check_h
#define mitre_geometry_mesh_check_h

#include <map>

#include <mitre/geometry/tet_mesh.h>

namespace mitre::geometry
{
  /** What check_mesh() finds. */
  struct MeshReport
  {
    std::size_t n_vertices = 0;
    std::map<int, size_t> n_cells; // by material id
    std::map<int, double> volume;  // by material id (cm^3)
    std::size_t n_inverted = 0;
    /** Least quality 12 (3 |V|)^(2/3) / sum of squared edge lengths; 1 is the regular
     *  tetrahedron, 0 a flat one (mean ratio). */
    double min_quality   = 0;
    double mean_quality  = 0;
    double shortest_edge = 0, longest_edge = 0;
    /** Triangles that belong to more than two cells: none in a sound mesh. */
    std::size_t n_bad_faces = 0;
    /** Triangles of the surface, and edges of the surface that do not belong to exactly
     * two of its triangles: none if the surface is closed. */
    std::size_t n_surface_faces = 0, n_bad_surface_edges = 0;
    double surface_area = 0;
    /** Vertices that belong to no cell. */
    std::size_t n_unused_vertices = 0;
    /** Euler characteristic V - E + F of the surface: 0 for a ring, 2 for each ball. */
    long euler_characteristic = 0;
    /** Largest | |f| - 1 | of the fibre directions, and the number of cells without one.
     */
    double fibre_length_error   = 0;
    std::size_t n_without_fibre = 0;

    std::size_t total_cells() const;
    double total_volume() const;
    /** No inverted cell, no bad face, a closed surface, no unused vertex. */
    bool sound() const;
  };

  MeshReport check_mesh(const TetMesh &mesh);
} // namespace mitre::geometry

#endif
