#ifndef mitre_structure_loads_pressure_h
#define mitre_structure_loads_pressure_h

#include <mitre/structure/loads/region_loads.h>
#include <mitre/structure/time_function.h>

namespace mitre::structure
{
  /**
   * A pressure p [dyn/cm^2] on the surface of a body, that pushes inward if it is
   * positive. As a follower load it acts on the deformed surface, and turns and grows
   * with it,
   * @f[ G_a = -\int_{\partial\Omega} p\,\phi_a\,n\,da; @f]
   * as a dead load on the reference surface,
   * @f$G_a = -\int_{\partial U} p\,\phi_a\,N\,dA@f$.
   *
   * Bonet and Wood (2008), Nonlinear Continuum Mechanics for Finite Element Analysis,
   * section 8.5. Follower forces on a closed surface add up to no force and no torque.
   */
  template <int dim>
  class Pressure : public SurfaceLoad<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &what) override;

    void add_forces(const NodalState &state, double *forces) const override;

  private:
    /// [dyn/cm^2]
    TimeFunction pressure;

    bool follower = true;
  };
} // namespace mitre::structure

#endif
