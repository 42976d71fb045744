#ifndef mitre_instruments_pressure_point_h
#define mitre_instruments_pressure_point_h

#include <mitre/grid/patch_grid.h>
#include <mitre/grid/types.h>
#include <mitre/instruments/instrument.h>

namespace mitre::instruments
{
  /**
   * The pressure at a point, linearly interpolated between the centres of the cells of
   * its patch.
   *
   * On the surface of a part the pressure is smeared over the reach of the kernel. There
   * it can be taken from the fluid outside: extrapolated along the normal, by the
   * parabola through the values at one, two and three times a distance from the surface.
   *
   * The pressure is that of the middle of the last time step.
   */
  template <int dim>
  class PressurePoint : public Instrument<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name) override;

    std::vector<std::string> columns() const override;

    std::vector<double> measure(const Observation<dim> &observation) override;

  private:
    std::string name;
    bool in_mmHg = true;

    /// Where the pressure is taken, and with which weight.
    std::vector<std::pair<dealii::Point<dim>, double>> samples;
  };


  /// The pressure [dyn/cm^2] at @p x; NaN if @p x is outside of the box. Collective.
  template <int dim>
  double compute_pressure_at(const dealii::Point<dim> &x,
                             const grid::PatchGrid<dim> &patch_grid,
                             const grid::VectorType &p);
} // namespace mitre::instruments

#endif
