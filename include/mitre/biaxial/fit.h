#ifndef mitre_biaxial_fit_h
#define mitre_biaxial_fit_h

#include <deal.II/base/parameter_handler.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <mitre/base/csv_table.h>
#include <mitre/biaxial/sample.h>

namespace mitre::biaxial
{
  /**
   * What a column of a table of stresses and stretches holds. Headings are "stretch 1
   * [1]", "stretch 2 [1]", "shear [1]", "Cauchy stress 11 [kPa]" (also 22, 12), "first
   * Piola stress 11 [kPa]" (also 22, 12) and "tension 11 [N/m]" (also 22), which is the
   * force per length of the undeformed sheet, that is, the first Piola-Kirchhoff stress
   * times the thickness.
   */
  struct Quantity
  {
    enum class Kind
    {
      cauchy_stress,
      first_piola_stress,
      tension
    };

    Kind kind;

    /// Components from 0.
    unsigned int i, j;

    /// "Cauchy stress 11"
    std::string name() const;

    /// @param thickness of the undeformed sheet [cm]
    double value(const State &state, const double thickness) const;
  };


  /**
   * Measured stresses, read from a table: the stretches and the shear of each line are
   * imposed, and its stresses and tensions measured; without a "stretch 2" ("stretch 1")
   * the test is uniaxial. Columns "stretch 3" are passed over.
   */
  class Measurements
  {
  public:
    /**
     * Throws base::UserError with file and line for what base::CsvTable does not
     * understand, headings other than Quantity's, a unit that is not that of the
     * quantity, a stretch that is not positive, and a table without stretches or without
     * stresses; also for tensions if @p thickness is 0.
     */
    Measurements(const std::string &file_name, const double thickness);

    unsigned int n_lines() const
    {
      return table.n_lines();
    }

    const std::vector<Quantity> &quantities() const
    {
      return measured;
    }

    /// What was measured in line @p line, in cm, g, s.
    double value(const unsigned int quantity, const unsigned int line) const
    {
      return table.values[columns[quantity]][line];
    }

    /// The stretch in direction 1 or 2, 1 if the table has none.
    double stretch(const unsigned int direction, const unsigned int line) const;

    /// The state of @p sample in line @p line.
    State state(const Sample &sample, const unsigned int line) const;

    /// "fit.csv:3: "
    std::string place(const unsigned int line) const
    {
      return table.place(line);
    }

  private:
    static constexpr unsigned int none = static_cast<unsigned int>(-1);

    base::CsvTable table;
    unsigned int stretch_columns[2] = {none, none};
    unsigned int shear_column       = none;
    std::vector<Quantity> measured;

    /// Of the measured quantities.
    std::vector<unsigned int> columns;
  };


  /**
   * A parameter that a fit may choose between bounds.
   */
  struct FreeParameter
  {
    std::string name;
    double start = 0, lower = 0, upper = 0;
  };


  /**
   * What a fit has found.
   */
  struct FitResult
  {
    std::vector<double> values;

    /// Standard errors of the values from the linearised problem; NaN where the
    /// measurements do not determine the parameter, or it is at a bound.
    std::vector<double> standard_errors;

    /// For each measured quantity: root of the mean squared difference [dyn/cm^2, dyn/cm]
    /// and coefficient of determination R^2.
    std::vector<double> rms, r_squared;

    unsigned int n_evaluations = 0;
  };


  /**
   * The least squares fit of the free parameters to @p measurements: minimises the sum of
   * the squared differences of stresses, each divided by the mean square of all measured
   * stresses (or tensions), by the derivative-free trust region method BOBYQA (Powell
   * 2009) of NLopt, in the logarithms of those parameters whose bounds are positive.
   *
   * @param parameters names, start values and bounds; base::UserError if a start value is
   * outside of the bounds
   * @param measurements the data
   * @param thickness of the undeformed sheet [cm]
   * @param make_sample the sample with given values of the parameters, which is used
   * until the next call
   * @param tolerance relative change of the (scaled) parameters at which the search ends
   * @param max_evaluations at which it ends with base::UserError
   */
  FitResult fit(const std::vector<FreeParameter> &parameters,
                const Measurements &measurements,
                const double thickness,
                const std::function<Sample(const std::vector<double> &)> &make_sample,
                const double tolerance,
                const unsigned int max_evaluations);
} // namespace mitre::biaxial

#endif
