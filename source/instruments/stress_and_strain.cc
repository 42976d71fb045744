#include <deal.II/base/mpi.h>

#include <algorithm>
#include <utility>

#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/base/parameters.h>
#include <mitre/instruments/stress_and_strain.h>

namespace mitre::instruments
{
  namespace
  {
    /// A value and the volume in which it holds.
    using Sample = std::pair<double, double>;


    /// Smallest, mean, largest value and percentile of the samples of all ranks.
    std::array<double, 4> compute_statistics(std::vector<Sample> samples,
                                             const double percentile,
                                             const MPI_Comm communicator)
    {
      // Step 1: all samples on the first rank, in order.
      const std::vector<std::vector<Sample>> parts =
        dealii::Utilities::MPI::gather(communicator, samples);
      std::array<double, 4> result = {};
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        {
          samples.clear();
          for (const std::vector<Sample> &samples_of_rank : parts)
            samples.insert(samples.end(), samples_of_rank.begin(), samples_of_rank.end());
          std::sort(samples.begin(), samples.end());
          double volume = 0, sum = 0;
          for (const Sample &sample : samples)
            {
              volume += sample.second;
              sum += sample.first * sample.second;
            }

          // Step 2: up to the value below which there is enough volume; a sum that misses
          // it by round-off counts.
          double below       = 0;
          std::size_t i      = 0;
          const double bound = percentile / 100 * volume * (1 - 1e-12);
          while (i + 1 < samples.size() && below + samples[i].second < bound)
            below += samples[i++].second;
          result = {{samples.front().first,
                     sum / volume,
                     samples.back().first,
                     samples[i].first}};
        }
      return dealii::Utilities::MPI::broadcast(communicator, result);
    }
  } // namespace


  template <int dim>
  void StressAndStrain<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    std::string names;
    for (const auto &quantity : structure::stress_quantities<dim>())
      if (quantity.n_components == 1)
        names += (names.empty() ? "" : "|") + quantity.name;

    prm.declare_entry("Part", "", dealii::Patterns::Anything(), "Name of the part.");
    prm.declare_entry("Materials",
                      "",
                      dealii::Patterns::Anything(),
                      "Names of materials of the part, each of which gets columns of its "
                      "own; empty: the whole part.");
    prm.declare_entry("Quantities",
                      "first principal stress, first principal strain",
                      dealii::Patterns::MultipleSelection(names),
                      "What is looked at; stresses are those of the constitutive law "
                      "[dyn/cm^2], without the pressure of the fluid.");
    prm.declare_entry("Percentile",
                      "95",
                      dealii::Patterns::Double(0, 100),
                      "Part of the volume in which the value of the fourth column is not "
                      "exceeded [per cent].");
  }


  template <int dim>
  void StressAndStrain<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                              const std::string &instrument)
  {
    name            = instrument;
    part            = prm.get("Part");
    materials       = base::parse_names(prm.get("Materials"));
    quantities      = base::parse_names(prm.get("Quantities"));
    percentile      = prm.get_double("Percentile");
    percentile_text = prm.get("Percentile");
    AssertThrow(!quantities.empty(),
                base::UserError("Instrument " + name +
                                ": \"Quantities\" is empty; expected at least one."));
  }


  template <int dim>
  std::vector<std::string> StressAndStrain<dim>::columns() const
  {
    std::vector<std::string> result;
    for (const std::string &material :
         materials.empty() ? std::vector<std::string>{""} : materials)
      for (const std::string &quantity : quantities)
        {
          const std::string unit = structure::find_stress_quantity<dim>(quantity).unit;
          for (const std::string &statistic : {std::string("min"),
                                               std::string("mean"),
                                               std::string("max"),
                                               "percentile " + percentile_text})
            result.push_back(name + (material.empty() ? "" : " " + material) + " " +
                             quantity + " " + statistic + " [" +
                             (unit.empty() ? "1" : unit) + "]");
        }
    return result;
  }


  template <int dim>
  std::vector<double> StressAndStrain<dim>::measure(const Observation<dim> &observation)
  {
    const ObservedPart<dim> &observed = observation.find_part(part, name);
    const structure::FiniteElementBody<dim> &body =
      observation.find_finite_elements(part, name);

    // Step 1: to which columns the materials belong.
    constexpr unsigned int none = dealii::numbers::invalid_unsigned_int;
    std::vector<unsigned int> group_of_material(body.materials().size(),
                                                materials.empty() ? 0 : none);
    std::vector<std::string> known;
    for (const auto &material : body.materials())
      known.push_back(material.name);
    for (unsigned int g = 0; g < materials.size(); ++g)
      {
        const auto found = std::find(known.begin(), known.end(), materials[g]);
        AssertThrow(found != known.end(),
                    base::UserError("Instrument " + name + ": part " + part +
                                    " has no material '" + materials[g] + "'. " +
                                    base::suggest_name(materials[g], known)));
        group_of_material[found - known.begin()] = g;
      }

    // Step 2: the values at all points.
    const unsigned int n_quantities = quantities.size();
    std::vector<const structure::StressQuantity<dim> *> functions;
    for (const std::string &quantity : quantities)
      functions.push_back(&structure::find_stress_quantity<dim>(quantity));
    std::vector<std::vector<Sample>> samples(std::max<std::size_t>(1, materials.size()) *
                                             n_quantities);
    body.for_each_point(*observed.X,
                        observation.time,
                        [&](const unsigned int material,
                            const unsigned int,
                            const double volume,
                            const structure::StressState<dim> &state) {
                          const unsigned int group = group_of_material[material];
                          if (group == none)
                            return;
                          for (unsigned int k = 0; k < n_quantities; ++k)
                            {
                              const unsigned int family = functions[k]->fibre_family;
                              if (family < structure::max_fibre_families &&
                                  state.fibre_stretch[family] == 0)
                                continue;
                              double value;
                              functions[k]->evaluate(state, &value);
                              samples[group * n_quantities + k].emplace_back(value,
                                                                             volume);
                            }
                        });

    // Step 3: their statistics.
    std::vector<double> result;
    for (unsigned int i = 0; i < samples.size(); ++i)
      {
        AssertThrow(
          dealii::Utilities::MPI::logical_or(!samples[i].empty(), body.communicator()),
          base::UserError("Instrument " + name + ": the " + quantities[i % n_quantities] +
                          " has no value, as there are no fibres in " +
                          (materials.empty()
                             ? "part " + part
                             : "material " + materials[i / n_quantities]) +
                          "."));
        for (const double value :
             compute_statistics(std::move(samples[i]), percentile, body.communicator()))
          result.push_back(value);
      }
    return result;
  }


  template class StressAndStrain<2>;
  template class StressAndStrain<3>;
} // namespace mitre::instruments
