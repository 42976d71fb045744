// The steady state of the collapsible channel (section 3.3 of the thesis;
// parameter_files/collapsible_channel.prm) by another method than Mitre's, none of whose
// code is used: the Navier-Stokes equations on a mesh that is fitted to the wall, with
// Taylor-Hood elements, and a geometrically exact beam. doc/verification.md compares
// both.
//
//   rho (u . grad) u - mu Laplace u + grad p = 0, div u = 0 in 0 < x < L_u + L + L_d,
//   0 < y < wall; u = 6 U0 y/D (1 - y/D) at x = 0, u_y = 0 and p - mu du_x/dx = 0 at the
//   outlet, u = 0 on the walls;
//   X(s), L_u < s < L_u + L, minimises
//     int EA/2 (|X'| - 1)^2 + EI/2 theta'^2 ds,  theta the angle of X',
//   less the work of the traction p_e n + sigma n of the fluids on both sides; clamped.
//
// Beam: cubic Hermite elements for x and y. Their nodes are the corners of the fluid's
// elements, which follow X exactly (mapping of degree 3; shifts fall linearly towards
// y = 0). Newton's method for the fluid and for the beam; the shape is the fixed point of
// "traction of the flow, then beam under it", accelerated by Anderson's method.
//
// What must hold (printed as deviations, with bounds where the exact value is zero):
//   1. A stiff wall: pressure 12 mu U0/D^2 (L_total - x), which the elements contain.
//   2. The beam under a small uniform pressure in the place of the fluid's: Timoshenko's
//      plate in cylindrical bending with held edges. Slopes are neglected there: the
//      difference is of second order in w/L, 1e-4.
//   3. Meshes of 6 and 12 elements across: 1 - min y agrees to 0.1 %; it does to 0.001 %
//      on 12, 24 and 48.
//   4. Momentum of the fluid in the converged state: the fluxes through the ends and the
//      force on all walls sum to zero up to the error of the mesh.
//
// Arguments: none: the test; "table": finer meshes, and how much it matters if the wall
// lies a little lower (same flow) or is held a little farther in, as a wall that is
// smeared by a delta function may; "shape FILE": writes the wall as comma-separated
// values.

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/householder.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/vector_tools.h>

#include <Sacado.hpp>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <deque>
#include <string>
#include <vector>

using namespace dealii;

namespace
{
  /// Lengths in cm, all else in cgs units, of a layer of 1 cm.
  struct Case
  {
    double width = 1, upstream = 5, elastic = 5, downstream = 30;
    double density = 1, viscosity = 0.01, mean_speed = 5;
    double external_pressure = 48.75;
    double stretching = 6e4, bending = 0.5; // EA, EI

    double length() const
    {
      return upstream + elastic + downstream;
    }
  };


  /**
   * The elastic wall: cubic Hermite elements. A node has the coefficients x, dx/ds, y,
   * dy/ds.
   */
  class Beam
  {
  public:
    Beam(const Case &channel, const unsigned int n_elements)
      : channel(channel)
    {
      // Nodes are dense at the ends, where bending has a layer of sqrt(EI/T).
      for (unsigned int i = 0; i <= n_elements; ++i)
        nodes.push_back(channel.upstream +
                        channel.elastic / 2 *
                          (1 + std::sin(numbers::PI * (double(i) / n_elements - 0.5))));
      coefficients.reinit(4 * nodes.size());
      for (unsigned int i = 0; i < nodes.size(); ++i)
        {
          const double t          = (nodes[i] - channel.upstream) / channel.elastic;
          coefficients[4 * i]     = nodes[i];
          coefficients[4 * i + 1] = 1;
          coefficients[4 * i + 2] = channel.width;
          coefficients[4 * i + 3] = 0;
          initial_guess.push_back(16 * std::pow(t * (1 - t), 2));
          initial_slope.push_back(32 * t * (1 - t) * (1 - 2 * t) / channel.elastic);
        }
    }

    /// A clamped shape of this depth, from which Newton's method finds others.
    void bend(const double depth)
    {
      for (unsigned int i = 0; i < nodes.size(); ++i)
        {
          coefficients[4 * i + 2] = channel.width - depth * initial_guess[i];
          coefficients[4 * i + 3] = -depth * initial_slope[i];
        }
    }

