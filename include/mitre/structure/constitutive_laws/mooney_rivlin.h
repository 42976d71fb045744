#ifndef mitre_structure_constitutive_laws_mooney_rivlin_h
#define mitre_structure_constitutive_laws_mooney_rivlin_h

#include <mitre/structure/constitutive_laws/volumetric_part.h>

namespace mitre::structure
{
  /**
   * The Mooney-Rivlin solid (Mooney 1940, J. Appl. Phys. 11; Rivlin 1948, Phil. Trans. R.
   * Soc. A 241),
   * @f[ \hat W = C_1 (I_1 - 3) + C_2 (I_2 - 3), \quad
   *     \hat S = 2 (C_1 + C_2 I_1) I - 2 C_2 C, \quad p_0 = 2 C_1 + 4 C_2, @f]
   * completed by VolumetricPart. Its shear modulus is @f$2 (C_1 + C_2)@f$. By default
   * C_1 = C_2 = 9000 dyn/cm^2, as of the twisted bar of Vadala-Roth et al. (2020),
   * Comput. Methods Appl. Mech. Engrg. 365, 112978.
   */
  template <int dim>
  class MooneyRivlin : public ConstitutiveLawBase<dim, MooneyRivlin<dim>>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm) override;

    VolumetricPart *volumetric_part() override
    {
      return &volumetric;
    }

    bool is_stress_free_in_reference() const override
    {
      return volumetric.is_stress_free_in_reference();
    }

    double energy_at(const Deformation<dim> &point) const
    {
      const double scale = volumetric.scale(point.J);
      const double I1    = scale * point.I1();
      const double trace_of_square =
        scale * scale * (point.C().norm_square() + (dim == 2 ? 1 : 0));
      return C1 * (I1 - 3) + C2 * (0.5 * (I1 * I1 - trace_of_square) - 3) +
             volumetric.energy(point.J, 2 * C1 + 4 * C2);
    }

    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const
    {
      const double scale    = volumetric.scale(point.J);
      const double diagonal = 2 * (C1 + C2 * scale * point.I1());
      return volumetric.stress(point,
                               scale,
                               diagonal * point.F -
                                 (2 * C2 * scale) * (point.F * point.C()),
                               diagonal - 2 * C2 * scale,
                               2 * C1 + 4 * C2);
    }

  private:
    /// [dyn/cm^2]
    double C1 = 0, C2 = 0;

    VolumetricPart volumetric;
  };
} // namespace mitre::structure

#endif
