#include <vector>

#include <mitre/structure/boundary_faces.h>
#include <mitre/structure/face_frame.h>

namespace mitre::structure
{
  template <int dim>
  FaceFrame<dim> face_frame(const ElementShape shape, const unsigned int face)
  {
    std::vector<dealii::Point<dim>> corners;
    dealii::Point<dim> middle;
    for (unsigned int v = 0; v < (shape == ElementShape::simplex ? dim + 1 : 1 << dim);
         ++v)
      {
        dealii::Point<dim> corner;
        for (unsigned int d = 0; d < dim; ++d)
          corner[d] = shape == ElementShape::simplex ? (v == d + 1) : ((v >> d) & 1u);
        corners.push_back(corner);
        middle += corner;
      }
    middle /= static_cast<double>(corners.size());

    const std::vector<unsigned int> &of_face = face_corners<dim>(shape)[face];
    FaceFrame<dim> frame;
    frame.origin = corners[of_face[0]];
    for (unsigned int k = 0; k + 1 < dim; ++k)
      frame.tangents[k] = corners[of_face[k + 1]] - frame.origin;
    frame.orientation =
      area_vector<dim>(frame.tangents) * (frame.origin - middle) > 0 ? 1 : -1;
    return frame;
  }


  template FaceFrame<2> face_frame(const ElementShape, const unsigned int);
  template FaceFrame<3> face_frame(const ElementShape, const unsigned int);
} // namespace mitre::structure