    unsigned int n_elements() const
    {
      return nodes.size() - 1;
    }

    /// Shape functions (derivatives) at t in (0, 1) of an element: first node, its
    /// derivative, second node, its derivative.
    std::array<double, 4>
    shape(const unsigned int element, const double t, const unsigned int derivative) const
    {
      const double l = nodes[element + 1] - nodes[element];
      switch (derivative)
        {
          case 0:
            return {{(1 + 2 * t) * (1 - t) * (1 - t),
                     l * t * (1 - t) * (1 - t),
                     t * t * (3 - 2 * t),
                     l * t * t * (t - 1)}};
          case 1:
            return {{6 * t * (t - 1) / l,
                     (1 - t) * (1 - 3 * t),
                     6 * t * (1 - t) / l,
                     t * (3 * t - 2)}};
          default:
            return {{(12 * t - 6) / (l * l),
                     (6 * t - 4) / l,
                     (6 - 12 * t) / (l * l),
                     (6 * t - 2) / l}};
        }
    }

    /// The coefficient of component c that belongs to shape function k.
    unsigned int
    index(const unsigned int element, const unsigned int k, const unsigned int c) const
    {
      return 4 * (element + k / 2) + 2 * c + k % 2;
    }

    Tensor<1, 2> position(const unsigned int element,
                          const double t,
                          const unsigned int derivative = 0) const
    {
      const auto N = shape(element, t, derivative);
      Tensor<1, 2> x;
      for (unsigned int c = 0; c < 2; ++c)
        for (unsigned int k = 0; k < 4; ++k)
          x[c] += N[k] * coefficients[index(element, k, c)];
      return x;
    }

    /// Element and place in it of a material coordinate.
    std::pair<unsigned int, double> locate(const double s) const
    {
      unsigned int e = 0;
      while (e + 1 < n_elements() && s > nodes[e + 1])
        ++e;
      return {e, (s - nodes[e]) / (nodes[e + 1] - nodes[e])};
    }

    /// Equilibrium under forces on the coefficients, from the shape that it has.
    void solve(const Vector<double> &forces)
    {
      // EI theta'^2 has eighth-degree rational terms; five points an element are ample.
      const QGauss<1> quadrature(5);
      const unsigned int n = coefficients.size();
      SparsityPattern sparsity(n, n, 16);
      for (unsigned int e = 0; e < n_elements(); ++e)
        for (unsigned int i = 0; i < 8; ++i)
          for (unsigned int j = 0; j < 8; ++j)
            sparsity.add(4 * e + i, 4 * e + j);
      sparsity.compress();
      SparseMatrix<double> matrix(sparsity);
      Vector<double> residual(n), update(n);
      using Fad  = Sacado::Fad::SFad<double, 8>;
      using Fad2 = Sacado::Fad::SFad<Fad, 8>;

      for (unsigned int iteration = 0;; ++iteration)
        {
          AssertThrow(iteration < 200, ExcMessage("The beam does not converge."));
          matrix   = 0;
          residual = forces;
          residual *= -1;
          for (unsigned int e = 0; e < n_elements(); ++e)
            {
              std::array<Fad2, 8> q;
              for (unsigned int i = 0; i < 8; ++i)
                {
                  q[i] = Fad2(8, i, Fad(8, i, coefficients[4 * e + i]));
                }
              Fad2 energy = Fad(0.);
              for (unsigned int p = 0; p < quadrature.size(); ++p)
                {
                  const double t = quadrature.point(p)[0];
                  const auto N1 = shape(e, t, 1), N2 = shape(e, t, 2);
                  std::array<Fad2, 2> a, b;
                  for (unsigned int c = 0; c < 2; ++c)
                    {
                      a[c] = b[c] = Fad(0.);
                      for (unsigned int k = 0; k < 4; ++k)
                        {
                          const Fad2 &value = q[4 * (k / 2) + 2 * c + k % 2];
                          a[c] += N1[k] * value;
                          b[c] += N2[k] * value;
                        }
                    }
                  const Fad2 square  = a[0] * a[0] + a[1] * a[1];
                  const Fad2 strain  = sqrt(square) - 1.;
                  const Fad2 bending = (a[0] * b[1] - a[1] * b[0]) / square;
                  energy += (0.5 * channel.stretching * strain * strain +
                             0.5 * channel.bending * bending * bending) *
                            (quadrature.weight(p) * (nodes[e + 1] - nodes[e]));
                }
              for (unsigned int i = 0; i < 8; ++i)
                {
                  residual[4 * e + i] += energy.dx(i).val();
                  for (unsigned int j = 0; j < 8; ++j)
                    matrix.add(4 * e + i, 4 * e + j, energy.dx(i).dx(j));
                }
            }
          for (const unsigned int i :
               {0u, 2u, 3u, n - 4, n - 2, n - 1}) // x, y, dy/ds at the ends
            {
              for (auto entry = matrix.begin(i); entry != matrix.end(i); ++entry)
                entry->value() = (entry->column() == i);
              residual[i] = 0;
            }
          SparseDirectUMFPACK solver;
          solver.initialize(matrix);
          solver.vmult(update, residual);
          const double size = update.linfty_norm();
          // At most a quarter of the width in a step: stretching is very nonlinear.
          coefficients.add(-std::min(1., 0.25 * channel.width / size), update);
          if (size < 1e-12 * channel.elastic)
            return;
        }
    }

