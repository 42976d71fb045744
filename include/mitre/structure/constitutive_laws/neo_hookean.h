#ifndef mitre_structure_constitutive_laws_neo_hookean_h
#define mitre_structure_constitutive_laws_neo_hookean_h

#include <cmath>

#include <mitre/structure/constitutive_laws/constitutive_law.h>

namespace mitre::structure
{
  /**
   * The isotropic part that several laws share,
   * @f[ W = C_1 (I_1 - d) - [2 C_1 \ln J] + \frac{\kappa}{2} (\ln J)^2, \quad
   *     P = 2 C_1 F - [2 C_1 F^{-T}] + \kappa \ln J\, F^{-T}, @f]
   * where the terms in brackets make the reference configuration free of stress; without
   * them the stress differs by a pressure, which an incompressible fluid takes up, except
   * at the surface of the body.
   */
  struct NeoHookeanMatrix
  {
    /// [dyn/cm^2]
    double C1 = 0;

    /// @f$\kappa@f$ [dyn/cm^2]
    double bulk_modulus = 0;

    bool stress_free = true;

    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm);

    template <int dim>
    double energy_at(const Deformation<dim> &point) const
    {
      double energy = C1 * (point.I1() - dim);
      if (stress_free || bulk_modulus != 0)
        {
          const double log_J = std::log(point.J);
          if (stress_free)
            energy -= 2 * C1 * log_J;
          energy += 0.5 * bulk_modulus * log_J * log_J;
        }
      return energy;
    }

    template <int dim>
    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const
    {
      dealii::Tensor<2, dim> P = (2 * C1) * point.F;

      double factor = stress_free ? -2 * C1 : 0;
      if (bulk_modulus != 0)
        factor += bulk_modulus * std::log(point.J);
      if (factor != 0)
        P += factor * point.inverse_transpose();
      return P;
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

    bool is_stress_free_in_reference() const override
    {
      return matrix.stress_free;
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
