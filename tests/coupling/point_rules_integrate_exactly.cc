// The rules of every k have points inside the reference element only, positive weights
// that sum to its volume, 1/dim! or 1, and integrate products of two linear fields
// exactly: on simplices the integral of x_i x_j is (1 + delta_ij) / (dim + 2)!, on
// hypercubes that of (x^2 y^2 ..) is 3^-dim. On regular simplices with edges of length 1
// no place is farther from the nearest point than the largest hole between the k^dim
// Gauss points of the unit cube, but by 15 % (the parts of a divided tetrahedron are not
// all regular); with fewer points than these have. For the number of points of tetrahedra
// see point_rules.h. With a degree given, rules on simplices integrate the product of
// powers of the coordinates exactly: n! m! .. / (n + m + .. + dim)!. No point of
// quadratic elements is farther beyond the box of the nodes than overshoot() says: the
// sum of the shape functions' absolute values, on a lattice that has its maximum, is 1 +
// 2 overshoot.

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/utilities.h>

#include <cmath>
#include <iostream>

#include <mitre/coupling/point_rules.h>

using namespace mitre;

/// Largest distance of a place in the regular simplex from the nearest point of @p rule.
template <int dim>
double
largest_hole(const dealii::Quadrature<dim> &rule)
{
  // The edges from one vertex of the regular simplex are at 60 degrees.
  const auto square = [](const dealii::Tensor<1, dim> &x) {
    double sum = 0;
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int e = 0; e < dim; ++e)
        sum += x[d] * x[e] * (d == e ? 1 : 0.5);
    return sum;
  };
  const int n    = dim == 2 ? 40 : 24;
  double largest = 0;
  for (int i = 0; i < dealii::Utilities::pow(n + 1, dim); ++i)
    {
      dealii::Point<dim> x;
      double total = 0;
      for (int d = 0, rest = i; d < dim; ++d, rest /= n + 1)
        total += x[d] = (rest % (n + 1)) / static_cast<double>(n);
      if (total > 1 + 1e-10)
        continue;
      double nearest = 1;
      for (const auto &point : rule.get_points())
        nearest = std::min(nearest, square(x - point));
      largest = std::max(largest, nearest);
    }
  return std::sqrt(largest);
}

template <int dim>
void
check(const structure::ElementShape shape)
{
  const bool simplex = shape == structure::ElementShape::simplex;
  double volume = 0, moment = 0, hole = 0;
  bool inside = true, positive = true, few = true;
  for (unsigned int k = 2; k <= 17; ++k)
    {
      const dealii::Quadrature<dim> rule = coupling::make_point_rule<dim>(shape, k);
      double sum = 0, product = 0, x0x0 = 0, x0x1 = 0;
      for (unsigned int q = 0; q < rule.size(); ++q)
        {
          const dealii::Point<dim> &x = rule.point(q);

          double square = 1, total = 0;
          for (unsigned int d = 0; d < dim; ++d)
            {
              inside = inside && x[d] > 0 && x[d] < 1;
              total += x[d];
              square *= x[d] * x[d];
            }
          inside   = inside && (!simplex || total < 1);
          positive = positive && rule.weight(q) > 0;
          sum += rule.weight(q);
          x0x0 += rule.weight(q) * x[dim - 1] * x[dim - 1];
          x0x1 += rule.weight(q) * x[0] * x[1];
          product += rule.weight(q) * square;
        }
      volume =
        std::max(volume, std::abs(sum - (simplex ? (dim == 2 ? 0.5 : 1. / 6) : 1.)));
      if (simplex)
        {
          const double factorial = dim == 2 ? 24 : 120;
          moment                 = std::max(
            {moment, std::abs(x0x0 - 2 / factorial), std::abs(x0x1 - 1 / factorial)});
          const dealii::QGauss<1> gauss(k);
          double half = gauss.point(0)[0];
          for (unsigned int i = 1; i < k; ++i)
            half = std::max(half, 0.5 * (gauss.point(i)[0] - gauss.point(i - 1)[0]));
          hole = std::max(hole, largest_hole(rule) / (half * std::sqrt(1. * dim)));
          few  = few && rule.size() < std::pow(k, dim);
        }
      else
        moment = std::max(moment, std::abs(product - std::pow(3., -dim)));
    }
  for (const bool fine :
       {volume < 1e-14, moment < 1e-14, hole < 1.15, inside, positive, few})
    std::cout << (fine ? "ok " : "FAILED ");
  std::cout << std::endl;
}

template <int dim>
void
check_degrees()
{
  const auto factorial = [](const unsigned int n) { return std::tgamma(n + 1.); };
  double error         = 0;
  for (const unsigned int degree : {2, 4, 6, 7})
    for (unsigned int k = 2; k <= 17; ++k)
      {
        const dealii::Quadrature<dim> rule =
          coupling::make_point_rule<dim>(structure::ElementShape::simplex, k, degree);
        for (unsigned int n = 0; n <= degree; ++n)
          for (unsigned int m = 0; m <= degree - n; ++m)
            {
              const unsigned int l = dim == 3 ? degree - n - m : 0;
              double sum           = 0;
              for (unsigned int q = 0; q < rule.size(); ++q)
                sum += rule.weight(q) * std::pow(rule.point(q)[0], n) *
                       std::pow(rule.point(q)[1], m) *
                       std::pow(rule.point(q)[dim - 1], l);
              error = std::max(error,
                               std::abs(sum * factorial(n + m + l + dim) /
                                          (factorial(n) * factorial(m) * factorial(l)) -
                                        1));
            }
      }

  double difference = 0;
  for (const structure::ElementShape shape :
       {structure::ElementShape::simplex, structure::ElementShape::hypercube})
    for (const unsigned int degree : {1, 2})
      {
        const structure::ReferenceElement<dim> element(shape, degree);
        double largest = 0;
        const int n    = 12;
        for (int i = 0; i < dealii::Utilities::pow(n + 1, dim); ++i)
          {
            dealii::Point<dim> x;
            double total = 0;
            for (int d = 0, rest = i; d < dim; ++d, rest /= n + 1)
              total += x[d] = (rest % (n + 1)) / static_cast<double>(n);
            if (shape == structure::ElementShape::simplex && total > 1 + 1e-10)
              continue;
            double sum = 0;
            for (unsigned int a = 0; a < element.n_nodes(); ++a)
              sum += std::abs(element.value(a, x));
            largest = std::max(largest, sum);
          }
        difference =
          std::max(difference,
                   std::abs(largest - 1 - 2 * coupling::overshoot(dim, shape, degree)));
      }
  std::cout << (error < 1e-12 ? "ok " : "FAILED ")
            << (difference < 1e-12 ? "ok" : "FAILED") << std::endl;
}

int
main()
{
  check<2>(structure::ElementShape::simplex);
  check<2>(structure::ElementShape::hypercube);
  check<3>(structure::ElementShape::simplex);
  check<3>(structure::ElementShape::hypercube);

  check_degrees<2>();
  check_degrees<3>();

  for (const unsigned int k : {2, 4, 5, 6, 7, 8, 10})
    std::cout << coupling::make_point_rule<3>(structure::ElementShape::simplex, k).size()
              << ' ';
  std::cout << std::endl;
}
