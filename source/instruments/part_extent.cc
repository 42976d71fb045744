#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/instruments/measuring_disc.h>
#include <mitre/instruments/part_extent.h>

namespace mitre::instruments
{
  template <int dim>
  void PartExtent<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Part", "", dealii::Patterns::Anything(), "Name of the part.");
    prm.declare_entry("Axis",
                      "x",
                      dealii::Patterns::Selection("x|y|z"),
                      "The coordinate that is looked at.");
    prm.declare_entry("Material ids",
                      "",
                      dealii::Patterns::List(dealii::Patterns::Integer(0)),
                      "Look at nodes of elements with these ids only; empty: at all.");
  }


  template <int dim>
  void PartExtent<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                         const std::string &instrument)
  {
    name = instrument;
    part = prm.get("Part");
    axis = parse_axis<dim>(prm.get("Axis"), name);
    material_ids.clear();
    for (const int id : base::parse_integers(prm.get("Material ids"),
                                             "Instrument " + name + ", Material ids"))
      material_ids.push_back(id);
  }


  template <int dim>
  std::vector<std::string> PartExtent<dim>::columns() const
  {
    return {name + " min [cm]", name + " max [cm]"};
  }


  template <int dim>
  std::vector<double> PartExtent<dim>::measure(const Observation<dim> &observation)
  {
    const ObservedPart<dim> &observed = observation.find_part(part, name);
    const structure::Body<dim> &body  = *observed.body;
    const auto &elements              = body.elements();

    std::vector<bool> wanted(elements.n_owned_nodes(), material_ids.empty());
    if (!material_ids.empty())
      for (unsigned int i = 0; i < elements.n_elements(); ++i)
        if (std::find(material_ids.begin(),
                      material_ids.end(),
                      body.mesh().material_ids[elements.element(i)]) !=
            material_ids.end())
          for (unsigned int a = 0; a < body.mesh().nodes_per_element; ++a)
            if (elements.nodes(i)[a] < wanted.size())
              wanted[elements.nodes(i)[a]] = true;

    double smallest = std::numeric_limits<double>::infinity();
    double largest  = -smallest;
    for (unsigned int i = 0; i < wanted.size(); ++i)
      if (wanted[i])
        {
          const double x = observed.X->local_element(i * dim + axis);
          smallest       = std::min(smallest, x);
          largest        = std::max(largest, x);
        }
    smallest = dealii::Utilities::MPI::min(smallest, body.communicator());
    largest  = dealii::Utilities::MPI::max(largest, body.communicator());
    AssertThrow(smallest <= largest,
                base::UserError("Instrument " + name + ": no element of " +
                                body.mesh().source + " has one of its material ids."));
    return {smallest, largest};
  }


  template class PartExtent<2>;
  template class PartExtent<3>;
} // namespace mitre::instruments
