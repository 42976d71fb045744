#ifndef mitre_structure_loads_damping_h
#define mitre_structure_loads_damping_h

#include <mitre/structure/loads/region_loads.h>
#include <mitre/structure/time_function.h>

namespace mitre::structure
{
  /**
   * A drag that slows a body down wherever it is, @f$G_a = -\int_U \eta\,\phi_a\,U\,ds@f$
   * with @f$\eta@f$ [dyn s/cm^4]. An explicit time step bounds it: with a body of the
   * fluid's density @f$\rho@f$, @f$\eta \lesssim \rho/\Delta t@f$.
   */
  template <int dim>
  class Damping : public VolumeLoad<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &what) override;

    void add_forces(const NodalState &state, double *forces) const override;

  private:
    /// [dyn s/cm^4]
    TimeFunction damping;
  };
} // namespace mitre::structure

#endif
