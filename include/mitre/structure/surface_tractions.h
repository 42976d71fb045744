#ifndef mitre_structure_surface_tractions_h
#define mitre_structure_surface_tractions_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <functional>
#include <map>
#include <vector>

#include <mitre/structure/body.h>
#include <mitre/structure/boundary_faces.h>

namespace mitre::structure
{
  /// Forces on points of the surface of a body.
  template <int dim>
  struct SurfaceForces
  {
    /// Where [cm], and @f$-P N\,dA@f$ [dyn].
    std::vector<dealii::Point<dim>> points;
    std::vector<dealii::Tensor<1, dim>> forces;

    /// @f$\sum_q \phi_a(q) f_q@f$ [dyn], by node of the mesh and component.
    std::vector<double> moments;
  };


  /**
   * The transmission force @f$-P N@f$ per reference area of the surface of a body of
   * finite elements. The weak form (2.36) has it and the force of the volume, div P, in
   * one density, over the width of an element; to spread it from the surface itself, its
   * moments are taken out of the nodal forces (Boffi, Gastaldi, Heltai and Peskin, CMAME
   * 197 (2008) 2210-2231; Griffith and Luo (2017)).
   *
   * The stress is that of the law at points of the faces, with the change of volume as it
   * is there, whether or not it is projected in the elements.
   */
  template <int dim>
  class SurfaceTractions
  {
  public:
    /// @p body must outlive this object.
    explicit SurfaceTractions(const FiniteElementBody<dim> &body);

    /**
     * Forces on those points for which @p is_here holds, for others of which their
     * moments are not in the sum either. The rule on a face has so many points that they
     * are about @p spacing apart, and is exact for products of quadratic functions with
     * constants at least.
     *
     * @param X positions by node of the mesh and component [cm]
     */
    void compute(const std::vector<double> &X,
                 const double t,
                 const double spacing,
                 const std::function<bool(const dealii::Point<dim> &)> &is_here,
                 SurfaceForces<dim> &result) const;

  private:
    /// Shape functions at the points of a rule on each of the faces of an element.
    struct Table
    {
      ShapeTable<dim> shape;
      /// Weights of the rule; their sum is that of the reference face.
      std::vector<double> weights;
    };

    const Table &table(const unsigned int face, const unsigned int n) const;

    const FiniteElementBody<dim> &body;
    std::vector<BoundaryFace> faces;

    /// Number of the material of each face.
    std::vector<unsigned int> materials;

    mutable std::map<std::pair<unsigned int, unsigned int>, Table> tables;
  };
} // namespace mitre::structure

#endif
