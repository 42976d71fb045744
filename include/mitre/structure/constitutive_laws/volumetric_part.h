#ifndef mitre_structure_constitutive_laws_volumetric_part_h
#define mitre_structure_constitutive_laws_volumetric_part_h

#include <cmath>

#include <mitre/structure/constitutive_laws/constitutive_law.h>

namespace mitre::structure
{
  /**
   * How a law answers to changes of volume, which all laws share. A law whose energy for
   * changes of shape is @f$\hat W(C)@f$ has
   * @f[ W = \hat W(C) - [p_0 \ln J] + U(J) \quad\text{or}\quad
   *     W = \hat W(J^{-2/3} C) + U(J), @f]
   * the latter with <code>Isochoric split = true</code>, for fibres as well as for the
   * matrix. @f$p_0 I = 2\,\partial\hat W/\partial C@f$ at C = I [dyn/cm^2]; the term in
   * brackets makes the reference configuration free of stress. Without it
   * (<code>Reference stress = raw</code>) the stress differs by a pressure, which an
   * incompressible fluid takes up, except at the surface of the body.
   *
   * U is one of (bulk modulus @f$\kappa@f$ [dyn/cm^2])
   * | <code>Volumetric energy</code> | @f$U@f$ | |
   * |---|---|---|
   * | log squared | @f$(\kappa/2)(\ln J)^2@f$ | Vadala-Roth et al. (2020), CMAME 365 |
   * | quadratic | @f$(\kappa/2)(J-1)^2@f$ | |
   * | Simo-Taylor | @f$(\kappa/4)(J^2 - 1 - 2\ln J)@f$ | Simo and Taylor (1991), CMAME 85
   * |
   *
   * With fewer than three dimensions, plane strain: C has a third principal value 1.
   */
  struct VolumetricPart
  {
    enum class Energy : unsigned char
    {
      log_squared,
      quadratic,
      simo_taylor
    };

    /// [dyn/cm^2]
    double bulk_modulus = 0;

    Energy form = Energy::log_squared;

    bool isochoric_split = false;

    bool stress_free = true;

    /// @param has_reference_stress whether p_0 is not 0, so that there is a choice.
    static void declare_parameters(dealii::ParameterHandler &prm,
                                   const bool has_reference_stress);

    void parse_parameters(dealii::ParameterHandler &prm, const bool has_reference_stress);

    /// Whether a law with p_0 > 0 has no stress at F = I.
    bool is_stress_free_in_reference() const
    {
      return stress_free || isochoric_split;
    }

    /// The factor of C in @f$\hat W@f$: @f$J^{-2/3}@f$ or 1.
    template <typename Number>
    Number scale(const Number &J) const
    {
      using std::pow;
      return isochoric_split ? Number(pow(J, -2. / 3.)) : Number(1.);
    }

    /// @f$U(J) - [p_0 \ln J]@f$ [dyn/cm^2]
    template <typename Number>
    Number energy(const Number &J, const double p0) const
    {
      using std::log;
      Number energy = 0.;
      if (stress_free && !isochoric_split && p0 != 0)
        energy -= p0 * log(J);
      return energy + bulk_energy(J);
    }

    /// @f$U(J)@f$ [dyn/cm^2]
    template <typename Number>
    Number bulk_energy(const Number &J) const
    {
      using std::log;
      if (bulk_modulus != 0)
        switch (form)
          {
            case Energy::log_squared:
              return 0.5 * bulk_modulus * log(J) * log(J);
            case Energy::quadratic:
              return 0.5 * bulk_modulus * (J - 1.) * (J - 1.);
            case Energy::simo_taylor:
              return 0.25 * bulk_modulus * (J * J - 1. - 2. * log(J));
          }
      return Number(0.);
    }

    /// J times the derivative of energy() [dyn/cm^2]: the factor of @f$F^{-T}@f$ in P.
    double kirchhoff_pressure(const double J, const double p0) const
    {
      return (stress_free && !isochoric_split ? -p0 : 0) + bulk_kirchhoff_pressure(J);
    }

    /// @f$J U'(J)@f$ [dyn/cm^2]
    double bulk_kirchhoff_pressure(const double J) const
    {
      if (bulk_modulus != 0)
        switch (form)
          {
            case Energy::log_squared:
              return bulk_modulus * std::log(J);
            case Energy::quadratic:
              return bulk_modulus * J * (J - 1);
            case Energy::simo_taylor:
              return 0.5 * bulk_modulus * (J * J - 1);
          }
      return 0;
    }

    /**
     * The whole first Piola-Kirchhoff stress [dyn/cm^2].
     *
     * @param point the deformation
     * @param scale of its C
     * @param FS @f$F \hat S@f$ with @f$\hat S = 2\,\partial\hat W/\partial C@f$ at scale
     * C
     * @param S33 component of @f$\hat S@f$ in the third direction; of use in 2D only
     * @param p0 see above
     */
    template <int dim>
    dealii::Tensor<2, dim> stress(const Deformation<dim> &point,
                                  const double scale,
                                  const dealii::Tensor<2, dim> &FS,
                                  [[maybe_unused]] const double S33,
                                  const double p0) const
    {
      dealii::Tensor<2, dim> P = FS;
      double factor            = kirchhoff_pressure(point.J, p0);
      if (isochoric_split)
        {
          double trace = scalar_product(FS, point.F);
          if constexpr (dim == 2)
            trace += S33;
          P *= scale;
          factor -= scale * trace / 3;
        }
      if (factor != 0)
        P += factor * point.inverse_transpose();
      return P;
    }
  };


  /**
   * Whether fibres that are shorter than in the reference configuration carry load
   * (<code>Fibres in compression</code>). Collagen is crimped and buckles, so that by
   * default they do not: their part of energy and stress is left out where their strain
   * is negative.
   */
  struct FibreCompression
  {
    bool elastic = false;

    static void declare_parameters(dealii::ParameterHandler &prm,
                                   const bool elastic_by_default = false);

    void parse_parameters(dealii::ParameterHandler &prm);

    /// @param strain of the fibres, of any measure that is positive in tension
    bool fibres_carry(const double strain) const
    {
      return strain > 0 || elastic;
    }
  };
} // namespace mitre::structure

#endif
