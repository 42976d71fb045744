#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>

#include <mitre/structure/reference_element.h>

namespace mitre::structure
{
  template <int dim>
  ReferenceElement<dim>::ReferenceElement(const ElementShape shape,
                                          const unsigned int degree)
  {
    if (shape == ElementShape::simplex)
      {
        fe = std::make_unique<dealii::FE_SimplexP<dim>>(degree);
        // Gradients are of degree - 1; products of shape functions of 2 degree.
        force_rule = dealii::QWitherdenVincentSimplex<dim>(degree);
        // The Jacobian of bent elements adds dim (degree - 1).
        mass_rule = degree == 1 ? dealii::QWitherdenVincentSimplex<dim>(1, false)
                    : dim == 2  ? dealii::QWitherdenVincentSimplex<dim>(3, false)
                                : dealii::QWitherdenVincentSimplex<dim>(4, true);
      }
    else
      {
        fe         = std::make_unique<dealii::FE_Q<dim>>(degree);
        force_rule = dealii::QGauss<dim>(degree + 1);
        // The determinant of the map's gradient adds dim degree - 1 in each coordinate.
        mass_rule = dealii::QGauss<dim>(degree + 1 + (dim * degree - 1) / 2);
      }
  }


  template <int dim>
  ReferenceElement<dim>::~ReferenceElement() = default;


  template <int dim>
  unsigned int ReferenceElement<dim>::n_nodes() const
  {
    return fe->n_dofs_per_cell();
  }


  template <int dim>
  const std::vector<dealii::Point<dim>> &ReferenceElement<dim>::nodes() const
  {
    return fe->get_unit_support_points();
  }


  template <int dim>
  double ReferenceElement<dim>::value(const unsigned int a,
                                      const dealii::Point<dim> &xi) const
  {
    return fe->shape_value(a, xi);
  }


  template <int dim>
  dealii::Tensor<1, dim>
  ReferenceElement<dim>::gradient(const unsigned int a,
                                  const dealii::Point<dim> &xi) const
  {
    return fe->shape_grad(a, xi);
  }


  template <int dim>
  ShapeTable<dim>::ShapeTable(const ReferenceElement<dim> &element,
                              const dealii::Quadrature<dim> &rule)
    : n_nodes(element.n_nodes())
    , n_points(rule.size())
  {
    for (unsigned int q = 0; q < n_points; ++q)
      for (unsigned int a = 0; a < n_nodes; ++a)
        {
          values.push_back(element.value(a, rule.point(q)));
          gradients.push_back(element.gradient(a, rule.point(q)));
        }
    weights = rule.get_weights();
  }


  template <int dim>
  dealii::Tensor<2, dim> ShapeTable<dim>::jacobian(const Mesh<dim> &mesh,
                                                   const unsigned int e,
                                                   const unsigned int q) const
  {
    dealii::Tensor<2, dim> result;
    for (unsigned int a = 0; a < n_nodes; ++a)
      {
        const dealii::Point<dim> &s     = mesh.nodes[mesh.elements[e * n_nodes + a]];
        const dealii::Tensor<1, dim> &g = gradients[q * n_nodes + a];
        for (unsigned int i = 0; i < dim; ++i)
          result[i] += s[i] * g;
      }
    return result;
  }


  template class ReferenceElement<2>;
  template class ReferenceElement<3>;
  template struct ShapeTable<2>;
  template struct ShapeTable<3>;
} // namespace mitre::structure
