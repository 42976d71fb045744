#include <algorithm>

#include <mitre/grid/linear_combination.h>

namespace mitre::grid
{
  template <int dim>
  void LinearCombination<dim>::add(const LinearCombination<dim> &other,
                                   const double factor)
  {
    repeats = repeats || other.repeats || !entries.empty();
    for (const auto &entry : other.entries)
      entries.emplace_back(entry.first, entry.second * factor);
    for (const auto &value : other.auxiliary)
      auxiliary.emplace_back(value.first, value.second * factor);
    for (BoundaryTerm<dim> term : other.boundary)
      {
        term.weight *= factor;
        boundary.push_back(term);
      }
  }


  template <int dim>
  void LinearCombination<dim>::merge()
  {
    std::sort(entries.begin(), entries.end());
    std::size_t size = 0;
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (size > 0 && entries[size - 1].first == entries[i].first)
        entries[size - 1].second += entries[i].second;
      else
        entries[size++] = entries[i];
    entries.resize(size);
    repeats = false;
  }


  template <int dim>
  void LinearCombination<dim>::clear()
  {
    entries.clear();
    auxiliary.clear();
    boundary.clear();
    repeats = false;
  }


  template <int dim>
  void CoarseValues<dim>::clear()
  {
    places.clear();
    auxiliary.clear();
  }


  template <int dim>
  void CombinationSum<dim>::add(const LinearCombination<dim> &terms, const double factor)
  {
    for (const auto &[unknown, weight] : terms.entries)
      {
        const auto [number, is_new] = numbers.insert(unknown);
        if (is_new)
          {
            number = total.entries.size();
            total.entries.emplace_back(unknown, factor * weight);
          }
        else
          total.entries[number].second += factor * weight;
      }
    for (BoundaryTerm<dim> term : terms.boundary)
      {
        term.weight *= factor;
        total.boundary.push_back(term);
      }
  }


  template <int dim>
  void CombinationSum<dim>::add(const LinearCombination<dim> &terms,
                                const double factor,
                                const CoarseValues<dim> &coarse_values)
  {
    add(terms, factor);
    for (const auto &[number, weight] : terms.auxiliary)
      add(coarse_values.values()[number], factor * weight);
  }


  template <int dim>
  void CombinationSum<dim>::move_to(LinearCombination<dim> &sum)
  {
    sum.clear();
    sum.entries.swap(total.entries);
    sum.boundary.swap(total.boundary);
    numbers.clear();
  }


  template struct LinearCombination<2>;
  template struct LinearCombination<3>;
  template class CoarseValues<2>;
  template class CoarseValues<3>;
  template class CombinationSum<2>;
  template class CombinationSum<3>;
} // namespace mitre::grid
