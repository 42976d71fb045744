#ifndef mitre_structure_reference_element_h
#define mitre_structure_reference_element_h

#include <deal.II/base/point.h>
#include <deal.II/base/quadrature.h>
#include <deal.II/base/tensor.h>

#include <memory>
#include <type_traits>

#include <mitre/structure/mesh.h>

namespace dealii
{
  template <int dim, int spacedim>
  class FiniteElement;
}

namespace mitre::structure
{
  /**
   * The Lagrangian shape functions @f$\phi_a(\xi)@f$ of one shape and degree (1 or 2) on
   * the reference cell (unit simplex or unit cube).
   */
  template <int dim>
  class ReferenceElement
  {
  public:
    ReferenceElement(const ElementShape shape, const unsigned int degree);
    ~ReferenceElement();

    unsigned int n_nodes() const;

    /// Where the nodes are, @f$\phi_a(\xi_b) = \delta_{ab}@f$.
    const std::vector<dealii::Point<dim>> &nodes() const;

    double value(const unsigned int a, const dealii::Point<dim> &xi) const;

    /// @f$\partial\phi_a/\partial\xi@f$
    dealii::Tensor<1, dim> gradient(const unsigned int a,
                                    const dealii::Point<dim> &xi) const;

    /**
     * The rule for the elastic force: one point for linear simplices, on which the
     * deformation gradient is constant, (degree + 1)^dim Gauss points on hypercubes.
     */
    const dealii::Quadrature<dim> &force_quadrature() const
    {
      return force_rule;
    }

    /// A rule that integrates @f$\phi_a\phi_b@f$ exactly, on multilinear cells too.
    const dealii::Quadrature<dim> &mass_quadrature() const
    {
      return mass_rule;
    }

  private:
    std::unique_ptr<const dealii::FiniteElement<dim, dim>> fe;
    dealii::Quadrature<dim> force_rule;
    dealii::Quadrature<dim> mass_rule;
  };


  /// Call @p function with the number of nodes of an element of degree 1 or 2 as a
  /// constant, so that loops over them can be unrolled.
  template <int dim, typename Function>
  void with_n_nodes(const unsigned int n_nodes, const Function &function)
  {
    switch (n_nodes)
      {
        case dim + 1:
          return function(std::integral_constant<int, dim + 1>());
        case (1 << dim):
          return function(std::integral_constant<int, (1 << dim)>());
        case (dim + 1) * (dim + 2) / 2:
          return function(std::integral_constant<int, (dim + 1) * (dim + 2) / 2>());
        case (dim == 2 ? 9 : 27):
          return function(std::integral_constant<int, (dim == 2 ? 9 : 27)>());
        default:
          AssertThrow(false, dealii::ExcNotImplemented());
      }
  }


  /**
   * The shape functions at the points of a quadrature rule:
   * values[q * n_nodes + a], gradients[q * n_nodes + a], weights[q].
   */
  template <int dim>
  struct ShapeTable
  {
    ShapeTable() = default;
    ShapeTable(const ReferenceElement<dim> &element, const dealii::Quadrature<dim> &rule);

    unsigned int n_nodes  = 0;
    unsigned int n_points = 0;
    std::vector<double> values;
    std::vector<dealii::Tensor<1, dim>> gradients;
    std::vector<double> weights;

    /**
     * @f$\partial s/\partial\xi = \sum_a s_a \otimes \partial\phi_a/\partial\xi@f$ at
     * point @p q of element @p e of @p mesh.
     */
    dealii::Tensor<2, dim>
    jacobian(const Mesh<dim> &mesh, const unsigned int e, const unsigned int q) const;
  };
} // namespace mitre::structure

#endif
