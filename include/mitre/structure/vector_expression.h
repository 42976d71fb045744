#ifndef mitre_structure_vector_expression_h
#define mitre_structure_vector_expression_h

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

#include <mitre/base/expression.h>

namespace mitre::structure
{
  /**
   * A vector that a parameter file gives as one expression of the reference coordinates
   * and the time for each component: the entries NAME x, NAME y and, in 3D, NAME z.
   */
  template <int dim>
  class VectorExpression
  {
  public:
    /// @param help what the vector is, with its unit
    static void declare_parameters(dealii::ParameterHandler &prm,
                                   const std::string &name,
                                   const std::string &help);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name,
                          const std::string &what);

    /// Whether no component differs from the default "0".
    bool is_zero() const
    {
      return zero;
    }

    dealii::Tensor<1, dim> value(const dealii::Point<dim> &s, const double t) const;

  private:
    std::vector<base::Expression<dim>> components;
    bool zero = true;
  };
} // namespace mitre::structure

#endif
