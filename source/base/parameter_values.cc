// What Boost's own header asks for, lest it warn about its use of <boost/bind.hpp>.
#define BOOST_BIND_GLOBAL_PLACEHOLDERS
#include <array>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <zlib.h>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameter_values.h>

namespace mitre::base
{
  namespace
  {
    using Tree                 = boost::property_tree::ptree;
    const std::string contents = ", contents ";


    std::string sum_of_contents(const std::string &file_name)
    {
      std::ifstream file(file_name, std::ios::binary);
      std::stringstream text;
      text << file.rdbuf();
      if (!file)
        throw UserError("Cannot read the file '" + file_name + "'.");
      const std::string bytes = text.str();
      std::array<char, 16> sum;
      std::snprintf(
        sum.data(),
        sum.size(),
        "%08lx",
        crc32(0, reinterpret_cast<const Bytef *>(bytes.data()), bytes.size()));
      return sum.data();
    }


    void list(const Tree &tree,
              const std::string &prefix,
              const std::string &what,
              std::map<std::string, std::string> &values)
    {
      for (const auto &[name, child] : tree)
        {
          const auto pattern = child.get_optional<std::string>("pattern_description");
          if (!pattern)
            list(child, prefix + name + " / ", what, values);
          else
            {
              std::string value = child.get<std::string>(what);
              if (*pattern == "[InputFile]" && !value.empty())
                value = describe_contents(value);
              for (char &c : value)
                if (c == '\n')
                  c = ' ';
              values[prefix + name] = value;
            }
        }
    }


    std::map<std::string, std::string> list(const dealii::ParameterHandler &prm,
                                            const std::string &what)
    {
      std::ostringstream json;
      prm.print_parameters(json, dealii::ParameterHandler::JSON);
      std::istringstream input(json.str());
      Tree tree;
      boost::property_tree::read_json(input, tree);
      std::map<std::string, std::string> values;
      list(tree, "", what, values);
      return values;
    }


    /// Whether two values mean the same.
    bool agree(const std::string &a, const std::string &b)
    {
      if (a == b)
        return true;
      const std::size_t file_a = a.rfind(contents), file_b = b.rfind(contents);
      if (file_a != std::string::npos && file_b != std::string::npos)
        return a.substr(file_a) == b.substr(file_b);
      char *end_a = nullptr, *end_b = nullptr;
      const double x = std::strtod(a.c_str(), &end_a);
      const double y = std::strtod(b.c_str(), &end_b);
      return !a.empty() && !b.empty() && *end_a == '\0' && *end_b == '\0' && x == y;
    }


    bool is_free(const std::string &name, const std::set<std::string> &free)
    {
      if (free.count(name) > 0)
        return true;
      for (std::size_t at = name.find(" / "); at != std::string::npos;
           at             = name.find(" / ", at + 1))
        if (free.count(name.substr(0, at + 3)) > 0 || free.count(name.substr(at)) > 0)
          return true;
      return false;
    }
  } // namespace


  std::string describe_contents(const std::string &file_name)
  {
    return file_name + contents + sum_of_contents(file_name);
  }


  std::map<std::string, std::string>
  list_parameter_values(const dealii::ParameterHandler &prm)
  {
    return list(prm, "value");
  }


  std::map<std::string, std::string>
  list_parameter_defaults(const dealii::ParameterHandler &prm)
  {
    return list(prm, "default_value");
  }


  std::string
  describe_changed_parameters(const std::map<std::string, std::string> &before,
                              const std::map<std::string, std::string> &now,
                              const std::set<std::string> &free,
                              const std::map<std::string, std::string> &defaults)
  {
    const auto quote = [](const std::map<std::string, std::string> &values,
                          const std::string &name) {
      const auto found = values.find(name);
      return found == values.end() ? "no parameter" : "\"" + found->second + "\"";
    };
    std::map<std::string, std::string> all = before;
    all.insert(now.begin(), now.end());
    std::string text;
    for (const auto &[name, value] : all)
      {
        const auto a = before.find(name), b = now.find(name), c = defaults.find(name);
        if (a == before.end() && b != now.end() && c != defaults.end() &&
            agree(b->second, c->second))
          continue;
        if (!is_free(name, free) &&
            (a == before.end() || b == now.end() || !agree(a->second, b->second)))
          text += (text.empty() ? "" : "\n") + name + ": was " + quote(before, name) +
                  ", is now " + quote(now, name);
      }
    return text;
  }
} // namespace mitre::base
