#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <mitre/base/csv_table.h>
#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/base/time_table.h>
#include <mitre/base/units.h>

namespace mitre::base
{
  namespace
  {
    std::string to_text(const double number)
    {
      std::ostringstream text;
      text << number;
      return text.str();
    }


    // Slope at a point between two intervals with lengths h and mean slopes s: a weighted
    // harmonic mean if the slopes have the same sign, else 0.
    double limited_slope(const double h_left,
                         const double s_left,
                         const double h_right,
                         const double s_right)
    {
      if (s_left * s_right <= 0.)
        return 0.;
      const double alpha = (h_left + 2. * h_right) / (3. * (h_left + h_right));
      return s_left * s_right / (alpha * s_right + (1. - alpha) * s_left);
    }
  } // namespace


  TimeTable::TimeTable(const std::string &file_name, const Extension extension)
    : file_name_(file_name)
    , extension_(extension)
  {
    const CsvTable table(file_name, 2, "time [s],pressure [mmHg]");
    if (table.n_columns() > 0)
      {
        AssertThrow(table.units[0] == "s" || table.units[0] == "ms",
                    UserError(file_name + ":" + std::to_string(table.heading_line) +
                              ": the first column must be time, in [s] or [ms]; found '" +
                              table.names[0] + " [" + table.units[0] + "]'."));
        times_        = table.values[0];
        heading_line_ = table.heading_line;
        names_.assign(table.names.begin() + 1, table.names.end());
        units_.assign(table.units.begin() + 1, table.units.end());
        values_.assign(table.values.begin() + 1, table.values.end());
      }
    for (unsigned int i = 1; i < times_.size(); ++i)
      AssertThrow(times_[i] > times_[i - 1],
                  UserError(table.place(i) + "the time " +
                            to_text(times_[i] / unit_in_cgs(table.units[0])) +
                            " is not later than the one before it."));
    AssertThrow(times_.size() >= 2,
                UserError(file_name +
                          ": a table needs a line of headings and at least two "
                          "lines of numbers; found " +
                          std::to_string(times_.size()) + "."));

    if (extension == Extension::periodic)
      for (unsigned int c = 0; c < names_.size(); ++c)
        {
          const auto [low, high] =
            std::minmax_element(values_[c].begin(), values_[c].end());
          AssertThrow(std::abs(values_[c].back() - values_[c].front()) <=
                        1e-9 * std::max(std::abs(*low), std::abs(*high)),
                      UserError(file_name + ": the column '" + names_[c] +
                                "' is to be repeated in time, but its first and its last "
                                "value differ."));
        }
    compute_slopes();
  }


  void TimeTable::compute_slopes()
  {
    const unsigned int n = times_.size();
    slopes_.assign(values_.size(), std::vector<double>(n, 0.));
    for (unsigned int c = 0; c < values_.size(); ++c)
      {
        const auto length = [&](const unsigned int i) {
          return times_[i + 1] - times_[i];
        };
        const auto mean_slope = [&](const unsigned int i) {
          return (values_[c][i + 1] - values_[c][i]) / length(i);
        };
        for (unsigned int i = 1; i + 1 < n; ++i)
          slopes_[c][i] =
            limited_slope(length(i - 1), mean_slope(i - 1), length(i), mean_slope(i));
        if (extension_ == Extension::periodic)
          slopes_[c][0] = slopes_[c][n - 1] =
            limited_slope(length(n - 2), mean_slope(n - 2), length(0), mean_slope(0));
        // Where the table is clamped its ends are level, so that the derivative is
        // continuous there, too.
      }
  }


  const std::vector<std::string> &TimeTable::column_names() const
  {
    return names_;
  }


  unsigned int TimeTable::column(const std::string &name,
                                 const std::string &quantity) const
  {
    const auto found = std::find(names_.begin(), names_.end(), name);
    AssertThrow(found != names_.end(),
                UserError(file_name_ + ": there is no column '" + name + "'. " +
                          suggest_name(name, names_)));
    const unsigned int index = found - names_.begin();
    if (quantity.empty() || quantity_of_unit(units_[index]) == quantity)
      return index;
    std::string expected;
    for (const std::string &unit : known_units())
      if (quantity_of_unit(unit) == quantity)
        expected += (expected.empty() ? "[" : ", [") + unit + "]";
    throw UserError(file_name_ + ":" + std::to_string(heading_line_) + ": the column '" +
                    name + " [" + units_[index] + "]' is needed as a " + quantity +
                    "; expected one of the units " + expected + ".");
  }


  std::pair<unsigned int, double> TimeTable::locate(const double t) const
  {
    double place = t;
    if (extension_ == Extension::periodic)
      {
        const double period = times_.back() - times_.front();
        place -= period * std::floor((t - times_.front()) / period);
      }
    place            = std::clamp(place, times_.front(), times_.back());
    const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, place);
    const unsigned int interval = after - times_.begin() - 1;
    return {interval, place - times_[interval]};
  }


  double TimeTable::value(const unsigned int column, const double t) const
  {
    AssertIndexRange(column, values_.size());
    const auto [i, elapsed] = locate(t);
    const double h          = times_[i + 1] - times_[i];
    const double s          = elapsed / h;
    const auto &values      = values_[column];
    const auto &slopes      = slopes_[column];
    // Hermite's cubic
    return values[i] * (1. + 2. * s) * (1. - s) * (1. - s) +
           values[i + 1] * s * s * (3. - 2. * s) +
           h * s * (1. - s) * (slopes[i] * (1. - s) - slopes[i + 1] * s);
  }


  double TimeTable::derivative(const unsigned int column, const double t) const
  {
    AssertIndexRange(column, values_.size());
    if (extension_ == Extension::clamped && (t < times_.front() || t > times_.back()))
      return 0.;
    const auto [i, elapsed] = locate(t);
    const double h          = times_[i + 1] - times_[i];
    const double s          = elapsed / h;
    const auto &values      = values_[column];
    const auto &slopes      = slopes_[column];
    return (values[i + 1] - values[i]) * 6. * s * (1. - s) / h +
           slopes[i] * (1. - s) * (1. - 3. * s) + slopes[i + 1] * s * (3. * s - 2.);
  }


  double TimeTable::start_time() const
  {
    return times_.front();
  }


  double TimeTable::end_time() const
  {
    return times_.back();
  }
} // namespace mitre::base
