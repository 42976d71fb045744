#include <deal.II/base/exceptions.h>

#include <algorithm>
// What Boost's own header asks for, lest it warn about its use of <boost/bind.hpp>.
#define BOOST_BIND_GLOBAL_PLACEHOLDERS
#include <boost/locale/utf.hpp>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/base/parameters.h>

namespace mitre::base
{
  namespace
  {
    using boost::property_tree::ptree;
    using dealii::ParameterHandler;

    // What values that come from the file begin with until the parameter is declared.
    const std::string undeclared = "not declared: ";

    std::string trim(const std::string &text)
    {
      const auto begin = text.find_first_not_of(" \t\r\n");
      const auto end   = text.find_last_not_of(" \t\r\n");
      return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
    }


    // Without blanks at the ends, and with single ones between the words.
    std::string normalise_name(const std::string &text)
    {
      std::istringstream words(text);
      std::string name, word;
      while (words >> word)
        name += (name.empty() ? "" : " ") + word;
      return name;
    }


    std::vector<std::string> split(const std::string &text, const char separator)
    {
      std::vector<std::string> pieces;
      std::istringstream stream(text);
      std::string piece;
      while (std::getline(stream, piece, separator))
        pieces.push_back(trim(piece));
      if (!text.empty() && text.back() == separator)
        pieces.emplace_back();
      if (pieces.size() == 1 && pieces[0].empty())
        pieces.clear();
      return pieces;
    }


    std::string join(const std::vector<std::string> &pieces, const std::string &separator)
    {
      std::string text;
      for (unsigned int i = 0; i < pieces.size(); ++i)
        text += (i == 0 ? "" : separator) + pieces[i];
      return text;
    }


    std::string read_file(const std::string &file_name)
    {
      std::error_code error;
      AssertThrow(std::filesystem::is_regular_file(file_name, error),
                  UserError("There is no parameter file '" + file_name + "'."));
      std::ifstream file(file_name);
      AssertThrow(file, UserError("Cannot read the parameter file '" + file_name + "'."));
      std::stringstream text;
      text << file.rdbuf();
      return text.str();
    }


