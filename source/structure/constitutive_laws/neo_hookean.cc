#include <mitre/structure/constitutive_laws/neo_hookean.h>

namespace mitre::structure
{
  void NeoHookeanMatrix::declare_parameters(dealii::ParameterHandler &prm,
                                            const std::string &default_C1)
  {
    prm.declare_entry("C1",
                      default_C1,
                      dealii::Patterns::Double(0),
                      "C1 of C1 (I1 - 3) [dyn/cm^2]: half of the shear modulus.");
    VolumetricPart::declare_parameters(prm, true);
  }


  void NeoHookeanMatrix::parse_parameters(dealii::ParameterHandler &prm)
  {
    C1 = prm.get_double("C1");
    volumetric.parse_parameters(prm, true);
  }


  template <int dim>
  void NeoHookean<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    NeoHookeanMatrix::declare_parameters(prm, "1e5");
  }


  template <int dim>
  void NeoHookean<dim>::parse_parameters(dealii::ParameterHandler &prm)
  {
    matrix.parse_parameters(prm);
  }


  template class NeoHookean<2>;
  template class NeoHookean<3>;
} // namespace mitre::structure
