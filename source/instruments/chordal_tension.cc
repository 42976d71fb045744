#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/instruments/chordal_tension.h>

namespace mitre::instruments
{
  template <int dim>
  void ChordalTension<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "Part", "", dealii::Patterns::Anything(), "Name of the part, of fibres.");
    prm.declare_entry("Force functions",
                      "1",
                      dealii::Patterns::List(dealii::Patterns::Integer(0), 1),
                      "Springs with one of these indices in the fifth column of the "
                      "spring file are those of chordae.");
    prm.declare_entry("Number of chordae",
                      "0",
                      dealii::Patterns::Integer(0, 10000),
                      "0: the largest and the mean tension of all. Otherwise how many "
                      "chordae the part has, each of which gets a column.");
  }


  template <int dim>
  void ChordalTension<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                             const std::string &instrument)
  {
    name            = instrument;
    part            = prm.get("Part");
    force_functions = base::parse_integers(prm.get("Force functions"),
                                           "Instrument " + name + ", Force functions");
    n_chordae       = prm.get_integer("Number of chordae");
    chordae.clear();
  }


  template <int dim>
  std::vector<std::string> ChordalTension<dim>::columns() const
  {
    std::vector<std::string> result = {name + " largest [dyn]", name + " mean [dyn]"};
    for (unsigned int i = 0; i < n_chordae; ++i)
      result.push_back(name + " chord " + std::to_string(i + 1) + " [dyn]");
    return result;
  }


  template <int dim>
  void ChordalTension<dim>::find_chordae(const structure::FibreNetwork<dim> &network)
  {
    // Each node points towards the one that stands for its chord.
    std::vector<unsigned int> towards(network.nodes.size());
    std::iota(towards.begin(), towards.end(), 0);
    const auto find = [&](unsigned int node) {
      while (towards[node] != node)
        node = towards[node] = towards[towards[node]];
      return node;
    };
    std::vector<unsigned int> springs;
    for (unsigned int i = 0; i < network.springs.size(); ++i)
      if (const structure::Spring &spring = network.springs[i];
          std::find(force_functions.begin(),
                    force_functions.end(),
                    static_cast<int>(spring.force_function)) != force_functions.end())
        {
          springs.push_back(i);
          towards[find(spring.nodes[0])] = find(spring.nodes[1]);
        }
    AssertThrow(!springs.empty(),
                base::UserError("Instrument " + name + ": no spring of " +
                                network.spring_source +
                                " has one of its \"Force functions\"."));

    std::map<unsigned int, unsigned int> number_of;
    for (const unsigned int i : springs)
      {
        const auto added =
          number_of.emplace(find(network.springs[i].nodes[0]), chordae.size());
        if (added.second)
          chordae.emplace_back();
        chordae[added.first->second].push_back(i);
      }
    AssertThrow(n_chordae == 0 || n_chordae == chordae.size(),
                base::UserError("Instrument " + name + ": " + network.spring_source +
                                " has " + std::to_string(chordae.size()) +
                                " chordae; \"Number of chordae\" says " +
                                std::to_string(n_chordae) + "."));
  }


  template <int dim>
  std::vector<double> ChordalTension<dim>::measure(const Observation<dim> &observation)
  {
    const ObservedPart<dim> &observed = observation.find_part(part, name);
    const auto *body = dynamic_cast<const structure::FibreBody<dim> *>(observed.body);
    AssertThrow(body != nullptr,
                base::UserError("Instrument " + name + ": the part " + part +
                                " consists of finite elements; expected one of fibres."));
    if (chordae.empty())
      find_chordae(body->network());

    const std::vector<double> tensions =
      body->compute_spring_tensions(body->to_mesh_order(*observed.X));
    double largest = -std::numeric_limits<double>::infinity(), sum = 0, length = 0;
    double plain_sum       = 0;
    unsigned int n_springs = 0;
    std::vector<double> result(2);
    for (const std::vector<unsigned int> &chord : chordae)
      {
        double largest_of_chord = -std::numeric_limits<double>::infinity();
        for (const unsigned int i : chord)
          {
            const double l   = body->network().springs[i].rest_length;
            largest_of_chord = std::max(largest_of_chord, tensions[i]);
            sum += l * tensions[i];
            length += l;
            plain_sum += tensions[i];
            ++n_springs;
          }
        largest = std::max(largest, largest_of_chord);
        if (n_chordae > 0)
          result.push_back(largest_of_chord);
      }
    result[0] = largest;
    result[1] = length > 0 ? sum / length : plain_sum / n_springs;
    return result;
  }


  template class ChordalTension<2>;
  template class ChordalTension<3>;
} // namespace mitre::instruments
