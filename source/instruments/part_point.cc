#include <deal.II/base/mpi.h>

#include <algorithm>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/instruments/part_point.h>

namespace mitre::instruments
{
  template <int dim>
  void PartPoint<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Part", "", dealii::Patterns::Anything(), "Name of the part.");
    prm.declare_entry("Point",
                      dim == 2 ? "0, 0" : "0, 0, 0",
                      dealii::Patterns::List(dealii::Patterns::Double(), dim, dim),
                      "A place in the reference configuration [cm]; the node that is "
                      "nearest to it is followed.");
    prm.declare_entry("Largest distance",
                      "0.1",
                      dealii::Patterns::Double(0.),
                      "The run stops if the nearest node is farther than this from the "
                      "place [cm].");
  }


  template <int dim>
  void PartPoint<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                        const std::string &instrument)
  {
    name  = instrument;
    part  = prm.get("Part");
    point = base::parse_point<dim>(prm.get("Point"), "Instrument " + name + ", Point");
    largest_distance = prm.get_double("Largest distance");
  }


  template <int dim>
  std::vector<std::string> PartPoint<dim>::columns() const
  {
    std::vector<std::string> names;
    for (const char *quantity : {" displacement ", " velocity "})
      for (unsigned int d = 0; d < dim; ++d)
        names.push_back(name + quantity + "xyz"[d] +
                        (quantity[1] == 'd' ? " [cm]" : " [cm/s]"));
    return names;
  }


  template <int dim>
  std::vector<double> PartPoint<dim>::measure(const Observation<dim> &observation)
  {
    const ObservedPart<dim> &observed            = observation.find_part(part, name);
    const structure::Body<dim> &body             = *observed.body;
    const std::vector<dealii::Point<dim>> &nodes = body.mesh().nodes;
    const structure::NodeNumbering &numbering    = body.numbering();
    const auto nearer = [this](const dealii::Point<dim> &a, const dealii::Point<dim> &b) {
      return a.distance_square(point) < b.distance_square(point);
    };
    const std::size_t node =
      std::min_element(nodes.begin(), nodes.end(), nearer) - nodes.begin();
    if (nodes[node].distance(point) > largest_distance)
      {
        std::ostringstream text;
        text << "Instrument " << name << ": the node of " << body.mesh().source
             << " that is nearest to the \"Point\" " << structure::to_string(point)
             << " cm is at " << structure::to_string(nodes[node])
             << " cm, farther away than the \"Largest distance\" of " << largest_distance
             << " cm.";
        throw base::UserError(text.str());
      }

    std::vector<double> values(2 * dim, 0.);
    const unsigned int number = numbering.number_of[node];
    if (number >= numbering.begin_owned() && number < numbering.end_owned())
      for (unsigned int d = 0; d < dim; ++d)
        {
          const unsigned int i = (number - numbering.begin_owned()) * dim + d;
          values[d]            = observed.X->local_element(i) - nodes[node][d];
          values[dim + d]      = observed.U->local_element(i);
        }
    dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(values),
                                body.communicator(),
                                dealii::ArrayView<double>(values));
    return values;
  }


  template class PartPoint<2>;
  template class PartPoint<3>;
} // namespace mitre::instruments
