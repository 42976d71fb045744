#include <algorithm>
#include <cmath>
#include <optional>

#include <mitre/base/exceptions.h>
#include <mitre/structure/reference_element.h>
#include <mitre/structure/tie.h>

namespace mitre::structure
{
  using dealii::Point;
  using dealii::Tensor;

  template <int dim>
  void Tie<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Part",
                      "",
                      dealii::Patterns::Anything(),
                      "The part whose nodes are tied, as one of fibres.");
    prm.declare_entry("To",
                      "",
                      dealii::Patterns::Anything(),
                      "The part, of finite elements, that they are tied to.");
    prm.declare_entry("Region",
                      "",
                      dealii::Patterns::Anything(),
                      "Ties the nodes where this expression of the reference coordinates "
                      "x, y, z holds, all of which must lie in the other part; empty: "
                      "those that do.");
    prm.declare_entry(
      "Stiffness",
      "0",
      dealii::Patterns::Double(0.),
      "kappa of the spring of each node [dyn/cm]. It limits the time step "
      "as the stiffness of target points does.");
  }


  template <int dim>
  void Tie<dim>::parse_parameters(dealii::ParameterHandler &prm, const std::string &name)
  {
    name_            = name;
    part_            = prm.get("Part");
    host_            = prm.get("To");
    takes_all_inside = prm.get("Region").empty();
    if (!takes_all_inside)
      region = base::Expression<dim>(prm.get("Region"), "Tie " + name_ + ", Region");
    stiffness = prm.get_double("Stiffness");
  }


  namespace
  {
    /// Where @p x lies in the reference cell of element @p e; nothing if outside.
    template <int dim>
    std::optional<Point<dim>> find_in_element(const Mesh<dim> &mesh,
                                              const ReferenceElement<dim> &element,
                                              const unsigned int e,
                                              const Point<dim> &x)
    {
      const unsigned int *nodes = &mesh.elements[e * mesh.nodes_per_element];
      constexpr double slack    = 1e-8;
      for (unsigned int d = 0; d < dim; ++d)
        {
          double lower = mesh.nodes[nodes[0]][d], upper = lower;
          for (unsigned int a = 1; a < mesh.nodes_per_element; ++a)
            {
              lower = std::min(lower, mesh.nodes[nodes[a]][d]);
              upper = std::max(upper, mesh.nodes[nodes[a]][d]);
            }
          // quadratic elements may bulge beyond their nodes
          const double margin =
            (mesh.degree > 1 ? 0.25 : slack) * (upper - lower) + slack;
          if (x[d] < lower - margin || x[d] > upper + margin)
            return {};
        }

      // Newton's method; exact in one step if the element is affine.
      Point<dim> xi;
      for (unsigned int d = 0; d < dim; ++d)
        xi[d] = mesh.shape == ElementShape::simplex ? 1. / (dim + 1) : 0.5;
      for (unsigned int iteration = 0; iteration < 20; ++iteration)
        {
          Tensor<1, dim> residual = x;
          Tensor<2, dim> jacobian;
          for (unsigned int a = 0; a < mesh.nodes_per_element; ++a)
            {
              residual -= element.value(a, xi) * mesh.nodes[nodes[a]];
              jacobian += outer_product(Tensor<1, dim>(mesh.nodes[nodes[a]]),
                                        element.gradient(a, xi));
            }
          if (std::abs(determinant(jacobian)) < 1e-300)
            return {};
          const Tensor<1, dim> change = invert(jacobian) * residual;
          xi += change;
          if (change.norm() < 1e-12)
            break;
          if (xi.norm() > 10.)
            return {};
        }
      double sum = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          sum += xi[d];
          if (!(xi[d] > -slack && xi[d] < 1. + slack))
            return {};
        }
      if (mesh.shape == ElementShape::simplex && sum > 1. + slack)
        return {};
      return xi;
    }


    template <int dim>
    Tensor<1, dim> vector_at(const std::vector<double> &X, const unsigned int node)
    {
      Tensor<1, dim> x;
      for (unsigned int c = 0; c < dim; ++c)
        x[c] = X[node * dim + c];
      return x;
    }


    template <int dim>
    void
    add_at(std::vector<double> &G, const unsigned int node, const Tensor<1, dim> &force)
    {
      for (unsigned int c = 0; c < dim; ++c)
        G[node * dim + c] += force[c];
    }
  } // namespace


  template <int dim>
  void Tie<dim>::reinit(const Mesh<dim> &part, const Mesh<dim> &host)
  {
    AssertThrow(host.shape != ElementShape::segment,
                base::UserError("Tie " + name_ + ": the part " + host_ +
                                " consists of fibres; \"To\" must name one of finite "
                                "elements."));
    const ReferenceElement<dim> element(host.shape, host.degree);
    places.clear();
    for (unsigned int i = 0; i < part.nodes.size(); ++i)
      {
        const Point<dim> &x = part.nodes[i];
        if (!takes_all_inside && !region.holds(x))
          continue;
        bool found = false;
        for (unsigned int e = 0; e < host.n_elements() && !found; ++e)
          if (const auto xi = find_in_element(host, element, e, x))
            {
              Place place;
              place.node = i;
              for (unsigned int a = 0; a < host.nodes_per_element; ++a)
                {
                  place.host_nodes.push_back(
                    host.elements[e * host.nodes_per_element + a]);
                  place.weights.push_back(element.value(a, *xi));
                }
              places.push_back(place);
              found = true;
            }
        AssertThrow(found || takes_all_inside,
                    base::UserError("Tie " + name_ + ": the node " + std::to_string(i) +
                                    " of part " + part_ + " at " + to_string(x) +
                                    " cm is in the \"Region\", but in no element of " +
                                    "part " + host_ + "."));
      }
    AssertThrow(
      !places.empty(),
      base::UserError("Tie " + name_ + ": no node of part " + part_ +
                      (takes_all_inside ? " lies in part " + host_
                                        : std::string(" is in the \"Region\"")) +
                      "."));
  }


  template <int dim>
  Tensor<1, dim> Tie<dim>::distance(const Place &place,
                                    const std::vector<double> &X_part,
                                    const std::vector<double> &X_host) const
  {
    Tensor<1, dim> d = vector_at<dim>(X_part, place.node);
    for (unsigned int a = 0; a < place.weights.size(); ++a)
      d -= place.weights[a] * vector_at<dim>(X_host, place.host_nodes[a]);
    return d;
  }


  template <int dim>
  void Tie<dim>::add_forces(const std::vector<double> &X_part,
                            const std::vector<double> &X_host,
                            std::vector<double> &on_part,
                            std::vector<double> &on_host) const
  {
    for (const Place &place : places)
      {
        const Tensor<1, dim> force = -stiffness * distance(place, X_part, X_host);
        add_at<dim>(on_part, place.node, force);
        for (unsigned int a = 0; a < place.weights.size(); ++a)
          add_at<dim>(on_host, place.host_nodes[a], -place.weights[a] * force);
      }
  }


  template <int dim>
  double Tie<dim>::largest_distance(const std::vector<double> &X_part,
                                    const std::vector<double> &X_host) const
  {
    double largest = 0.;
    for (const Place &place : places)
      largest = std::max(largest, distance(place, X_part, X_host).norm());
    return largest;
  }


  template class Tie<2>;
  template class Tie<3>;
} // namespace mitre::structure
