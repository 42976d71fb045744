#ifndef mitre_base_parameters_h
#define mitre_base_parameters_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>
#include <deal.II/base/point.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace mitre::base
{
  /**
   * Pattern of a parameter that names a file to be read. parse_parameter_file() replaces
   * the value by the path at which find_file() finds it, and stops with an error if it
   * does not; an empty value stays empty.
   */
  class InputFile : public dealii::Patterns::PatternBase
  {
  public:
    bool match(const std::string &) const override;

    std::string description(const OutputStyle style = Machine) const override;

    std::unique_ptr<dealii::Patterns::PatternBase> clone() const override;
  };


  /**
   * The path of a file that a parameter file names: @p name itself if it is absolute or
   * exists seen from the current folder, else seen from the folder of @p parameter_file,
   * else from the parent of that. Throws UserError, which lists the paths tried, if there
   * is no such file.
   */
  std::string find_file(const std::string &name, const std::string &parameter_file);


  /**
   * Fill @p prm from the parameter file @p file_name, written in deal.II's
   * <code>.prm</code> syntax (set, subsection, end, include, #, continuation by \).
   *
   * What a file may contain depends on what it says: a list of parts is followed by one
   * subsection for each, with one for each of its materials, in which the parameters are
   * those of its law. So @p declare, which declares all parameters, uses declare_names()
   * and declare_choice() for such entries: these return what the file says, and @p
   * declare enters the subsections that follow from it and declares what belongs there.
   *
   * Throws UserError with the file and the line for text that is not understood, for a
   * parameter or subsection that has not been declared (with the nearest known name), for
   * a value that does not match its pattern, and for an input file that is not there.
   */
  void
  parse_parameter_file(dealii::ParameterHandler &prm,
                       const std::string &file_name,
                       const std::function<void(dealii::ParameterHandler &)> &declare);

  /**
   * The same for a text that is in memory; @p name stands for the file in messages and in
   * the search for input files.
   */
  void
  parse_parameter_text(dealii::ParameterHandler &prm,
                       const std::string &text,
                       const std::string &name,
                       const std::function<void(dealii::ParameterHandler &)> &declare);


  /**
   * The text of a parameter file in which each included file stands in the place of its
   * <code>include</code>, between comments that name it: what a run has been told, in one
   * file. Throws UserError if a file is not there.
   */
  std::string expand_includes(const std::string &file_name);


  /**
   * Declare an entry whose value decides what else there is to declare, in the subsection
   * of @p prm that has been entered. Returns the value that the parameter file gives it;
   * @p default_value if it gives none, if the value does not match @p pattern (which
   * parse_parameter_file() then reports) or if no parameter file is being parsed.
   */
  std::string declare_and_read(dealii::ParameterHandler &prm,
                               const std::string &entry,
                               const std::string &default_value,
                               const dealii::Patterns::PatternBase &pattern,
                               const std::string &help);

  /** declare_and_read() for a comma-separated list of names, each of which may occur
   * once. */
  std::vector<std::string> declare_names(dealii::ParameterHandler &prm,
                                         const std::string &entry,
                                         const std::string &default_value,
                                         const std::string &help);

  /** declare_and_read() for one of the given names, for example those of a registry. */
  std::string declare_choice(dealii::ParameterHandler &prm,
                             const std::string &entry,
                             const std::string &default_value,
                             const std::vector<std::string> &names,
                             const std::string &help);


  /** The members of a comma-separated list, without the blanks around them. */
  std::vector<std::string> parse_names(const std::string &text);

  /**
   * A number; UserError, which names @p what (the parameter or the file and line), if
   * @p text is anything but one finite number.
   */
  double parse_number(const std::string &text, const std::string &what);

  /** The numbers of a comma-separated list. */
  std::vector<double> parse_numbers(const std::string &text, const std::string &what);

  /** The integers of a comma-separated list. */
  std::vector<int> parse_integers(const std::string &text, const std::string &what);

  /** A point from "1, 2, 3"; UserError unless there are exactly dim numbers. */
  template <int dim>
  dealii::Point<dim> parse_point(const std::string &text, const std::string &what);

  /** The points of a list such as "0, 0, 0; 1, 2, 3". */
  template <int dim>
  std::vector<dealii::Point<dim>> parse_points(const std::string &text,
                                               const std::string &what);
} // namespace mitre::base

#endif
