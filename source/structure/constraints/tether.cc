#include <algorithm>
#include <cmath>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/structure/constraints/tether.h>

namespace mitre::structure
{
  template <int dim>
  void Tether<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Stiffness",
                      "1e6",
                      dealii::Patterns::Double(0),
                      "kappa of the force density -kappa (X - X_target) per reference "
                      "volume [dyn/cm^4]; stable up to about rho/dt^2.");
    prm.declare_entry("Damping",
                      "0",
                      dealii::Patterns::Double(0),
                      "eta of the force density -eta U per reference volume "
                      "[dyn s/cm^4]; stable up to about rho/dt.");
    prm.declare_entry("Region",
                      "1",
                      dealii::Patterns::Anything(),
                      "Acts on the nodes where this expression of the reference "
                      "coordinates x, y, z [cm] is not 0, for example 'x < 4'.");
    prm.declare_entry("Material ids",
                      "",
                      dealii::Patterns::List(dealii::Patterns::Integer(0)),
                      "Acts on nodes of elements with these ids only; empty: all.");
  }


  template <int dim>
  void Tether<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                     const std::string &what)
  {
    stiffness    = prm.get_double("Stiffness");
    damping      = prm.get_double("Damping");
    region       = base::Expression<dim>(prm.get("Region"), what + ", Region");
    material_ids = base::parse_integers(prm.get("Material ids"), what + ", Material ids");
  }


  template <int dim>
  void Tether<dim>::reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements)
  {
    std::vector<bool> candidate(elements.n_owned_nodes(), material_ids.empty());
    for (unsigned int i = 0; i < elements.n_elements(); ++i)
      if (std::find(material_ids.begin(),
                    material_ids.end(),
                    static_cast<int>(mesh.material_ids[elements.element(i)])) !=
          material_ids.end())
        for (unsigned int a = 0; a < mesh.nodes_per_element; ++a)
          if (elements.nodes(i)[a] < elements.n_owned_nodes())
            candidate[elements.nodes(i)[a]] = true;

    nodes.clear();
    reference_positions.clear();
    for (unsigned int i = 0; i < elements.n_owned_nodes(); ++i)
      if (candidate[i])
        {
          const dealii::Point<dim> &s = mesh.nodes[elements.file_node(i)];
          if (region.holds(s))
            {
              nodes.push_back(i);
              reference_positions.push_back(s);
            }
        }
  }


  template <int dim>
  dealii::Point<dim> Tether<dim>::target(const unsigned int i, const double) const
  {
    return reference_positions[i];
  }


  template <int dim>
  void Tether<dim>::add_force_density(const VectorType &X,
                                      const VectorType &U,
                                      const double t,
                                      VectorType &F) const
  {
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        const dealii::Point<dim> x = target(i, t);
        for (unsigned int c = 0; c < dim; ++c)
          {
            const unsigned int entry = nodes[i] * dim + c;
            F.local_element(entry) += -stiffness * (X.local_element(entry) - x[c]) -
                                      damping * U.local_element(entry);
          }
      }
  }


  template <int dim>
  double Tether<dim>::largest_displacement(const VectorType &X, const double t) const
  {
    double largest_square = 0;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        const dealii::Point<dim> x = target(i, t);
        double square              = 0;
        for (unsigned int c = 0; c < dim; ++c)
          {
            const double difference = X.local_element(nodes[i] * dim + c) - x[c];
            square += difference * difference;
          }
        largest_square = std::max(largest_square, square);
      }
    return std::sqrt(largest_square);
  }


  template class Tether<2>;
  template class Tether<3>;
} // namespace mitre::structure
