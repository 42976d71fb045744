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
   *
   * @param degree polynomials of a total degree up to this are integrated exactly on
   * simplices; without influence on hypercubes
   */
  template <int dim>
  dealii::Quadrature<dim> make_point_rule(const structure::ElementShape shape,
                                          const unsigned int k,
                                          const unsigned int degree = 2);


  /**
   * What a rule must integrate so that spreading keeps the force and the torque of an
   * element of the given kind: products of two of its fields, times the reference
   * Jacobian where this is not constant.
   */
  struct Exactness
  {
    /// The least number of points an edge (hypercubes).
    unsigned int points_per_edge;

    /// The total degree (simplices).
    unsigned int degree;
  };

  Exactness needed_exactness(const int dim,
                             const structure::ElementShape shape,
                             const unsigned int degree,
                             const bool is_affine);


  /**
   * How far points of an element may lie beyond the box about its nodes, in widths of
   * that box: half of what the Lebesgue constant of the shape functions exceeds 1 by, 0
   * for linear elements. (With L the sum of |phi_a|, a coordinate that is within 1/2 of
   * the middle at the nodes is within L/2 everywhere.) The constants are 5/3 and 2 for
   * quadratic triangles and tetrahedra and (5/4)^dim for quadratic hypercubes.
   */
  double overshoot(const int dim,
                   const structure::ElementShape shape,
                   const unsigned int degree);


  /**
   * A rule with the shape functions at its points, in two layouts, and with room for
   * vectorised loops that run over the end by up to seven numbers.
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


  /// The rules of one kind of element, each made when it is first needed. A rule has a
  /// number, that of its points an edge and of whether it is for elements that are images
  /// of the reference element by an affine map.
  template <int dim>
  class PointRules
  {
  public:
    PointRules(const structure::ElementShape shape,
               const unsigned int degree,
               const structure::ReferenceElement<dim> &element);

    static unsigned int number(const unsigned int k, const bool is_affine)
    {
      return 2 * k + (is_affine ? 0 : 1);
    }

    const PointRule<dim> &get(const unsigned int number)
    {
      return number < rules.size() && rules[number] != nullptr ? *rules[number]
                                                               : make(number);
    }

  private:
    const PointRule<dim> &make(const unsigned int number);

    const structure::ElementShape shape;
    const unsigned int degree;
    const structure::ReferenceElement<dim> &element;
    std::vector<std::unique_ptr<PointRule<dim>>> rules;
  };
} // namespace mitre::coupling

#endif
