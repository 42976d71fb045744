#include <algorithm>

#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/base/units.h>
#include <mitre/simulation/pressure_control.h>

namespace mitre::simulation
{
  using namespace dealii;

  namespace
  {
    const char *const section = "Pressure control";
  }


  template <int dim>
  void PressureControl<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.declare_entry("Condition",
                      "",
                      Patterns::Anything(),
                      "Name of the boundary condition, of the type pressure, to whose "
                      "pressure a shift is "
                      "added so that the difference between two pressure stations "
                      "follows a target, which "
                      "\"Pressure\" and the table below give; empty: none.");
    prm.declare_entry("Time constant",
                      "5e-3",
                      Patterns::Double(1e-12),
                      "tau of tau ds/dt = target - difference for the shift s [s]; more "
                      "than half of a time step.");
    prm.declare_entry("Largest shift",
                      "20",
                      Patterns::Double(0.),
                      "The shift stays between this and minus this [mmHg].");
    fluid::GivenPressure<dim>::declare_parameters(prm);
    instruments::StationPair<dim>::declare_parameters(prm);
  }


  template <int dim>
  void
  PressureControl<dim>::parse_parameters(ParameterHandler &prm,
                                         const fluid::BoundaryConditions<dim> &conditions)
  {
    condition = nullptr;
    shift     = 0.;
    last_values.clear();
    const std::string name = prm.get("Condition");
    if (name.empty())
      return;

    std::vector<std::string> known;
    for (unsigned int i = 0; i < conditions.size(); ++i)
      {
        known.push_back(conditions.name(i));
        if (known.back() != name)
          continue;
        condition =
          dynamic_cast<const fluid::PressureCondition<dim> *>(&conditions.condition(i));
        AssertThrow(condition != nullptr,
                    base::UserError(std::string(section) +
                                    " / Condition: the boundary "
                                    "condition '" +
                                    name + "' is not of the type pressure."));
        condition->set_shift(0.);
      }
    AssertThrow(condition != nullptr,
                base::UserError(std::string(section) +
                                " / Condition: there is no boundary condition '" + name +
                                "'. " + base::suggest_name(name, known)));
    target.parse_parameters(prm, section, section);
    stations.parse_parameters(prm, section);
    AssertThrow(stations.upstream.position != stations.downstream.position,
                base::UserError(std::string(section) + ": both stations are at " +
                                std::to_string(stations.upstream.position) +
                                " cm; expected two places."));
    time_constant = prm.get_double("Time constant");
    largest_shift = prm.get_double("Largest shift") * base::mmHg;
    last_values.assign(3, 0.);
  }


  template <int dim>
  void PressureControl<dim>::update(const fluid::NavierStokes<dim> &fluid,
                                    const double t,
                                    const double dt)
  {
    const double wanted = target.value(stations.upstream.centre, t + 0.5 * dt);
    const double difference =
      stations.compute_difference(fluid.space().grid(), fluid.pressure(), section);
    last_values = {shift / base::mmHg, difference / base::mmHg, wanted / base::mmHg};
    shift += dt / time_constant * (wanted - difference);
    shift = std::max(-largest_shift, std::min(shift, largest_shift));
    condition->set_shift(shift);
  }


  template <int dim>
  std::vector<std::string> PressureControl<dim>::columns() const
  {
    if (!is_active())
      return {};
    return {"pressure shift [mmHg]",
            "controlled difference [mmHg]",
            "target difference [mmHg]"};
  }


  template <int dim>
  std::vector<double> PressureControl<dim>::state() const
  {
    if (!is_active())
      return {};
    std::vector<double> result = last_values;
    result.push_back(shift);
    return result;
  }


  template <int dim>
  void PressureControl<dim>::set_state(const std::vector<double> &state)
  {
    if (!is_active())
      return;
    AssertDimension(state.size(), last_values.size() + 1);
    last_values.assign(state.begin(), state.end() - 1);
    shift = state.back();
    condition->set_shift(shift);
  }


  template class PressureControl<2>;
  template class PressureControl<3>;
} // namespace mitre::simulation
