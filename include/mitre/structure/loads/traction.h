#ifndef mitre_structure_loads_traction_h
#define mitre_structure_loads_traction_h

#include <mitre/structure/loads/region_loads.h>
#include <mitre/structure/time_function.h>
#include <mitre/structure/vector_expression.h>

namespace mitre::structure
{
  /**
   * A dead load in a given direction: a force per area of the reference surface
   * [dyn/cm^2], @f$G_a = \int_{\partial U} \phi_a\,T(s, t)\,dA@f$.
   */
  template <int dim>
  class Traction : public SurfaceLoad<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &what) override;

    void add_forces(const NodalState &state, double *forces) const override;

  private:
    /// [dyn/cm^2]
    VectorExpression<dim> traction;

    TimeFunction factor;
  };
} // namespace mitre::structure

#endif
