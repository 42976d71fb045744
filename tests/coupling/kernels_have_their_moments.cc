// Over the points of the grid, the weights of IB_4 and IB_3 sum to 1 and their first
// moment vanishes, so that constants and linear functions are interpolated exactly; the
// sum of their squares does not depend on where the point is (3/8 and 1/2), and those of
// IB_4 sum to 1/2 over the even and over the odd points. They agree with the formulas as
// published, phi(r) of the distance r.

#include <cmath>
#include <iostream>

#include <mitre/coupling/kernels.h>

using namespace mitre::coupling;

double
ib4(double r)
{
  r = std::abs(r);
  if (r >= 2)
    return 0;
  return r < 1 ? (3 - 2 * r + std::sqrt(1 + 4 * r - 4 * r * r)) / 8
               : (5 - 2 * r - std::sqrt(-7 + 12 * r - 4 * r * r)) / 8;
}

double
ib3(double r)
{
  r = std::abs(r);
  if (r >= 1.5)
    return 0;
  return r < 0.5 ? (1 + std::sqrt(1 - 3 * r * r)) / 3
                 : (5 - 3 * r - std::sqrt(1 - 3 * (1 - r) * (1 - r))) / 6;
}

int
main()
{
  for (const std::string &name : kernel_names())
    with_kernel(name, [&](const auto kernel) {
      using Kernel = decltype(kernel);

      const bool four = name == "IB_4";
      double sum = 0, first = 0, squares = 0, even = 0, formula = 0;
      for (double x = 5; x < 7; x += 0.01)
        {
          const double base   = Kernel::index_plus_one(x);
          const double r      = x - base;
          const FourDoubles w = Kernel::weights(r, Kernel::root(r));

          double s = 0, f = 0, q = 0, e[2] = {};
          for (int j = 0; j < 4; ++j)
            {
              const double distance = base - 1 + j - x;
              s += w[j];
              f += w[j] * distance;
              q += w[j] * w[j];
              e[(static_cast<int>(base) + j) % 2] += w[j];
              formula = std::max(formula,
                                 std::abs(w[j] - (four ? ib4(distance) : ib3(distance))));
            }
          sum     = std::max(sum, std::abs(s - 1));
          first   = std::max(first, std::abs(f));
          squares = std::max(squares, std::abs(q - (four ? 0.375 : 0.5)));
          even    = std::max(even, four ? std::abs(e[0] - 0.5) : 0);
        }
      for (const double error : {sum, first, squares, even, formula})
        std::cout << (error < 1e-14 ? "ok " : "FAILED ");
      std::cout << name << std::endl;
    });
}
