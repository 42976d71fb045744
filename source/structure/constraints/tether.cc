#include <algorithm>
#include <cmath>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/structure/constraints/tether.h>
#include <mitre/structure/time_function.h>

namespace mitre::structure
{
  template <int dim>
  void Tether<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Acts on",
                      "volume",
                      dealii::Patterns::Selection("volume|surface|points"),
                      "'volume': a force per reference volume at all nodes; 'surface': a "
                      "force per reference area on the body's surface; 'points': a force "
                      "on each node.");
    prm.declare_entry("Stiffness",
                      "1e6",
                      dealii::Patterns::Double(0),
                      "kappa of the force -kappa (X - X_target) [dyn/cm^4 in a volume, "
                      "dyn/cm^3 on a surface, dyn/cm at points]; stable up to about "
                      "rho/dt^2 in a volume.");
    prm.declare_entry("Damping",
                      "0",
                      dealii::Patterns::Double(0),
                      "eta of the force -eta (U - U_target) [dyn s/cm^4 in a volume, dyn "
                      "s/cm^3 on a surface, dyn s/cm at points]; stable up to about "
                      "rho/dt in a volume.");
    prm.declare_entry("Components",
                      dim == 2 ? "x, y" : "x, y, z",
                      dealii::Patterns::MultipleSelection(dim == 2 ? "x|y" : "x|y|z"),
                      "The components of the position that are held; the others are "
                      "free.");
    VectorExpression<dim>::declare_parameters(
      prm, "Displacement", "Of the target from the reference position [cm]");
    prm.declare_entry("Displacement table",
                      "",
                      base::InputFile(),
                      "Table (CSV) of the displacement over time, in the place of the "
                      "expressions.");
    prm.declare_entry("Displacement columns",
                      "",
                      dealii::Patterns::Anything(),
                      "Names of the table's columns for x, y (and z), with a unit of "
                      "length, such as [mm].");
    prm.declare_entry("Displacement extension",
                      "clamped",
                      dealii::Patterns::Selection("clamped|periodic"),
                      "What holds outside of the table's times: its first and last "
                      "value, or the table over and over.");
    prm.declare_entry("Boundary ids",
                      "",
                      dealii::Patterns::List(dealii::Patterns::Integer(0)),
                      "On a surface: acts on faces with these physical ids in the mesh "
                      "only; empty: on all.");
    prm.declare_entry("Region",
                      "1",
                      dealii::Patterns::Anything(),
                      "Acts on the nodes (on a surface: the faces at whose centre) where "
                      "this expression of the reference coordinates x, y, z [cm] is not "
                      "0, for example 'x < 4'.");
    prm.declare_entry("Material ids",
                      "",
                      dealii::Patterns::List(dealii::Patterns::Integer(0)),
                      "Acts on nodes (on a surface: faces) of elements with these ids "
                      "only; empty: all.");
  }


  template <int dim>
  void Tether<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                     const std::string &what)
  {
    const std::string acts_on = prm.get("Acts on");

    kind         = acts_on == "volume"    ? Kind::volume
                   : acts_on == "surface" ? Kind::surface
                                          : Kind::points;
    stiffness    = prm.get_double("Stiffness");
    damping      = prm.get_double("Damping");
    region       = base::Expression<dim>(prm.get("Region"), what + ", Region");
    material_ids = base::parse_integers(prm.get("Material ids"), what + ", Material ids");
    surface.parse_parameters(prm, what);
    AssertThrow(kind == Kind::surface || prm.get("Boundary ids").empty(),
                base::UserError(what + ": \"Boundary ids\" is '" +
                                prm.get("Boundary ids") + "', but the tether acts on " +
                                acts_on + "; expected 'Acts on = surface'."));

    held = dealii::Tensor<1, dim>();
    for (const std::string &component : base::parse_names(prm.get("Components")))
      held[component[0] - 'x'] = 1;

    displacement.parse_parameters(prm, "Displacement", what);
    const std::string file               = prm.get("Displacement table");
    const std::vector<std::string> names = base::parse_names(prm.get("Displacement "
                                                                     "columns"));
    table                                = nullptr;
    columns.clear();
    AssertThrow(names.size() == (file.empty() ? 0 : dim),
                base::UserError(what + ": \"Displacement table\" is '" + file +
                                "' and \"Displacement columns\" is '" +
                                prm.get("Displacement columns") + "'; expected " +
                                std::to_string(dim) +
                                " columns of a table, or neither."));
    if (file.empty())
      return;
    AssertThrow(displacement.is_zero(),
                base::UserError(what + ": there is a \"Displacement table\" as well as "
                                       "a displacement by expressions; expected one of "
                                       "them."));
    table = std::make_shared<const base::TimeTable>(
      file, parse_extension(prm.get("Displacement extension")));
    for (const std::string &name : names)
      columns.push_back(table->column(name, "length"));
  }


  template <int dim>
  void Tether<dim>::initialize(const Mesh<dim> &mesh)
  {
    if (kind == Kind::surface)
      surface.initialize(mesh);
  }


  template <int dim>
  void Tether<dim>::reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements)
  {
    nodes.clear();
    reference_positions.clear();
    if (kind == Kind::surface)
      {
        surface.reinit(mesh, elements);
        nodes = surface.find_owned_nodes(elements);
        for (const unsigned int i : nodes)
          reference_positions.push_back(mesh.nodes[elements.file_node(i)]);
        return;
      }

    std::vector<bool> candidate(elements.n_owned_nodes(), material_ids.empty());
    for (unsigned int i = 0; i < elements.n_elements(); ++i)
      if (std::find(material_ids.begin(),
                    material_ids.end(),
                    static_cast<int>(mesh.material_ids[elements.element(i)])) !=
          material_ids.end())
        for (unsigned int a = 0; a < mesh.nodes_per_element; ++a)
          if (elements.nodes(i)[a] < elements.n_owned_nodes())
            candidate[elements.nodes(i)[a]] = true;

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
  dealii::Point<dim> Tether<dim>::target(const dealii::Point<dim> &s,
                                         const double t) const
  {
    if (table)
      {
        dealii::Point<dim> x = s;
        for (unsigned int c = 0; c < dim; ++c)
          x[c] += table->value(columns[c], t);
        return x;
      }
    return displacement.is_zero() ? s : s + displacement.value(s, t);
  }


  template <int dim>
  dealii::Tensor<1, dim> Tether<dim>::target_velocity(const dealii::Point<dim> &s,
                                                      const double t) const
  {
    if (!table && displacement.is_zero())
      return dealii::Tensor<1, dim>();
    constexpr double step = 1e-6;
    return (target(s, t + step) - target(s, t - step)) / (2 * step);
  }


  template <int dim>
  dealii::Tensor<1, dim> Tether<dim>::force(const dealii::Point<dim> &s,
                                            const dealii::Tensor<1, dim> &x,
                                            const dealii::Tensor<1, dim> &u,
                                            const double t) const
  {
    dealii::Tensor<1, dim> f = -stiffness * (x - target(s, t));
    if (damping > 0)
      f -= damping * (u - target_velocity(s, t));
    for (unsigned int c = 0; c < dim; ++c)
      f[c] *= held[c];
    return f;
  }


  template <int dim>
  void Tether<dim>::add_force_density(const VectorType &X,
                                      const VectorType &U,
                                      const double t,
                                      VectorType &F) const
  {
    if (kind != Kind::volume)
      return;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        dealii::Tensor<1, dim> x, u;
        for (unsigned int c = 0; c < dim; ++c)
          {
            x[c] = X.local_element(nodes[i] * dim + c);
            u[c] = U.local_element(nodes[i] * dim + c);
          }
        const dealii::Tensor<1, dim> f = force(reference_positions[i], x, u, t);
        for (unsigned int c = 0; c < dim; ++c)
          F.local_element(nodes[i] * dim + c) += f[c];
      }
  }


  template <int dim>
  void Tether<dim>::add_forces(const NodalState &state, double *forces) const
  {
    if (kind == Kind::surface)
      surface.add_forces(
        state,
        [&](const SurfacePoint<dim> &point) {
          return point.reference_area.norm() * force(point.s, point.x, point.u, state.t);
        },
        forces);
    else if (kind == Kind::points)
      for (unsigned int i = 0; i < nodes.size(); ++i)
        {
          dealii::Tensor<1, dim> x, u;
          for (unsigned int c = 0; c < dim; ++c)
            {
              x[c] = state.X[nodes[i] * dim + c];
              u[c] = state.U[nodes[i] * dim + c];
            }
          const dealii::Tensor<1, dim> f = force(reference_positions[i], x, u, state.t);
          for (unsigned int c = 0; c < dim; ++c)
            forces[nodes[i] * dim + c] += f[c];
        }
  }


  template <int dim>
  void Tether<dim>::set_targets(const double t, VectorType &X) const
  {
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        const dealii::Point<dim> x = target(reference_positions[i], t);
        for (unsigned int c = 0; c < dim; ++c)
          if (held[c] != 0)
            X.local_element(nodes[i] * dim + c) = x[c];
      }
  }


  template <int dim>
  double Tether<dim>::largest_displacement(const VectorType &X, const double t) const
  {
    double largest_square = 0;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        const dealii::Point<dim> x = target(reference_positions[i], t);
        double square              = 0;
        for (unsigned int c = 0; c < dim; ++c)
          {
            const double difference = X.local_element(nodes[i] * dim + c) - x[c];
            square += held[c] * difference * difference;
          }
        largest_square = std::max(largest_square, square);
      }
    return std::sqrt(largest_square);
  }


  template class Tether<2>;
  template class Tether<3>;
} // namespace mitre::structure
