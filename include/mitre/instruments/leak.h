#ifndef mitre_instruments_leak_h
#define mitre_instruments_leak_h

#include <deal.II/base/tensor.h>

#include <mitre/instruments/instrument.h>

namespace mitre::instruments
{
  /**
   * Flow of the fluid through a part that should be tight: @f$\int_\Gamma (u - U) \cdot
   * n\, dA@f$ [cm^dim/s] over the deformed faces @f$\Gamma@f$ of the part's surface that
   * look in a given direction in the undeformed part, with the velocity U of their nodes
   * and the velocity u of the grid. u is interpolated by composite B-splines
   * (coupling::FECoupling::velocities_at()), so that it is free of divergence and the
   * flow is that through every surface with the same rim. The rule on a face has four
   * points a grid spacing, more than the part's own coupling, which sees no difference of
   * u and U at its points.
   *
   * Also the volume that has passed since the first measurement, by the trapezoidal rule,
   * and the part of it that has passed in either direction (the integral of the flow's
   * magnitude).
   */
  template <int dim>
  class Leak : public Instrument<dim>
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
    void find_faces(const structure::Mesh<dim> &mesh);

    std::string name;
    std::string part;
    dealii::Tensor<1, dim> direction;

    /// Nodes of each face in an order in which its normal points out of the part.
    std::vector<std::vector<unsigned int>> faces;

    bool has_previous       = false;
    double previous_time    = 0;
    double previous_flow    = 0;
    double volume           = 0;
    double volume_both_ways = 0;
  };
} // namespace mitre::instruments

#endif
