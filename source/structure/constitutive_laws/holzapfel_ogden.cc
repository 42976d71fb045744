#include <mitre/structure/constitutive_laws/holzapfel_ogden.h>

namespace mitre::structure
{
  template <int dim>
  void HolzapfelOgden<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("a",
                      "590",
                      dealii::Patterns::Double(0),
                      "a of a / (2 b) (exp(b (I1 - 3)) - 1) [dyn/cm^2].");
    prm.declare_entry("b",
                      "8.023",
                      dealii::Patterns::Double(1e-6),
                      "b of a / (2 b) (exp(b (I1 - 3)) - 1).");
    prm.declare_entry(
      "a_f",
      "1.8472e5",
      dealii::Patterns::Double(0),
      "a_f of a_f / (2 b_f) (exp(b_f (I4f - 1)^2) - 1), along the fibres [dyn/cm^2].");
    prm.declare_entry("b_f",
                      "16.026",
                      dealii::Patterns::Double(1e-6),
                      "b_f of a_f / (2 b_f) (exp(b_f (I4f - 1)^2) - 1).");
    prm.declare_entry(
      "a_s",
      "2.481e4",
      dealii::Patterns::Double(0),
      "a_s of a_s / (2 b_s) (exp(b_s (I4s - 1)^2) - 1), along the sheets [dyn/cm^2].");
    prm.declare_entry("b_s",
                      "11.12",
                      dealii::Patterns::Double(1e-6),
                      "b_s of a_s / (2 b_s) (exp(b_s (I4s - 1)^2) - 1).");
    prm.declare_entry("a_fs",
                      "2160",
                      dealii::Patterns::Double(0),
                      "a_fs of a_fs / (2 b_fs) (exp(b_fs I8^2) - 1), shear of fibres "
                      "against sheets [dyn/cm^2].");
    prm.declare_entry("b_fs",
                      "11.436",
                      dealii::Patterns::Double(1e-6),
                      "b_fs of a_fs / (2 b_fs) (exp(b_fs I8^2) - 1).");
    FibreCompression::declare_parameters(prm);
    VolumetricPart::declare_parameters(prm, true);
  }


  template <int dim>
  void HolzapfelOgden<dim>::parse_parameters(dealii::ParameterHandler &prm)
  {
    a    = prm.get_double("a");
    b    = prm.get_double("b");
    a_i  = {{prm.get_double("a_f"), prm.get_double("a_s")}};
    b_i  = {{prm.get_double("b_f"), prm.get_double("b_s")}};
    a_fs = prm.get_double("a_fs");
    b_fs = prm.get_double("b_fs");
    compression.parse_parameters(prm);
    volumetric.parse_parameters(prm, true);
  }


  template class HolzapfelOgden<2>;
  template class HolzapfelOgden<3>;
} // namespace mitre::structure
