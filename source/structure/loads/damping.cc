#include <mitre/structure/loads/damping.h>

namespace mitre::structure
{
  template <int dim>
  void Damping<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    TimeFunction::declare_parameters(prm,
                                     "Damping",
                                     "0",
                                     "Expression of the time t [s] that gives eta of the "
                                     "force -eta U per reference volume [dyn s/cm^4]; "
                                     "stable up to about rho/dt.",
                                     "whose values are taken as [dyn s/cm^4]");
    VolumeRegion<dim>::declare_parameters(prm);
  }


  template <int dim>
  void Damping<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                      const std::string &what)
  {
    damping.parse_parameters(prm, "Damping", "0", what, "");
    this->volume.parse_parameters(prm, what);
  }


  template <int dim>
  void Damping<dim>::add_forces(const NodalState &state, double *forces) const
  {
    const double eta = damping.value(state.t);
    this->volume.add_forces(
      state,
      [&](const VolumePoint<dim> &point) { return -eta * point.volume * point.u; },
      forces);
  }


  template class Damping<2>;
  template class Damping<3>;
} // namespace mitre::structure