    /// Coefficients of forces by a constant pressure from above.
    Vector<double> forces_of_pressure(const double pressure) const
    {
      const QGauss<1> quadrature(5);
      Vector<double> forces(coefficients.size());
      for (unsigned int e = 0; e < n_elements(); ++e)
        for (unsigned int p = 0; p < quadrature.size(); ++p)
          {
            const auto N       = shape(e, quadrature.point(p)[0], 0);
            const auto tangent = position(e, quadrature.point(p)[0], 1);
            const double weight =
              pressure * quadrature.weight(p) * (nodes[e + 1] - nodes[e]);
            for (unsigned int k = 0; k < 4; ++k)
              {
                forces[index(e, k, 0)] += weight * tangent[1] * N[k];
                forces[index(e, k, 1)] -= weight * tangent[0] * N[k];
              }
          }
      return forces;
    }

    /// Lowest point.
    Tensor<1, 2> lowest() const
    {
      Tensor<1, 2> lowest({0., channel.width});
      for (unsigned int e = 0; e < n_elements(); ++e)
        for (unsigned int i = 0; i <= 100; ++i)
          {
            const auto x = position(e, 0.01 * i);
            if (x[1] <= lowest[1])
              lowest = x;
          }
      return lowest;
    }

    const Case channel;
    std::vector<double> nodes;
    Vector<double> coefficients;

  private:
    std::vector<double> initial_guess, initial_slope;
  };


  /// The steady flow below the wall.
  class Fluid
  {
  public:
    /// @param n_rows elements across; all others go with it
    Fluid(const Case &channel, const Beam &beam, const unsigned int n_rows)
      : channel(channel)
      , beam(beam)
      , mapping(3)
      , fe(FE_Q<2>(2), 2, FE_Q<2>(1), 1)
      , dof_handler(triangulation)
    {
      // Columns: those of the beam, and ones that grow away from it.
      std::vector<std::vector<double>> steps(2);
      std::vector<double> corners;
      const unsigned int n_upstream = 4 * n_rows / 3, n_downstream = 16 * n_rows / 3;
      const auto graded = [](const double t) { return t * (0.05 + 0.95 * t); };
      for (unsigned int i = n_upstream; i > 0; --i)
        corners.push_back(channel.upstream * (1 - graded(double(i) / n_upstream)));
      corners.insert(corners.end(), beam.nodes.begin(), beam.nodes.end());
      for (unsigned int i = 1; i <= n_downstream; ++i)
        corners.push_back(channel.upstream + channel.elastic +
                          channel.downstream * graded(double(i) / n_downstream));
      for (unsigned int i = 1; i < corners.size(); ++i)
        steps[0].push_back(corners[i] - corners[i - 1]);
      for (unsigned int i = 0; i < n_rows; ++i)
        {
          const auto height = [&](const unsigned int j) {
            const double t = double(j) / n_rows;
            return channel.width * (0.4 * t + 0.3 * (1 - std::cos(numbers::PI * t)));
          };
          steps[1].push_back(height(i + 1) - height(i));
        }
      GridGenerator::subdivided_hyper_rectangle(triangulation,
                                                steps,
                                                Point<2>(),
                                                Point<2>(channel.length(), channel.width),
                                                true);
      follow_beam();
      dof_handler.distribute_dofs(fe);
      const FEValuesExtractors::Vector velocities(0);
      const FEValuesExtractors::Scalar vertical(1);
      for (const types::boundary_id id : {0, 2, 3})
        DoFTools::make_zero_boundary_constraints(
          dof_handler, id, constraints, fe.component_mask(velocities));
      DoFTools::make_zero_boundary_constraints(
        dof_handler, 1, constraints, fe.component_mask(vertical));
      constraints.close();
      DynamicSparsityPattern pattern(dof_handler.n_dofs());
      DoFTools::make_sparsity_pattern(dof_handler, pattern, constraints, false);
      sparsity.copy_from(pattern);
      matrix.reinit(sparsity);
      solution.reinit(dof_handler.n_dofs());
      residual.reinit(dof_handler.n_dofs());

      // Poiseuille's flow: the solution below a flat wall, and what stays at the inlet.
      Poiseuille poiseuille(channel);
      VectorTools::interpolate(mapping, dof_handler, poiseuille, solution);
    }

