#include <mitre/structure/loads/body_force.h>

namespace mitre::structure
{
  template <int dim>
  void BodyForce<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    VectorExpression<dim>::declare_parameters(
      prm, "Force", "Force per reference volume [dyn/cm^3]");
    TimeFunction::declare_parameters(prm,
                                     "Time factor",
                                     "1",
                                     "Expression of the time t [s] that multiplies the "
                                     "force.",
                                     "with the unit [1]");
    VolumeRegion<dim>::declare_parameters(prm);
  }


  template <int dim>
  void BodyForce<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                        const std::string &what)
  {
    force.parse_parameters(prm, "Force", what);
    factor.parse_parameters(prm, "Time factor", "1", what, "number");
    this->volume.parse_parameters(prm, what);
  }


  template <int dim>
  void BodyForce<dim>::add_forces(const NodalState &state, double *forces) const
  {
    const double f = factor.value(state.t);
    this->volume.add_forces(
      state,
      [&](const VolumePoint<dim> &point) {
        return f * point.volume * force.value(point.s, state.t);
      },
      forces);
  }


  template class BodyForce<2>;
  template class BodyForce<3>;
} // namespace mitre::structure
