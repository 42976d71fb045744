#ifndef mitre_coupling_point_rules_h
#define mitre_coupling_point_rules_h

#include <deal.II/base/quadrature.h>

#include <memory>
#include <vector>

#include <mitre/structure/reference_element.h>

namespace mitre::coupling
{
  /**
   * The quadrature rule by which an element with @p k points an edge meets the grid:
   * k^dim Gauss points on hypercubes. On simplices that of the symmetric rules of
   * Witherden and Vincent (2015), of degree 2 at least and with positive weights and all
   * points inside, on the whole element or on equal parts of it, which has the fewest
   * points among those whose holes are no larger than the ones between the k^dim points
   * of a hypercube with edges of the same length (in 3D 4, 8, 14, 24, 32 and 46 points
   * for k = 2, 4, 5, 6, 7, 8; from k = 12 on they are up to 15 % larger, as the parts of
   * a divided tetrahedron are not all regular). A hole is a ball without points about a
   * place in the element, which for simplices is taken to be regular.
   *
   * All integrate the product of two linear fields exactly, hypercubes that are
   * parallelepipeds from k = 2, others from k = dim on.
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

    /// One point that takes the value of one node.
    PointRule();

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

  private:
    const PointRule<dim> &make(const unsigned int k);

    const structure::ElementShape shape;
    const structure::ReferenceElement<dim> &element;
    std::vector<std::unique_ptr<PointRule<dim>>> rules;
  };
} // namespace mitre::coupling

#endif
