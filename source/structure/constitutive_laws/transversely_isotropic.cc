#include <mitre/structure/constitutive_laws/transversely_isotropic.h>

namespace mitre::structure
{
  template <int dim>
  void TransverselyIsotropic<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    NeoHookeanMatrix::declare_parameters(prm, "1.7370e5");
    prm.declare_entry("a_f",
                      "3.1275e5",
                      dealii::Patterns::Double(0),
                      "a_f of a_f / (2 b_f) (exp(b_f (I_f - 1)^2) - 1) [dyn/cm^2].");
    prm.declare_entry("b_f",
                      "55.9258",
                      dealii::Patterns::Double(1e-6),
                      "b_f of a_f / (2 b_f) (exp(b_f (I_f - 1)^2) - 1).");
    FibreCompression::declare_parameters(prm);
  }


  template <int dim>
  void TransverselyIsotropic<dim>::parse_parameters(dealii::ParameterHandler &prm)
  {
    matrix.parse_parameters(prm);
    compression.parse_parameters(prm);
    a_f = prm.get_double("a_f");
    b_f = prm.get_double("b_f");
  }


  template class TransverselyIsotropic<2>;
  template class TransverselyIsotropic<3>;
} // namespace mitre::structure
