#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/fluid/boundary_conditions/pressure.h>

namespace mitre::fluid
{
  using namespace dealii;

  template <int dim>
  void GivenPressure<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.declare_entry(
      "Pressure",
      "0",
      Patterns::Anything(),
      "Pressure [dyn/cm^2], an expression of x, y, z [cm] and t [s]; the "
      "constant mmHg converts: 10*mmHg. Added to the table's, if there is "
      "one.");
    prm.declare_entry("Table file",
                      "",
                      base::InputFile(),
                      "A table of pressures over time: comma-separated, first line with "
                      "names and units, as in \"time [s],atrium [mmHg]\".");
    prm.declare_entry("Table column",
                      "",
                      Patterns::Anything(),
                      "Name of the table's column (without its unit).");
    prm.declare_entry(
      "Table extension",
      "periodic",
      Patterns::Selection("periodic|clamped"),
      "What holds after the end of the table: it repeats, or its last value "
      "stays.");
  }


  template <int dim>
  void GivenPressure<dim>::parse_parameters(ParameterHandler &prm,
                                            const std::string &section,
                                            const std::string &owner)
  {
    expression = base::Expression<dim>(prm.get("Pressure"), section + " / Pressure");
    table.reset();
    const std::string file = prm.get("Table file");
    if (!file.empty())
      {
        table = std::make_shared<base::TimeTable>(
          file,
          prm.get("Table extension") == "periodic" ? base::TimeTable::Extension::periodic
                                                   : base::TimeTable::Extension::clamped);
        if (prm.get("Table column").empty())
          throw base::UserError(owner +
                                " names a \"Table file\", but no \"Table column\".");
        column = table->column(prm.get("Table column"), "pressure");
      }
  }


  template <int dim>
  double GivenPressure<dim>::value(const Point<dim> &x, const double t) const
  {
    return expression.value(x, t) + (table ? table->value(column, t) : 0.);
  }


  template <int dim>
  void PressureCondition<dim>::declare_parameters(ParameterHandler &prm)
  {
    GivenPressure<dim>::declare_parameters(prm);
    prm.declare_entry(
      "Backflow stabilisation",
      "0",
      Patterns::Double(0., 2.),
      "beta: where the fluid flows in, the pressure is lower than given by beta "
      "rho/2 times the square of the normal velocity. With 1 the given pressure is that "
      "of a reservoir at rest, and jets into the domain cannot feed themselves; with 0 "
      "it is the pressure in the boundary itself.");
    FeedbackParameters::declare_parameters(prm);
    prm.declare_entry(
      "Backflow damping",
      "0",
      Patterns::Double(0., 1.),
      "k dt / rho of a body force -k u_n on the normal velocity where the fluid moves "
      "into the domain, over \"Feedback width\" as the feedback force; 0.5 is usual. Not "
      "for boundaries that fluid is meant to come in through.");
  }


  template <int dim>
  void PressureCondition<dim>::parse_parameters(ParameterHandler &prm,
                                                const std::string &name)
  {
    given.parse_parameters(
      prm, "Boundary conditions / " + name, "Boundary condition \"" + name + "\"");
    beta = prm.get_double("Backflow stabilisation");
    feedback_parameters.parse_parameters(prm);
    feedback_parameters.backflow_damping = prm.get_double("Backflow damping");
  }


  template <int dim>
  double PressureCondition<dim>::pressure(const Point<dim> &x, const double t) const
  {
    return given.value(x, t) + *shift;
  }


  template class GivenPressure<2>;
  template class GivenPressure<3>;
  template class PressureCondition<2>;
  template class PressureCondition<3>;
} // namespace mitre::fluid
