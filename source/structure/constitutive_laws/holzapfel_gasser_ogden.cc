#include <mitre/structure/constitutive_laws/holzapfel_gasser_ogden.h>

namespace mitre::structure
{
  template <int dim>
  void HolzapfelGasserOgden<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "mu",
      "7.64e4",
      dealii::Patterns::Double(0),
      "mu of (mu/2) (I1 - 3) [dyn/cm^2], the shear modulus of the matrix.");
    prm.declare_entry(
      "k1",
      "9.966e6",
      dealii::Patterns::Double(0),
      "k1 of k1 / (2 k2) (exp(k2 E^2) - 1), one for both families [dyn/cm^2].");
    prm.declare_entry("k2",
                      "524.6",
                      dealii::Patterns::Double(1e-6),
                      "k2 of k1 / (2 k2) (exp(k2 E^2) - 1).");
    prm.declare_entry("kappa",
                      "0.226",
                      dealii::Patterns::Double(0, 1. / 3),
                      "Dispersion of the fibres in E = kappa (I1 - 3) + (1 - 3 kappa) "
                      "(I4 - 1): from 0 (aligned) to 1/3 (isotropic).");
    FibreCompression::declare_parameters(prm);
    VolumetricPart::declare_parameters(prm, true);
  }


  template <int dim>
  void HolzapfelGasserOgden<dim>::parse_parameters(dealii::ParameterHandler &prm)
  {
    mu    = prm.get_double("mu");
    k1    = prm.get_double("k1");
    k2    = prm.get_double("k2");
    kappa = prm.get_double("kappa");
    compression.parse_parameters(prm);
    volumetric.parse_parameters(prm, true);
  }


  template class HolzapfelGasserOgden<2>;
  template class HolzapfelGasserOgden<3>;
} // namespace mitre::structure
