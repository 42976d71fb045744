#include <deal.II/base/mpi.h>

#include <algorithm>

#include <mitre/base/exceptions.h>
#include <mitre/fluid/boundary_conditions/interface.h>
#include <mitre/fluid/navier_stokes.h>
#include <mitre/instruments/energy.h>

namespace mitre::instruments
{
  template <int dim>
  void Energy<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Budget",
                      "false",
                      dealii::Patterns::Bool(),
                      "Whether the power of the open boundaries and the viscous "
                      "dissipation are given, too; not for runs with prescribed "
                      "velocities other than zero.");
  }


  template <int dim>
  void Energy<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                     const std::string &instrument)
  {
    name       = instrument;
    has_budget = prm.get_bool("Budget");
  }


  template <int dim>
  std::vector<std::string> Energy<dim>::columns() const
  {
    const std::string unit          = dim == 3 ? "erg" : "erg/cm";
    std::vector<std::string> result = {name + " kinetic [" + unit + "]",
                                       name + " elastic [" + unit + "]"};
    if (has_budget)
      {
        const std::string power = dim == 3 ? "erg/s" : "erg/(cm s)";
        result.push_back(name + " boundary power [" + power + "]");
        result.push_back(name + " dissipation [" + power + "]");
      }
    return result;
  }


  template <int dim>
  double Energy<dim>::compute_boundary_power(const Observation<dim> &observation) const
  {
    const fluid::NavierStokes<dim> &fluid = *observation.fluid;
    const grid::PatchGrid<dim> &grid      = fluid.space().grid();
    const double density                  = fluid.fluid_parameters().density;
    double power                          = 0;
    for (const auto &face : fluid.space().open_faces())
      {
        const auto &condition =
          observation.boundary_conditions->condition(face.condition);
        double area = 1;
        for (unsigned int d = 0; d < dim; ++d)
          if (d != face.side / 2)
            area *= grid.patch(face.patch).h[d];
        const double inward =
          (face.side % 2 == 0 ? 1 : -1) * fluid.velocity().local_element(face.dof);
        const double taken = inward > 0 ? condition.backflow_stabilisation() : 0;
        power += area * inward *
                 (condition.pressure(face.x, observation.time) +
                  0.5 * density * (1 - taken) * inward * inward);
      }
    return dealii::Utilities::MPI::sum(power, grid.communicator());
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
    if (!has_budget)
      return {kinetic, elastic};

    AssertThrow(
      observation.boundary_conditions->all_velocities_zero(),
      base::UserError("Instrument " + name +
                      ": a \"Budget\" is for runs without prescribed velocities "
                      "other than zero, whose work it does not know."));
    grid::VectorType velocity = u, viscous = u;
    fluid.operators().apply_helmholtz(
      viscous, velocity, 0., -fluid.fluid_parameters().viscosity, false);
    double dissipation = 0;
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      dissipation +=
        volumes.local_element(i) * u.local_element(i) * viscous.local_element(i);
    return {
      kinetic,
      elastic,
      compute_boundary_power(observation),
      dealii::Utilities::MPI::sum(dissipation, fluid.space().grid().communicator())};
  }


  template class Energy<2>;
  template class Energy<3>;
} // namespace mitre::instruments