    class Poiseuille : public Function<2>
    {
    public:
      explicit Poiseuille(const Case &channel)
        : Function<2>(3)
        , channel(channel)
      {
      }

      double value(const Point<2> &x, const unsigned int component) const override
      {
        const double y = x[1] / channel.width;
        if (component == 0)
          return 6 * channel.mean_speed * y * (1 - y);
        return component == 1 ? 0. : pressure_gradient() * (channel.length() - x[0]);
      }

      double pressure_gradient() const
      {
        return 12 * channel.viscosity * channel.mean_speed /
               (channel.width * channel.width);
      }

    private:
      const Case channel;
    };

    /// Move the mesh to where the beam is.
    void follow_beam()
    {
      mapping.initialize(
        MappingQ1<2>(),
        triangulation,
        [this](const Triangulation<2>::cell_iterator &cell, const Point<2> &x) {
          const double middle = cell->center()[0];
          if (middle < channel.upstream || middle > channel.upstream + channel.elastic)
            return x;
          const auto place = beam.locate(middle);
          const double t   = (x[0] - beam.nodes[place.first]) /
                           (beam.nodes[place.first + 1] - beam.nodes[place.first]);
          const auto wall = beam.position(place.first, t);
          const double y  = x[1] / channel.width;
          return Point<2>(x[0] + y * (wall[0] - x[0]), y * wall[1]);
        },
        false);
    }

