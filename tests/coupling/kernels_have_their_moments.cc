// Over the points of the grid, wherever a point lies between them, the weights of all
// kernels sum to 1 and their first moment vanishes, so that constants and linear
// functions are interpolated exactly. Further moments about the point as their
// definitions have them: the sum of squares is 1/2 (IB_3), 3/8 (IB_4), or that at the
// middle between two points (IB_5, IB_6); those of IB_4 and IB_6 sum to 1/2 over the even
// and over the odd points; the second moment is (38 - sqrt 69)/60 (IB_5), 59/60 -
// sqrt(29)/20 (IB_6), n/12 (B-splines of n >= 3 points), and the third one 0 (IB_5, IB_6,
// B-splines from n = 4 on). Weights agree with formulas of the distance as published (IB)
// or with the sum of truncated powers (B-splines), are continuous from one grid point to
// the next, and not negative. All to round-off, 1e-13.
//
// A composite kernel is the B-spline of n points along a component and that of n - 1
// across; the derivative of the one is the difference of the other, here as a
// difference quotient with a step of 1e-4 (5e-6). No kernel has another name.

#include <cmath>
#include <iostream>

#include <mitre/base/exceptions.h>
#include <mitre/coupling/kernels.h>

using namespace mitre::coupling;

/// The kernel at distance @p r by a formula that the code does not use.
double
published(const std::string &name, double r)
{
  r = std::abs(r);
  if (name == "IB_3")
    return r >= 1.5  ? 0
           : r < 0.5 ? (1 + std::sqrt(1 - 3 * r * r)) / 3
                     : (5 - 3 * r - std::sqrt(1 - 3 * (1 - r) * (1 - r))) / 6;
  if (name == "IB_4")
    return r >= 2  ? 0
           : r < 1 ? (3 - 2 * r + std::sqrt(1 + 4 * r - 4 * r * r)) / 8
                   : (5 - 2 * r - std::sqrt(-7 + 12 * r - 4 * r * r)) / 8;
  if (name == "IB_5" && r <= 0.5)
    {
      const double K = (38 - std::sqrt(69.)) / 60, r2 = r * r;
      return (136 - 40 * K - 40 * r2 +
              std::sqrt(2 * (3123 - 6840 * K + 3600 * K * K - 12440 * r2 +
                             25680 * K * r2 - 12600 * K * K * r2 + 8080 * r2 * r2 -
                             8400 * K * r2 * r2 - 1400 * r2 * r2 * r2))) /
             280;
    }
  if (name == "IB_6" && r >= 2 && r < 3)
    {
      const double K = 59. / 60 - std::sqrt(29.) / 20, s = 3 - r, s2 = s * s;
      const double beta =
        9. / 4 - 1.5 * (K + s2) + (22. / 3 - 7 * K) * s - 7. / 3 * s * s2;
      const double gamma =
        0.25 * ((161. / 36 - 59. / 6 * K + 5 * K * K) * 0.5 * s2 +
                (-109. / 24 + 5 * K) / 3 * s2 * s2 + 5. / 18 * s2 * s2 * s2);
      return (-beta + std::sqrt(beta * beta - 112 * gamma)) / 56;
    }
  if (name.substr(0, 8) == "BSPLINE_")
    {
      const int n = name[8] - '0';
      double sum = 0, binomial = 1, factorial = 1;
      for (int i = 0; i <= n; ++i)
        {
          const double y = r + 0.5 * n - i;
          sum += y > 0 ? binomial * std::pow(y, n - 1) : 0;
          binomial *= -(n - i) / (i + 1.);
          factorial *= i > 0 && i < n ? i : 1;
        }
      return r < 0.5 * n ? sum / factorial : 0;
    }
  return NAN;
}

/// weights[j] and distances[j] of the grid points about coordinate x > 10.
template <typename Kernel>
struct Weights
{
  static constexpr int n = Kernel::n_points;
  std::array<double, n> weights;
  std::array<double, n> distances;
  int first;

  explicit Weights(const double x)
  {
    const double base = std::floor(n % 2 == 0 ? x : x + 0.5);
    weights           = Kernel::weights(x - base);
    first             = static_cast<int>(base) - (n - 1) / 2;
    for (int j = 0; j < n; ++j)
      distances[j] = first + j - x;
  }

  double moment(const int order) const
  {
    double sum = 0;
    for (int j = 0; j < n; ++j)
      sum += weights[j] * std::pow(distances[j], order);
    return sum;
  }

