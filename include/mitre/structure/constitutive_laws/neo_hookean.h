#ifndef mitre_structure_constitutive_laws_neo_hookean_h
#define mitre_structure_constitutive_laws_neo_hookean_h

#include <string>

#include <mitre/structure/constitutive_laws/volumetric_part.h>

namespace mitre::structure
{
  /**
   * The isotropic matrix that several laws share, @f$\hat W = C_1 (I_1 - 3)@f$ with
   * @f$p_0 = 2 C_1@f$, completed by VolumetricPart. Without the split,
   * @f[ W = C_1 (I_1 - 3) - [2 C_1 \ln J] + U(J), \quad
   *     P = 2 C_1 F - [2 C_1 F^{-T}] + J U'(J)\, F^{-T}. @f]
   */
  struct NeoHookeanMatrix
  {
    /// [dyn/cm^2]
    double C1 = 0;

    VolumetricPart volumetric;

    static void declare_parameters(dealii::ParameterHandler &prm,
                                   const std::string &default_C1);

    void parse_parameters(dealii::ParameterHandler &prm);

    template <int dim>
    double energy_at(const Deformation<dim> &point) const
    {
      return C1 * (volumetric.scale(point.J) * point.I1() - 3) +
             volumetric.energy(point.J, 2 * C1);
    }

    /// The stress of the matrix and of fibres in it, whose @f$F \hat S@f$ is @p fibres.
    template <int dim>
    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point,
                                     const double scale,
                                     const dealii::Tensor<2, dim> &fibres) const
    {
      return volumetric.stress(point, scale, (2 * C1) * point.F + fibres, 2 * C1, 2 * C1);
    }

    template <int dim>
    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const
    {
      return volumetric.stress(
        point, volumetric.scale(point.J), (2 * C1) * point.F, 2 * C1, 2 * C1);
    }
  };


  /**
   * The neo-Hookean solid, see NeoHookeanMatrix; @f$W = C_1 (I_1 - 3)@f$ in the thesis
   * (5.7). Its shear modulus is @f$2 C_1@f$, Young's modulus @f$6 C_1@f$.
   */
  template <int dim>
  class NeoHookean : public ConstitutiveLawBase<dim, NeoHookean<dim>>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm) override;

    VolumetricPart *volumetric_part() override
    {
      return &matrix.volumetric;
    }

    bool is_stress_free_in_reference() const override
    {
      return matrix.volumetric.is_stress_free_in_reference();
    }

    double energy_at(const Deformation<dim> &point) const
    {
      return matrix.energy_at(point);
    }

    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const
    {
      return matrix.stress_at(point);
    }

  private:
    NeoHookeanMatrix matrix;
  };
} // namespace mitre::structure

#endif