    /// Newton's method, from the last solution.
    void solve()
    {
      const QGauss<2> quadrature(4);
      FEValues<2> values(
        mapping, fe, quadrature, update_values | update_gradients | update_JxW_values);
      const unsigned int n = fe.n_dofs_per_cell();
      const FEValuesExtractors::Vector velocities(0);
      const FEValuesExtractors::Scalar pressure(2);
      std::vector<Tensor<1, 2>> u(quadrature.size()), phi(n);
      std::vector<Tensor<2, 2>> grad_u(quadrature.size()), grad_phi(n);
      std::vector<double> div_phi(n), psi(n), p(quadrature.size());
      FullMatrix<double> cell_matrix(n, n);
      Vector<double> cell_residual(n), update(solution.size());
      std::vector<types::global_dof_index> dofs(n);

      for (unsigned int iteration = 0;; ++iteration)
        {
          AssertThrow(iteration < 25, ExcMessage("The flow does not converge."));
          matrix   = 0;
          residual = 0;
          for (const auto &cell : dof_handler.active_cell_iterators())
            {
              values.reinit(cell);
              values[velocities].get_function_values(solution, u);
              values[velocities].get_function_gradients(solution, grad_u);
              values[pressure].get_function_values(solution, p);
              cell_matrix   = 0;
              cell_residual = 0;
              for (unsigned int q = 0; q < quadrature.size(); ++q)
                {
                  for (unsigned int i = 0; i < n; ++i)
                    {
                      phi[i]      = values[velocities].value(i, q);
                      grad_phi[i] = values[velocities].gradient(i, q);
                      div_phi[i]  = trace(grad_phi[i]);
                      psi[i]      = values[pressure].value(i, q);
                    }
                  const Tensor<1, 2> advection = channel.density * grad_u[q] * u[q];
                  for (unsigned int i = 0; i < n; ++i)
                    {
                      cell_residual[i] +=
                        (phi[i] * advection +
                         channel.viscosity * scalar_product(grad_phi[i], grad_u[q]) -
                         div_phi[i] * p[q] - psi[i] * trace(grad_u[q])) *
                        values.JxW(q);
                      for (unsigned int j = 0; j < n; ++j)
                        cell_matrix(i, j) +=
                          (channel.density * (phi[i] * (grad_phi[j] * u[q]) +
                                              phi[i] * (grad_u[q] * phi[j])) +
                           channel.viscosity * scalar_product(grad_phi[i], grad_phi[j]) -
                           div_phi[i] * psi[j] - psi[i] * div_phi[j]) *
                          values.JxW(q);
                    }
                }
              cell->get_dof_indices(dofs);
              constraints.distribute_local_to_global(
                cell_matrix, cell_residual, dofs, matrix, residual);
            }
          // Residuals are forces; of the order of the inlet's momentum they are 25
          // dyn/cm.
          if (iteration > 0 && residual.linfty_norm() < 1e-11)
            return;
          SparseDirectUMFPACK solver;
          solver.initialize(matrix);
          solver.vmult(update, residual);
          constraints.distribute(update);
          solution -= update;
        }
    }

    /// Tractions of the fluid and of the external pressure as forces on the coefficients
    /// of the beam.
    Vector<double> forces_on_beam() const
    {
      Vector<double> forces(beam.coefficients.size());
      loop_over_walls([&](const Point<2> &, const double s, const Tensor<1, 2> &force) {
        if (s < channel.upstream || s > channel.upstream + channel.elastic)
          return;
        const auto place = beam.locate(s);
        const auto N     = beam.shape(place.first, place.second, 0);
        for (unsigned int k = 0; k < 4; ++k)
          for (unsigned int c = 0; c < 2; ++c)
            forces[beam.index(place.first, k, c)] += N[k] * force[c];
      });
      forces += beam.forces_of_pressure(channel.external_pressure);
      return forces;
    }

    /// Horizontal force of the fluid on all walls over the difference of the fluxes of
    /// momentum and pressures at the ends, minus 1.
    double balance_of_momentum() const
    {
      Tensor<1, 2> on_walls;
      loop_over_walls([&](const Point<2> &, const double, const Tensor<1, 2> &force) {
        on_walls += force;
      });
      double ends = 0;
      const QGauss<1> quadrature(4);
      FEFaceValues<2> values(mapping,
                             fe,
                             quadrature,
                             update_values | update_gradients | update_JxW_values |
                               update_normal_vectors);
      std::vector<Vector<double>> u(quadrature.size(), Vector<double>(3));
      std::vector<std::vector<Tensor<1, 2>>> gradients(quadrature.size(),
                                                       std::vector<Tensor<1, 2>>(3));
      for (const auto &cell : dof_handler.active_cell_iterators())
        for (const unsigned int f : {0, 1})
          if (cell->at_boundary(f))
            {
              values.reinit(cell, f);
              values.get_function_values(solution, u);
              values.get_function_gradients(solution, gradients);
              for (unsigned int q = 0; q < quadrature.size(); ++q)
                ends -= values.normal_vector(q)[0] *
                        (channel.density * u[q][0] * u[q][0] + u[q][2] -
                         2 * channel.viscosity * gradients[q][0][0]) *
                        values.JxW(q);
            }
      return on_walls[0] / ends - 1;
    }

    double pressure_at(const Point<2> &reference) const
    {
      for (const auto &cell : dof_handler.active_cell_iterators())
        for (const unsigned int v : cell->vertex_indices())
          if (cell->vertex(v).distance(reference) < 1e-8)
            return solution[cell->vertex_dof_index(v, 2)];
      AssertThrow(false, ExcMessage("There is no vertex at this place."));
      return 0;
    }

