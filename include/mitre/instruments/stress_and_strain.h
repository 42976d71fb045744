#ifndef mitre_instruments_stress_and_strain_h
#define mitre_instruments_stress_and_strain_h

#include <mitre/instruments/instrument.h>

namespace mitre::instruments
{
  /**
   * Stress and strain of the solid in a part or in some of its materials: smallest, mean
   * and largest value, and a percentile, of scalar quantities of
   * structure::stress_quantities() at the quadrature points of the elastic force,
   * weighted with the reference volume. The percentile is the smallest value that is not
   * exceeded in that part of the volume. Quantities of fibres are taken where there are
   * fibres.
   */
  template <int dim>
  class StressAndStrain : public Instrument<dim>
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
    std::vector<std::string> quantities;
    std::vector<std::string> materials;
    double percentile = 95;
    std::string percentile_text;
  };
} // namespace mitre::instruments

#endif
