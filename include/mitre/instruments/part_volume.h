#ifndef mitre_instruments_part_volume_h
#define mitre_instruments_part_volume_h

#include <mitre/instruments/instrument.h>

namespace mitre::instruments
{
  /**
   * How well a part keeps its volume: @f$\int_U J\,ds / \int_U ds@f$, and the smallest
   * and largest @f$J = \det\partial X/\partial s@f$ at the quadrature points of the
   * elastic force.
   */
  template <int dim>
  class PartVolume : public Instrument<dim>
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
  };
} // namespace mitre::instruments

#endif
