#include <mitre/base/exceptions.h>
#include <mitre/instruments/part_force.h>

namespace mitre::instruments
{
  template <int dim>
  void PartForce<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Part",
                      "",
                      dealii::Patterns::Anything(),
                      "Name of the part, which must have constraints or loads.");
    prm.declare_entry("Reference force",
                      "0",
                      dealii::Patterns::Double(0.),
                      "If not 0: columns with the force divided by this [dyn; dyn/cm in "
                      "2D] are added. With density times speed squared times frontal "
                      "area (length in 2D) over 2 they are drag and lift coefficients.");
  }


  template <int dim>
  void PartForce<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                        const std::string &instrument)
  {
    name            = instrument;
    part            = prm.get("Part");
    reference_force = prm.get_double("Reference force");
  }


  template <int dim>
  std::vector<std::string> PartForce<dim>::columns() const
  {
    const std::string axes[3] = {"x", "y", "z"};
    std::vector<std::string> result;
    for (unsigned int c = 0; c < dim; ++c)
      result.push_back(name + " " + axes[c] + (dim == 3 ? " [dyn]" : " [dyn/cm]"));
    if (reference_force > 0.)
      for (unsigned int c = 0; c < dim; ++c)
        result.push_back(name + " coefficient " + axes[c]);
    return result;
  }


  template <int dim>
  std::vector<double> PartForce<dim>::measure(const Observation<dim> &observation)
  {
    const ObservedPart<dim> &observed = observation.find_part(part, name);
    const structure::Body<dim> &body  = *observed.body;
    AssertThrow(!body.constraints().empty() || !body.loads().empty(),
                base::UserError("Instrument " + name + ": part " + part +
                                " has no constraints or loads, whose forces could be "
                                "summed."));
    const dealii::Tensor<1, dim> force = -body.compute_total_external_force(
      observed.pulled != nullptr ? *observed.pulled : *observed.X,
      *observed.U,
      observation.time);

    std::vector<double> result;
    for (unsigned int c = 0; c < dim; ++c)
      result.push_back(force[c]);
    if (reference_force > 0.)
      for (unsigned int c = 0; c < dim; ++c)
        result.push_back(force[c] / reference_force);
    return result;
  }


  template class PartForce<2>;
  template class PartForce<3>;
} // namespace mitre::instruments
