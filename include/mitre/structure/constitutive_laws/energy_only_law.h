#ifndef mitre_structure_constitutive_laws_energy_only_law_h
#define mitre_structure_constitutive_laws_energy_only_law_h

#include <deal.II/differentiation/ad/sacado_math.h>
#include <deal.II/differentiation/ad/sacado_number_types.h>
#include <deal.II/differentiation/ad/sacado_product_types.h>

#include <mitre/structure/constitutive_laws/volumetric_part.h>

#ifndef DEAL_II_TRILINOS_WITH_SACADO
#  error "Mitre needs a deal.II whose Trilinos has Sacado."
#endif

namespace mitre::structure
{
  /**
   * The base of a law that gives its energy only, as a template of the number type,
   * @code
   *   template <typename Number = double>
   *   Number energy_at(const Deformation<dim, Number> &point) const;
   * @endcode
   * from which Trilinos' Sacado derives the stress by forward differentiation, exact up
   * to round-off. It takes some times as long as a stress that is worked out by hand
   * (tests/performance/structure/constitutive_laws.cc): good for laws that are tried out,
   * and for those whose part of the tissue is small.
   *
   * In energy_at(), write "using std::exp;" and "exp(x)", so that both kinds of numbers
   * find their function, and make branches on values continuous: they are not
   * differentiated.
   */
  template <int dim, typename Law>
  class EnergyOnlyLaw : public ConstitutiveLawBase<dim, Law>
  {
  public:
    dealii::Tensor<2, dim> stress_at(const Deformation<dim> &point) const
    {
      using Number = Sacado::Fad::SFad<double, dim * dim>;

      dealii::Tensor<2, dim, Number> F;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          F[i][j] = Number(dim * dim, i * dim + j, point.F[i][j]);

      // The derivative of the determinant is its cofactor.
      const dealii::Tensor<2, dim> cofactor = point.J * point.inverse_transpose();
      Number J(dim * dim, point.J);
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          J.fastAccessDx(i * dim + j) = cofactor[i][j];

      const Number W = static_cast<const Law &>(*this).energy_at(
        Deformation<dim, Number>{F, J, point.fibres, point.t});

      dealii::Tensor<2, dim> P;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          P[i][j] = W.dx(i * dim + j);
      return P;
    }
  };
} // namespace mitre::structure

#endif
