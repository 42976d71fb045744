#ifndef mitre_instruments_pressure_station_h
#define mitre_instruments_pressure_station_h

#include <mitre/grid/types.h>
#include <mitre/instruments/instrument.h>
#include <mitre/instruments/measuring_disc.h>

namespace mitre::instruments
{
  /**
   * Mean pressure over a disc: of the columns of cells whose centres lie over it, by
   * their cross-sections, each at the disc's position on the straight line through the
   * two layers of cells of its patch that are nearest.
   *
   * The pressure is that of the middle of the last time step.
   */
  template <int dim>
  class PressureStation : public Instrument<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name) override;

    std::vector<std::string> columns() const override;

    std::vector<double> measure(const Observation<dim> &observation) override;

  private:
    std::string name;
    MeasuringDisc<dim> disc;
  };


  /// The mean [dyn/cm^2] of @p p, a vector of the pressure's. Collective.
  template <int dim>
  double compute_mean_pressure(const MeasuringDisc<dim> &disc,
                               const grid::PatchGrid<dim> &patch_grid,
                               const grid::VectorType &p,
                               const std::string &instrument);
} // namespace mitre::instruments

#endif
