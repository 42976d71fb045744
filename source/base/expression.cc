#include <deal.II/base/exceptions.h>
#include <deal.II/base/function_parser.h>
#include <deal.II/base/numbers.h>

#include <cmath>
#include <iostream>
#include <map>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/base/expression.h>
#include <mitre/base/units.h>

namespace mitre::base
{
  namespace
  {
    // deal.II writes what muParser objects to on std::cerr, on every rank, besides
    // throwing it. This keeps it quiet as long as it exists.
    class QuietErrorStream
    {
    public:
      QuietErrorStream()
        : buffer_(std::cerr.rdbuf(text_.rdbuf()))
      {
      }

      QuietErrorStream(const QuietErrorStream &) = delete;

      ~QuietErrorStream()
      {
        std::cerr.rdbuf(buffer_);
      }

    private:
      std::ostringstream text_;
      std::streambuf *buffer_;
    };


    // muParser's own words in an exception of deal.II's.
    std::string reason(const dealii::ExceptionBase &error)
    {
      std::ostringstream text;
      error.print_info(text);
      std::string message      = text.str();
      const std::string before = "The parser said: ";
      const auto begin         = message.find(before);
      if (begin != std::string::npos)
        message = message.substr(begin + before.size());
      message = message.substr(0, message.find('\n'));
      return message.substr(0, message.find_last_not_of(" .") + 1) + ".";
    }


    template <int dim>
    std::shared_ptr<dealii::FunctionParser<dim>>
    make_parser(const std::string &expression,
                const std::string &what,
                const std::string &variables,
                const bool time_dependent)
    {
      const std::string place =
        what + ": cannot read the expression '" + expression + "': ";
      AssertThrow(expression.find_first_not_of(" \t") != std::string::npos,
                  UserError(place + "it is empty."));
      // deal.II takes a semicolon for the beginning of a second component.
      AssertThrow(expression.find(';') == std::string::npos,
                  UserError(place + "it contains a semicolon."));

      auto parser = std::make_shared<dealii::FunctionParser<dim>>();
      try
        {
          const QuietErrorStream quiet;
          parser->initialize(variables,
                             expression,
                             {{"pi", dealii::numbers::PI}, {"mmHg", mmHg}},
                             time_dependent);
          // Some mistakes are only seen when the expression is evaluated.
          parser->set_time(0.);
          parser->value(dealii::Point<dim>());
        }
      catch (const dealii::ExceptionBase &error)
        {
          throw UserError(place + reason(error) + " The variables are " + variables +
                          ", the constants pi and mmHg.");
        }
      return parser;
    }


    void check_finite(const double value,
                      const std::string &what,
                      const std::string &text,
                      const std::string &place)
    {
      AssertThrow(std::isfinite(value),
                  UserError(what + ": the expression '" + text +
                            "' is not a finite number " + place + "."));
    }


    std::string number_to_string(const double value)
    {
      std::ostringstream text;
      text << value;
      return text.str();
    }
  } // namespace


  template <int dim>
  Expression<dim>::Expression()
    : Expression("0", "zero")
  {
  }


  template <int dim>
  Expression<dim>::Expression(const std::string &expression, const std::string &what)
    : text_(expression)
    , what_(what)
    , parser_(make_parser<dim>(expression, what, dim == 2 ? "x,y,t" : "x,y,z,t", true))
  {
  }


  template <int dim>
  double Expression<dim>::value(const dealii::Point<dim> &x, const double t) const
  {
    parser_->set_time(t);
    const double value = parser_->value(x);
    if (!std::isfinite(value))
      {
        std::string place = "at (";
        for (unsigned int d = 0; d < dim; ++d)
          place += (d == 0 ? "" : ", ") + number_to_string(x[d]);
        check_finite(value, what_, text_, place + "), t = " + number_to_string(t));
      }
    return value;
  }


  template <int dim>
  bool Expression<dim>::holds(const dealii::Point<dim> &x, const double t) const
  {
    return value(x, t) != 0.;
  }


  template <int dim>
  const std::string &Expression<dim>::text() const
  {
    return text_;
  }


  TimeExpression::TimeExpression()
    : TimeExpression("0", "zero")
  {
  }


  TimeExpression::TimeExpression(const std::string &expression, const std::string &what)
    : text_(expression)
    , what_(what)
    , parser_(make_parser<1>(expression, what, "t", false))
  {
  }


  double TimeExpression::value(const double t) const
  {
    const double value = parser_->value(dealii::Point<1>(t));
    if (!std::isfinite(value))
      check_finite(value, what_, text_, "at t = " + number_to_string(t));
    return value;
  }


  const std::string &TimeExpression::text() const
  {
    return text_;
  }


  template class Expression<2>;
  template class Expression<3>;
} // namespace mitre::base
