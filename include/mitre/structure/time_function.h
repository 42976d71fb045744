#ifndef mitre_structure_time_function_h
#define mitre_structure_time_function_h

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>

#include <mitre/base/expression.h>
#include <mitre/base/time_table.h>

namespace mitre::structure
{
  /**
   * A number that changes over time: an expression of t [s] or a column of a time table,
   * whose unit the table names. In parameter files these are the entries NAME, NAME
   * table, NAME column and NAME extension.
   */
  class TimeFunction
  {
  public:
    TimeFunction() = default;

    TimeFunction(base::TimeExpression expression);

    /**
     * @param name of the first entry, from which the others have theirs
     * @param default_value of the expression
     * @param help for the expression
     * @param column_help completes the sentence about the column: "with the unit [1]"
     */
    static void declare_parameters(dealii::ParameterHandler &prm,
                                   const std::string &name,
                                   const std::string &default_value,
                                   const std::string &help,
                                   const std::string &column_help);

    /// @param what it belongs to, for messages. Throws base::UserError, which names it,
    /// if there is a table as well as an expression other than @p default_value.
    /// @param quantity that the table's column must have the unit of; empty: any
    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name,
                          const std::string &default_value,
                          const std::string &what,
                          const std::string &quantity);

    double value(const double t) const;

  private:
    base::TimeExpression expression;

    /// Takes the place of the expression if there is one.
    std::shared_ptr<const base::TimeTable> table;

    unsigned int column = 0;
  };


  /// The pattern of the entries "... extension" and what their values mean.
  base::TimeTable::Extension parse_extension(const std::string &text);
} // namespace mitre::structure

#endif
