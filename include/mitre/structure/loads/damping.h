#ifndef mitre_structure_loads_damping_h
#define mitre_structure_loads_damping_h

#include <mitre/structure/loads/load.h>
#include <mitre/structure/time_function.h>

namespace mitre::structure
{
  /**
   * A drag that slows a body down wherever it is, @f$G_a = -\int_U \eta\,\phi_a\,U\,ds@f$
   * with @f$\eta@f$ [dyn s/cm^4]. An explicit time step bounds it: with a body of the
   * fluid's density @f$\rho@f$, @f$\eta \lesssim \rho/\Delta t@f$.
   */
  template <int dim>
  class Damping : public Load<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &what) override;

    void initialize(const Mesh<dim> &) override
    {
    }

    void reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements) override
    {
      volume.reinit(mesh, elements);
    }

    unsigned int n_elements() const override
    {
      return volume.n_elements();
    }

    void add_forces(const NodalState &state, double *forces) const override;

  private:
    VolumeRegion<dim> volume;

    /// [dyn s/cm^4]
    TimeFunction damping;
  };
} // namespace mitre::structure

#endif
