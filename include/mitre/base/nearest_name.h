#ifndef mitre_base_nearest_name_h
#define mitre_base_nearest_name_h

#include <string>
#include <vector>

namespace mitre::base
{
  /**
   * The number of letters to insert, delete, replace or swap with their neighbour that
   * turns one string into the other (Damerau-Levenshtein distance with non-overlapping
   * swaps), upper and lower case taken as equal.
   */
  unsigned int edit_distance(const std::string &a, const std::string &b);

  /**
   * The member of @p known that is nearest to @p name by edit_distance(), or an empty
   * string when none is near enough to be a slip of the pen: more than a third of the
   * letters of the longer of the two would have to change.
   */
  std::string nearest_name(const std::string &name,
                           const std::vector<std::string> &known);

  /**
   * The end of an error message about an unknown name: "Did you mean 'IB_4'? Known: IB_3,
   * IB_4.", the question only if there is a near name.
   */
  std::string suggest_name(const std::string &name,
                           const std::vector<std::string> &known);
} // namespace mitre::base

#endif
