// The longest stable time step of a body that moves by central differences, density 1.1:
// with 0.96 of the estimate a small disturbance stays small for 2000 steps, with 1.04 of
// it it grows beyond all bounds. The power iteration finds the highest frequency to 2 per
// cent (against the generalised eigenvalues of the matrices, by LAPACK). The stiffer of
// two materials limits the step, by its frequency; a stiff tether does by sqrt(kappa/rho)
// (its body adds below a per cent), a strong drag by 2 rho / eta.

#include <deal.II/lac/lapack_full_matrix.h>

#include <mitre/structure/stable_time_step.h>

#include "structure_tests.h"

using namespace structure_tests;

constexpr double density = 1.1;

template <int dim>
double
exact_frequency(const FiniteElementBody<dim> &body, const VectorType &X)
{
  const unsigned int n = X.size();
  VectorType Y         = X, plus, minus, e, column;
  for (VectorType *v : {&plus, &minus, &e, &column})
    body.initialize_vector(*v);
  dealii::LAPACKFullMatrix<double> K(n), M(n);
  for (unsigned int j = 0; j < n; ++j)
    {
      const double step = 1e-6;
      Y[j]              = X[j] + step;
      body.compute_elastic_force(Y, 0., plus);
      Y[j] = X[j] - step;
      body.compute_elastic_force(Y, 0., minus);
      Y[j] = X[j];
      e    = 0;
      e[j] = 1;
      body.mass_matrix().vmult(column, e);
      for (unsigned int i = 0; i < n; ++i)
        {
          K(i, j) = (minus[i] - plus[i]) / (2 * step);
          M(i, j) = column[i];
        }
    }
  std::vector<dealii::Vector<double>> vectors(1, dealii::Vector<double>(n));
  K.compute_generalized_eigenvalues_symmetric(M, vectors);
  double largest = 0;
  for (unsigned int i = 0; i < n; ++i)
    largest = std::max(largest, K.eigenvalue(i).real());
  return std::sqrt(largest / density);
}

template <int dim>
bool
stays_small(FiniteElementBody<dim> &body, const VectorType &X, const double dt)
{
  VectorType Y = X, U, F;
  body.initialize_vector(U);
  body.initialize_vector(F);
  for (unsigned int i = 0; i < Y.size(); ++i)
    Y[i] += 1e-7 * std::sin(17. * i * i);
  try
    {
      for (unsigned int step = 0; step < 2000; ++step)
        {
          body.compute_force_density(Y, U, 0., F);
          U.add(dt / density, F);
          Y.add(dt, U);
        }
    }
  catch (const std::exception &)
    {
      return false;
    }
  Y -= X;
  return Y.linfty_norm() < 1e-4;
}

template <int dim>
void
check(const std::string &title,
      BodyParameters<dim> parameters,
      const ElementShape shape,
      const unsigned int degree,
      const double frequency = 0,
      const double rate      = 0)
{
  FiniteElementBody<dim> body(
    parameters, make_box_of_degree<dim>(shape, degree, dim == 2 ? 3 : 2), MPI_COMM_SELF);
  VectorType X;
  body.initialize_vector(X);
  body.set_to_reference_positions(X);
  const StableTimeStep estimate = estimate_stable_time_step(body, X, 0., density);
  std::cout << title << ", " << element_name(dim, shape, degree) << ": limited by "
            << estimate.limited_by;
  const double expected = frequency > 0 ? frequency
                          : rate > 0    ? 0
                                        : exact_frequency(body, X);
  if (expected > 0)
    std::cout << ", frequency "
              << below(std::abs(estimate.frequency / expected - 1), 0.02);
  if (rate > 0)
    std::cout << ", damping " << below(std::abs(estimate.damping_rate / rate - 1), 0.02);
  std::cout << ", " << (stays_small(body, X, 0.96 * estimate.time_step) ? "" : "not ")
            << "stable at 0.96, "
            << (stays_small(body, X, 1.04 * estimate.time_step) ? "" : "not ")
            << "at 1.04" << std::endl;
}

template <int dim>
BodyParameters<dim>
two_materials(const std::string &soft, const std::string &stiff)
{
  BodyParameters<dim> parameters;
  parameters.name           = "box";
  parameters.mass_tolerance = 1e-6;
  parameters.materials.push_back({"soft",
                                  {1},
                                  make_law<dim>("neo-Hookean", "set C1 = " + soft),
                                  mitre::base::TimeExpression("1", "factor")});
  parameters.materials.push_back(
    {"stiff",
     {2},
     make_law<dim>("neo-Hookean", "set C1 = " + stiff + "\nset Bulk modulus = 100\n"),
     mitre::base::TimeExpression("1", "factor")});
  return parameters;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const unsigned int degree : {1, 2})
    for (const auto shape : {ElementShape::simplex, ElementShape::hypercube})
      check<2>("two materials", two_materials<2>("3", "20"), shape, degree);
  check<3>("two materials", two_materials<3>("3", "20"), ElementShape::simplex, 1);

  BodyParameters<2> lumped = two_materials<2>("3", "20");
  lumped.consistent_mass   = false;
  lumped.constraints.push_back(
    {"hold",
     make_plugin<Constraint<2>>(constraints<2>(), "tether", "set Stiffness = 1e7")});
  check<2>("tether", lumped, ElementShape::simplex, 1, std::sqrt(1e7 / density));
  lumped.constraints.clear();
  lumped.loads.push_back(
    {"drag", make_plugin<Load<2>>(loads<2>(), "damping", "set Damping = 2000")});
  lumped.consistent_mass = true;
  check<2>("drag", lumped, ElementShape::simplex, 1, 0, 2000 / density);
}
