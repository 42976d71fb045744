#ifndef mitre_structure_face_frame_h
#define mitre_structure_face_frame_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>

#include <mitre/structure/mesh.h>

namespace mitre::structure
{
  /// A face of the reference element: the points @f$\xi = o + \sum_k \eta_k t_k@f$ for
  /// @f$\eta@f$ in the unit line, triangle or square.
  template <int dim>
  struct FaceFrame
  {
    dealii::Point<dim> origin;
    std::array<dealii::Tensor<1, dim>, dim - 1> tangents;

    /// 1 if area_vector() of the tangents points outward, -1 if inward.
    double orientation;
  };


  /// Of the face with this number in face_corners().
  template <int dim>
  FaceFrame<dim> face_frame(const ElementShape shape, const unsigned int face);


  /// The normal of a face as long as its area, from the derivatives of the position
  /// along it.
  template <int dim>
  dealii::Tensor<1, dim>
  area_vector(const std::array<dealii::Tensor<1, dim>, dim - 1> &tangents)
  {
    if constexpr (dim == 2)
      return dealii::cross_product_2d(tangents[0]);
    else
      return dealii::cross_product_3d(tangents[0], tangents[1]);
  }
} // namespace mitre::structure

#endif