  private:
    /// Call f(place, material coordinate of the wall (-1 on the lower one), force of the
    /// fluid on the wall) at quadrature points.
    template <typename Function>
    void loop_over_walls(const Function &function) const
    {
      const QGauss<1> quadrature(4);
      FEFaceValues<2> values(mapping,
                             fe,
                             quadrature,
                             update_values | update_gradients | update_JxW_values |
                               update_normal_vectors | update_quadrature_points);
      const FEValuesExtractors::Vector velocities(0);
      const FEValuesExtractors::Scalar pressure(2);
      std::vector<SymmetricTensor<2, 2>> rates(quadrature.size());
      std::vector<double> p(quadrature.size());
      for (const auto &cell : dof_handler.active_cell_iterators())
        for (const unsigned int f : {2, 3})
          if (cell->at_boundary(f))
            {
              values.reinit(cell, f);
              values[velocities].get_function_symmetric_gradients(solution, rates);
              values[pressure].get_function_values(solution, p);
              const double begin = cell->vertex(0)[0], end = cell->vertex(1)[0];
              for (unsigned int q = 0; q < quadrature.size(); ++q)
                {
                  const Tensor<1, 2> normal = values.normal_vector(q);
                  const Tensor<1, 2> force =
                    (p[q] * normal - 2 * channel.viscosity * (rates[q] * normal)) *
                    values.JxW(q);
                  function(values.quadrature_point(q),
                           f == 2 ? -1. : begin + (end - begin) * quadrature.point(q)[0],
                           force);
                }
            }
    }

    const Case channel;
    const Beam &beam;
    Triangulation<2> triangulation;
    MappingQCache<2> mapping;
    const FESystem<2> fe;
    DoFHandler<2> dof_handler;
    AffineConstraints<double> constraints;
    SparsityPattern sparsity;
    SparseMatrix<double> matrix;
    Vector<double> solution, residual;
  };


  /// Wall and flow that fit each other.
  class Steady
  {
  public:
    Steady(const Case &channel, const unsigned int n_rows)
      : beam(channel, 10 * n_rows / 3)
      , fluid(channel, beam, n_rows)
    {
      beam.bend(0.2 * channel.width);
      fluid.follow_beam();
      fluid.solve();

      // Anderson's method on the coefficients: of the last shapes and what became of
      // them, the affine combination with the smallest change.
      std::deque<Vector<double>> shapes, changes;
      for (n_iterations = 1;; ++n_iterations)
        {
          AssertThrow(n_iterations < 60, ExcMessage("The coupling does not converge."));
          const Vector<double> shape = beam.coefficients;
          beam.solve(fluid.forces_on_beam());
          Vector<double> change = beam.coefficients;
          change -= shape;
          shapes.push_front(shape);
          changes.push_front(change);
          if (change.linfty_norm() < 1e-9)
            break;
          if (shapes.size() > 8)
            {
              shapes.pop_back();
              changes.pop_back();
            }
          Vector<double> next = shapes[0];
          next += changes[0];
          const unsigned int m = shapes.size() - 1;
          if (m > 0)
            {
              FullMatrix<double> differences(change.size(), m);
              for (unsigned int j = 0; j < m; ++j)
                for (unsigned int i = 0; i < change.size(); ++i)
                  differences(i, j) = changes[j][i] - changes[j + 1][i];
              Vector<double> weights(m);
              Householder<double>(differences).least_squares(weights, changes[0]);
              for (unsigned int j = 0; j < m; ++j)
                for (unsigned int i = 0; i < change.size(); ++i)
                  next[i] -=
                    weights[j] * (shapes[j][i] - shapes[j + 1][i] + differences(i, j));
            }
          beam.coefficients = next;
          fluid.follow_beam();
          fluid.solve();
        }
    }

    double channel_depth() const
    {
      return beam.channel.width - beam.lowest()[1];
    }

    Beam beam;
    Fluid fluid;
    unsigned int n_iterations = 0;
  };


