#ifndef mitre_structure_constitutive_laws_holzapfel_ogden_h
#define mitre_structure_constitutive_laws_holzapfel_ogden_h

#include <array>
#include <cmath>

#include <mitre/structure/constitutive_laws/volumetric_part.h>

namespace mitre::structure
{
  /**
   * Passive myocardium, orthotropic, with fibres f_0 and sheets s_0 as the two fibre
   * families of the mesh (Holzapfel and Ogden 2009, Phil. Trans. R. Soc. A 367,
   * 3445-3475, (5.38)),
   * @f[ \hat W = \frac{a}{2b} \left(e^{b (I_1 - 3)} - 1\right) +
   *     \sum_{i=f,s} \frac{a_i}{2 b_i} \left(e^{b_i (I_{4i} - 1)^2} - 1\right) +
   *     \frac{a_{fs}}{2 b_{fs}} \left(e^{b_{fs} I_8^2} - 1\right), @f]
   * @f[ \hat S = a e^{b(I_1 - 3)} I +
   *     \sum_i 2 a_i (I_{4i} - 1) e^{b_i (I_{4i} - 1)^2} i_0 \otimes i_0 +
   *     a_{fs} I_8 e^{b_{fs} I_8^2} (f_0 \otimes s_0 + s_0 \otimes f_0), \quad p_0 = a,
   * @f] with @f$I_{4i} = i_0 \cdot C i_0@f$ and @f$I_8 = f_0 \cdot C s_0@f$ (minus
   * @f$f_0 \cdot s_0@f$, which is 0 if the mesh has orthogonal directions); completed by
   * VolumetricPart. Fibres and sheets are slack one by one, see FibreCompression. The
   * defaults are their Table 1, fitted to the shear tests of pig hearts of Dokos et al.
   * (2002), in kPa: a = 0.059, a_f = 18.472, a_s = 2.481, a_fs = 0.216; b = 8.023, b_f =
   * 16.026, b_s = 11.120, b_fs = 11.436.
   */
  template <int dim>
  class HolzapfelOgden : public ConstitutiveLawBase<dim, HolzapfelOgden<dim>>
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
      const double scale             = volumetric.scale(point.J);
      const dealii::Tensor<1, dim> f = point.F * point.fibres[0];
      const dealii::Tensor<1, dim> s = point.F * point.fibres[1];
      const std::array<double, 2> E  = {
         {scale * f.norm_square() - 1, scale * s.norm_square() - 1}};
      const double I8 = scale * (f * s) - point.fibres[0] * point.fibres[1];

      double energy = a / (2 * b) * std::expm1(b * (scale * point.I1() - 3)) +
                      a_fs / (2 * b_fs) * std::expm1(b_fs * I8 * I8) +
                      volumetric.energy(point.J, a);
      for (unsigned int i = 0; i < 2; ++i)
        if (compression.fibres_carry(E[i]))
          energy += a_i[i] / (2 * b_i[i]) * std::expm1(b_i[i] * E[i] * E[i]);
      return energy;
    }

    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const
    {
      const double scale                                     = volumetric.scale(point.J);
      const std::array<dealii::Tensor<1, dim>, 2> directions = {
        {point.F * point.fibres[0], point.F * point.fibres[1]}};
      const double I8 =
        scale * (directions[0] * directions[1]) - point.fibres[0] * point.fibres[1];

      const double diagonal     = a * std::exp(b * (scale * point.I1() - 3));
      const double shear        = a_fs * I8 * std::exp(b_fs * I8 * I8);
      dealii::Tensor<2, dim> FS = diagonal * point.F;
      for (unsigned int i = 0; i < 2; ++i)
        {
          dealii::Tensor<1, dim> pull = shear * directions[1 - i];
          const double E              = scale * directions[i].norm_square() - 1;
          if (compression.fibres_carry(E))
            pull += (2 * a_i[i] * E * std::exp(b_i[i] * E * E)) * directions[i];
          FS += outer_product(pull, point.fibres[i]);
        }
      return volumetric.stress(point, scale, FS, diagonal, a);
    }

  private:
    /// [dyn/cm^2]
    double a = 0, a_fs = 0;

    double b = 1, b_fs = 1;

    /// Of fibres and sheets: a_f, a_s [dyn/cm^2] and b_f, b_s.
    std::array<double, 2> a_i{{0, 0}}, b_i{{1, 1}};

    VolumetricPart volumetric;
    FibreCompression compression;
  };
} // namespace mitre::structure

#endif
