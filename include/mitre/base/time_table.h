#ifndef mitre_base_time_table_h
#define mitre_base_time_table_h

#include <string>
#include <vector>

namespace mitre::base
{
  /**
   * Columns of values over time, read from a file and interpolated smoothly: the pressure
   * waveforms that drive a valve.
   *
   * The file is a comma-separated table. Its first line names the columns, each with its
   * unit in square brackets, "time [s],ventricle [mmHg],atrium [mmHg]"; the first column
   * is time and increases from line to line. Empty lines and lines that begin with # are
   * passed over. All values are kept in cm, g, s (see unit_in_cgs()).
   *
   * Between the lines of the table the value is a cubic in time, with continuous
   * derivative and with slopes that are limited so that it is monotone wherever the
   * table is (Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304): it
   * passes through the values and never beyond its neighbours.
   */
  class TimeTable
  {
  public:
    /** What the table says outside the times that it covers. */
    enum class Extension
    {
      /** The first or the last value. */
      clamped,
      /**
       * The table over and over; its period is from the first time to the last, where
       * the values must agree.
       */
      periodic
    };

    /**
     * Read @p file_name. Throws UserError with file and line for a line with another
     * number of columns than the first, a field that is not a number, a time that does
     * not increase, an unknown unit, fewer than two lines, and a periodic table whose
     * first and last values differ.
     */
    TimeTable(const std::string &file_name, const Extension extension);

    /** The names of the value columns (without time), in the order of the file. */
    const std::vector<std::string> &column_names() const;

    /**
     * The index of the value column @p name; UserError, which lists the names there are,
     * if there is none. If a @p quantity is given, such as "pressure", UserError unless
     * the column's unit measures it (quantity_of_unit()).
     */
    unsigned int column(const std::string &name, const std::string &quantity = "") const;

    /** The value of a column at any time, in cm, g, s. */
    double value(const unsigned int column, const double t) const;

    /** Its derivative in time. */
    double derivative(const unsigned int column, const double t) const;

    double start_time() const;

    double end_time() const;

  private:
    /** Where time @p t lies: the interval, and the time since its beginning. */
    std::pair<unsigned int, double> locate(const double t) const;

    void compute_slopes();

    std::string file_name_;
    Extension extension_;
    unsigned int heading_line_ = 0;
    std::vector<std::string> names_, units_;
    std::vector<double> times_;
    std::vector<std::vector<double>> values_; // [column][line]
    std::vector<std::vector<double>> slopes_; // [column][line]
  };
} // namespace mitre::base

#endif
