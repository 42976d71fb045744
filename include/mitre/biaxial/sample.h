#ifndef mitre_biaxial_sample_h
#define mitre_biaxial_sample_h

#include <deal.II/base/tensor.h>

#include <functional>
#include <string>

#include <mitre/structure/constitutive_laws/constitutive_law.h>

namespace mitre::biaxial
{
  /**
   * How the volume of a sample behaves.
   */
  enum class Volume
  {
    /// det F = 1; the pressure that this takes is the one that frees the faces of the
    /// sheet of stress (plane stress).
    incompressible,
    /// As the law has it; the stretch through the thickness is the one at which the faces
    /// are free of stress.
    compressible
  };


  /**
   * Deformation and stresses of a sample, directions 1 and 2 in the plane of the sheet,
   * 3 through its thickness.
   */
  struct State
  {
    dealii::Tensor<2, 3> F;

    /// [dyn/cm^2]
    dealii::Tensor<2, 3> cauchy_stress, first_piola_stress;
  };


  /**
   * A thin homogeneous sheet of a constitutive law whose faces are free of stress.
   *
   * All functions throw base::UserError, which names the deformation, if no stretch is
   * found at which stresses vanish that must, or if a stress is not finite.
   */
  class Sample
  {
  public:
    /**
     * @param law of the tissue; not owned
     * @param fibres in the plane of the sheet
     * @param volume see there
     * @param stiffness_factor multiplies all stresses
     * @param t time [s]
     */
    Sample(const structure::ConstitutiveLaw<3> &law,
           const structure::Fibres<3> &fibres,
           const Volume volume,
           const double stiffness_factor = 1,
           const double t                = 0);

    /// Stretches in both directions and an amount of shear,
    /// @f$F = \mathrm{diag}(\lambda_1, \lambda_2, \cdot) + \gamma\, e_1 \otimes e_2@f$.
    State
    deform(const double stretch_1, const double stretch_2, const double shear) const;

    /// A stretch in one direction (1 or 2); the other one is free of normal stress.
    State stretch_uniaxially(const unsigned int direction, const double stretch) const;

  private:
    State evaluate(const double stretch_1,
                   const double stretch_2,
                   const double shear,
                   const double stretch_3) const;

    const structure::ConstitutiveLaw<3> &law;
    const structure::Fibres<3> fibres;
    const Volume volume;
    const double stiffness_factor;
    const double t;
  };


  /**
   * The stretch between a fifth and five times @p start at which @p stress vanishes,
   * nearest to @p start as far as one can tell from a search in both directions;
   * base::UserError that ends in @p what if there is none.
   */
  double find_free_stretch(const std::function<double(const double)> &stress,
                           const double start,
                           const std::string &what);
} // namespace mitre::biaxial

#endif
