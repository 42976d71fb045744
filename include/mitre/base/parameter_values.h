#ifndef mitre_base_parameter_values_h
#define mitre_base_parameter_values_h

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <set>
#include <string>

namespace mitre::base
{
  /**
   * The values of all parameters by their path, "Time / End time". A parameter that names
   * an input file has the CRC-32 of what is in the file as its value, after its name, for
   * a run depends on the one and not on the other: "valve.msh, contents 3f2a9c01".
   */
  std::map<std::string, std::string>
  list_parameter_values(const dealii::ParameterHandler &prm);

  /// "valve.msh, contents 3f2a9c01": a file's name and the CRC-32 of what is in it.
  std::string describe_contents(const std::string &file_name);

  /** The defaults of all parameters by their path. */
  std::map<std::string, std::string>
  list_parameter_defaults(const dealii::ParameterHandler &prm);


  /**
   * A line for each parameter that differs, "Time / Time step: was 0.001, is now 0.002";
   * nothing if none does. Numbers are compared as such, input files by their contents.
   *
   * @param free parameters that may differ; a name that ends with " / " stands for all of
   * its section, one that begins with " / " for all that end with it
   * @param defaults of the parameters now: one that has its default now and was not there
   * before does not differ, for the program has learnt it since
   */
  std::string
  describe_changed_parameters(const std::map<std::string, std::string> &before,
                              const std::map<std::string, std::string> &now,
                              const std::set<std::string> &free,
                              const std::map<std::string, std::string> &defaults = {});
} // namespace mitre::base

#endif
