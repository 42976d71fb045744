#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlopt.hpp>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/biaxial/fit.h>

namespace mitre::biaxial
{
  namespace
  {
    const std::vector<std::pair<std::string, Quantity::Kind>> kinds = {
      {"Cauchy stress", Quantity::Kind::cauchy_stress},
      {"first Piola stress", Quantity::Kind::first_piola_stress},
      {"tension", Quantity::Kind::tension}};

    const std::vector<std::string> stress_units  = {"dyn/cm^2",
                                                    "Pa",
                                                    "kPa",
                                                    "MPa",
                                                    "mmHg"};
    const std::vector<std::string> tension_units = {"dyn/cm", "N/m"};


    std::vector<Quantity> all_quantities()
    {
      std::vector<Quantity> quantities;
      for (const auto &[name, kind] : kinds)
        {
          quantities.push_back({kind, 0, 0});
          quantities.push_back({kind, 1, 1});
          if (kind != Quantity::Kind::tension)
            quantities.push_back({kind, 0, 1});
        }
      return quantities;
    }


    void check_unit(const base::CsvTable &table,
                    const unsigned int column,
                    const std::vector<std::string> &units)
    {
      std::string list;
      for (const std::string &unit : units)
        list += (list.empty() ? "[" : ", [") + unit + "]";
      AssertThrow(
        std::find(units.begin(), units.end(), table.units[column]) != units.end(),
        base::UserError(table.file_name + ":" + std::to_string(table.heading_line) +
                        ": '" + table.names[column] + "' has the unit [" +
                        table.units[column] + "]; expected " + list + "."));
    }
  } // namespace


