#include <mitre/structure/constitutive_laws/st_venant_kirchhoff.h>

namespace mitre::structure
{
  template <int dim>
  void StVenantKirchhoff<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "lambda",
      "2e7",
      dealii::Patterns::Double(0),
      "First of Lame's constants, of (lambda/2) (tr E)^2 + mu E:E [dyn/cm^2].");
    prm.declare_entry(
      "mu", "5e6", dealii::Patterns::Double(0), "Shear modulus [dyn/cm^2].");
    VolumetricPart::declare_parameters(prm, false);
  }


  template <int dim>
  void StVenantKirchhoff<dim>::parse_parameters(dealii::ParameterHandler &prm)
  {
    lambda = prm.get_double("lambda");
    mu     = prm.get_double("mu");
    volumetric.parse_parameters(prm, false);
  }


  template class StVenantKirchhoff<2>;
  template class StVenantKirchhoff<3>;
} // namespace mitre::structure
