#ifndef mitre_instruments_pressure_difference_h
#define mitre_instruments_pressure_difference_h

#include <mitre/grid/types.h>
#include <mitre/instruments/instrument.h>
#include <mitre/instruments/measuring_disc.h>

namespace mitre::instruments
{
  /**
   * Two pressure stations on one axis, between which a difference of pressure is
   * measured: the mean over the disc upstream minus that over the disc downstream.
   */
  template <int dim>
  struct StationPair
  {
    MeasuringDisc<dim> upstream, downstream;

    static void declare_parameters(dealii::ParameterHandler &prm);

    /// @param instrument for messages
    void parse_parameters(dealii::ParameterHandler &prm, const std::string &instrument);

    /// [dyn/cm^2], of a vector @p p of the pressure's. Collective.
    double compute_difference(const grid::PatchGrid<dim> &patch_grid,
                              const grid::VectorType &p,
                              const std::string &instrument) const;
  };


  /**
   * Difference of the mean pressures over two discs [mmHg], that of the middle of the
   * last time step.
   */
  template <int dim>
  class PressureDifference : public Instrument<dim>
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
  };
} // namespace mitre::instruments

#endif
