#include <mitre/structure/vector_expression.h>

namespace mitre::structure
{
  namespace
  {
    const char *const axes[3] = {" x", " y", " z"};
  }


  template <int dim>
  void VectorExpression<dim>::declare_parameters(dealii::ParameterHandler &prm,
                                                 const std::string &name,
                                                 const std::string &help)
  {
    for (unsigned int c = 0; c < dim; ++c)
      prm.declare_entry(name + axes[c],
                        "0",
                        dealii::Patterns::Anything(),
                        help +
                          ", an expression of the reference coordinates x, y, z [cm] and "
                          "the time t [s].");
  }


  template <int dim>
  void VectorExpression<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                               const std::string &name,
                                               const std::string &what)
  {
    components.clear();
    zero = true;
    for (unsigned int c = 0; c < dim; ++c)
      {
        const std::string entry = name + axes[c], text = prm.get(entry);
        components.emplace_back(text, what + ", " + entry);
        zero = zero && text == "0";
      }
  }


  template <int dim>
  dealii::Tensor<1, dim> VectorExpression<dim>::value(const dealii::Point<dim> &s,
                                                      const double t) const
  {
    dealii::Tensor<1, dim> result;
    for (unsigned int c = 0; c < dim; ++c)
      result[c] = components[c].value(s, t);
    return result;
  }


  template class VectorExpression<2>;
  template class VectorExpression<3>;
} // namespace mitre::structure
