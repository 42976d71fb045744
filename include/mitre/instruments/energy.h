#ifndef mitre_instruments_energy_h
#define mitre_instruments_energy_h

#include <mitre/instruments/instrument.h>

namespace mitre::instruments
{
  /**
   * Kinetic energy of the fluid, @f$\frac{\rho}{2}\sum_f W_f u_f^2@f$ with the control
   * volumes W of the faces, and strain energy of all parts together.
   */
  template <int dim>
  class Energy : public Instrument<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name) override;

    std::vector<std::string> columns() const override;

    std::vector<double> measure(const Observation<dim> &observation) override;

  private:
    std::string name;
  };
} // namespace mitre::instruments

#endif
