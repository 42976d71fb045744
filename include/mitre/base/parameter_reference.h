#ifndef mitre_base_parameter_reference_h
#define mitre_base_parameter_reference_h

#include <deal.II/base/parameter_handler.h>

#include <ostream>
#include <string>

namespace mitre::base
{
  /**
   * Write the parameters that are declared in @p prm as Markdown: a heading for each
   * subsection (of @p heading_level for those at the top, deeper ones one level more, at
   * most six), in it a table of name, default, allowed values and meaning.
   */
  void write_parameter_reference(std::ostream &out,
                                 const dealii::ParameterHandler &prm,
                                 const unsigned int heading_level);
} // namespace mitre::base

#endif
