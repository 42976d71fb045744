#ifndef mitre_structure_constitutive_laws_constitutive_law_h
#define mitre_structure_constitutive_laws_constitutive_law_h

#include <deal.II/base/array_view.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/tensor.h>

#include <mitre/structure/mesh.h>

namespace mitre::structure
{
  struct VolumetricPart;


  /**
   * A hyperelastic law: the strain energy @f$W(F)@f$ per reference volume [dyn/cm^2] and
   * the first Piola-Kirchhoff stress @f$P = \partial W/\partial F@f$ [dyn/cm^2], with the
   * deformation gradient @f$F_{ij} = \partial X_i/\partial s_j@f$. In 2D, plane strain.
   *
   * Laws derive from ConstitutiveLawBase, not from this.
   */
  template <int dim>
  class ConstitutiveLaw
  {
  public:
    virtual ~ConstitutiveLaw() = default;

    /// Read what the law's declare_parameters() has declared.
    virtual void parse_parameters(dealii::ParameterHandler &prm) = 0;

    /// How many fibre families the law needs the mesh to have.
    virtual unsigned int n_fibre_families() const
    {
      return 0;
    }

    /// Whether the stress vanishes at F = I.
    virtual bool is_stress_free_in_reference() const
    {
      return true;
    }

    /// The volumetric part of the law, if it has one: its energy U(J) is a summand of
    /// energy(), so that it can be integrated by a rule of its own.
    virtual VolumetricPart *volumetric_part()
    {
      return nullptr;
    }

    const VolumetricPart *volumetric_part() const
    {
      return const_cast<ConstitutiveLaw<dim> *>(this)->volumetric_part();
    }

    /// @f$W(F)@f$ [dyn/cm^2]; fibres as in the mesh, t [s].
    virtual double energy(const dealii::Tensor<2, dim> &F,
                          const Fibres<dim> &fibres,
                          const double t) const = 0;

    /// @f$P(F)@f$ [dyn/cm^2].
    virtual dealii::Tensor<2, dim>
    first_piola_kirchhoff_stress(const dealii::Tensor<2, dim> &F,
                                 const Fibres<dim> &fibres,
                                 const double t) const = 0;

    /**
     * The stress at many points with one virtual call: P[i] from F[i], its determinant
     * J[i] > 0 and fibres[i / points_per_element].
     */
    virtual void
    compute_stresses(const dealii::ArrayView<const dealii::Tensor<2, dim>> &F,
                     const dealii::ArrayView<const double> &J,
                     const Fibres<dim> *fibres,
                     const unsigned int points_per_element,
                     const double t,
                     const dealii::ArrayView<dealii::Tensor<2, dim>> &P) const = 0;
  };


  /**
   * The deformation gradient of one point and what laws need of it. In 2D (plane strain)
   * the stretch of the third direction is 1. @p Number is double or an automatically
   * differentiable type, see EnergyOnlyLaw.
   */
  template <int dim, typename Number = double>
  struct Deformation
  {
    const dealii::Tensor<2, dim, Number> &F;

    /// @f$\det F@f$
    const Number J;

    const Fibres<dim> &fibres;

    /// Time [s].
    const double t;

    /// @f$I_1 = \mathrm{tr}\,C@f$, with the 1 of the third direction in 2D.
    Number I1() const
    {
      Number sum = dim == 2 ? 1. : 0.;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          sum += F[i][j] * F[i][j];
      return sum;
    }

    /// @f$C = F^T F@f$, without its third row and column in 2D.
    dealii::Tensor<2, dim, Number> C() const
    {
      dealii::Tensor<2, dim, Number> result;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          for (unsigned int k = 0; k < dim; ++k)
            result[i][j] += F[k][i] * F[k][j];
      return result;
    }

    /// @f$F^{-T} = \mathrm{cof}(F)/J@f$
    dealii::Tensor<2, dim, Number> inverse_transpose() const
    {
      dealii::Tensor<2, dim, Number> cofactor;
      if constexpr (dim == 2)
        {
          cofactor[0][0] = F[1][1];
          cofactor[0][1] = -F[1][0];
          cofactor[1][0] = -F[0][1];
          cofactor[1][1] = F[0][0];
        }
      else
        for (unsigned int i = 0; i < 3; ++i)
          {
            const unsigned int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
            for (unsigned int j = 0; j < 3; ++j)
              {
                const unsigned int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
                cofactor[i][j] = F[i1][j1] * F[i2][j2] - F[i1][j2] * F[i2][j1];
              }
          }
      return cofactor / J;
    }
  };


  /**
   * What all laws share. A law @p Law derives from ConstitutiveLawBase<dim, Law> and has
   * two functions that may be inlined into loops:
   * @code
   *   double energy_at(const Deformation<dim> &point) const;
   *   dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const;
   * @endcode
   */
  template <int dim, typename Law>
  class ConstitutiveLawBase : public ConstitutiveLaw<dim>
  {
  public:
    double energy(const dealii::Tensor<2, dim> &F,
                  const Fibres<dim> &fibres,
                  const double t) const final
    {
      return law().energy_at({F, determinant(F), fibres, t});
    }

    dealii::Tensor<2, dim> first_piola_kirchhoff_stress(const dealii::Tensor<2, dim> &F,
                                                        const Fibres<dim> &fibres,
                                                        const double t) const final
    {
      return law().stress_at({F, determinant(F), fibres, t});
    }

    void compute_stresses(const dealii::ArrayView<const dealii::Tensor<2, dim>> &F,
                          const dealii::ArrayView<const double> &J,
                          const Fibres<dim> *fibres,
                          const unsigned int points_per_element,
                          const double t,
                          const dealii::ArrayView<dealii::Tensor<2, dim>> &P) const final
    {
      const unsigned int n_points = F.size();
      for (unsigned int i = 0, q = 0; i < n_points; ++i)
        {
          P[i] = law().stress_at({F[i], J[i], *fibres, t});
          if (++q == points_per_element)
            {
              q = 0;
              ++fibres;
            }
        }
    }

  private:
    const Law &law() const
    {
      return static_cast<const Law &>(*this);
    }
  };
} // namespace mitre::structure

#endif
