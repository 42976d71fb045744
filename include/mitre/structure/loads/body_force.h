#ifndef mitre_structure_loads_body_force_h
#define mitre_structure_loads_body_force_h

#include <mitre/structure/loads/region_loads.h>
#include <mitre/structure/time_function.h>
#include <mitre/structure/vector_expression.h>

namespace mitre::structure
{
  /**
   * A force per reference volume [dyn/cm^3] within a body, such as the weight that it has
   * beyond that of the fluid: @f$G_a = \int_U \phi_a\,b(s, t)\,ds@f$.
   */
  template <int dim>
  class BodyForce : public VolumeLoad<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &what) override;

    void add_forces(const NodalState &state, double *forces) const override;

  private:
    /// [dyn/cm^3]
    VectorExpression<dim> force;

    TimeFunction factor;
  };
} // namespace mitre::structure

#endif
