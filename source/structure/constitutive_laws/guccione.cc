#include <mitre/structure/constitutive_laws/guccione.h>

namespace mitre::structure
{
  template <int dim>
  void Guccione<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "C", "8760", dealii::Patterns::Double(0), "C of (C/2) (exp(Q) - 1) [dyn/cm^2].");
    prm.declare_entry("b_f",
                      "18.48",
                      dealii::Patterns::Double(0),
                      "Factor in Q of the square of the strain along the fibres.");
    prm.declare_entry("b_t",
                      "3.58",
                      dealii::Patterns::Double(0),
                      "Factor in Q of the squares of the strains across the fibres.");
    prm.declare_entry("b_fs",
                      "1.627",
                      dealii::Patterns::Double(0),
                      "Factor in Q of twice the squares of the shear strains of fibres "
                      "against what is across.");
    FibreCompression::declare_parameters(prm, true);
    VolumetricPart::declare_parameters(prm, false);
  }


  template <int dim>
  void Guccione<dim>::parse_parameters(dealii::ParameterHandler &prm)
  {
    C    = prm.get_double("C");
    b_f  = prm.get_double("b_f");
    b_t  = prm.get_double("b_t");
    b_fs = prm.get_double("b_fs");
    compression.parse_parameters(prm);
    volumetric.parse_parameters(prm, false);
  }


  template class Guccione<2>;
  template class Guccione<3>;
} // namespace mitre::structure
