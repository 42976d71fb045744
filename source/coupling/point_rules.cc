#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <mitre/coupling/point_rules.h>

namespace mitre::coupling
{
  namespace
  {
    using dealii::Point;
    using dealii::Quadrature;


    /// A rule of Witherden and Vincent, and the radius of its largest hole in the regular
    /// simplex with edges of length 1.
    struct SimplexRule
    {
      unsigned int n_points_1d;
      bool odd_degree;
      unsigned int n_points;
      double hole;
    };

    /// Those that no other rule of as few points betters.
    template <int dim>
    const std::vector<SimplexRule> &simplex_rules()
    {
      static const std::vector<SimplexRule> rules =
        dim == 2 ? std::vector<SimplexRule>{{1, false, 3, 0.2887},
                                            {2, false, 6, 0.1999},
                                            {3, false, 12, 0.1695},
                                            {4, true, 15, 0.1590},
                                            {4, false, 16, 0.1434},
                                            {5, true, 19, 0.1303},
                                            {5, false, 25, 0.1205},
                                            {6, true, 28, 0.1099},
                                            {6, false, 33, 0.1072},
                                            {7, true, 37, 0.1008}}
                 : std::vector<SimplexRule>{{1, false, 4, 0.3386},
                                            {2, true, 8, 0.2909},
                                            {3, true, 14, 0.2272},
                                            {3, false, 24, 0.1895},
                                            {4, true, 35, 0.1706},
                                            {4, false, 46, 0.1573},
                                            {5, true, 59, 0.1360}};
      return rules;
    }


    /// The radius of the largest hole between k^dim Gauss points in the unit cube.
    template <int dim>
    double largest_hole(const unsigned int k)
    {
      const dealii::QGauss<1> rule(k);
      double half_distance = rule.point(0)[0];
      for (unsigned int i = 1; i < k; ++i)
        half_distance =
          std::max(half_distance, 0.5 * (rule.point(i)[0] - rule.point(i - 1)[0]));
      return half_distance * std::sqrt(1. * dim);
    }


    /**
     * @p rule on each of m^dim simplices of equal volume that make up the reference
     * simplex. In coordinates y with 1 >= y_0 >= y_1 >= .. >= 0 these are the simplices
     * into which the diagonals divide the cubes of a lattice of width 1/m.
     */
    template <int dim>
    Quadrature<dim> subdivide(const Quadrature<dim> &rule, const unsigned int m)
    {
      std::vector<Point<dim>> points;
      std::vector<double> weights;

      std::array<unsigned int, dim> order;
      for (unsigned int d = 0; d < dim; ++d)
        order[d] = d;
      do
        for (unsigned int cube = 0; cube < dealii::Utilities::pow(m, dim); ++cube)
          {
            // Step 1: the vertices, from the cube's first corner along the edges in the
            // order of the permutation; is the centroid inside?
            std::array<Point<dim>, dim + 1> vertices;
            for (unsigned int d = 0, rest = cube; d < dim; ++d, rest /= m)
              vertices[0][d] = rest % m;
            Point<dim> centroid = vertices[0];
            for (unsigned int a = 1; a <= dim; ++a)
              {
                vertices[a] = vertices[a - 1];
                vertices[a][order[a - 1]] += 1;
                centroid += vertices[a];
              }
            bool inside = true;
            for (unsigned int d = 1; d < dim; ++d)
              inside = inside && centroid[d - 1] > centroid[d];
            if (!inside)
              continue;

            // Step 2: the rule's points, with x_d = y_d - y_{d+1}.
            for (unsigned int q = 0; q < rule.size(); ++q)
              {
                Point<dim> y = vertices[0];
                for (unsigned int a = 0; a < dim; ++a)
                  y += rule.point(q)[a] * (vertices[a + 1] - vertices[0]);
                Point<dim> x;
                for (unsigned int d = 0; d < dim; ++d)
                  x[d] = (y[d] - (d + 1 < dim ? y[d + 1] : 0)) / m;
                points.push_back(x);
                weights.push_back(rule.weight(q) / dealii::Utilities::pow(m, dim));
              }
          }
      while (std::next_permutation(order.begin(), order.end()));
      return Quadrature<dim>(points, weights);
    }
  } // namespace


