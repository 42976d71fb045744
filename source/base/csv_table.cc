#include <deal.II/base/exceptions.h>

#include <fstream>
#include <utility>

#include <mitre/base/csv_table.h>
#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/base/units.h>

namespace mitre::base
{
  namespace
  {
    std::vector<std::string> split_fields(const std::string &line)
    {
      std::vector<std::string> fields(1);
      for (const char c : line)
        if (c == ',')
          fields.emplace_back();
        else
          fields.back() += c;
      for (std::string &field : fields)
        {
          const auto begin = field.find_first_not_of(" \t\r");
          const auto end   = field.find_last_not_of(" \t\r");
          field = begin == std::string::npos ? "" : field.substr(begin, end - begin + 1);
        }
      return fields;
    }


    // Takes "name [unit]" apart.
    std::pair<std::string, std::string> split_heading(const std::string &heading,
                                                      const std::string &place)
    {
      const auto open = heading.rfind('[');
      AssertThrow(open != std::string::npos && open > 0 && heading.back() == ']',
                  UserError(place + "the column heading '" + heading +
                            "' is not a name and a unit, such as 'time [s]'."));
      const auto end = heading.find_last_not_of(" \t", open - 1);
      AssertThrow(end != std::string::npos,
                  UserError(place + "the column heading '" + heading + "' has no name."));
      return {heading.substr(0, end + 1),
              heading.substr(open + 1, heading.size() - open - 2)};
    }
  } // namespace


  CsvTable::CsvTable(const std::string &file_name,
                     const unsigned int min_columns,
                     const std::string &example)
    : file_name(file_name)
  {
    std::ifstream file(file_name);
    AssertThrow(file, UserError("Cannot open the table '" + file_name + "'."));

    std::vector<double> factors;
    std::string line;
    unsigned int line_number = 0;
    while (std::getline(file, line))
      {
        ++line_number;
        const std::string place = file_name + ":" + std::to_string(line_number) + ": ";
        const auto begin        = line.find_first_not_of(" \t\r");
        if (begin == std::string::npos || line[begin] == '#')
          continue;

        const std::vector<std::string> fields = split_fields(line);
        if (heading_line == 0)
          {
            heading_line = line_number;
            AssertThrow(
              fields.size() >= min_columns,
              UserError(place + "expected the headings of at least " +
                        (min_columns == 2 ? "two" : std::to_string(min_columns)) +
                        " columns, such as '" + example + "'; found '" + line + "'."));
            for (const std::string &field : fields)
              {
                const auto [name, unit] = split_heading(field, place);
                try
                  {
                    factors.push_back(unit_in_cgs(unit));
                  }
                catch (const UserError &error)
                  {
                    throw UserError(place + error.what());
                  }
                names.push_back(name);
                units.push_back(unit);
              }
            values.resize(names.size());
            continue;
          }

        AssertThrow(fields.size() == factors.size(),
                    UserError(place + "found " + std::to_string(fields.size()) +
                              " columns, but the first line names " +
                              std::to_string(factors.size()) + "."));
        for (unsigned int i = 0; i < fields.size(); ++i)
          values[i].push_back(
            parse_number(fields[i], place + "column " + std::to_string(i + 1)) *
            factors[i]);
        line_numbers.push_back(line_number);
      }
  }


  std::string CsvTable::place(const unsigned int line) const
  {
    return file_name + ":" + std::to_string(line_numbers[line]) + ": ";
  }
} // namespace mitre::base
