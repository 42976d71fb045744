// Time of the batched stresses of every law, with its default parameters, in nanoseconds
// a point (an element, for linear simplices), on one core.
//
// Usage: constitutive_laws [points = 64] [repetitions = 20000]

#include <chrono>
#include <cstdio>

#include "../../structure/structure_tests.h"

using namespace structure_tests;

template <int dim>
void
run(const unsigned int n_points, const unsigned int n_repetitions)
{
  std::vector<dealii::Tensor<2, dim>> F(n_points), P(n_points);
  std::vector<double> J(n_points);
  std::vector<Fibres<dim>> fibres(n_points);
  for (unsigned int p = 0; p < n_points; ++p)
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          F[p][i][j] = (i == j ? 1.08 : 0.) + 0.03 * std::sin(1. + p + 3 * i + 5 * j);
      J[p]            = determinant(F[p]);
      fibres[p][0][0] = 1;
      fibres[p][1][1] = 1;
    }

  for (const std::string &name : constitutive_laws<dim>().names())
    {
      const auto law = make_law<dim>(name);
      double best    = 1e9;
      for (unsigned int trial = 0; trial < 9; ++trial)
        {
          const auto start = std::chrono::steady_clock::now();
          for (unsigned int r = 0; r < n_repetitions / 9; ++r)
            law->compute_stresses(dealii::make_array_view(std::as_const(F)),
                                  dealii::make_array_view(std::as_const(J)),
                                  fibres.data(),
                                  1,
                                  0.,
                                  dealii::make_array_view(P));
          best = std::min(
            best,
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
              .count());
        }
      std::printf("%dD %-24s %7.1f ns a point\n",
                  dim,
                  name.c_str(),
                  best / (n_repetitions / 9) / n_points * 1e9);
    }
}

int
main(int argc, char **argv)
{
  const unsigned int n_points      = argc > 1 ? std::atoi(argv[1]) : 64;
  const unsigned int n_repetitions = argc > 2 ? std::atoi(argv[2]) : 20000;
  run<2>(n_points, n_repetitions);
  run<3>(n_points, n_repetitions);
}
