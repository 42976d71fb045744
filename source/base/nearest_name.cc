#include <algorithm>
#include <cctype>

#include <mitre/base/nearest_name.h>

namespace mitre::base
{
  unsigned int edit_distance(const std::string &a, const std::string &b)
  {
    const auto same = [](const char x, const char y) {
      return std::tolower(static_cast<unsigned char>(x)) ==
             std::tolower(static_cast<unsigned char>(y));
    };

    // distance[i][j] is the distance between the first i letters of a and j of b.
    std::vector<std::vector<unsigned int>> distance(
      a.size() + 1, std::vector<unsigned int>(b.size() + 1));
    for (unsigned int i = 0; i <= a.size(); ++i)
      distance[i][0] = i;
    for (unsigned int j = 0; j <= b.size(); ++j)
      distance[0][j] = j;
    for (unsigned int i = 1; i <= a.size(); ++i)
      for (unsigned int j = 1; j <= b.size(); ++j)
        {
          unsigned int &d = distance[i][j];
          d               = std::min({distance[i - 1][j] + 1,
                                      distance[i][j - 1] + 1,
                                      distance[i - 1][j - 1] + !same(a[i - 1], b[j - 1])});
          if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
            d = std::min(d, distance[i - 2][j - 2] + 1);
        }
    return distance[a.size()][b.size()];
  }


  std::string nearest_name(const std::string &name, const std::vector<std::string> &known)
  {
    std::string nearest;
    unsigned int smallest = 0;
    for (const std::string &candidate : known)
      {
        const unsigned int distance = edit_distance(name, candidate);
        if (3 * distance <= std::max(name.size(), candidate.size()) &&
            (nearest.empty() || distance < smallest))
          {
            nearest  = candidate;
            smallest = distance;
          }
      }
    return nearest;
  }


  std::string suggest_name(const std::string &name, const std::vector<std::string> &known)
  {
    std::string text;
    const std::string nearest = nearest_name(name, known);
    if (!nearest.empty())
      text += "Did you mean '" + nearest + "'? ";
    text += "Known: ";
    for (unsigned int i = 0; i < known.size(); ++i)
      text += (i == 0 ? "" : ", ") + known[i];
    if (known.empty())
      text += "none";
    return text + ".";
  }
} // namespace mitre::base
