#ifndef mitre_instruments_flow_meter_h
#define mitre_instruments_flow_meter_h

#include <mitre/grid/staggered_space.h>
#include <mitre/instruments/instrument.h>
#include <mitre/instruments/measuring_disc.h>

namespace mitre::instruments
{
  /**
   * Volume flow @f$Q = \sum_f u_f A_f@f$ through a disc, over the faces f of the plane of
   * the grid nearest to it whose centres lie in the disc (the plane is one of the
   * coarsest cells there, so that all levels have it). Through a whole cross-section this
   * is the flux that the discrete divergence knows.
   *
   * Through a disc across any other direction it is @f$Q = \int u \cdot n\, dA@f$ of the
   * velocity as coupling::FECoupling::velocities_at() interpolates it, by a rule of Gauss
   * points along the radius and equal angles, two a cell or more.
   *
   * Also the volumes that have passed forward and back since the first measurement,
   * @f$\int \max(\pm Q, 0)\, dt@f$ with Q linear between measurements.
   */
  template <int dim>
  class FlowMeter : public Instrument<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name) override;

    std::vector<std::string> columns() const override;

    std::vector<double> measure(const Observation<dim> &observation) override;

    std::vector<double> state() const override;

    void set_state(const std::vector<double> &state) override;

  private:
    double flow_through_inclined_disc(const Observation<dim> &observation);

    std::string name;
    MeasuringDisc<dim> disc;
    double sign = 1;

    /// Of unit length, for an inclined disc; otherwise zero.
    dealii::Tensor<1, dim> normal;

    /// Of an inclined disc: quadrature points, and weights [cm^(dim-1)].
    std::vector<dealii::Point<dim>> points;
    std::vector<double> weights;

    bool has_previous      = false;
    double previous_time   = 0;
    double previous_flow   = 0;
    double forward_volume  = 0;
    double backward_volume = 0;
  };


  /// The flow [cm^dim/s] in the direction of the axis. Collective.
  template <int dim>
  double compute_flow(const MeasuringDisc<dim> &disc,
                      const grid::StaggeredSpace<dim> &space,
                      const grid::VectorType &u,
                      const std::string &instrument);
} // namespace mitre::instruments

#endif
