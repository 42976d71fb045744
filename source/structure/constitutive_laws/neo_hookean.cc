#include <mitre/structure/constitutive_laws/neo_hookean.h>

namespace mitre::structure
{
  void NeoHookeanMatrix::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("C1",
                      "1e5",
                      dealii::Patterns::Double(0),
                      "C1 of C1 (I1 - 3) [dyn/cm^2]: half of the shear modulus.");
    prm.declare_entry("Reference stress",
                      "stress-free",
                      dealii::Patterns::Selection("stress-free|raw"),
                      "'stress-free' subtracts 2 C1 F^-T, so that the undeformed body "
                      "carries no stress; 'raw' is the derivative of C1 (I1 - 3) alone.");
    prm.declare_entry(
      "Bulk modulus",
      "0",
      dealii::Patterns::Double(0),
      "kappa of the volumetric energy (kappa/2) (ln J)^2 [dyn/cm^2], which "
      "keeps elements from changing their volume where the discrete "
      "velocity would.");
  }


  void NeoHookeanMatrix::parse_parameters(dealii::ParameterHandler &prm)
  {
    C1           = prm.get_double("C1");
    bulk_modulus = prm.get_double("Bulk modulus");
    stress_free  = prm.get("Reference stress") == "stress-free";
  }


  template <int dim>
  void NeoHookean<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    NeoHookeanMatrix::declare_parameters(prm);
  }


  template <int dim>
  void NeoHookean<dim>::parse_parameters(dealii::ParameterHandler &prm)
  {
    matrix.parse_parameters(prm);
  }


  template class NeoHookean<2>;
  template class NeoHookean<3>;
} // namespace mitre::structure
