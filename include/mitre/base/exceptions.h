#ifndef mitre_base_exceptions_h
#define mitre_base_exceptions_h

#include <deal.II/base/exceptions.h>

#include <ostream>
#include <string>
#include <utility>

namespace mitre::base
{
  /**
   * A mistake that a user or a user's file made: a missing mesh, an unknown law, a
   * time step that blows up. The message names the file, parameter, element or place,
   * says what was found there and what was expected; what() returns the message alone,
   * without the stack trace and source line that deal.II's exceptions carry.
   *
   * Usage: <code>AssertThrow(condition, UserError("..."))</code>, or
   * <code>throw UserError("...")</code> where the message is costly to put together.
   * Mistakes of the code itself are <code>Assert</code>ed with deal.II's exceptions.
   */
  class UserError : public dealii::ExceptionBase
  {
  public:
    explicit UserError(std::string message)
      : message_(std::move(message))
    {
    }

    const char *what() const noexcept override
    {
      return message_.c_str();
    }

    void print_info(std::ostream &out) const override
    {
      out << message_ << '\n';
    }

  private:
    std::string message_;
  };
} // namespace mitre::base

#endif
