// The rules of every k have points inside the reference element only, positive weights
// that sum to its volume, 1/dim! or 1, and integrate linear fields exactly (simplices;
// the centroid is at 1/(dim + 1)) or products of two linear functions in each direction
// (hypercubes, k >= 2; integral of (x^2 y^2 ..) is 3^-dim). On simplices the number of
// points is at most k^dim from k = 3 on.

#include <cmath>
#include <iostream>

#include <mitre/coupling/point_rules.h>

using namespace mitre;

template <int dim>
void
check(const structure::ElementShape shape)
{
  const bool simplex = shape == structure::ElementShape::simplex;
  double volume = 0, moment = 0;
  bool inside = true, positive = true, few = true;
  for (unsigned int k = simplex ? 1 : 2; k <= 17; ++k)
    {
      const dealii::Quadrature<dim> rule = coupling::make_point_rule<dim>(shape, k);
      double sum = 0, product = 0, first = 0;
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
          first += rule.weight(q) * x[dim - 1];
          product += rule.weight(q) * square;
        }
      const double expected = simplex ? (dim == 2 ? 0.5 : 1. / 6) : 1.;
      volume                = std::max(volume, std::abs(sum - expected));
      moment                = std::max(moment,
                        simplex ? std::abs(first - expected / (dim + 1))
                                               : std::abs(product - std::pow(3., -dim)));
      few                   = few && (k < 3 || rule.size() <= std::pow(k, dim));
    }
  for (const bool fine : {volume < 1e-14, moment < 1e-14, inside, positive, few})
    std::cout << (fine ? "ok " : "FAILED ");
  std::cout << std::endl;
}

int
main()
{
  check<2>(structure::ElementShape::simplex);
  check<2>(structure::ElementShape::hypercube);
  check<3>(structure::ElementShape::simplex);
  check<3>(structure::ElementShape::hypercube);
}
