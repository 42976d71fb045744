#include <mitre/structure/loads/pressure.h>

namespace mitre::structure
{
  template <int dim>
  void Pressure<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    TimeFunction::declare_parameters(prm,
                                     "Pressure",
                                     "0",
                                     "Expression of the time t [s] that gives the "
                                     "pressure [dyn/cm^2], against the outward normal; "
                                     "'10 * mmHg' is 10 mmHg.",
                                     "with a unit of pressure, such as [mmHg]");
    prm.declare_entry(
      "Surface",
      "deformed",
      dealii::Patterns::Selection("deformed|reference"),
      "Whether the pressure acts on the surface as it is now, and follows "
      "its normal, or is a dead load on the reference surface.");
    SurfaceRegion<dim>::declare_parameters(prm);
  }


  template <int dim>
  void Pressure<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                       const std::string &what)
  {
    pressure.parse_parameters(prm, "Pressure", "0", what, "pressure");
    follower = prm.get("Surface") == "deformed";
    this->surface.parse_parameters(prm, what);
  }


  template <int dim>
  void Pressure<dim>::add_forces(const NodalState &state, double *forces) const
  {
    const double p = pressure.value(state.t);
    if (p == 0)
      return;
    this->surface.add_forces(
      state,
      [&](const SurfacePoint<dim> &point) {
        return -p * (follower ? point.area : point.reference_area);
      },
      forces);
  }


  template class Pressure<2>;
  template class Pressure<3>;
} // namespace mitre::structure
