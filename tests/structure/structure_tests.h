#ifndef mitre_tests_structure_tests_h
#define mitre_tests_structure_tests_h

// Meshes and bodies that several tests of structures use.

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <mitre/structure/body.h>
#include <mitre/structure/library.h>

namespace structure_tests
{
  using namespace mitre::structure;

  /// The box (0,1)^dim of n^dim cubes, each one a hypercube or split into simplices that
  /// share its main diagonal; inner nodes moved by a fifth of the width in a fixed
  /// irregular way. Fibres turn with the position.
  template <int dim>
  Mesh<dim>
  make_box(const ElementShape shape, const unsigned int n, const double jitter = 0.2)
  {
    Mesh<dim> mesh;
    mesh.source            = "box";
    mesh.shape             = shape;
    mesh.nodes_per_element = shape == ElementShape::simplex ? dim + 1 : 1 << dim;

    const auto node = [n](const std::array<unsigned int, 3> &i) {
      return dim == 2 ? i[0] + (n + 1) * i[1] : i[0] + (n + 1) * (i[1] + (n + 1) * i[2]);
    };
    for (unsigned int k = 0; k <= (dim == 3 ? n : 0); ++k)
      for (unsigned int j = 0; j <= n; ++j)
        for (unsigned int i = 0; i <= n; ++i)
          {
            const std::array<unsigned int, 3> index{{i, j, k}};
            bool inner = true;
            for (unsigned int d = 0; d < dim; ++d)
              inner = inner && index[d] > 0 && index[d] < n;
            dealii::Point<dim> x;
            for (unsigned int d = 0; d < dim; ++d)
              x[d] = (index[d] +
                      (inner ? jitter * std::sin(12.9898 * (i + 1) + 78.233 * (j + 2) +
                                                 37.719 * (k + 3) + 5 * d)
                             : 0.)) /
                     n;
            mesh.nodes.push_back(x);
          }

    std::vector<std::vector<unsigned int>> orders{{0, 1}, {1, 0}};
    if (dim == 3)
      orders = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (unsigned int k = 0; k < (dim == 3 ? n : 1); ++k)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n; ++i)
          if (shape == ElementShape::hypercube)
            {
              for (unsigned int v = 0; v < (1u << dim); ++v)
                mesh.elements.push_back(
                  node({{i + (v & 1u), j + ((v >> 1) & 1u), k + ((v >> 2) & 1u)}}));
              mesh.material_ids.push_back(2 * i < n ? 1 : 2);
            }
          else
            for (unsigned int o = 0; o < orders.size(); ++o)
              {
                std::array<unsigned int, 3> index{{i, j, k}};
                std::vector<unsigned int> nodes{node(index)};
                for (const unsigned int d : orders[o])
                  {
                    ++index[d];
                    nodes.push_back(node(index));
                  }
                // Odd permutations are of negative orientation.
                if (o >= orders.size() / 2)
                  std::swap(nodes[0], nodes[1]);
                mesh.elements.insert(mesh.elements.end(), nodes.begin(), nodes.end());
                mesh.material_ids.push_back(2 * i < n ? 1 : 2);
              }

    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      {
        dealii::Tensor<1, dim> f;
        f[0] = std::cos(3 * mesh.centroid(e)[1]);
        f[1] = std::sin(3 * mesh.centroid(e)[1]);
        mesh.fibres[0].push_back(f);
      }
    return mesh;
  }


  /// A mesh of linear elements with nodes in the middle of edges (and, of hypercubes, of
  /// faces and cells) added: quadratic elements of the same shape.
  template <int dim>
  Mesh<dim> make_quadratic(const Mesh<dim> &linear)
  {
    const ReferenceElement<dim> element(linear.shape, 1), quadratic(linear.shape, 2);
    Mesh<dim> mesh         = linear;
    mesh.degree            = 2;
    mesh.nodes_per_element = quadratic.n_nodes();
    mesh.elements.clear();
    // A node is known by the corners of which it is the mean.
    std::map<std::vector<unsigned int>, unsigned int> node_of_corners;
    for (unsigned int e = 0; e < linear.n_elements(); ++e)
      for (unsigned int b = 0; b < quadratic.n_nodes(); ++b)
        {
          std::vector<unsigned int> corners;
          dealii::Point<dim> x;
          for (unsigned int a = 0; a < element.n_nodes(); ++a)
            {
              const double weight     = element.value(a, quadratic.nodes()[b]);
              const unsigned int node = linear.elements[e * element.n_nodes() + a];
              if (std::abs(weight) > 1e-10)
                corners.push_back(node);
              x += weight * linear.nodes[node];
            }
          if (corners.size() == 1)
            mesh.elements.push_back(corners[0]);
          else
            {
              std::sort(corners.begin(), corners.end());
              const auto added = node_of_corners.emplace(corners, mesh.nodes.size());
              if (added.second)
                mesh.nodes.push_back(x);
              mesh.elements.push_back(added.first->second);
            }
        }
    return mesh;
  }


  /// The box of make_box() with elements of degree 1 or 2.
  template <int dim>
  Mesh<dim> make_box_of_degree(const ElementShape shape,
                               const unsigned int degree,
                               const unsigned int n,
                               const double jitter = 0.2)
  {
    const Mesh<dim> linear = make_box<dim>(shape, n, jitter);
    return degree == 1 ? linear : make_quadratic(linear);
  }


  /// A plugin of a registry with given parameters, as "name = value" lines.
  template <typename Plugin>
  std::shared_ptr<Plugin> make_plugin(const mitre::base::PluginRegistry<Plugin> &registry,
                                      const std::string &name,
                                      const std::string &values)
  {
    dealii::ParameterHandler prm;
    registry.declare_parameters(name, prm);
    prm.parse_input_from_string(values);
    std::shared_ptr<Plugin> plugin = registry.create(name);
    plugin->parse_parameters(prm, "Part box, " + name);
    return plugin;
  }


  /// A law with given parameters, as "name = value" lines, on top of its defaults.
  template <int dim>
  std::shared_ptr<ConstitutiveLaw<dim>> make_law(const std::string &name,
                                                 const std::string &values = "")
  {
    dealii::ParameterHandler prm;
    constitutive_laws<dim>().declare_parameters(name, prm);
    prm.parse_input_from_string(values);
    std::shared_ptr<ConstitutiveLaw<dim>> law = constitutive_laws<dim>().create(name);
    law->parse_parameters(prm);
    return law;
  }


  /// Material 1 is a fibre-reinforced solid, material 2 neo-Hookean.
  template <int dim>
  BodyParameters<dim> make_parameters()
  {
    BodyParameters<dim> parameters;
    parameters.name = "box";
    parameters.materials.push_back({"fibrous",
                                    {1},
                                    make_law<dim>("transversely isotropic",
                                                  "set C1 = 3\n"
                                                  "set a_f = 5\n"
                                                  "set b_f = 2\n"),
                                    mitre::base::TimeExpression("1 + t", "factor")});
    parameters.materials.push_back({"plain",
                                    {2},
                                    make_law<dim>("neo-Hookean",
                                                  "set C1 = 2\n"
                                                  "set Bulk modulus = 7\n"),
                                    mitre::base::TimeExpression("1", "factor")});
    return parameters;
  }


  /// A smooth deformation with a determinant well above 0.
  template <int dim>
  dealii::Point<dim> deform(const dealii::Point<dim> &s)
  {
    dealii::Point<dim> x = s;
    x[0] += 0.1 * s[1] + 0.15 * std::sin(2 * s[0]) * s[1];
    x[1] += 0.2 * s[0] * s[1] - 0.05 * s[0] * s[0];
    if (dim == 3)
      {
        x[2] += 0.1 * std::sin(3 * s[0]) - 0.1 * s[2] * s[1];
        x[0] += 0.1 * s[2] * s[2];
      }
    return x;
  }


  template <int dim>
  void set_positions(const Body<dim> &body, VectorType &X)
  {
    std::vector<double> values;
    for (const dealii::Point<dim> &s : body.mesh().nodes)
      {
        const dealii::Point<dim> x = deform(s);
        for (unsigned int d = 0; d < dim; ++d)
          values.push_back(x[d]);
      }
    body.from_mesh_order(values, X);
  }


  /// "1.2e-15 < 1e-12: ok" without the number, which is round-off.
  inline std::string below(const double value, const double bound)
  {
    if (value < bound)
      return "ok";
    return "FAILED, " + std::to_string(value) + " is not below the bound";
  }


  inline std::string
  element_name(const int dim, const ElementShape shape, const unsigned int degree)
  {
    return std::string(degree == 2 ? "quadratic " : "") +
           (shape == ElementShape::simplex ? (dim == 2 ? "triangles" : "tetrahedra")
                                           : (dim == 2 ? "quadrilaterals" : "hexahedra"));
  }


  inline const char *shape_name(const int dim, const ElementShape shape)
  {
    if (shape == ElementShape::simplex)
      return dim == 2 ? "triangles" : "tetrahedra";
    return dim == 2 ? "quadrilaterals" : "hexahedra";
  }
} // namespace structure_tests

#endif
