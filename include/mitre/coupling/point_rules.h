#ifndef mitre_coupling_point_rules_h
#define mitre_coupling_point_rules_h

#include <deal.II/base/quadrature.h>

#include <memory>
#include <vector>

#include <mitre/structure/reference_element.h>

namespace mitre::coupling
{
  /**
   * The quadrature rule with @p k points an edge by which an element meets the grid:
   * Gauss points on hypercubes; on simplices symmetric rules of Witherden and Vincent
   * (2015) with positive weights, all points inside (in 3D 1, 4, 14, 35, 59 points for k
   * = 1, .., 5), and for larger k such rules on equal parts of the element. All integrate
   * products of a linear field and the Jacobian exactly, hypercubes from k = 2 on.
   */
  template <int dim>
  dealii::Quadrature<dim> make_point_rule(const structure::ElementShape shape,
                                          const unsigned int k);


  /**
   * A rule with the shape functions at its points, in two layouts, and with room for
   * vectorised loops that run over the end.
   */
  template <int dim>
  struct PointRule
  {
    PointRule(const structure::ReferenceElement<dim> &element,
              const dealii::Quadrature<dim> &rule);

    /// Number of points, and the same rounded up to a multiple of 8.
    unsigned int n_points;
    unsigned int n_padded;

    /// Shape function a at point q: by_node[a * n_padded + q], by_point[q * n_nodes + a].
    std::vector<double> by_node;
    std::vector<double> by_point;

    structure::ShapeTable<dim> table;
  };


  /// The rules of one kind of element by their k, each made when it is first needed.
  template <int dim>
  class PointRules
  {
  public:
    PointRules(const structure::ElementShape shape,
               const structure::ReferenceElement<dim> &element);

    const PointRule<dim> &get(const unsigned int k)
    {
      return k < rules.size() && rules[k] != nullptr ? *rules[k] : make(k);
    }

    /// The least k that integrates linear fields exactly.
    unsigned int smallest() const
    {
      return shape == structure::ElementShape::simplex ? 1 : 2;
    }

  private:
    const PointRule<dim> &make(const unsigned int k);

    const structure::ElementShape shape;
    const structure::ReferenceElement<dim> &element;
    std::vector<std::unique_ptr<PointRule<dim>>> rules;
  };
} // namespace mitre::coupling

#endif
