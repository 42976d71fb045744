#include <mitre/structure/constitutive_laws/may_newman_yin.h>

namespace mitre::structure
{
  template <int dim>
  void MayNewmanYin<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "c0",
      "3990",
      dealii::Patterns::Double(0),
      "c0 of c0 (exp(c1 (I1 - 3)^2 + c2 (sqrt(I4) - 1)^4) - 1) [dyn/cm^2].");
    prm.declare_entry("c1",
                      "4.325",
                      dealii::Patterns::Double(0),
                      "c1 of c0 (exp(c1 (I1 - 3)^2 + c2 (sqrt(I4) - 1)^4) - 1).");
    prm.declare_entry("c2",
                      "1446.5",
                      dealii::Patterns::Double(0),
                      "c2 of c0 (exp(c1 (I1 - 3)^2 + c2 (sqrt(I4) - 1)^4) - 1).");
    FibreCompression::declare_parameters(prm);
    VolumetricPart::declare_parameters(prm, false);
  }


  template <int dim>
  void MayNewmanYin<dim>::parse_parameters(dealii::ParameterHandler &prm)
  {
    c0 = prm.get_double("c0");
    c1 = prm.get_double("c1");
    c2 = prm.get_double("c2");
    compression.parse_parameters(prm);
    volumetric.parse_parameters(prm, false);
  }


  template class MayNewmanYin<2>;
  template class MayNewmanYin<3>;
} // namespace mitre::structure
