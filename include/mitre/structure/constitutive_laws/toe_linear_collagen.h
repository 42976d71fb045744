#ifndef mitre_structure_constitutive_laws_toe_linear_collagen_h
#define mitre_structure_constitutive_laws_toe_linear_collagen_h

#include <algorithm>
#include <cmath>

#include <mitre/structure/constitutive_laws/neo_hookean.h>

namespace mitre::structure
{
  /**
   * Chordae tendineae: a neo-Hookean matrix with parallel collagen fibres that straighten
   * in an exponential toe and then pull linearly. With the stretch @f$\lambda = |F
   * f_0|@f$ the tension per reference area is
   * @f[ T = \frac{dW_{fibre}}{d\lambda} = k \left(e^{\alpha(\lambda - 1)} - 1\right)
   *     \;\;(\lambda \le \lambda^*), \qquad
   *     T = T^* + E (\lambda - \lambda^*) \;\;(\lambda > \lambda^*), @f]
   * where @f$k = E e^{-\alpha(\lambda^* - 1)}/\alpha@f$ makes the slope continuous;
   * @f$\hat S = \hat S_{matrix} + (T/\lambda)\, f_0 \otimes f_0@f$. The toe is that of
   * Fung (1967), Am. J. Physiol. 213, 1532-1544, the straight part that of Weiss, Maker
   * and Govindjee (1996), Comput. Methods Appl. Mech. Engrg. 135, 107-128. Fibres are
   * slack in compression (see FibreCompression).
   *
   * By default the linear modulus of 74.1 MPa begins at a strain of 0.22, as measured in
   * basal chordae of pigs, cross-linked without load (doi 10.1177/0954411920975938); the
   * exponent makes the mean slope of the toe, @f$(1 - e^{-0.22\alpha}) E /
   * (0.22\alpha)@f$, their modulus before the transition, 5.78 MPa. The matrix is a
   * hundredth of that, our choice.
   */
  template <int dim>
  class ToeLinearCollagen : public ConstitutiveLawBase<dim, ToeLinearCollagen<dim>>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm) override;

    VolumetricPart *volumetric_part() override
    {
      return &matrix.volumetric;
    }

    unsigned int n_fibre_families() const override
    {
      return 1;
    }

    bool is_stress_free_in_reference() const override
    {
      return matrix.volumetric.is_stress_free_in_reference();
    }

    double energy_at(const Deformation<dim> &point) const
    {
      const double e =
        std::sqrt(matrix.volumetric.scale(point.J)) * (point.F * point.fibres[0]).norm() -
        1;
      double energy = matrix.energy_at(point);
      if (compression.fibres_carry(e))
        {
          const double toe_e  = std::min(e, transition_strain);
          const double beyond = e - toe_e;
          energy += toe_modulus / toe_exponent *
                      (std::expm1(toe_exponent * toe_e) - toe_exponent * toe_e) +
                    toe_tension(transition_strain) * beyond +
                    0.5 * linear_modulus * beyond * beyond;
        }
      return energy;
    }

    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const
    {
      const double scale                 = matrix.volumetric.scale(point.J);
      const dealii::Tensor<1, dim> fibre = point.F * point.fibres[0];
      const double stretch               = std::sqrt(scale * fibre.norm_square());
      const double e                     = stretch - 1;
      if (!compression.fibres_carry(e))
        return matrix.stress_at(point);

      const double toe_e   = std::min(e, transition_strain);
      const double tension = toe_tension(toe_e) + linear_modulus * (e - toe_e);
      return matrix.stress_at(
        point, scale, outer_product((tension / stretch) * fibre, point.fibres[0]));
    }

  private:
    /// [dyn/cm^2]
    double toe_tension(const double strain) const
    {
      return toe_modulus * std::expm1(toe_exponent * strain);
    }

    NeoHookeanMatrix matrix;

    /// E [dyn/cm^2]
    double linear_modulus = 0;

    /// lambda^* - 1
    double transition_strain = 0;

    /// alpha
    double toe_exponent = 1;

    /// k [dyn/cm^2]
    double toe_modulus = 0;

    FibreCompression compression;
  };
} // namespace mitre::structure

#endif
