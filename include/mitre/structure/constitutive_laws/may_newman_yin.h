#ifndef mitre_structure_constitutive_laws_may_newman_yin_h
#define mitre_structure_constitutive_laws_may_newman_yin_h

#include <cmath>

#include <mitre/structure/constitutive_laws/volumetric_part.h>

namespace mitre::structure
{
  /**
   * Mitral valve leaflets (May-Newman and Yin 1998, J. Biomech. Eng. 120, 38-47), with
   * @f$\alpha = \sqrt{I_4} = |F f_0|@f$ along the fibres,
   * @f[ \hat W = c_0 \left(e^{c_1 (I_1 - 3)^2 + c_2 (\alpha - 1)^4} - 1\right), \quad
   *     \hat S = 4 c_0 e^{...} \left(c_1 (I_1 - 3) I +
   *     c_2 \frac{(\alpha - 1)^3}{\alpha} f_0 \otimes f_0\right), \quad p_0 = 0, @f]
   * completed by VolumetricPart. Slack fibres (see FibreCompression) leave out the second
   * term of the exponent. It has no stiffness at all in the reference configuration. The
   * defaults are theirs for the anterior leaflet of pigs: c_0 = 0.399 kPa, c_1 = 4.325,
   * c_2 = 1446.5 (posterior: 0.414 kPa, 4.848, 305.4).
   */
  template <int dim>
  class MayNewmanYin : public ConstitutiveLawBase<dim, MayNewmanYin<dim>>
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
      const double scale   = volumetric.scale(point.J);
      const double I1      = scale * point.I1();
      const double stretch = std::sqrt(scale) * (point.F * point.fibres[0]).norm();
      return c0 * std::expm1(exponent(I1, stretch)) + volumetric.energy(point.J, 0);
    }

    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const
    {
      const double scale                 = volumetric.scale(point.J);
      const double I1                    = scale * point.I1();
      const dealii::Tensor<1, dim> fibre = point.F * point.fibres[0];
      const double stretch               = std::sqrt(scale * fibre.norm_square());

      const double factor       = 4 * c0 * std::exp(exponent(I1, stretch));
      const double diagonal     = factor * c1 * (I1 - 3);
      dealii::Tensor<2, dim> FS = diagonal * point.F;
      if (compression.fibres_carry(stretch - 1))
        {
          const double e = stretch - 1;
          FS +=
            outer_product((factor * c2 * e * e * e / stretch) * fibre, point.fibres[0]);
        }
      return volumetric.stress(point, scale, FS, diagonal, 0);
    }

  private:
    double exponent(const double I1, const double stretch) const
    {
      double result = c1 * (I1 - 3) * (I1 - 3);
      if (compression.fibres_carry(stretch - 1))
        {
          const double square = (stretch - 1) * (stretch - 1);
          result += c2 * square * square;
        }
      return result;
    }

    /// [dyn/cm^2]
    double c0 = 0;

    double c1 = 0, c2 = 0;

    VolumetricPart volumetric;
    FibreCompression compression;
  };
} // namespace mitre::structure

#endif
