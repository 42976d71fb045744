#include <mitre/structure/constitutive_laws/mooney_rivlin.h>

namespace mitre::structure
{
  template <int dim>
  void MooneyRivlin<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("C1",
                      "9000",
                      dealii::Patterns::Double(0),
                      "C1 of C1 (I1 - 3) + C2 (I2 - 3) [dyn/cm^2].");
    prm.declare_entry("C2",
                      "9000",
                      dealii::Patterns::Double(0),
                      "C2 of C1 (I1 - 3) + C2 (I2 - 3) [dyn/cm^2].");
    VolumetricPart::declare_parameters(prm, true);
  }


  template <int dim>
  void MooneyRivlin<dim>::parse_parameters(dealii::ParameterHandler &prm)
  {
    C1 = prm.get_double("C1");
    C2 = prm.get_double("C2");
    volumetric.parse_parameters(prm, true);
  }


  template class MooneyRivlin<2>;
  template class MooneyRivlin<3>;
} // namespace mitre::structure
