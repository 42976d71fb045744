#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>

#include <mitre/instruments/part_volume.h>

namespace mitre::instruments
{
  template <int dim>
  void PartVolume<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Part", "", dealii::Patterns::Anything(), "Name of the part.");
  }


  template <int dim>
  void PartVolume<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                         const std::string &instrument)
  {
    name = instrument;
    part = prm.get("Part");
  }


  template <int dim>
  std::vector<std::string> PartVolume<dim>::columns() const
  {
    return {name + " volume ratio [1]", name + " min J [1]", name + " max J [1]"};
  }


  template <int dim>
  std::vector<double> PartVolume<dim>::measure(const Observation<dim> &observation)
  {
    const ObservedPart<dim> &observed = observation.find_part(part, name);
    const structure::FiniteElementBody<dim> &body =
      observation.find_finite_elements(part, name);
    const auto &elements = body.elements();
    const structure::ShapeTable<dim> shape(body.reference_element(),
                                           body.reference_element().force_quadrature());

    structure::VectorType X(elements.partitioner());
    std::copy(observed.X->begin(), observed.X->end(), X.begin());
    X.update_ghost_values();

    double volume = 0, reference_volume = 0;
    double smallest = std::numeric_limits<double>::max();
    double largest  = std::numeric_limits<double>::lowest();
    for (unsigned int i = 0; i < elements.n_elements(); ++i)
      {
        const unsigned int *nodes = elements.nodes(i);
        for (unsigned int q = 0; q < shape.n_points; ++q)
          {
            dealii::Tensor<2, dim> jacobian;
            for (unsigned int a = 0; a < shape.n_nodes; ++a)
              for (unsigned int c = 0; c < dim; ++c)
                jacobian[c] += X.local_element(nodes[a] * dim + c) *
                               shape.gradients[q * shape.n_nodes + a];
            const double deformed = determinant(jacobian);
            const double reference =
              determinant(shape.jacobian(body.mesh(), elements.element(i), q));
            smallest = std::min(smallest, deformed / reference);
            largest  = std::max(largest, deformed / reference);

            // Elements of two ranks count on that of their first node.
            if (nodes[0] < elements.n_owned_nodes())
              {
                volume += shape.weights[q] * deformed;
                reference_volume += shape.weights[q] * reference;
              }
          }
      }
    const MPI_Comm communicator = body.communicator();
    return {dealii::Utilities::MPI::sum(volume, communicator) /
              dealii::Utilities::MPI::sum(reference_volume, communicator),
            dealii::Utilities::MPI::min(smallest, communicator),
            dealii::Utilities::MPI::max(largest, communicator)};
  }


  template class PartVolume<2>;
  template class PartVolume<3>;
} // namespace mitre::instruments
