#include <mitre/structure/constitutive_laws/volumetric_part.h>

namespace mitre::structure
{
  void VolumetricPart::declare_parameters(dealii::ParameterHandler &prm,
                                          const bool has_reference_stress)
  {
    if (has_reference_stress)
      prm.declare_entry("Reference stress",
                        "stress-free",
                        dealii::Patterns::Selection("stress-free|raw"),
                        "'stress-free' subtracts a multiple of F^-T, so that the "
                        "undeformed body carries no stress; 'raw' is the derivative of "
                        "the energy above alone. Without effect with the isochoric "
                        "split, which is free of stress by itself.");
    prm.declare_entry(
      "Bulk modulus",
      "0",
      dealii::Patterns::Double(0),
      "kappa of the volumetric energy [dyn/cm^2], which keeps elements from changing "
      "their volume where the discrete velocity would.");
    prm.declare_entry("Volumetric energy",
                      "log squared",
                      dealii::Patterns::Selection("log squared|quadratic|Simo-Taylor"),
                      "'log squared' is (kappa/2) (ln J)^2, 'quadratic' (kappa/2) "
                      "(J - 1)^2, 'Simo-Taylor' (kappa/4) (J^2 - 1 - 2 ln J).");
    prm.declare_entry("Isochoric split",
                      "false",
                      dealii::Patterns::Bool(),
                      "Whether the energy above is that of J^(-1/3) F, so that a change "
                      "of volume alone does not count in it.");
  }


  void VolumetricPart::parse_parameters(dealii::ParameterHandler &prm,
                                        const bool has_reference_stress)
  {
    stress_free  = !has_reference_stress || prm.get("Reference stress") == "stress-free";
    bulk_modulus = prm.get_double("Bulk modulus");
    const std::string energy = prm.get("Volumetric energy");
    form                     = energy == "quadratic"     ? Energy::quadratic
                               : energy == "Simo-Taylor" ? Energy::simo_taylor
                                                         : Energy::log_squared;
    isochoric_split          = prm.get_bool("Isochoric split");
  }


  void FibreCompression::declare_parameters(dealii::ParameterHandler &prm,
                                            const bool elastic_by_default)
  {
    prm.declare_entry("Fibres in compression",
                      elastic_by_default ? "elastic" : "slack",
                      dealii::Patterns::Selection("slack|elastic"),
                      "Whether shortened fibres carry nothing or go on by the same law.");
  }


  void FibreCompression::parse_parameters(dealii::ParameterHandler &prm)
  {
    elastic = prm.get("Fibres in compression") == "elastic";
  }
} // namespace mitre::structure
