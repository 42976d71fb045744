#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/instruments/observation.h>

namespace mitre::instruments
{
  template <int dim>
  const ObservedPart<dim> &
  Observation<dim>::find_part(const std::string &name,
                              const std::string &instrument) const
  {
    std::vector<std::string> known;
    for (const ObservedPart<dim> &part : parts)
      {
        if (part.body->name() == name)
          return part;
        known.push_back(part.body->name());
      }
    throw base::UserError("Instrument " + instrument + ": there is no part '" + name +
                          "'. " + base::suggest_name(name, known));
  }


  template <int dim>
  const structure::FiniteElementBody<dim> &
  Observation<dim>::find_finite_elements(const std::string &name,
                                         const std::string &instrument) const
  {
    const auto *body = dynamic_cast<const structure::FiniteElementBody<dim> *>(
      find_part(name, instrument).body);
    AssertThrow(body != nullptr,
                base::UserError("Instrument " + instrument + ": the part " + name +
                                " consists of fibres; expected one of finite elements."));
    return *body;
  }


  template struct Observation<2>;
  template struct Observation<3>;
} // namespace mitre::instruments
