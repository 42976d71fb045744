#ifndef mitre_instruments_energy_h
#define mitre_instruments_energy_h

#include <mitre/instruments/instrument.h>

namespace mitre::instruments
{
  /**
   * Kinetic energy of the fluid, @f$\frac{\rho}{2}\sum_f W_f u_f^2@f$ with the control
   * volumes W of the faces, and strain energy of all parts together.
   *
   * With a budget, also the power of the open boundaries, that is, of their pressures and
   * of the kinetic energy that the fluid carries in less that which it carries out,
   * @f$\oint (p + \frac{\rho}{2} u_n^2)\, u_n\, dA@f$ with u_n inward and the pressure p
   * that holds there (less what backflow stabilisation takes), and the viscous
   * dissipation @f$-\mu \sum_f W_f u_f (\nabla^2 u)_f@f$ [erg/s], both by the velocity
   * now. For a fluid that is not accelerated and touches nothing but walls at rest they
   * are equal, but for what the advection scheme dissipates. The work of constraints and
   * loads is not in it.
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
    double compute_boundary_power(const Observation<dim> &observation) const;

    std::string name;
    bool has_budget = false;
  };
} // namespace mitre::instruments

#endif
