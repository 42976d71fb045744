#ifndef mitre_tests_fluid_momentum_h
#define mitre_tests_fluid_momentum_h

#include "fluid_tests.h"

namespace fluid_tests
{
  /// The sum of rates of change of the velocity over all control volumes, largest of the
  /// components, relative to the sum of what all control volumes gain or lose.
  template <int dim>
  double relative_momentum(const grid::StaggeredSpace<dim> &space,
                           const grid::VectorType &rate)
  {
    std::array<double, dim> sum{};
    double size = 0.;
    grid_tests::for_each_face(space,
                              [&](const std::size_t entry,
                                  const unsigned int,
                                  const unsigned int c,
                                  const Point<dim> &) {
                                const double gain = space.volumes().local_element(entry) *
                                                    rate.local_element(entry);
                                sum[c] += gain;
                                size += std::abs(gain);
                              });
    size           = Utilities::MPI::sum(size, MPI_COMM_WORLD);
    double largest = 0.;
    for (const double s : sum)
      largest = std::max(largest, std::abs(Utilities::MPI::sum(s, MPI_COMM_WORLD)));
    return largest / size;
  }
} // namespace fluid_tests

#endif
