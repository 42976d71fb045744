#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/base/expression.h>
#include <mitre/base/parameters.h>
#include <mitre/fluid/boundary_conditions/interface.h>

namespace mitre::fluid
{
  using namespace dealii;

  namespace
  {
    const std::array<std::string, 6> side_names = {
      {"x min", "x max", "y min", "y max", "z min", "z max"}};

    std::string section_name(const std::string &name)
    {
      return "Condition " + name;
    }
  } // namespace


  void FeedbackParameters::declare_parameters(ParameterHandler &prm)
  {
    prm.declare_entry(
      "Feedback strength",
      "0",
      Patterns::Double(0., 1.),
      "k dt / rho of a body force k (u_b - u) that draws the fluid next to the boundary "
      "to the velocity u_b that is given on it (thesis, (3.4), where it is 0.5); at open "
      "boundaries the tangential velocity only. 0: no force.");
    prm.declare_entry("Feedback width",
                      "4",
                      Patterns::Double(0.5),
                      "Number of grid cells from the boundary over which the feedback "
                      "force falls to zero, as half a wave of a cosine.");
  }


  void FeedbackParameters::parse_parameters(ParameterHandler &prm)
  {
    strength = prm.get_double("Feedback strength");
    width    = prm.get_double("Feedback width");
  }


  template <int dim>
  void BoundaryConditions<dim>::declare_parameters(ParameterHandler &prm)
  {
    const auto names = base::declare_names(
      prm,
      "Conditions",
      "",
      "Names of the boundary conditions; each has a subsection "
      "\"Condition NAME\". Where several match, the first holds. Faces "
      "of periodic directions need none.");
    for (const std::string &name : names)
      {
        prm.enter_subsection(section_name(name));
        prm.declare_entry(
          "Faces",
          "",
          Patterns::List(Patterns::Selection("x min|x max|y min|y max|z min|z max|all")),
          "The faces of the box that the condition is for.");
        prm.declare_entry(
          "Region",
          "1",
          Patterns::Anything(),
          "An expression of x, y, z [cm]: the condition holds where it is "
          "true (not zero).");
        const std::string type =
          base::declare_choice(prm,
                               "Type",
                               "wall",
                               boundary_condition_registry<dim>().names(),
                               boundary_condition_registry<dim>().help());
        if (boundary_condition_registry<dim>().contains(type))
          boundary_condition_registry<dim>().declare_parameters(type, prm);
        prm.leave_subsection();
      }
  }


  template <int dim>
  void BoundaryConditions<dim>::parse_parameters(ParameterHandler &prm)
  {
    entries.clear();
    for (const std::string &name : base::parse_names(prm.get("Conditions")))
      {
        prm.enter_subsection(section_name(name));
        Entry entry;
        entry.name = name;
        entry.sides.fill(false);
        for (const std::string &face : base::parse_names(prm.get("Faces")))
          {
            bool known = false;
            for (unsigned int side = 0; side < 2 * dim; ++side)
              if (face == "all" || face == side_names[side])
                {
                  entry.sides[side] = true;
                  known             = true;
                }
            if (!known)
              throw base::UserError("Boundary condition \"" + name +
                                    "\" names the face \"" + face +
                                    "\", which a run in " + std::to_string(dim) +
                                    " dimensions does not have.");
          }
        const std::string region = prm.get("Region");
        if (region == "1")
          entry.region = [](const Point<dim> &) { return true; };
        else
          {
            const base::Expression<dim> expression(
              region, "Boundary conditions / " + name + " / Region");
            entry.region = [expression](const Point<dim> &x) {
              return expression.holds(x);
            };
          }
        std::shared_ptr<BoundaryCondition<dim>> condition =
          boundary_condition_registry<dim>().create(prm.get("Type"));
        condition->parse_parameters(prm, name);
        entry.condition = condition;
        entries.push_back(entry);
        prm.leave_subsection();
      }
  }


  template <int dim>
  void
  BoundaryConditions<dim>::add(const std::string &name,
                               const std::vector<unsigned int> &sides,
                               std::shared_ptr<const BoundaryCondition<dim>> condition)
  {
    Entry entry;
    entry.name = name;
    entry.sides.fill(false);
    for (const unsigned int side : sides)
      entry.sides[side] = true;
    entry.region    = [](const Point<dim> &) { return true; };
    entry.condition = condition;
    entries.push_back(entry);
  }


  template <int dim>
  grid::BoundaryInfo BoundaryConditions<dim>::info(const unsigned int side,
                                                   const Point<dim> &x) const
  {
    for (unsigned int i = 0; i < entries.size(); ++i)
      if (entries[i].sides[side] && entries[i].region(x))
        return {entries[i].condition->kind(), i};
    std::ostringstream message;
    message << "No boundary condition is given on face \"" << side_names[side]
            << "\" at (" << x
            << ") cm. Add one to \"Boundary conditions / Conditions\", or make its "
            << "direction periodic.";
    throw base::UserError(message.str());
  }


  template <int dim>
  bool BoundaryConditions<dim>::all_velocities_zero() const
  {
    for (const Entry &entry : entries)
      if (!entry.condition->velocity_is_zero())
        return false;
    return true;
  }


  template class BoundaryConditions<2>;
  template class BoundaryConditions<3>;
} // namespace mitre::fluid