  template <int dim>
  Quadrature<dim> make_point_rule(const structure::ElementShape shape,
                                  const unsigned int k,
                                  const unsigned int degree)
  {
    if (shape == structure::ElementShape::hypercube)
      return dealii::QGauss<dim>(k);

    const double hole = largest_hole<dim>(k);
    SimplexRule best{};
    unsigned int best_parts = 0;
    std::size_t fewest      = std::numeric_limits<std::size_t>::max();
    for (const SimplexRule &rule : simplex_rules<dim>())
      {
        if (2 * rule.n_points_1d - rule.odd_degree < degree)
          continue;
        const unsigned int m = std::ceil(rule.hole / hole);
        const std::size_t n  = rule.n_points * dealii::Utilities::pow(m, dim);
        if (n < fewest)
          {
            best       = rule;
            best_parts = m;
            fewest     = n;
          }
      }
    const dealii::QWitherdenVincentSimplex<dim> rule(best.n_points_1d, best.odd_degree);
    return best_parts == 1 ? Quadrature<dim>(rule) : subdivide<dim>(rule, best_parts);
  }


  Exactness needed_exactness(const int dim,
                             const structure::ElementShape shape,
                             const unsigned int degree,
                             const bool is_affine)
  {
    // The determinant of the map's gradient: of each coordinate to the power dim degree -
    // 1 on hypercubes, of total degree dim (degree - 1) on simplices.
    const unsigned int jacobian =
      is_affine ? 0
                : (shape == structure::ElementShape::simplex ? dim * (degree - 1)
                                                             : dim * degree - 1);
    return {degree + 1 + jacobian / 2, 2 * degree + jacobian};
  }


  double
  overshoot(const int dim, const structure::ElementShape shape, const unsigned int degree)
  {
    if (degree == 1)
      return 0;
    if (shape == structure::ElementShape::simplex)
      return dim == 2 ? 1. / 3 : 0.5;
    return 0.5 * (std::pow(1.25, dim) - 1);
  }


  template <int dim>
  PointRule<dim>::PointRule(const structure::ReferenceElement<dim> &element,
                            const Quadrature<dim> &rule)
    : n_points(rule.size())
    , n_padded((n_points + 7) / 8 * 8)
    , table(element, rule)
  {
    // The points that fill up the last vector are copies of the first one.
    for (unsigned int a = 0; a < table.n_nodes; ++a)
      for (unsigned int q = 0; q < n_padded; ++q)
        by_node.push_back(table.values[(q < n_points ? q : 0) * table.n_nodes + a]);
    by_point = table.values;
    by_point.resize(by_point.size() + 7);
  }


  template <int dim>
  PointRule<dim>::PointRule()
    : n_points(1)
    , n_padded(8)
    , by_node(8, 1.)
    , by_point{1., 0., 0., 0., 0., 0., 0., 0.}
  {
  }


  template <int dim>
  PointRules<dim>::PointRules(const structure::ElementShape shape,
                              const unsigned int degree,
                              const structure::ReferenceElement<dim> &element)
    : shape(shape)
    , degree(degree)
    , element(element)
  {
  }


  template <int dim>
  const PointRule<dim> &PointRules<dim>::make(const unsigned int number)
  {
    if (number >= rules.size())
      rules.resize(number + 1);
    const bool is_affine = number % 2 == 0;
    rules[number]        = std::make_unique<PointRule<dim>>(
      element,
      make_point_rule<dim>(
        shape, number / 2, needed_exactness(dim, shape, degree, is_affine).degree));
    return *rules[number];
  }


  template Quadrature<2>
  make_point_rule(const structure::ElementShape, const unsigned int, const unsigned int);
  template Quadrature<3>
  make_point_rule(const structure::ElementShape, const unsigned int, const unsigned int);
  template struct PointRule<2>;
  template struct PointRule<3>;
  template class PointRules<2>;
  template class PointRules<3>;
} // namespace mitre::coupling