  std::string Quantity::name() const
  {
    const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const auto &entry) {
      return entry.second == kind;
    });
    return found->first + " " + std::to_string(i + 1) + std::to_string(j + 1);
  }


  double Quantity::value(const State &state, const double thickness) const
  {
    switch (kind)
      {
        case Kind::cauchy_stress:
          return state.cauchy_stress[i][j];
        case Kind::first_piola_stress:
          return state.first_piola_stress[i][j];
        case Kind::tension:
          return state.first_piola_stress[i][j] * thickness;
      }
    return 0;
  }


  Measurements::Measurements(const std::string &file_name, const double thickness)
    : table(file_name, 2, "stretch 1 [1],Cauchy stress 11 [kPa]")
  {
    // Step 1: what the columns are.
    std::vector<std::string> known = {"stretch 1", "stretch 2", "stretch 3", "shear"};
    for (const Quantity &quantity : all_quantities())
      known.push_back(quantity.name());

    const std::string heading =
      table.file_name + ":" + std::to_string(table.heading_line) + ": ";
    for (unsigned int c = 0; c < table.n_columns(); ++c)
      {
        const std::string &name = table.names[c];
        AssertThrow(std::count(table.names.begin(), table.names.end(), name) == 1,
                    base::UserError(heading + "there are two columns '" + name + "'."));
        if (name == "stretch 1" || name == "stretch 2" || name == "stretch 3" ||
            name == "shear")
          {
            check_unit(table, c, {"1"});
            if (name == "shear")
              shear_column = c;
            else if (name != "stretch 3")
              stretch_columns[name == "stretch 1" ? 0 : 1] = c;
            continue;
          }
        bool found = false;
        for (const Quantity &quantity : all_quantities())
          if (quantity.name() == name)
            {
              const bool tension = quantity.kind == Quantity::Kind::tension;
              check_unit(table, c, tension ? tension_units : stress_units);
              AssertThrow(!tension || thickness > 0,
                          base::UserError(heading + "the column '" + name +
                                          "' is of use only with a \"Thickness\" in the "
                                          "parameter file."));
              measured.push_back(quantity);
              columns.push_back(c);
              found = true;
            }
        AssertThrow(found,
                    base::UserError(heading + "the column '" + name + "' is not known. " +
                                    base::suggest_name(name, known)));
      }

    // Step 2: what there must be.
    AssertThrow(table.n_lines() > 0,
                base::UserError(file_name + ": expected a line of headings and lines of "
                                            "numbers below it; found no numbers."));
    AssertThrow(
      stretch_columns[0] != none || stretch_columns[1] != none,
      base::UserError(heading + "there is no column 'stretch 1' or 'stretch 2'."));
    AssertThrow(!measured.empty(),
                base::UserError(heading +
                                "there is no column with a stress or a tension. " +
                                base::suggest_name("", known)));
    AssertThrow(shear_column == none ||
                  (stretch_columns[0] != none && stretch_columns[1] != none),
                base::UserError(heading + "with a column 'shear', both 'stretch 1' and "
                                          "'stretch 2' are expected."));
    for (unsigned int line = 0; line < table.n_lines(); ++line)
      for (const unsigned int c : stretch_columns)
        AssertThrow(c == none || table.values[c][line] > 0,
                    base::UserError(table.place(line) + "the stretch in column " +
                                    std::to_string(c + 1) + " is " +
                                    std::to_string(table.values[c][line]) +
                                    "; expected a positive number."));
  }


  double Measurements::stretch(const unsigned int direction,
                               const unsigned int line) const
  {
    const unsigned int column = stretch_columns[direction - 1];
    return column == none ? 1 : table.values[column][line];
  }


  State Measurements::state(const Sample &sample, const unsigned int line) const
  {
    if (stretch_columns[0] == none || stretch_columns[1] == none)
      {
        const unsigned int direction = stretch_columns[0] == none ? 2 : 1;
        return sample.stretch_uniaxially(direction, stretch(direction, line));
      }
    return sample.deform(stretch(1, line),
                         stretch(2, line),
                         shear_column == none ? 0. : table.values[shear_column][line]);
  }


  FitResult fit(const std::vector<FreeParameter> &parameters,
                const Measurements &measurements,
                const double thickness,
                const std::function<Sample(const std::vector<double> &)> &make_sample,
                const double tolerance,
                const unsigned int max_evaluations)
  {
    const unsigned int n   = parameters.size();
    const auto &quantities = measurements.quantities();
    const unsigned int m   = quantities.size() * measurements.n_lines();
    for (const FreeParameter &p : parameters)
      {
        std::ostringstream text;
        text << "The parameter '" << p.name << "' starts at " << p.start
             << ", which is not between its bounds " << p.lower << " and " << p.upper
             << ".";
        AssertThrow(p.lower < p.upper && p.lower <= p.start && p.start <= p.upper,
                    base::UserError(text.str()));
      }
    AssertThrow(m >= n,
                base::UserError("There are " + std::to_string(m) +
                                " measured values for " + std::to_string(n) +
                                " parameters; expected at least as "
                                "many values as parameters."));

    // Step 1: the scale of stresses and that of tensions.
    double sums[2]         = {0, 0};
    unsigned int counts[2] = {0, 0};
    for (unsigned int k = 0; k < quantities.size(); ++k)
      for (unsigned int line = 0; line < measurements.n_lines(); ++line)
        {
          const bool tension = quantities[k].kind == Quantity::Kind::tension;
          sums[tension] += std::pow(measurements.value(k, line), 2);
          ++counts[tension];
        }
    const auto scale = [&](const unsigned int k) {
      const bool tension = quantities[k].kind == Quantity::Kind::tension;
      return sums[tension] > 0 ? std::sqrt(sums[tension] / counts[tension]) : 1.;
    };

    // Step 2: the differences, divided by their scale.
    FitResult result;
    const auto differences = [&](const std::vector<double> &values) {
      ++result.n_evaluations;
      const Sample sample = make_sample(values);
      std::vector<double> r;
      r.reserve(m);
      for (unsigned int line = 0; line < measurements.n_lines(); ++line)
        {
          const State state = measurements.state(sample, line);
          for (unsigned int k = 0; k < quantities.size(); ++k)
            r.push_back(
              (quantities[k].value(state, thickness) - measurements.value(k, line)) /
              scale(k));
        }
      return r;
    };

    // Step 3: minimise in variables between 0 and 1.
    const auto to_value = [&](const unsigned int i, const double x) {
      const FreeParameter &p = parameters[i];
      const double value     = p.lower > 0 ? p.lower * std::pow(p.upper / p.lower, x)
                                           : p.lower + x * (p.upper - p.lower);
      return std::clamp(value, p.lower, p.upper);
    };
    const auto to_values = [&](const std::vector<double> &x) {
      std::vector<double> values;
      for (unsigned int i = 0; i < n; ++i)
        values.push_back(to_value(i, x[i]));
      return values;
    };
    std::function<double(const std::vector<double> &)> sum_of_squares =
      [&](const std::vector<double> &x) {
        double sum = 0;
        try
          {
            for (const double r : differences(to_values(x)))
              sum += r * r;
          }
        catch (const base::UserError &)
          {
            sum = std::numeric_limits<double>::infinity();
          }
        // The search needs finite values, also where the law has none.
        return std::min(sum / m, 1e30);
      };

    std::vector<double> x(n);
    for (unsigned int i = 0; i < n; ++i)
      {
        const FreeParameter &p = parameters[i];
        x[i] = p.lower > 0 ? std::log(p.start / p.lower) / std::log(p.upper / p.lower)
                           : (p.start - p.lower) / (p.upper - p.lower);
      }

    // BOBYQA needs two variables or more. A second search from where the first one ended
    // begins with large steps again.
    nlopt::opt search(n == 1 ? nlopt::LN_SBPLX : nlopt::LN_BOBYQA, n);
    search.set_lower_bounds(0.);
    search.set_upper_bounds(1.);
    search.set_xtol_rel(tolerance);
    search.set_xtol_abs(tolerance);
    search.set_maxeval(max_evaluations);
    search.set_min_objective(
      [](const std::vector<double> &x, std::vector<double> &, void *data) {
        return (*static_cast<decltype(sum_of_squares) *>(data))(x);
      },
      &sum_of_squares);
    for (unsigned int repetition = 0; repetition < 2; ++repetition)
      {
        double minimum        = 0;
        nlopt::result outcome = nlopt::FAILURE;
        try
          {
            outcome = search.optimize(x, minimum);
          }
        catch (const nlopt::roundoff_limited &)
          {
            // x is then as good as it can be.
          }
        AssertThrow(
          outcome != nlopt::MAXEVAL_REACHED,
          base::UserError("The fit has not converged within " +
                          std::to_string(max_evaluations) +
                          " evaluations. Closer bounds, better start values, "
                          "fewer parameters or a larger \"Maximum evaluations\" "
                          "may help."));
      }
    result.values = to_values(x);

    // Step 4: how good it is. The errors come from (J^T J)^-1 s^2, J by central
    // differences.
    const std::vector<double> best = differences(result.values);
    for (unsigned int k = 0; k < quantities.size(); ++k)
      {
        double sum = 0, mean = 0, variance = 0;
        for (unsigned int line = 0; line < measurements.n_lines(); ++line)
          {
            sum += std::pow(best[line * quantities.size() + k] * scale(k), 2);
            mean += measurements.value(k, line) / measurements.n_lines();
          }
        for (unsigned int line = 0; line < measurements.n_lines(); ++line)
          variance += std::pow(measurements.value(k, line) - mean, 2);
        result.rms.push_back(std::sqrt(sum / measurements.n_lines()));
        result.r_squared.push_back(1 - sum / variance);
      }

    result.standard_errors.assign(n, std::numeric_limits<double>::quiet_NaN());
    std::vector<unsigned int> inner;
    for (unsigned int i = 0; i < n; ++i)
      if (x[i] > 1e-6 && x[i] < 1 - 1e-6)
        inner.push_back(i);
    if (inner.empty() || m <= inner.size())
      return result;
    dealii::FullMatrix<double> J(m, inner.size()), normal(inner.size(), inner.size());
    for (unsigned int c = 0; c < inner.size(); ++c)
      {
        const double step             = 1e-6;
        std::vector<double> x_forward = x, x_backward = x;
        x_forward[inner[c]] += step;
        x_backward[inner[c]] -= step;
        const auto forward  = differences(to_values(x_forward)),
                   backward = differences(to_values(x_backward));
        for (unsigned int r = 0; r < m; ++r)
          J(r, c) = (forward[r] - backward[r]) / (2 * step);
      }
    J.Tmmult(normal, J);
    double sum = 0;
    for (const double r : best)
      sum += r * r;
    // The determinant of the matrix scaled to a unit diagonal is 0 if two parameters have
    // the same effect, and an entry of the diagonal is if one has none.
    dealii::FullMatrix<double> scaled = normal;
    bool regular                      = true;
    for (unsigned int a = 0; a < inner.size(); ++a)
      regular = regular && normal(a, a) > 0;
    if (!regular)
      return result;
    for (unsigned int a = 0; a < inner.size(); ++a)
      for (unsigned int b = 0; b < inner.size(); ++b)
        scaled(a, b) = normal(a, b) / std::sqrt(normal(a, a) * normal(b, b));
    try
      {
        scaled.gauss_jordan();
      }
    catch (const dealii::ExceptionBase &)
      {
        return result;
      }
    for (unsigned int c = 0; c < inner.size(); ++c)
      {
        const double in_x =
          std::sqrt(scaled(c, c) / normal(c, c) * sum / (m - inner.size()));
        const double step  = 1e-6;
        const double slope = (to_value(inner[c], x[inner[c]] + step) -
                              to_value(inner[c], x[inner[c]] - step)) /
                             (2 * step);
        result.standard_errors[inner[c]] = in_x * slope;
      }
    return result;
  }
} // namespace mitre::biaxial
