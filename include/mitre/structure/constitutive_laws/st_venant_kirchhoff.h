#ifndef mitre_structure_constitutive_laws_st_venant_kirchhoff_h
#define mitre_structure_constitutive_laws_st_venant_kirchhoff_h

#include <mitre/structure/constitutive_laws/volumetric_part.h>

namespace mitre::structure
{
  /**
   * The St Venant-Kirchhoff solid: Hooke's law for the Green-Lagrange strain
   * @f$E = (C - I)/2@f$,
   * @f[ \hat W = \frac{\lambda}{2} (\mathrm{tr}\,E)^2 + \mu\, E:E, \quad
   *     \hat S = \lambda\,\mathrm{tr}\,E\; I + 2\mu E, @f]
   * completed by VolumetricPart, which it does not need. For moderate strains: it softens
   * in strong compression. By default the constants are those of the flag FSI1 of Turek
   * and Hron (2006), LNCSE 53, 371-385: @f$\mu@f$ = 0.5 MPa and Poisson's ratio 0.4, so
   * that
   * @f$\lambda = 2\mu\nu/(1 - 2\nu)@f$ = 2 MPa.
   */
  template <int dim>
  class StVenantKirchhoff : public ConstitutiveLawBase<dim, StVenantKirchhoff<dim>>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm) override;

    VolumetricPart *volumetric_part() override
    {
      return &volumetric;
    }

    double energy_at(const Deformation<dim> &point) const
    {
      const double scale             = volumetric.scale(point.J);
      const dealii::Tensor<2, dim> E = strain(point, scale);
      const double E33               = dim == 2 ? 0.5 * (scale - 1) : 0;
      const double trace_E           = trace(E) + E33;
      return 0.5 * lambda * trace_E * trace_E + mu * (E.norm_square() + E33 * E33) +
             volumetric.energy(point.J, 0);
    }

    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const
    {
      const double scale             = volumetric.scale(point.J);
      const dealii::Tensor<2, dim> E = strain(point, scale);
      const double E33               = dim == 2 ? 0.5 * (scale - 1) : 0;
      const double pressure          = lambda * (trace(E) + E33);
      return volumetric.stress(point,
                               scale,
                               pressure * point.F + (2 * mu) * (point.F * E),
                               pressure + 2 * mu * E33,
                               0);
    }

  private:
    static dealii::Tensor<2, dim> strain(const Deformation<dim> &point,
                                         const double scale)
    {
      dealii::Tensor<2, dim> E = (0.5 * scale) * point.C();
      for (unsigned int i = 0; i < dim; ++i)
        E[i][i] -= 0.5;
      return E;
    }

    /// Lame's constants [dyn/cm^2].
    double lambda = 0, mu = 0;

    VolumetricPart volumetric;
  };
} // namespace mitre::structure

#endif
