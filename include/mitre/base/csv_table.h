#ifndef mitre_base_csv_table_h
#define mitre_base_csv_table_h

#include <string>
#include <vector>

namespace mitre::base
{
  /**
   * Columns of numbers, read from a file of comma-separated values. Its first line names
   * the columns, each with its unit in square brackets, "time [s],ventricle [mmHg]";
   * every other line has a number for each. Empty lines and lines that begin with # are
   * passed over. Values are kept in cm, g, s (see unit_in_cgs()).
   */
  struct CsvTable
  {
    /**
     * Read @p file_name. Throws UserError with file and line for headings that are no
     * names with units, an unknown unit, a line with another number of columns than the
     * first and a field that is not a number.
     *
     * @param min_columns how many columns there must be at least
     * @param example of headings, for messages: "time [s],pressure [mmHg]"
     */
    CsvTable(const std::string &file_name,
             const unsigned int min_columns,
             const std::string &example);

    unsigned int n_columns() const
    {
      return names.size();
    }

    unsigned int n_lines() const
    {
      return line_numbers.size();
    }

    /// "pressures.csv:3: ", for messages about a line of numbers.
    std::string place(const unsigned int line) const;

    std::string file_name;

    /// The line of the headings in the file, 0 if there is none.
    unsigned int heading_line = 0;

    /// Of the columns.
    std::vector<std::string> names, units;

    /// By column and line, in cm, g, s.
    std::vector<std::vector<double>> values;

    /// The place of each line of numbers in the file, from 1.
    std::vector<unsigned int> line_numbers;
  };
} // namespace mitre::base

#endif
