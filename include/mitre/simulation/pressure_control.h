#ifndef mitre_simulation_pressure_control_h
#define mitre_simulation_pressure_control_h

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

#include <mitre/fluid/boundary_conditions/pressure.h>
#include <mitre/fluid/navier_stokes.h>
#include <mitre/instruments/pressure_difference.h>

namespace mitre::simulation
{
  /**
   * Adjusts the pressure that drives a flow so that the difference @f$\Delta p@f$ between
   * two stations follows a target curve, as a pressure measured there: the boundary
   * condition of a given name has its own pressure plus a shift s, for which
   * @f[ \tau \frac{ds}{dt} = \Delta p_\mathrm{target}(t) - \Delta p(t),
   *     \qquad |s| \le s_\mathrm{max}, \qquad s(0) = 0. @f]
   * After a step from t to t + dt, in which s was constant, s is changed by
   * @f$(dt/\tau)(\Delta p_\mathrm{target} - \Delta p)@f$ with both at t + dt/2, the time
   * of the pressure.
   *
   * An incompressible flow has the new pressure at once. If a part a <= 1 of the shift
   * arrives between the stations, the difference approaches its target by
   * exp(-a t/tau), and the control is stable for a dt < 2 tau. With the target as the
   * boundary's own pressure, s is what the tube before and behind the stations takes
   * (dP_shift of section 3.4).
   */
  template <int dim>
  class PressureControl
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    /// Throws base::UserError if the condition is not there or is none of a given
    /// pressure. @p conditions must outlive this.
    void parse_parameters(dealii::ParameterHandler &prm,
                          const fluid::BoundaryConditions<dim> &conditions);

    /// Whether a condition is adjusted.
    bool is_active() const
    {
      return condition != nullptr;
    }

    /// After a step of length @p dt that began at @p t [s]. Collective.
    void update(const fluid::NavierStokes<dim> &fluid, const double t, const double dt);

    /// Names with units of what values() returns; empty if there is no control.
    std::vector<std::string> columns() const;

    /// The shift in the last step, and measured difference and target after it.
    const std::vector<double> &values() const
    {
      return last_values;
    }

    /// What later steps depend on, for checkpoints.
    std::vector<double> state() const;
    void set_state(const std::vector<double> &state);

  private:
    const fluid::PressureCondition<dim> *condition = nullptr;
    fluid::GivenPressure<dim> target;
    instruments::StationPair<dim> stations;
    double time_constant = 0., largest_shift = 0.;

    /// [dyn/cm^2]
    double shift = 0.;
    std::vector<double> last_values;
  };
} // namespace mitre::simulation

#endif
