#include <mitre/structure/loads/traction.h>

namespace mitre::structure
{
  template <int dim>
  void Traction<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    VectorExpression<dim>::declare_parameters(
      prm, "Traction", "Force per area of the reference surface [dyn/cm^2]");
    TimeFunction::declare_parameters(prm,
                                     "Time factor",
                                     "1",
                                     "Expression of the time t [s] that multiplies the "
                                     "traction.",
                                     "with the unit [1]");
    SurfaceRegion<dim>::declare_parameters(prm);
  }


  template <int dim>
  void Traction<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                       const std::string &what)
  {
    traction.parse_parameters(prm, "Traction", what);
    factor.parse_parameters(prm, "Time factor", "1", what, "number");
    this->surface.parse_parameters(prm, what);
  }


  template <int dim>
  void Traction<dim>::add_forces(const NodalState &state, double *forces) const
  {
    const double f = factor.value(state.t);
    this->surface.add_forces(
      state,
      [&](const SurfacePoint<dim> &point) {
        return f * point.reference_area.norm() * traction.value(point.s, state.t);
      },
      forces);
  }


  template class Traction<2>;
  template class Traction<3>;
} // namespace mitre::structure
