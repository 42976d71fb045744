#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>

#include <mitre/coupling/point_rules.h>

namespace mitre::coupling
{
  namespace
  {
    using dealii::Point;
    using dealii::Quadrature;


    template <int dim>
    Quadrature<dim> simplex_rule(const unsigned int k)
    {
      if (k == 2)
        return dealii::QWitherdenVincentSimplex<dim>(1, false);
      return dealii::QWitherdenVincentSimplex<dim>(k);
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
                                  const unsigned int k)
  {
    if (shape == structure::ElementShape::hypercube)
      return dealii::QGauss<dim>(k);

    // The largest rule that there is.
    constexpr unsigned int largest = dim == 2 ? 7 : 5;
    if (k <= largest)
      return simplex_rule<dim>(k);
    const unsigned int m = (k + largest - 1) / largest;
    return subdivide(simplex_rule<dim>((k + m - 1) / m), m);
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
  }


  template <int dim>
  PointRules<dim>::PointRules(const structure::ElementShape shape,
                              const structure::ReferenceElement<dim> &element)
    : shape(shape)
    , element(element)
  {
  }


  template <int dim>
  const PointRule<dim> &PointRules<dim>::make(const unsigned int k)
  {
    if (k >= rules.size())
      rules.resize(k + 1);
    rules[k] = std::make_unique<PointRule<dim>>(element, make_point_rule<dim>(shape, k));
    return *rules[k];
  }


  template Quadrature<2> make_point_rule(const structure::ElementShape,
                                         const unsigned int);
  template Quadrature<3> make_point_rule(const structure::ElementShape,
                                         const unsigned int);
  template struct PointRule<2>;
  template struct PointRule<3>;
  template class PointRules<2>;
  template class PointRules<3>;
} // namespace mitre::coupling
