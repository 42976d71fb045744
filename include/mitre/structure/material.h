#ifndef mitre_structure_material_h
#define mitre_structure_material_h

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>
#include <vector>

#include <mitre/base/expression.h>
#include <mitre/structure/constitutive_laws/constitutive_law.h>
#include <mitre/structure/time_function.h>

namespace mitre::structure
{
  /**
   * What multiplies energy and stress of a material over time, whatever its law. By
   * default 1.
   */
  class StiffnessFactor : public TimeFunction
  {
  public:
    StiffnessFactor();

    StiffnessFactor(base::TimeExpression expression);

    static void declare_parameters(dealii::ParameterHandler &prm);

    /// @param what the material, for messages. Throws base::UserError, which names it.
    void parse_parameters(dealii::ParameterHandler &prm, const std::string &what);
  };


  /**
   * What the elements with some material ids are made of.
   */
  template <int dim>
  struct Material
  {
    std::string name;
    std::vector<unsigned int> ids;
    std::shared_ptr<ConstitutiveLaw<dim>> law;

    /// Multiplies energy and stress.
    StiffnessFactor time_factor;

    /// Whether the volumetric part of the law sees a projection of J, see
    /// compute_elastic_force().
    bool project_volume = true;

    /// Declare the law, its constants and the time factor, not the ids, in the subsection
    /// of the material.
    static void declare_parameters(dealii::ParameterHandler &prm);

    /// @param what the material, for messages. Throws base::UserError, which names it.
    void parse_parameters(dealii::ParameterHandler &prm, const std::string &what);
  };


  /**
   * Shear modulus [dyn/cm^2] of a law in its reference configuration, by central
   * differences of the stress (relative error about 1e-6 for smooth laws): the smallest
   * of those in the coordinate planes, with fibres along the first axis and, for a second
   * family, the second one.
   */
  template <int dim>
  double compute_shear_modulus(const ConstitutiveLaw<dim> &law);


  /// @f$\kappa = 2 G (1 + \nu)/(3 (1 - 2\nu))@f$, Vadala-Roth et al. (2020), CMAME 365.
  double bulk_modulus_of(const double shear_modulus, const double poisson_ratio);
} // namespace mitre::structure

#endif
