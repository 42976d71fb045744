// The stress that Sacado derives from the energy of the Guccione law as it is written
// down here, and that of the law of the registry, against the one in the frame of the
// fibres: with E = R^T (F^T F - I)/2 R, the columns of R being f, c and r, S_ff = C
// exp(Q) b_f E_ff, S_cc = C exp(Q) b_t E_cc, S_cr = C exp(Q) b_t E_cr, S_fc = C exp(Q)
// b_fs E_fc, and so on, P = F R S R^T + kappa ln(J) F^-T. All are exact, so that they
// agree to round-off. In 2D, plane strain.

#include <mitre/structure/constitutive_laws/energy_only_law.h>

#include "structure_tests.h"

using namespace structure_tests;

constexpr double C = 8760, b_f = 18.48, b_t = 3.58, b_fs = 1.627, bulk_modulus = 2e5;

/// Fibres are slack in compression.
template <int dim>
class EnergyOnlyGuccione : public EnergyOnlyLaw<dim, EnergyOnlyGuccione<dim>>
{
public:
  void parse_parameters(dealii::ParameterHandler &) override
  {
  }

  template <typename Number = double>
  Number energy_at(const Deformation<dim, Number> &point) const
  {
    using std::exp;
    using std::log;
    const dealii::Tensor<2, dim, Number> right = point.C();
    const dealii::Tensor<1, dim> &f            = point.fibres[0];
    Number E_E = 0., Ef_Ef = 0., E_ff = 0.;
    for (unsigned int i = 0; i < dim; ++i)
      {
        Number Ef = 0.;
        for (unsigned int j = 0; j < dim; ++j)
          {
            const Number E = 0.5 * (right[i][j] - (i == j ? 1. : 0.));
            E_E += E * E;
            Ef += E * f[j];
          }
        Ef_Ef += Ef * Ef;
        E_ff += Ef * f[i];
      }
    Number Q = b_t * (E_E - 2. * Ef_Ef + E_ff * E_ff) + 2. * b_fs * (Ef_Ef - E_ff * E_ff);
    if (E_ff > 0.)
      Q += b_f * E_ff * E_ff;
    return 0.5 * C * (exp(Q) - 1.) + 0.5 * bulk_modulus * log(point.J) * log(point.J);
  }
};

template <int dim>
void
check(const bool stretched)
{
  dealii::Tensor<2, dim> F, R;
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = 0; j < dim; ++j)
      F[i][j] =
        (i == j ? (stretched ? 1.1 : 0.9) : 0.) + 0.05 * std::sin(1. + 3 * i + 5 * j);
  const double angle = 0.7;
  R[0][0]            = std::cos(angle);
  R[1][0]            = std::sin(angle);
  R[0][1]            = -std::sin(angle);
  R[1][1]            = std::cos(angle);
  if (dim == 3)
    R[2][2] = 1;
  Fibres<dim> fibres;
  for (unsigned int i = 0; i < dim; ++i)
    fibres[0][i] = R[i][0];

  dealii::Tensor<2, dim> E = transpose(F) * F;
  for (unsigned int i = 0; i < dim; ++i)
    E[i][i] -= 1;
  E = 0.5 * (transpose(R) * E * R);

  // Slack fibres leave out the term of E_ff.
  double Q = 0;
  dealii::Tensor<2, dim> S;
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = 0; j < dim; ++j)
      {
        const double b =
          i == 0 && j == 0 ? (stretched ? b_f : 0) : (i == 0 || j == 0 ? b_fs : b_t);
        Q += b * E[i][j] * E[i][j];
        S[i][j] = b * E[i][j];
      }
  const double J                 = determinant(F);
  const dealii::Tensor<2, dim> P = C * std::exp(Q) * (F * R * S * transpose(R)) +
                                   bulk_modulus * std::log(J) * transpose(invert(F));

  const dealii::Tensor<2, dim> automatic =
    EnergyOnlyGuccione<dim>().first_piola_kirchhoff_stress(F, fibres, 0.);
  const dealii::Tensor<2, dim> registered =
    make_law<dim>("Guccione", "set Bulk modulus = 2e5\nset Fibres in compression = slack")
      ->first_piola_kirchhoff_stress(F, fibres, 0.);
  std::cout << dim << "D, " << (stretched ? "stretched" : "shortened") << ": "
            << below((automatic - P).norm() / P.norm(), 1e-13) << ", "
            << below((registered - P).norm() / P.norm(), 1e-13) << std::endl;
}

int
main()
{
  for (const bool stretched : {true, false})
    {
      check<2>(stretched);
      check<3>(stretched);
    }
}