    // The lower-case first word of a line and the rest of it, without comments.
    std::pair<std::string, std::string> split_line(const std::string &line)
    {
      const std::string text = trim(line.substr(0, line.find('#')));
      const auto blank       = text.find_first_of(" \t");
      std::string word       = text.substr(0, blank);
      std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) {
        return std::tolower(c);
      });
      return {word, blank == std::string::npos ? "" : trim(text.substr(blank))};
    }


    // The path of the file that a line at some place includes.
    std::string find_included(const std::string &name,
                              const std::string &file,
                              const std::string &place,
                              const unsigned int depth)
    {
      AssertThrow(depth < 20,
                  UserError(place + "more than 20 files include one another."));
      try
        {
          return find_file(name, file);
        }
      catch (const UserError &error)
        {
          throw UserError(place + error.what());
        }
    }


    std::string expand_includes(const std::string &file_name, const unsigned int depth)
    {
      std::istringstream input(read_file(file_name));
      std::string expanded, line;
      for (unsigned int number = 1; std::getline(input, line); ++number)
        {
          const auto [word, rest] = split_line(line);
          if (word == "include")
            {
              const std::string included = find_included(
                rest, file_name, file_name + ":" + std::to_string(number) + ": ", depth);
              expanded += "# from " + included + ":\n" +
                          expand_includes(included, depth + 1) + "# end of " + included +
                          "\n";
            }
          else
            expanded += line + "\n";
        }
      return expanded;
    }


    // One line of a parameter file: the beginning of a subsection, or the setting of a
    // parameter.
    struct Statement
    {
      std::vector<std::string>
        path; // of the subsection itself, or where the parameter is
      bool is_section;
      std::string name;
      std::string value;
      std::string file;
      unsigned int line;
      bool is_overridden = false; // by a later statement about the same parameter

      std::string place() const
      {
        return file + ":" + std::to_string(line) + ": ";
      }
    };


    void read_statements(std::istream &input,
                         const std::string &file,
                         std::vector<std::string> &path,
                         std::vector<Statement> &statements,
                         const unsigned int depth)
    {
      const unsigned int outer_sections = path.size();
      std::string line, physical_line;
      unsigned int number = 0;
      std::vector<unsigned int> opened; // the lines of the subsections that are open
      while (std::getline(input, physical_line))
        {
          ++number;
          std::string text = physical_line.substr(0, physical_line.find('#'));
          text             = trim(text);
          if (!text.empty() && text.back() == '\\')
            {
              line += text.substr(0, text.size() - 1);
              continue;
            }
          line = trim(line + text);
          if (line.empty())
            continue;

          const std::string place = file + ":" + std::to_string(number) + ": ";
          const auto [word, rest] = split_line(line);

          if (word == "subsection")
            {
              AssertThrow(!rest.empty(),
                          UserError(place + "expected a name after 'subsection'."));
              path.push_back(normalise_name(rest));
              opened.push_back(number);
              statements.push_back({path, true, "", "", file, number});
            }
          else if (word == "end")
            {
              AssertThrow(
                rest.empty(),
                UserError(place + "expected nothing after 'end', found '" + rest + "'."));
              AssertThrow(path.size() > outer_sections,
                          UserError(place + "this 'end' does not end a subsection."));
              path.pop_back();
              opened.pop_back();
            }
          else if (word == "set")
            {
              const auto equals = rest.find('=');
              AssertThrow(
                equals != std::string::npos && equals > 0,
                UserError(place + "expected 'set NAME = VALUE', found '" + line + "'."));
              statements.push_back({path,
                                    false,
                                    normalise_name(rest.substr(0, equals)),
                                    trim(rest.substr(equals + 1)),
                                    file,
                                    number});
            }
          else if (word == "include")
            {
              const std::string included = find_included(rest, file, place, depth);
              std::istringstream stream(read_file(included));
              read_statements(stream, included, path, statements, depth + 1);
            }
          else
            throw UserError(place +
                            "expected 'set', 'subsection', 'end' or 'include', found '" +
                            line + "'.");
          line.clear();
        }
      AssertThrow(line.empty(),
                  UserError(file + ":" + std::to_string(number) +
                            ": the last line ends with a \\."));
      AssertThrow(opened.empty(),
                  UserError(file + ":" + std::to_string(opened.back()) +
                            ": the subsection '" + path.back() +
                            "' that begins here has no 'end'."));
    }


    bool is_parameter(const ptree &node)
    {
      return node.get_optional<std::string>("value").has_value();
    }


    bool is_declared_parameter(const ptree &node)
    {
      const auto value = node.get_optional<std::string>("value");
      return value && value->compare(0, undeclared.size(), undeclared) != 0;
    }


    bool is_declared_section(const ptree &node)
    {
      if (is_parameter(node))
        return false;
      for (const auto &child : node)
        if (is_declared_parameter(child.second) || is_declared_section(child.second))
          return true;
      return false;
    }


    const ptree *find_child(const ptree &node, const std::string &name)
    {
      for (const auto &child : node)
        if (child.first == name)
          return &child.second;
      return nullptr;
    }


    template <typename Predicate>
    std::vector<std::string> child_names(const ptree &node, const Predicate &predicate)
    {
      std::vector<std::string> names;
      for (const auto &child : node)
        if (predicate(child.second))
          names.push_back(child.first);
      return names;
    }


    std::string describe(const std::vector<std::string> &path)
    {
      return path.empty() ? "outside of all subsections"
                          : "in the subsection " + join(path, " / ");
    }


    void enter(ParameterHandler &prm, const std::vector<std::string> &path)
    {
      for (const std::string &section : path)
        prm.enter_subsection(section);
    }


    void leave(ParameterHandler &prm, const std::vector<std::string> &path)
    {
      for (unsigned int i = 0; i < path.size(); ++i)
        prm.leave_subsection();
    }


    // What is wrong with a statement, or an empty string if it has been carried out.
    std::string
    apply(const Statement &statement, const ptree &declared, ParameterHandler &prm)
    {
      const ptree *node = &declared;
      for (unsigned int i = 0; i < statement.path.size(); ++i)
        {
          const ptree *child = find_child(*node, statement.path[i]);
          if (child == nullptr || !is_declared_section(*child))
            {
              // The line that opens the section has said so.
              if (!(statement.is_section && i + 1 == statement.path.size()))
                return "";
              const std::vector<std::string> outer(statement.path.begin(),
                                                   statement.path.begin() + i);
              return statement.place() + "there is no subsection '" + statement.path[i] +
                     "' " + describe(outer) + ". " +
                     suggest_name(statement.path[i],
                                  child_names(*node, is_declared_section));
            }
          node = child;
        }
      if (statement.is_section)
        return "";

      const ptree *parameter = find_child(*node, statement.name);
      if (parameter == nullptr || !is_declared_parameter(*parameter))
        return statement.place() + "there is no parameter '" + statement.name + "' " +
               describe(statement.path) + ". " +
               suggest_name(statement.name, child_names(*node, is_declared_parameter));

      const std::string pattern = parameter->get<std::string>("pattern_description", "");
      std::string value         = statement.value;
      std::string problem;
      if (!value.empty() && !statement.is_overridden &&
          (pattern == "[InputFile]" || pattern == "[FileName (Type: input)]"))
        try
          {
            value = find_file(value, statement.file);
          }
        catch (const UserError &error)
          {
            return statement.place() + "the parameter '" + statement.name + "' " +
                   describe(statement.path) + ": " + error.what();
          }

      enter(prm, statement.path);
      try
        {
          prm.set(statement.name, value);
        }
      catch (const ParameterHandler::ExcValueDoesNotMatchPattern &)
        {
          problem = statement.place() + "the parameter '" + statement.name + "' " +
                    describe(statement.path) + " has the value '" + value +
                    "', but must match " + pattern + ".";
          // "[Selection a|b|c ]", or "[MultipleSelection a|b|c ]" for a list of these
          for (const std::string selection : {"[Selection ", "[MultipleSelection "})
            if (pattern.compare(0, selection.size(), selection) == 0)
              {
                const std::vector<std::string> known = split(
                  pattern.substr(selection.size(), pattern.size() - selection.size() - 2),
                  '|');
                for (const std::string &piece : selection == "[Selection "
                                                  ? std::vector<std::string>{value}
                                                  : split(value, ','))
                  if (std::find(known.begin(), known.end(), piece) == known.end())
                    if (const std::string nearest = nearest_name(piece, known);
                        !nearest.empty())
                      problem += " Did you mean '" + nearest + "'?";
              }
        }
      catch (const UserError &error)
        {
          problem = statement.place() + error.what();
        }
      leave(prm, statement.path);
      return problem;
    }


    // Files that a parameter named before another value replaced them need not exist.
    std::vector<Statement> mark_overridden(std::vector<Statement> statements)
    {
      for (std::size_t i = 0; i < statements.size(); ++i)
        for (std::size_t j = i + 1; j < statements.size(); ++j)
          if (!statements[i].is_section && !statements[j].is_section &&
              statements[i].path == statements[j].path &&
              statements[i].name == statements[j].name)
            statements[i].is_overridden = true;
      return statements;
    }


    // deal.II's lists of parameters, which are JSON, cannot be read otherwise.
    bool is_utf8(const std::string &text)
    {
      using Traits = boost::locale::utf::utf_traits<char>;
      for (auto at = text.begin(); at != text.end();)
        if (!boost::locale::utf::is_valid_codepoint(Traits::decode(at, text.end())))
          return false;
      return true;
    }


    void parse_statements(const std::vector<Statement> &all_statements,
                          ParameterHandler &prm,
                          const std::function<void(ParameterHandler &)> &declare)
    {
      const std::vector<Statement> statements = mark_overridden(all_statements);

      for (const Statement &statement : statements)
        AssertThrow(is_utf8(statement.name) &&
                      std::all_of(statement.path.begin(), statement.path.end(), is_utf8),
                    UserError(statement.place() + "the name of this " +
                              (statement.is_section ? "subsection" : "parameter") +
                              " has bytes that are not UTF-8 text."));

      // Put what the file says where declare_and_read() finds it...
      for (const Statement &statement : statements)
        if (!statement.is_section)
          {
            AssertThrow(is_utf8(statement.value),
                        UserError(statement.place() + "the parameter '" + statement.name +
                                  "' " + describe(statement.path) +
                                  " has a value with bytes that are not UTF-8 text."));
            enter(prm, statement.path);
            prm.declare_entry(
              statement.name, undeclared + statement.value, dealii::Patterns::Anything());
            leave(prm, statement.path);
          }

      declare(prm);

      // ... so that now everything has been declared that may follow from it. Entries
      // that still say that they are undeclared are mistakes.
      std::stringstream stream;
      prm.print_parameters(stream, ParameterHandler::JSON);
      ptree declared;
      boost::property_tree::read_json(stream, declared);

      constexpr unsigned int max_problems = 10;
      unsigned int n_problems             = 0;
      std::string problems;
      for (const Statement &statement : statements)
        {
          const std::string problem = apply(statement, declared, prm);
          if (!problem.empty() && ++n_problems <= max_problems)
            problems += (n_problems == 1 ? "" : "\n") + problem;
        }
      if (n_problems > max_problems)
        problems += "\n... and " + std::to_string(n_problems - max_problems) + " more.";
      AssertThrow(n_problems == 0, UserError(problems));
    }


    // The value that the parameter file gives to an entry that is about to be declared,
    // or nothing.
    bool
    read_undeclared(ParameterHandler &prm, const std::string &entry, std::string &value)
    {
      // For an entry that does not exist get() returns an empty string in release mode
      // and asserts in debug mode; turn that into an exception.
      bool &abort = dealii::deal_II_exceptions::internals::allow_abort_on_exception;
      const bool abort_before = abort;
      abort                   = false;
      std::string found;
      try
        {
          found = prm.get(entry);
        }
      catch (const ParameterHandler::ExcEntryUndeclared &)
        {
        }
      abort = abort_before;
      if (found.compare(0, undeclared.size(), undeclared) != 0)
        return false;
      value = found.substr(undeclared.size());
      return true;
    }
  } // namespace


  bool InputFile::match(const std::string &) const
  {
    return true;
  }


  std::string InputFile::description(const OutputStyle style) const
  {
    return style == Machine ? "[InputFile]" : "the name of an input file, or nothing";
  }


  std::unique_ptr<dealii::Patterns::PatternBase> InputFile::clone() const
  {
    return std::make_unique<InputFile>();
  }


  std::string find_file(const std::string &name, const std::string &parameter_file)
  {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path path(name);
    std::vector<fs::path> candidates = {path};
    if (path.is_relative())
      {
        const fs::path folder = fs::path(parameter_file).parent_path();
        for (const fs::path &candidate : {folder / path, (folder / ".." / path)})
          if (std::find(candidates.begin(),
                        candidates.end(),
                        candidate.lexically_normal()) == candidates.end())
            candidates.push_back(candidate.lexically_normal());
      }
    std::vector<std::string> tried;
    for (const fs::path &candidate : candidates)
      {
        if (fs::is_regular_file(candidate, error))
          return candidate.string();
        tried.push_back("'" + candidate.string() + "'");
      }
    throw UserError("there is no file '" + name + "' (looked for " + join(tried, ", ") +
                    ").");
  }


  void parse_parameter_file(ParameterHandler &prm,
                            const std::string &file_name,
                            const std::function<void(ParameterHandler &)> &declare)
  {
    parse_parameter_text(prm, read_file(file_name), file_name, declare);
  }


  void parse_parameter_text(ParameterHandler &prm,
                            const std::string &text,
                            const std::string &name,
                            const std::function<void(ParameterHandler &)> &declare)
  {
    std::istringstream stream(text);
    std::vector<std::string> path;
    std::vector<Statement> statements;
    read_statements(stream, name, path, statements, 0);
    parse_statements(statements, prm, declare);
  }


  std::string expand_includes(const std::string &file_name)
  {
    return expand_includes(file_name, 0);
  }


  std::string declare_and_read(ParameterHandler &prm,
                               const std::string &entry,
                               const std::string &default_value,
                               const dealii::Patterns::PatternBase &pattern,
                               const std::string &help)
  {
    std::string value;
    const bool is_set = read_undeclared(prm, entry, value) && pattern.match(value);
    prm.declare_entry(entry, default_value, pattern, help);
    return is_set ? value : default_value;
  }


  std::vector<std::string> declare_names(ParameterHandler &prm,
                                         const std::string &entry,
                                         const std::string &default_value,
                                         const std::string &help)
  {
    const std::vector<std::string> names = parse_names(
      declare_and_read(prm, entry, default_value, dealii::Patterns::Anything(), help));
    for (auto name = names.begin(); name != names.end(); ++name)
      {
        AssertThrow(!name->empty(),
                    UserError("The list '" + entry + " = " + join(names, ", ") +
                              "' has an empty member."));
        AssertThrow(std::find(names.begin(), name, *name) == name,
                    UserError("The list '" + entry + " = " + join(names, ", ") +
                              "' names '" + *name + "' twice."));
      }
    return names;
  }


  std::string declare_choice(ParameterHandler &prm,
                             const std::string &entry,
                             const std::string &default_value,
                             const std::vector<std::string> &names,
                             const std::string &help)
  {
    return declare_and_read(
      prm, entry, default_value, dealii::Patterns::Selection(join(names, "|")), help);
  }


  std::vector<std::string> parse_names(const std::string &text)
  {
    std::vector<std::string> names = split(text, ',');
    for (std::string &name : names)
      name = normalise_name(name);
    return names;
  }


  double parse_number(const std::string &text, const std::string &what)
  {
    const std::string trimmed = trim(text);
    char *end                 = nullptr;
    const double value        = std::strtod(trimmed.c_str(), &end);
    AssertThrow(!trimmed.empty() && *end == '\0' && std::isfinite(value),
                UserError(what + ": expected a number, found '" + trimmed + "'."));
    return value;
  }


  std::vector<double> parse_numbers(const std::string &text, const std::string &what)
  {
    std::vector<double> numbers;
    for (const std::string &piece : split(text, ','))
      numbers.push_back(parse_number(piece, what));
    return numbers;
  }


  std::vector<int> parse_integers(const std::string &text, const std::string &what)
  {
    std::vector<int> numbers;
    for (const double number : parse_numbers(text, what))
      {
        AssertThrow(number == std::floor(number) && std::abs(number) < 2e9,
                    UserError(what + ": expected integers, found '" + text + "'."));
        numbers.push_back(static_cast<int>(number));
      }
    return numbers;
  }


  template <int dim>
  dealii::Point<dim> parse_point(const std::string &text, const std::string &what)
  {
    const std::vector<double> numbers = parse_numbers(text, what);
    AssertThrow(numbers.size() == dim,
                UserError(what + ": expected " + std::to_string(dim) +
                          " coordinates, found '" + text + "'."));
    dealii::Point<dim> point;
    for (unsigned int d = 0; d < dim; ++d)
      point[d] = numbers[d];
    return point;
  }


  template <int dim>
  std::vector<dealii::Point<dim>> parse_points(const std::string &text,
                                               const std::string &what)
  {
    std::vector<dealii::Point<dim>> points;
    for (const std::string &piece : split(text, ';'))
      points.push_back(parse_point<dim>(piece, what));
    return points;
  }


  template dealii::Point<2> parse_point<2>(const std::string &, const std::string &);
  template dealii::Point<3> parse_point<3>(const std::string &, const std::string &);
  template std::vector<dealii::Point<2>> parse_points<2>(const std::string &,
                                                         const std::string &);
  template std::vector<dealii::Point<3>> parse_points<3>(const std::string &,
                                                         const std::string &);
} // namespace mitre::base
