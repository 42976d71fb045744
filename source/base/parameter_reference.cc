#include <algorithm>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <cctype>
#include <regex>
#include <sstream>

#include <mitre/base/parameter_reference.h>

namespace mitre::base
{
  namespace
  {
    using Tree = boost::property_tree::ptree;

    bool is_entry(const Tree &tree)
    {
      return tree.get_optional<std::string>("pattern_description").has_value();
    }


    /// A text as it may stand in the cell of a table.
    std::string cell(const std::string &text)
    {
      std::string result;
      for (const char c : text)
        if (c == '\n')
          result += "<br>";
        else
          {
            if (std::string("|<>*_").find(c) != std::string::npos)
              result += '\\';
            result += c;
          }
      return result;
    }


    std::string code(const std::string &text)
    {
      return text.empty() ? "" : "`" + text + "`";
    }


    /// What ParameterHandler calls a pattern, in words: "[Double 0...MAX_DOUBLE
    /// (inclusive)]" as "number, at least 0".
    std::string allowed(const std::string &description)
    {
      const auto range = [](const std::string &kind, const std::smatch &match) {
        const std::string lower = match[1], upper = match[2];
        const bool from = lower != "-MAX_DOUBLE" && lower != "-2147483648";
        const bool to   = upper != "MAX_DOUBLE" && upper != "2147483647";
        return kind + (from && to ? ", " + lower + " to " + upper
                       : from     ? ", at least " + lower
                       : to       ? ", at most " + upper
                                  : "");
      };
      static const std::regex number("\\[Double (.*)\\.\\.\\.(.*) \\(inclusive\\)\\]");
      static const std::regex integer(
        "\\[Integer range (.*)\\.\\.\\.(.*) \\(inclusive\\)\\]");
      static const std::regex selection("\\[Selection (.*) \\]");
      static const std::regex list(
        "\\[List of <(.*)> of length (\\d+)\\.\\.\\.(\\d+) \\(inclusive\\).*\\]");
      std::smatch match;
      if (description == "[Anything]")
        return "";
      if (description == "[InputFile]")
        return "file";
      if (description == "[Bool]")
        return "true or false";
      if (description == "[Double]")
        return "number";
      if (description == "[Integer]")
        return "integer";
      if (std::regex_match(description, match, number))
        return range("number", match);
      if (std::regex_match(description, match, integer))
        return range("integer", match);
      if (std::regex_match(description, match, selection))
        return std::regex_replace(match[1].str(), std::regex("\\|"), ", ");
      if (std::regex_match(description, match, list))
        return "list" + (match[2] == match[3] ? " of " + match[2].str() : std::string()) +
               ": " + allowed(match[1]);
      return description;
    }


    void write(std::ostream &out,
               const Tree &tree,
               const std::string &name,
               const unsigned int level)
    {
      const bool has_entries =
        std::any_of(tree.begin(), tree.end(), [](const auto &child) {
          return is_entry(child.second);
        });
      if (!name.empty())
        out << std::string(std::min(level, 6u), '#') << ' ' << name << "\n\n";
      if (has_entries)
        {
          out << "| parameter | default | allowed | meaning |\n|---|---|---|---|\n";
          for (const auto &[key, child] : tree)
            if (is_entry(child))
              out << "| " << key << " | " << code(child.get<std::string>("default_value"))
                  << " | " << cell(allowed(child.get<std::string>("pattern_description")))
                  << " | " << cell(child.get<std::string>("documentation")) << " |\n";
          out << '\n';
        }
      for (const auto &[key, child] : tree)
        if (!is_entry(child))
          write(out, child, key, name.empty() ? level : level + 1);
    }
  } // namespace


  void write_parameter_reference(std::ostream &out,
                                 const dealii::ParameterHandler &prm,
                                 const unsigned int heading_level)
  {
    std::ostringstream json;
    prm.print_parameters(json, dealii::ParameterHandler::JSON);
    std::istringstream input(json.str());
    Tree tree;
    boost::property_tree::read_json(input, tree);
    write(out, tree, "", heading_level);
  }
} // namespace mitre::base
