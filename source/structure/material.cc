#include <utility>

#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/base/parameters.h>
#include <mitre/structure/library.h>
#include <mitre/structure/material.h>

namespace mitre::structure
{
  StiffnessFactor::StiffnessFactor()
    : expression("1", "Time factor")
  {
  }


  StiffnessFactor::StiffnessFactor(base::TimeExpression expression)
    : expression(std::move(expression))
  {
  }


  void StiffnessFactor::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Time factor",
                      "1",
                      dealii::Patterns::Anything(),
                      "Expression of the time t [s] that multiplies the stress.");
    prm.declare_entry("Time factor table",
                      "",
                      base::InputFile(),
                      "Table (CSV) of the factor over time, in the place of the "
                      "expression.");
    prm.declare_entry("Time factor column",
                      "",
                      dealii::Patterns::Anything(),
                      "Name of the table's column, with the unit [1].");
    prm.declare_entry(
      "Time factor extension",
      "clamped",
      dealii::Patterns::Selection("clamped|periodic"),
      "The factor outside of the table's times: its first and last value, "
      "or the table over and over.");
  }


  void StiffnessFactor::parse_parameters(dealii::ParameterHandler &prm,
                                         const std::string &what)
  {
    const std::string text   = prm.get("Time factor");
    const std::string file   = prm.get("Time factor table");
    const std::string column = prm.get("Time factor column");

    expression = base::TimeExpression(text, what + ", Time factor");
    table      = nullptr;
    AssertThrow(file.empty() == column.empty(),
                base::UserError(what + ": \"Time factor table\" is '" + file +
                                "' and \"Time factor column\" is '" + column +
                                "'; expected both or neither."));
    if (file.empty())
      return;
    AssertThrow(text == "1",
                base::UserError(what +
                                ": there is a \"Time factor table\" as well as the "
                                "\"Time factor\" '" +
                                text + "'; expected one of them."));
    const auto new_table = std::make_shared<const base::TimeTable>(
      file,
      prm.get("Time factor extension") == "periodic"
        ? base::TimeTable::Extension::periodic
        : base::TimeTable::Extension::clamped);
    this->column = new_table->column(column);
    table        = new_table;
  }


  double StiffnessFactor::value(const double t) const
  {
    return table ? table->value(column, t) : expression.value(t);
  }


  template <int dim>
  void Material<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    StiffnessFactor::declare_parameters(prm);
    const std::string law =
      base::declare_choice(prm,
                           "Law",
                           constitutive_laws<dim>().names().front(),
                           constitutive_laws<dim>().names(),
                           "Constitutive law; its constants are in the subsection of "
                           "that name.\n" +
                             constitutive_laws<dim>().help());
    prm.enter_subsection(law);
    constitutive_laws<dim>().declare_parameters(law, prm);
    prm.leave_subsection();
  }


  template <int dim>
  void Material<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                       const std::string &what)
  {
    time_factor.parse_parameters(prm, what);

    const std::string law_name = prm.get("Law");
    AssertThrow(
      constitutive_laws<dim>().contains(law_name),
      base::UserError(what + ": there is no constitutive law '" + law_name + "'. " +
                      base::suggest_name(law_name, constitutive_laws<dim>().names())));
    law = constitutive_laws<dim>().create(law_name);
    prm.enter_subsection(law_name);
    law->parse_parameters(prm);
    prm.leave_subsection();
  }


  template struct Material<2>;
  template struct Material<3>;
} // namespace mitre::structure