  double sum_of_squares() const
  {
    double sum = 0;
    for (const double weight : weights)
      sum += weight * weight;
    return sum;
  }

  double even_sum() const
  {
    double sum = 0;
    for (int j = 0; j < n; ++j)
      sum += (first + j) % 2 == 0 ? weights[j] : 0;
    return sum;
  }

  /// That of grid point @p i.
  double at(const int i) const
  {
    return i >= first && i < first + n ? weights[i - first] : 0;
  }
};

template <typename Kernel>
void
check()
{
  const std::string name = Kernel::name;
  const int n            = Kernel::n_points;
  const bool spline      = name[0] == 'B';

  // What is not claimed is NaN.
  const double squares = name == "IB_3"   ? 0.5
                         : name == "IB_4" ? 0.375
                         : spline         ? NAN
                                          : Weights<Kernel>(10.5).sum_of_squares();
  const double second  = name == "IB_5"     ? (38 - std::sqrt(69.)) / 60
                         : name == "IB_6"   ? 59. / 60 - std::sqrt(29.) / 20
                         : spline && n >= 3 ? n / 12.
                                            : NAN;
  const double third   = n >= 5 || (spline && n == 4) ? 0 : NAN;
  const double even    = name == "IB_4" || name == "IB_6" ? 0.5 : NAN;

  double errors[8] = {};
  double least     = 1;
  const auto note = [&](const unsigned int i, const double value, const double expected) {
    if (!std::isnan(expected))
      errors[i] = std::max(errors[i], std::abs(value - expected));
  };
  for (int step = 0; step < 200; ++step)
    {
      const Weights<Kernel> w(10 + 0.01 * step);
      note(0, w.moment(0), 1);
      note(1, w.moment(1), 0);
      note(2, w.moment(2), second);
      note(3, w.moment(3), third);
      note(4, w.sum_of_squares(), squares);
      note(5, w.even_sum(), even);
      for (int j = 0; j < n; ++j)
        {
          note(6, w.weights[j], published(name, w.distances[j]));
          least = std::min(least, w.weights[j]);
        }
    }
  const double jump = n % 2 == 0 ? 11 : 10.5;
  for (int i = 5; i < 16; ++i)
    note(7, Weights<Kernel>(jump - 1e-15).at(i), Weights<Kernel>(jump).at(i));

  for (const double error : errors)
    std::cout << (error < 1e-13 ? "ok " : "FAILED ");
  std::cout << (least > -1e-15 ? "ok " : "FAILED ") << name << std::endl;
}

template <typename Composite>
void
check_composite(const int n)
{
  using Normal = typename Composite::Normal;
  using Across = typename Composite::Across;

  // Cell i is between the faces i and i + 1. As a point moves up, face i gains what the
  // cell below it has more than the cell above.
  double error = 0;
  for (double x = 10; x < 12; x += 0.013)
    for (int i = 5; i < 16; ++i)
      {
        const double step = 1e-4;
        const double derivative =
          (Weights<Normal>(x + step).at(i) - Weights<Normal>(x - step).at(i)) /
          (2 * step);
        const Weights<Across> cells(x - 0.5);
        error = std::max(error, std::abs(derivative - (cells.at(i - 1) - cells.at(i))));
      }
  std::cout << (Normal::n_points == n && Across::n_points == n - 1 ? "ok " : "FAILED ")
            << (error < 5e-6 || (n == 3 && error < 1e-4) ? "ok " : "FAILED ")
            << Composite::name << std::endl;
}

int
main()
{
  check<kernels::IB3>();
  check<kernels::IB4>();
  check<kernels::IB5>();
  check<kernels::IB6>();
  check<kernels::BSpline<2>>();
  check<kernels::BSpline<3>>();
  check<kernels::BSpline<4>>();
  check<kernels::BSpline<5>>();
  check<kernels::BSpline<6>>();
  check_composite<kernels::CompositeBSpline<3>>(3);
  check_composite<kernels::CompositeBSpline<4>>(4);
  check_composite<kernels::CompositeBSpline<5>>(5);
  check_composite<kernels::CompositeBSpline<6>>(6);

  for (const std::string &name : kernel_names())
    with_kernel(name, [&](const auto kernel) {
      std::cout << (name == decltype(kernel)::name ? "found " : "FAILED ") << name
                << std::endl;
    });
  try
    {
      with_kernel("IB_7", [](const auto) { std::cout << "FAILED" << std::endl; });
    }
  catch (const mitre::base::UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
}
