#include <algorithm>
#include <cmath>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/structure/mesh.h>
#include <mitre/structure/reference_element.h>

namespace mitre::structure
{
  template <int dim>
  unsigned int Mesh<dim>::n_fibre_families() const
  {
    unsigned int n = 0;
    while (n < max_fibre_families && !fibres[n].empty())
      ++n;
    return n;
  }


  template <int dim>
  dealii::Point<dim> Mesh<dim>::centroid(const unsigned int e) const
  {
    dealii::Point<dim> sum;
    for (unsigned int a = 0; a < nodes_per_element; ++a)
      sum += nodes[elements[e * nodes_per_element + a]];
    return sum / static_cast<double>(nodes_per_element);
  }


  template <int dim>
  std::string Mesh<dim>::describe_element(const unsigned int e) const
  {
    return (shape == ElementShape::segment ? "segment " : "element ") +
           std::to_string(element_tags.empty() ? e : element_tags[e]) + " of " + source;
  }


  template <int dim>
  void check_orientation(const Mesh<dim> &mesh)
  {
    const ReferenceElement<dim> element(mesh.shape, mesh.degree);
    const unsigned int n_nodes = mesh.nodes_per_element;

    // At the vertices, where the Jacobian of a multilinear cell is smallest; of quadratic
    // elements at all nodes.
    const ShapeTable<dim> at_vertices(element, dealii::Quadrature<dim>(element.nodes()));
    const ShapeTable<dim> volume_rule(element, element.force_quadrature());

    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      {
        double smallest = std::numeric_limits<double>::max();
        for (unsigned int q = 0; q < at_vertices.n_points; ++q)
          smallest = std::min(smallest, determinant(at_vertices.jacobian(mesh, e, q)));

        double longest = 0;
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (unsigned int b = 0; b < a; ++b)
            longest = std::max(longest,
                               mesh.nodes[mesh.elements[e * n_nodes + a]].distance(
                                 mesh.nodes[mesh.elements[e * n_nodes + b]]));

        if (!(smallest > 1e-10 * std::pow(longest, dim)))
          {
            double volume = 0;
            for (unsigned int q = 0; q < volume_rule.n_points; ++q)
              volume +=
                determinant(volume_rule.jacobian(mesh, e, q)) * volume_rule.weights[q];
            std::ostringstream message;
            message << "The " << mesh.describe_element(e)
                    << " is inverted or flat: centroid " << to_string(mesh.centroid(e))
                    << ", " << (dim == 2 ? "area " : "volume ") << volume
                    << ", smallest Jacobian at a node " << smallest
                    << ". Expected are positive ones.";
            throw base::UserError(message.str());
          }
      }
  }


  template <int dim>
  std::string to_string(const dealii::Point<dim> &x)
  {
    std::ostringstream text;
    for (unsigned int d = 0; d < dim; ++d)
      text << (d == 0 ? "(" : ", ") << x[d];
    text << ")";
    return text.str();
  }


  template struct Mesh<2>;
  template struct Mesh<3>;
  template void check_orientation(const Mesh<2> &);
  template void check_orientation(const Mesh<3> &);
  template std::string to_string(const dealii::Point<2> &);
  template std::string to_string(const dealii::Point<3> &);
} // namespace mitre::structure
