#ifndef mitre_structure_constitutive_laws_guccione_h
#define mitre_structure_constitutive_laws_guccione_h

#include <array>
#include <cmath>

#include <mitre/structure/constitutive_laws/energy_only_law.h>

namespace mitre::structure
{
  /**
   * Passive myocardium as a transversely isotropic Fung solid (Guccione, McCulloch and
   * Waldman 1991, J. Biomech. Eng. 113, 42-55), in the Green-Lagrange strain
   * @f$E = (C - I)/2@f$ with components along the fibres f and across them (c, r),
   * @f[ \hat W = \frac{C}{2} \left(e^Q - 1\right), \quad
   *     Q = b_f E_{ff}^2 + b_t (E_{cc}^2 + E_{rr}^2 + 2 E_{cr}^2) +
   *     2 b_{fs} (E_{fc}^2 + E_{fr}^2), @f]
   * completed by VolumetricPart. Whichever c and r, the brackets are
   * @f$E:E - 2 |E f|^2 + E_{ff}^2@f$ and @f$|E f|^2 - E_{ff}^2@f$. The stress is
   * differentiated automatically. By default C = 0.876 kPa, b_f = 18.48, b_t = 3.58,
   * b_fs = 1.627, their values for the canine left ventricle.
   *
   * As the law is one of the whole tissue, fibres are elastic in compression by default,
   * as in the paper; slack ones (see FibreCompression) leave out b_f's term.
   */
  template <int dim>
  class Guccione : public EnergyOnlyLaw<dim, Guccione<dim>>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm) override;

    VolumetricPart *volumetric_part() override
    {
      return &volumetric;
    }

    unsigned int n_fibre_families() const override
    {
      return 1;
    }

    template <typename Number = double>
    Number energy_at(const Deformation<dim, Number> &point) const
    {
      using std::exp;
      const Number scale = volumetric.scale(point.J);

      // Step 1: E, and E f.
      dealii::Tensor<2, dim, Number> E = point.C();
      Number E_E                       = 0.;
      if (dim == 2)
        E_E = 0.25 * (scale - 1.) * (scale - 1.);
      std::array<Number, dim> Ef;
      Number Ef_Ef = 0., E_ff = 0.;
      for (unsigned int i = 0; i < dim; ++i)
        {
          Ef[i] = 0.;
          for (unsigned int j = 0; j < dim; ++j)
            {
              E[i][j] = 0.5 * (scale * E[i][j] - (i == j ? 1. : 0.));
              E_E += E[i][j] * E[i][j];
              Ef[i] += E[i][j] * point.fibres[0][j];
            }
          Ef_Ef += Ef[i] * Ef[i];
          E_ff += Ef[i] * point.fibres[0][i];
        }

      // Step 2: the exponent.
      Number Q =
        b_t * (E_E - 2. * Ef_Ef + E_ff * E_ff) + 2. * b_fs * (Ef_Ef - E_ff * E_ff);
      if (compression.elastic || E_ff > 0.)
        Q += b_f * E_ff * E_ff;
      return 0.5 * C * (exp(Q) - 1.) + volumetric.energy(point.J, 0);
    }

  private:
    /// [dyn/cm^2]
    double C = 0;

    double b_f = 0, b_t = 0, b_fs = 0;

    VolumetricPart volumetric;
    FibreCompression compression;
  };
} // namespace mitre::structure

#endif
