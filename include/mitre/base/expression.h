#ifndef mitre_base_expression_h
#define mitre_base_expression_h

#include <deal.II/base/point.h>

#include <memory>
#include <string>

namespace dealii
{
  template <int dim>
  class FunctionParser;
}

namespace mitre::base
{
  /**
   * A function of place and time that a parameter file gives as text, evaluated by
   * muParser: variables x, y (and z in three dimensions) in cm and t in s, constants
   * pi and mmHg (= 1333.22 dyn/cm^2), muParser's functions and operators (comparison and
   * the logical ones give 1 or 0), and deal.II's additions, such as if(a, b, c).
   *
   * Copies share the parser. Not for use by two threads at a time.
   */
  template <int dim>
  class Expression
  {
  public:
    /** The constant 0. */
    Expression();

    /**
     * @param expression the text
     * @param what the parameter it comes from, for messages: "Part tube, Region"
     *
     * Throws UserError, which names @p what, the expression, what is wrong with it and
     * the variables there are, if muParser cannot read it.
     */
    Expression(const std::string &expression, const std::string &what);

    /** The value at @p x and time @p t; UserError if it is not a finite number. */
    double value(const dealii::Point<dim> &x, const double t = 0.) const;

    /** Whether a condition such as "x < 4 && y > 1" holds, that is, value() is not 0. */
    bool holds(const dealii::Point<dim> &x, const double t = 0.) const;

    const std::string &text() const;

  private:
    std::string text_;
    std::string what_;
    std::shared_ptr<dealii::FunctionParser<dim>> parser_;
  };


  /**
   * The same for a function of time alone: its only variable is t in s, so that an x in
   * it is an error.
   */
  class TimeExpression
  {
  public:
    /** The constant 0. */
    TimeExpression();

    TimeExpression(const std::string &expression, const std::string &what);

    double value(const double t) const;

    const std::string &text() const;

  private:
    std::string text_;
    std::string what_;
    std::shared_ptr<dealii::FunctionParser<1>> parser_;
  };
} // namespace mitre::base

#endif
