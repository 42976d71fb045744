#ifndef mitre_instruments_part_force_h
#define mitre_instruments_part_force_h

#include <mitre/instruments/instrument.h>

namespace mitre::instruments
{
  /**
   * The force of the fluid on a part that its constraints hold: minus the sum of the
   * forces of its constraints and loads [dyn; dyn/cm in 2D]. For a part at rest that is
   * drag and lift, as the elastic forces of a part sum to zero and the fluid inside of it
   * does not accelerate.
   *
   * With a reference force, such as rho U^2 L / 2, the force divided by it is given too:
   * the drag and lift coefficients.
   */
  template <int dim>
  class PartForce : public Instrument<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name) override;

    std::vector<std::string> columns() const override;

    std::vector<double> measure(const Observation<dim> &observation) override;

  private:
    std::string name;
    std::string part;
    double reference_force = 0.;
  };
} // namespace mitre::instruments

#endif
