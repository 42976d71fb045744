#ifndef mitre_structure_constitutive_laws_transversely_isotropic_h
#define mitre_structure_constitutive_laws_transversely_isotropic_h

#include <cmath>

#include <mitre/structure/constitutive_laws/neo_hookean.h>

namespace mitre::structure
{
  /**
   * A neo-Hookean matrix with one family of fibres that stiffen exponentially (thesis
   * (5.1)-(5.6)): with @f$I_f = |F f_0|^2@f$ and, unless fibres are slack (see
   * FibreCompression),
   * @f[ W = W_{matrix} + \frac{a_f}{2 b_f} \left(e^{b_f (I_f - 1)^2} - 1\right), \quad
   *     P = P_{matrix} + 2 a_f (I_f - 1) e^{b_f (I_f - 1)^2} F f_0 \otimes f_0. @f]
   * By default the constants of the anterior leaflet (thesis, Table 5.1).
   */
  template <int dim>
  class TransverselyIsotropic
    : public ConstitutiveLawBase<dim, TransverselyIsotropic<dim>>
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
      const double stretch =
        matrix.volumetric.scale(point.J) * (point.F * point.fibres[0]).norm_square() - 1;

      double energy = matrix.energy_at(point);
      if (compression.fibres_carry(stretch))
        energy += a_f / (2 * b_f) * std::expm1(b_f * stretch * stretch);
      return energy;
    }

    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const
    {
      const dealii::Tensor<1, dim> &f0   = point.fibres[0];
      const dealii::Tensor<1, dim> fibre = point.F * f0;
      const double scale                 = matrix.volumetric.scale(point.J);
      const double stretch               = scale * fibre.norm_square() - 1;

      if (!compression.fibres_carry(stretch))
        return matrix.stress_at(point);
      return matrix.stress_at(
        point,
        scale,
        outer_product((2 * a_f * stretch * std::exp(b_f * stretch * stretch)) * fibre,
                      f0));
    }

  private:
    NeoHookeanMatrix matrix;
    FibreCompression compression;

    /// [dyn/cm^2]
    double a_f = 0;

    double b_f = 1;
  };
} // namespace mitre::structure

#endif
