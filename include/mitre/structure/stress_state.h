#ifndef mitre_structure_stress_state_h
#define mitre_structure_stress_state_h

#include <deal.II/base/tensor.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <mitre/structure/mesh.h>

namespace mitre::structure
{
  /**
   * Stress and strain of the solid at a point. The stress is that of the constitutive
   * law; the pressure and the viscous stress of the fluid, which fills the body too, are
   * not in it.
   */
  template <int dim>
  struct StressState
  {
    /// All zero, to which others are added.
    StressState() = default;

    /// @param P first Piola-Kirchhoff stress [dyn/cm^2]
    StressState(const dealii::Tensor<2, dim> &F,
                const dealii::Tensor<2, dim> &P,
                const Fibres<dim> &fibres);

    /// Add @p weight times another state, for means. Tensors and scalars are added, fibre
    /// directions as vectors.
    void add(const double weight, const StressState &other);

    /// Divide by the sum of the weights; fibre directions become unit vectors.
    void divide(const double volume);

    /// @f$P@f$ and @f$\sigma = P F^T/J@f$ [dyn/cm^2]
    dealii::Tensor<2, dim> piola, cauchy;

    /// @f$E = (F^T F - I)/2@f$
    dealii::Tensor<2, dim> green;

    double J = 0;

    /// By family: stretch @f$\lambda = |F f|@f$, direction @f$a = F f/\lambda@f$ now, and
    /// @f$a\cdot\sigma a@f$ [dyn/cm^2]; zero without fibres.
    std::array<double, max_fibre_families> fibre_stretch = {};
    std::array<double, max_fibre_families> fibre_stress  = {};
    Fibres<dim> fibre_direction;
  };


  /// Something that follows from a StressState, under the name that parameter files use.
  template <int dim>
  struct StressQuantity
  {
    std::string name;

    /// "dyn/cm^2"; empty for numbers.
    std::string unit;

    /// 1, or 3 and 9 as files for pictures have them: in 2D the others are zero.
    unsigned int n_components;

    /// Which family of fibres it needs; max_fibre_families: none.
    unsigned int fibre_family;

    /// Writes n_components values.
    std::function<void(const StressState<dim> &, double *)> evaluate;
  };


  /**
   * All quantities. Principal values are sorted from the largest on; in 2D they are those
   * in the plane. Principal directions are unit vectors, of either sign. The fibre angle
   * [degrees, 0 to 90] is that between the first family of fibres as it is now and the
   * direction of the first principal Cauchy stress.
   */
  template <int dim>
  const std::vector<StressQuantity<dim>> &stress_quantities();


  /// Throws base::UserError, which lists the names there are, if there is none.
  template <int dim>
  const StressQuantity<dim> &find_stress_quantity(const std::string &name);
} // namespace mitre::structure

#endif