  /**
   * Deflection in the middle of a plate in cylindrical bending with clamped edges that do
   * not approach each other (Timoshenko and Woinowsky-Krieger, Theory of plates and
   * shells, article 3): tension S, u^2 = S L^2 / (4 EI),
   *   w' = q L / (2 S) (1 - 2 x/L - sinh(u (1 - 2 x/L)) / sinh u),
   *   S L / EA = 1/2 int w'^2 dx.
   */
  double plate_deflection(const Case &channel, const double pressure)
  {
    const double L      = channel.elastic;
    const auto integral = [&](const double S, const unsigned int power) {
      const double u = std::sqrt(S * L * L / (4 * channel.bending));
      const QGauss<1> gauss(6);
      double sum = 0;
      for (unsigned int i = 0; i < 2000; ++i)
        for (unsigned int q = 0; q < gauss.size(); ++q)
          {
            const double z = (i + gauss.point(q)[0]) / 2000; // 1 - 2 x/L on a half
            const double ratio =
              std::exp(u * (z - 1)) * (1 - std::exp(-2 * u * z)) / (1 - std::exp(-2 * u));
            sum += gauss.weight(q) / 2000 * L / 2 *
                   std::pow(pressure * L / (2 * S) * (z - ratio), power);
          }
      return sum;
    };
    double low = 1e-6 * channel.bending, high = channel.stretching;
    for (unsigned int i = 0; i < 200; ++i)
      {
        const double S = std::sqrt(low * high);
        (integral(S, 2) > S * L / channel.stretching ? low : high) = S;
      }
    return integral(low, 1);
  }


  void print_row(const char *name, const Steady &steady)
  {
    std::printf("| %s | %.5f | %.3f | %.2e | %u |\n",
                name,
                steady.channel_depth(),
                steady.beam.lowest()[0],
                steady.fluid.balance_of_momentum(),
                steady.n_iterations);
    std::fflush(stdout);
  }
} // namespace


int
main(int argc, char **argv)
{
  const Case channel;
  const std::string task = argc > 1 ? argv[1] : "";
  if (task == "shape")
    {
      const Steady steady(channel, 24);
      FILE *file = std::fopen(argv[2], "w");
      std::fprintf(file, "s [cm],x [cm],y [cm]\n");
      for (unsigned int i = 0; i <= 200; ++i)
        {
          const double s   = channel.upstream + channel.elastic * i / 200;
          const auto place = steady.beam.locate(s);
          const auto x     = steady.beam.position(place.first, place.second);
          std::fprintf(file, "%.4f,%.6f,%.6f\n", s, x[0], x[1]);
        }
      std::fclose(file);
      return 0;
    }
  if (task == "table")
    {
      std::printf(
        "| case | 1 - min y | at x | momentum | iterations |\n|---|---|---|---|---|\n");
      for (const unsigned int n_rows : {6, 12, 24})
        print_row((std::to_string(n_rows) + " elements across").c_str(),
                  Steady(channel, n_rows));
      Case other  = channel;
      other.width = 0.99;
      other.mean_speed /= other.width;
      print_row("12, channel narrower by 0.01 cm", Steady(other, 12));
      other = channel;
      other.elastic -= 0.05;
      other.downstream += 0.05;
      print_row("12, elastic part shorter by 0.05 cm", Steady(other, 12));
      return 0;
    }

  // 1. and 2.
  {
    Case stiff       = channel;
    stiff.stretching = 1e12;
    Beam beam(stiff, 20);
    Fluid fluid(stiff, beam, 6);
    fluid.solve();
    std::printf("Poiseuille: deviation of the pressure at the inlet %.1e\n",
                std::abs(fluid.pressure_at(Point<2>(0, 0)) / 24 - 1) < 1e-10
                  ? 0.
                  : fluid.pressure_at(Point<2>(0, 0)) / 24 - 1);
  }
  for (const double pressure : {1e-4, 2e-2})
    {
      Beam beam(channel, 40);
      beam.bend(0.01);
      for (unsigned int i = 0; i < 20; ++i)
        beam.solve(beam.forces_of_pressure(pressure));
      const double plate = plate_deflection(channel, pressure);
      std::printf("pressure %g: deflection %.6g, Timoshenko's plate %.6g\n",
                  pressure,
                  channel.width - beam.lowest()[1],
                  plate);
    }
  // 3. and 4.
  print_row("6 elements across", Steady(channel, 6));
  print_row("12 elements across", Steady(channel, 12));
}
