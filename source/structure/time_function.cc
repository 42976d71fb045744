#include <utility>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/structure/time_function.h>

namespace mitre::structure
{
  namespace
  {
    /// "Time factor" within a sentence.
    std::string lower_case_start(std::string name)
    {
      if (!name.empty() && name[0] >= 'A' && name[0] <= 'Z')
        name[0] = name[0] - 'A' + 'a';
      return name;
    }
  } // namespace


  TimeFunction::TimeFunction(base::TimeExpression expression)
    : expression(std::move(expression))
  {
  }


  void TimeFunction::declare_parameters(dealii::ParameterHandler &prm,
                                        const std::string &name,
                                        const std::string &default_value,
                                        const std::string &help,
                                        const std::string &column_help)
  {
    prm.declare_entry(name, default_value, dealii::Patterns::Anything(), help);
    prm.declare_entry(name + " table",
                      "",
                      base::InputFile(),
                      "Table (CSV) of the " + lower_case_start(name) +
                        " over time, in the place of the expression.");
    prm.declare_entry(name + " column",
                      "",
                      dealii::Patterns::Anything(),
                      "Name of the table's column, " + column_help + ".");
    prm.declare_entry(name + " extension",
                      "clamped",
                      dealii::Patterns::Selection("clamped|periodic"),
                      "What holds outside of the table's times: its first and last "
                      "value, or the table over and over.");
  }


  void TimeFunction::parse_parameters(dealii::ParameterHandler &prm,
                                      const std::string &name,
                                      const std::string &default_value,
                                      const std::string &what,
                                      const std::string &quantity)
  {
    const std::string text        = prm.get(name);
    const std::string file        = prm.get(name + " table");
    const std::string column_name = prm.get(name + " column");

    expression = base::TimeExpression(text, what + ", " + name);
    table      = nullptr;
    AssertThrow(file.empty() == column_name.empty(),
                base::UserError(what + ": \"" + name + " table\" is '" + file +
                                "' and \"" + name + " column\" is '" + column_name +
                                "'; expected both or neither."));
    if (file.empty())
      return;
    AssertThrow(text == default_value,
                base::UserError(what + ": there is a \"" + name +
                                " table\" as well as the \"" + name + "\" '" + text +
                                "'; expected one of them."));
    const auto new_table = std::make_shared<const base::TimeTable>(
      file, parse_extension(prm.get(name + " extension")));
    column = new_table->column(column_name, quantity);
    table  = new_table;
  }


  double TimeFunction::value(const double t) const
  {
    return table ? table->value(column, t) : expression.value(t);
  }


  base::TimeTable::Extension parse_extension(const std::string &text)
  {
    return text == "periodic" ? base::TimeTable::Extension::periodic
                              : base::TimeTable::Extension::clamped;
  }
} // namespace mitre::structure
