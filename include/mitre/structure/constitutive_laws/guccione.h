#ifndef mitre_structure_constitutive_laws_guccione_h
#define mitre_structure_constitutive_laws_guccione_h

#include <cmath>

#include <mitre/structure/constitutive_laws/volumetric_part.h>

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
   * @f$E:E - 2 |E f|^2 + E_{ff}^2@f$ and @f$|E f|^2 - E_{ff}^2@f$, so that
   * @f[ \frac{\partial \hat W}{\partial E} = C e^Q \left[b_t E +
   *     (b_{fs} - b_t) (E f \otimes f + f \otimes E f) +
   *     (b_t - 2 b_{fs} + b_f) E_{ff}\, f \otimes f\right]. @f]
   * By default C = 0.876 kPa, b_f = 18.48, b_t = 3.58,
   * b_fs = 1.627, their values for the canine left ventricle.
   *
   * As the law is one of the whole tissue, fibres are elastic in compression by default,
   * as in the paper; slack ones (see FibreCompression) leave out b_f's term.
   */
  template <int dim>
  class Guccione : public ConstitutiveLawBase<dim, Guccione<dim>>
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

    double energy_at(const Deformation<dim> &point) const
    {
      return 0.5 * C * (std::exp(strain_of(point).Q) - 1.) +
             volumetric.energy(point.J, 0);
    }

    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const
    {
      const Strain strain             = strain_of(point);
      const dealii::Tensor<1, dim> &f = point.fibres[0];
      const double factor             = C * std::exp(strain.Q);
      const double along              = b_t - 2. * b_fs + fibre_factor(strain.E_ff);

      dealii::Tensor<2, dim> S;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          S[i][j] = factor * (b_t * strain.E[i][j] +
                              (b_fs - b_t) * (strain.Ef[i] * f[j] + f[i] * strain.Ef[j]) +
                              along * strain.E_ff * f[i] * f[j]);
      return volumetric.stress(
        point, strain.scale, point.F * S, factor * b_t * strain.E_33, 0.);
    }

  private:
    /// [dyn/cm^2]
    double C = 0;

    double b_f = 0, b_t = 0, b_fs = 0;

    /// The strain of the energy's argument, and its exponent.
    struct Strain
    {
      dealii::Tensor<2, dim> E;
      dealii::Tensor<1, dim> Ef;
      double E_ff, E_33, scale, Q;
    };

    /// b_f, or 0 where fibres are slack.
    double fibre_factor(const double E_ff) const
    {
      return compression.fibres_carry(E_ff) ? b_f : 0.;
    }

    Strain strain_of(const Deformation<dim> &point) const
    {
      Strain strain;
      strain.scale = volumetric.scale(point.J);
      strain.E     = (0.5 * strain.scale) * point.C();
      for (unsigned int i = 0; i < dim; ++i)
        strain.E[i][i] -= 0.5;
      strain.E_33        = dim == 2 ? 0.5 * (strain.scale - 1.) : 0.;
      strain.Ef          = strain.E * point.fibres[0];
      strain.E_ff        = strain.Ef * point.fibres[0];
      const double E_E   = scalar_product(strain.E, strain.E) + strain.E_33 * strain.E_33;
      const double Ef_Ef = strain.Ef * strain.Ef;
      const double E_ff_ff = strain.E_ff * strain.E_ff;
      strain.Q = b_t * (E_E - 2. * Ef_Ef + E_ff_ff) + 2. * b_fs * (Ef_Ef - E_ff_ff) +
                 fibre_factor(strain.E_ff) * E_ff_ff;
      return strain;
    }

    VolumetricPart volumetric;
    FibreCompression compression;
  };
} // namespace mitre::structure

#endif
