// Nodes tied to points of a finite element part. At rest and under the same affine map of
// both parts nothing pulls; when one node is moved by d, it is pulled back by kappa d,
// and the nodes of its element are pulled by the shares of the shape functions, which are
// worked out by hand for the middle of an edge and of a square. Under random positions
// the forces add up to nothing and are minus the derivative of the energy (central
// differences, 1e-7), on simplices and hypercubes of degree 1 and 2 whose inner nodes are
// displaced. Nodes outside of the part are found, and so are parts without elements.

#include <deal.II/base/mpi.h>

#include <functional>
#include <iostream>
#include <random>

#include <mitre/structure/tie.h>

#include "structure_tests.h"

using namespace structure_tests;
using dealii::Point;
using dealii::Tensor;

namespace
{
  void check(const std::string &what, const bool good, const double found = 0)
  {
    std::cout << what << (good ? ": ok" : ": FAILED, found " + std::to_string(found))
              << std::endl;
  }


  template <int dim>
  Tie<dim> make_tie(const std::string &region, const std::string &stiffness = "3")
  {
    dealii::ParameterHandler prm;
    Tie<dim>::declare_parameters(prm);
    prm.set("Part", "strand");
    prm.set("To", "block");
    prm.set("Region", region);
    prm.set("Stiffness", stiffness);
    Tie<dim> tie;
    tie.parse_parameters(prm, "knot");
    return tie;
  }


  template <int dim>
  std::vector<double> positions(const Mesh<dim> &mesh,
                                const std::function<Point<dim>(const Point<dim> &)> &map)
  {
    std::vector<double> X;
    for (const Point<dim> &s : mesh.nodes)
      for (unsigned int c = 0; c < dim; ++c)
        X.push_back(map(s)[c]);
    return X;
  }


  double largest(const std::vector<double> &values)
  {
    double result = 0;
    for (const double value : values)
      result = std::max(result, std::abs(value));
    return result;
  }


  template <int dim>
  void check_balance(const ElementShape shape, const unsigned int degree)
  {
    const Mesh<dim> block = make_box_of_degree<dim>(shape, degree, 3);
    Mesh<dim> strand;
    strand.source = "strand";
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(0.05, 0.95);
    for (unsigned int i = 0; i < 40; ++i)
      {
        Point<dim> x;
        for (unsigned int c = 0; c < dim; ++c)
          x[c] = number(random);
        if (i % 4 == 3)
          x[0] += 1; // outside
        strand.nodes.push_back(x);
      }
    Tie<dim> tie = make_tie<dim>("");
    tie.reinit(strand, block);
    check("tied", tie.n_nodes() == 30);

    const auto affine = [](const Point<dim> &s) {
      Point<dim> x;
      for (unsigned int c = 0; c < dim; ++c)
        x[c] = 0.3 * c + 1.2 * s[c] - 0.4 * s[(c + 1) % dim];
      return x;
    };
    std::vector<double> X = positions<dim>(strand, affine),
                        Y = positions<dim>(block, affine);
    std::vector<double> on_strand(X.size()), on_block(Y.size());
    tie.add_forces(X, Y, on_strand, on_block);
    check("no force under an affine map",
          largest(on_strand) < 1e-11 && largest(on_block) < 1e-11 &&
            tie.largest_distance(X, Y) < 1e-11);

    for (std::vector<double> *v : {&X, &Y})
      for (double &x : *v)
        x += 0.2 * number(random);
    std::fill(on_strand.begin(), on_strand.end(), 0.);
    std::fill(on_block.begin(), on_block.end(), 0.);
    tie.add_forces(X, Y, on_strand, on_block);
    Tensor<1, dim> total;
    for (const std::vector<double> *v : {&on_strand, &on_block})
      for (unsigned int i = 0; i < v->size(); ++i)
        total[i % dim] += (*v)[i];
    check("forces add up to nothing",
          total.norm() < 1e-12 * on_strand.size() && largest(on_strand) > 0.01);

    // The power of the forces with the positions themselves, which are linear in them, is
    // minus twice the energy; differentiated by a few positions.
    const auto energy = [&]() {
      std::vector<double> a(X.size()), b(Y.size());
      tie.add_forces(X, Y, a, b);
      double sum = 0;
      for (unsigned int i = 0; i < a.size(); ++i)
        sum -= a[i] * X[i];
      for (unsigned int i = 0; i < b.size(); ++i)
        sum -= b[i] * Y[i];
      return 0.5 * sum;
    };
    double error = 0;
    for (unsigned int i = 0; i < 7; ++i)
      for (const bool of_block : {false, true})
        {
          std::vector<double> &v = of_block ? Y : X;
          const unsigned int k   = (i * 37) % v.size();
          const double epsilon = 1e-4, middle = v[k];
          v[k]               = middle + epsilon;
          const double above = energy();
          v[k]               = middle - epsilon;
          const double below = energy();
          v[k]               = middle;
          error              = std::max(error,
                           std::abs((above - below) / (2 * epsilon) +
                                    (of_block ? on_block : on_strand)[k]));
        }
    check("forces are minus the derivative of the energy", error < 1e-7, error);
  }
} // namespace


int
main()
{
  // By hand: a node in the middle of the square (0,1)^2, one in the middle of its lower
  // side, one at its corner (1,1).
  const Mesh<2> square = make_box<2>(ElementShape::hypercube, 1, 0.);
  Mesh<2> nodes;
  nodes.nodes = {{0.5, 0.5}, {0.5, 0.}, {1., 1.}, {1.5, 1.}};
  Tie<2> tie  = make_tie<2>("x < 1.2");
  tie.reinit(nodes, square);
  check("three nodes", tie.n_nodes() == 3);
  std::vector<double> X = positions<2>(nodes, [](const Point<2> &s) { return s; }),
                      Y = positions<2>(square, [](const Point<2> &s) { return s; });
  for (const unsigned int node : {0, 1, 2})
    {
      std::vector<double> moved = X, f(8), g(8);
      moved[2 * node + 1] += 0.1;
      tie.add_forces(moved, Y, f, g);
      std::cout << "node " << node << ": " << f[2 * node + 1] << ";";
      for (const double force : g)
        std::cout << ' ' << force;
      std::cout << "; " << tie.largest_distance(moved, Y) << std::endl;
    }

  for (const ElementShape shape : {ElementShape::simplex, ElementShape::hypercube})
    for (const unsigned int degree : {1, 2})
      {
        check_balance<2>(shape, degree);
        check_balance<3>(shape, degree);
      }

  const auto expect_error = [&](Tie<2> wrong, const Mesh<2> &host) {
    try
      {
        wrong.reinit(nodes, host);
        std::cout << "FAILED: no error" << std::endl;
      }
    catch (const mitre::base::UserError &error)
      {
        std::cout << error.what() << std::endl;
      }
  };
  expect_error(make_tie<2>("x < 2"), square);
  expect_error(make_tie<2>("x > 2"), square);
  Mesh<2> away = square;
  for (Point<2> &x : away.nodes)
    x[0] += 3;
  expect_error(make_tie<2>(""), away);
  Mesh<2> fibres;
  fibres.shape = ElementShape::segment;
  expect_error(make_tie<2>(""), fibres);
}
