#ifndef mitre_structure_boundary_faces_h
#define mitre_structure_boundary_faces_h

#include <vector>

#include <mitre/structure/mesh.h>

namespace mitre::structure
{
  /// The corners of each face of an element, as numbers of its own corners: first, the
  /// neighbour along the first direction in the face, that along the second (in 3D), and
  /// the opposite one (quadrilaterals).
  template <int dim>
  const std::vector<std::vector<unsigned int>> &face_corners(const ElementShape shape);


  /// A side of an element with no other element behind it.
  struct BoundaryFace
  {
    static constexpr unsigned int no_id = static_cast<unsigned int>(-1);

    unsigned int element;

    /// Index into face_corners().
    unsigned int face;

    /// Physical id that the mesh file gives it.
    unsigned int id = no_id;
  };


  /**
   * The boundary of @p mesh, in the order of the elements. What the mesh names as
   * elements of the boundary but lies within the body is passed over.
   */
  template <int dim>
  std::vector<BoundaryFace> find_boundary_faces(const Mesh<dim> &mesh);


  /// Mean of the corners of a face in the reference configuration.
  template <int dim>
  dealii::Point<dim> centroid(const Mesh<dim> &mesh, const BoundaryFace &face);
} // namespace mitre::structure

#endif
