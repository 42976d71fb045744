#include <deal.II/base/mpi.h>

#include <mitre/fluid/navier_stokes.h>
#include <mitre/instruments/energy.h>

namespace mitre::instruments
{
  template <int dim>
  void Energy<dim>::declare_parameters(dealii::ParameterHandler &)
  {
  }


  template <int dim>
  void Energy<dim>::parse_parameters(dealii::ParameterHandler &,
                                     const std::string &instrument)
  {
    name = instrument;
  }


  template <int dim>
  std::vector<std::string> Energy<dim>::columns() const
  {
    const std::string unit = dim == 3 ? "erg" : "erg/cm";
    return {name + " kinetic [" + unit + "]", name + " elastic [" + unit + "]"};
  }


  template <int dim>
  std::vector<double> Energy<dim>::measure(const Observation<dim> &observation)
  {
    const fluid::NavierStokes<dim> &fluid = *observation.fluid;
    const grid::VectorType &u             = fluid.velocity();
    const grid::VectorType &volumes       = fluid.space().volumes();
    double sum                            = 0;
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      sum += volumes.local_element(i) * u.local_element(i) * u.local_element(i);
    const double kinetic =
      0.5 * fluid.fluid_parameters().density *
      dealii::Utilities::MPI::sum(sum, fluid.space().grid().communicator());

    double elastic = 0;
    for (const ObservedPart<dim> &part : observation.parts)
      elastic += part.body->compute_elastic_energy(*part.X, observation.time);
    return {kinetic, elastic};
  }


  template class Energy<2>;
  template class Energy<3>;
} // namespace mitre::instruments
