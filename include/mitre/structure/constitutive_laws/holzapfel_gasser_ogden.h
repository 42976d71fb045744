#ifndef mitre_structure_constitutive_laws_holzapfel_gasser_ogden_h
#define mitre_structure_constitutive_laws_holzapfel_gasser_ogden_h

#include <cmath>

#include <mitre/structure/constitutive_laws/volumetric_part.h>

namespace mitre::structure
{
  /**
   * Arterial tissue with two families of dispersed collagen fibres (Gasser, Ogden and
   * Holzapfel 2006, J. R. Soc. Interface 3, 15-35),
   * @f[ \hat W = \frac{\mu}{2} (I_1 - 3) +
   *     \frac{k_1}{2 k_2} \sum_{i=1,2} \left(e^{k_2 E_i^2} - 1\right), \quad
   *     E_i = \kappa (I_1 - 3) + (1 - 3\kappa)(I_{4i} - 1), @f]
   * @f[ \hat S = \mu I + 2 k_1 \sum_i E_i e^{k_2 E_i^2}
   *     \left(\kappa I + (1 - 3\kappa) f_i \otimes f_i\right), \quad p_0 = \mu, @f]
   * with @f$I_{4i} = |F f_i|^2@f$ and the dispersion @f$\kappa@f$ between 0 (all fibres
   * along @f$f_i@f$) and 1/3 (isotropic); completed by VolumetricPart. A family is slack
   * (see FibreCompression) where @f$E_i \le 0@f$, so that energy and stress are
   * continuous. Their constants for the adventitia of a human iliac artery are the
   * defaults: mu = 7.64 kPa, k_1 = 996.6 kPa, k_2 = 524.6, kappa = 0.226 (fibres at 49.98
   * degrees to the circumference).
   */
  template <int dim>
  class HolzapfelGasserOgden : public ConstitutiveLawBase<dim, HolzapfelGasserOgden<dim>>
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
      return 2;
    }

    bool is_stress_free_in_reference() const override
    {
      return volumetric.is_stress_free_in_reference();
    }

    double energy_at(const Deformation<dim> &point) const
    {
      const double scale = volumetric.scale(point.J);
      const double I1    = scale * point.I1();
      double energy      = 0.5 * mu * (I1 - 3) + volumetric.energy(point.J, mu);
      for (unsigned int f = 0; f < 2; ++f)
        {
          const double I4 = scale * (point.F * point.fibres[f]).norm_square();
          const double E  = kappa * (I1 - 3) + (1 - 3 * kappa) * (I4 - 1);
          if (compression.fibres_carry(E))
            energy += k1 / (2 * k2) * std::expm1(k2 * E * E);
        }
      return energy;
    }

    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const
    {
      const double scale = volumetric.scale(point.J);
      const double I1    = scale * point.I1();
      double diagonal    = mu;
      dealii::Tensor<2, dim> FS;
      for (unsigned int f = 0; f < 2; ++f)
        {
          const dealii::Tensor<1, dim> fibre = point.F * point.fibres[f];
          const double I4                    = scale * fibre.norm_square();
          const double E = kappa * (I1 - 3) + (1 - 3 * kappa) * (I4 - 1);
          if (compression.fibres_carry(E))
            {
              const double slope = 2 * k1 * E * std::exp(k2 * E * E);
              diagonal += slope * kappa;
              FS += outer_product((slope * (1 - 3 * kappa)) * fibre, point.fibres[f]);
            }
        }
      FS += diagonal * point.F;
      return volumetric.stress(point, scale, FS, diagonal, mu);
    }

  private:
    /// [dyn/cm^2]
    double mu = 0, k1 = 0;

    double k2 = 1, kappa = 0;

    VolumetricPart volumetric;
    FibreCompression compression;
  };
} // namespace mitre::structure

#endif
