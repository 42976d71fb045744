#ifndef mitre_instruments_gorlin_area_h
#define mitre_instruments_gorlin_area_h

#include <mitre/instruments/flow_meter.h>
#include <mitre/instruments/pressure_difference.h>

namespace mitre::instruments
{
  /**
   * Effective area of a valve's orifice by Gorlin's formula (3.5),
   * @f[ A = \frac{Q}{C_c\, 44.5\, \sqrt{\Delta p}}, \qquad C_c = 0.7, @f]
   * A in cm^2 from the flow Q in mL/s and the difference of pressure in mmHg (Gorlin and
   * Gorlin, Am. Heart J. 41 (1951) 1). 44.5 is their value of @f$\sqrt{2 g}@f$ with g in
   * cm/s^2; the formula is empirical, and takes mmHg for centimetres of the fluid. (The
   * thesis divides by 0.06 as well, which belongs to a flow in L/min:
   * doc/thesis_corrections.md.)
   *
   * The formula is for a steady flow forward: 0 where there is none, or where the
   * difference of pressure is less than a limit, as when the flow goes on by its inertia
   * alone.
   */
  template <int dim>
  class GorlinArea : public Instrument<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name) override;

    std::vector<std::string> columns() const override;

    std::vector<double> measure(const Observation<dim> &observation) override;

  private:
    std::string name;
    StationPair<dim> stations;
    MeasuringDisc<dim> flow_disc;
    double contraction_coefficient = 0, smallest_difference = 0;
  };


  /// The area [cm^2] for a flow [mL/s] and a difference of pressure [mmHg].
  double compute_gorlin_area(const double flow,
                             const double pressure_difference,
                             const double contraction_coefficient = 0.7);
} // namespace mitre::instruments

#endif
