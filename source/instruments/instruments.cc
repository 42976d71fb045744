#include <mitre/base/parameters.h>
#include <mitre/instruments/instruments.h>

namespace mitre::instruments
{
  template <int dim>
  void Instruments<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    const auto &registry = instrument_registry<dim>();
    for (const std::string &name :
         base::declare_names(prm,
                             "Instruments",
                             "",
                             "Names of the instruments, with which their columns in "
                             "statistics.csv begin; each is described in 'subsection "
                             "Instrument NAME'."))
      {
        prm.enter_subsection("Instrument " + name);
        const std::string type =
          base::declare_choice(prm,
                               "Type",
                               registry.names().front(),
                               registry.names(),
                               "What it measures.\n" + registry.help());
        registry.declare_parameters(type, prm);
        prm.leave_subsection();
      }
  }


  template <int dim>
  void Instruments<dim>::parse_parameters(dealii::ParameterHandler &prm)
  {
    instruments.clear();
    for (const std::string &name : base::parse_names(prm.get("Instruments")))
      {
        prm.enter_subsection("Instrument " + name);
        instruments.push_back(instrument_registry<dim>().create(prm.get("Type")));
        instruments.back()->parse_parameters(prm, name);
        prm.leave_subsection();
      }
  }


  template <int dim>
  std::vector<std::string> Instruments<dim>::columns() const
  {
    std::vector<std::string> result;
    for (const auto &instrument : instruments)
      for (const std::string &column : instrument->columns())
        result.push_back(column);
    return result;
  }


  template <int dim>
  std::vector<double> Instruments<dim>::measure(const Observation<dim> &observation)
  {
    std::vector<double> result;
    for (const auto &instrument : instruments)
      for (const double value : instrument->measure(observation))
        result.push_back(value);
    return result;
  }


  template <int dim>
  std::vector<std::vector<double>> Instruments<dim>::state() const
  {
    std::vector<std::vector<double>> result;
    for (const auto &instrument : instruments)
      result.push_back(instrument->state());
    return result;
  }


  template <int dim>
  void Instruments<dim>::set_state(const std::vector<std::vector<double>> &state)
  {
    AssertDimension(state.size(), instruments.size());
    for (unsigned int i = 0; i < instruments.size(); ++i)
      instruments[i]->set_state(state[i]);
  }


  template class Instruments<2>;
  template class Instruments<3>;
} // namespace mitre::instruments
