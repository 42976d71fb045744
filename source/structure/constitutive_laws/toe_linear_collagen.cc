#include <mitre/structure/constitutive_laws/toe_linear_collagen.h>

namespace mitre::structure
{
  template <int dim>
  void ToeLinearCollagen<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    NeoHookeanMatrix::declare_parameters(prm, "2.9e5");
    prm.declare_entry(
      "Linear modulus",
      "7.41e8",
      dealii::Patterns::Double(0),
      "Slope of tension per reference area over stretch beyond the toe [dyn/cm^2].");
    prm.declare_entry(
      "Transition stretch",
      "1.22",
      dealii::Patterns::Double(1),
      "Stretch at which the exponential toe ends and the linear part begins.");
    prm.declare_entry("Toe exponent",
                      "58.3",
                      dealii::Patterns::Double(1e-6),
                      "alpha of the tension k (exp(alpha (stretch - 1)) - 1) in the toe; "
                      "k follows, as the slope is continuous.");
    FibreCompression::declare_parameters(prm);
  }


  template <int dim>
  void ToeLinearCollagen<dim>::parse_parameters(dealii::ParameterHandler &prm)
  {
    matrix.parse_parameters(prm);
    linear_modulus    = prm.get_double("Linear modulus");
    transition_strain = prm.get_double("Transition stretch") - 1;
    toe_exponent      = prm.get_double("Toe exponent");
    toe_modulus =
      linear_modulus * std::exp(-toe_exponent * transition_strain) / toe_exponent;
    compression.parse_parameters(prm);
  }


  template class ToeLinearCollagen<2>;
  template class ToeLinearCollagen<3>;
} // namespace mitre::structure
