// For every constitutive law of the registry, with its default parameters, and for
// variants of them: P is the derivative of W (fourth-order differences with step 1e-4:
// where the exponential of the fibres grows by a factor e in 1e-2, the error is of order
// (1e-4/1e-2)^4 = 1e-8, and round-off 1e-16/1e-4, so that 1e-7 is safe),
// W(QF) = W(F) for a rotation Q, the Kirchhoff stress P F^T is symmetric, the stress
// vanishes at F = I where the law says so and does not where it says not, and the batched
// evaluation gives the same as the single one.

#include "structure_tests.h"

using namespace structure_tests;

template <int dim>
dealii::Tensor<2, dim>
rotation()
{
  dealii::Tensor<2, dim> Q;
  const double c = std::cos(0.7), s = std::sin(0.7);
  Q[0][0] = c;
  Q[0][1] = -s;
  Q[1][0] = s;
  Q[1][1] = c;
  if constexpr (dim == 3)
    {
      Q[2][2] = 1;
      dealii::Tensor<2, dim> R;
      R[0][0] = c;
      R[0][2] = s;
      R[2][0] = -s;
      R[2][2] = c;
      R[1][1] = 1;
      Q       = Q * R;
    }
  return Q;
}

template <int dim>
void
check(const std::string &title, const ConstitutiveLaw<dim> &law)
{
  Fibres<dim> fibres;
  for (unsigned int f = 0; f < law.n_fibre_families(); ++f)
    {
      fibres[f][0] = std::cos(0.3 + f);
      fibres[f][1] = std::sin(0.3 + f);
    }

  // Fibres are stretched in the first deformation and shortened in the second.
  std::vector<dealii::Tensor<2, dim>> deformations(2);
  for (unsigned int k = 0; k < 2; ++k)
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        deformations[k][i][j] =
          (i == j ? (k == 0 ? 1.15 : 0.9) : 0.) + 0.05 * std::sin(1. + 3 * i + 5 * j);

  double derivative = 0, objectivity = 0, symmetry = 0, batch = 0;
  for (const dealii::Tensor<2, dim> &F : deformations)
    {
      const double t = 0.1, step = 1e-4;
      const dealii::Tensor<2, dim> P = law.first_piola_kirchhoff_stress(F, fibres, t);
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            const auto energy = [&](const double distance) {
              dealii::Tensor<2, dim> moved = F;
              moved[i][j] += distance;
              return law.energy(moved, fibres, t);
            };
            const double difference = (8 * (energy(step) - energy(-step)) -
                                       (energy(2 * step) - energy(-2 * step))) /
                                      (12 * step);
            derivative = std::max(derivative, std::abs(difference - P[i][j]) / P.norm());
          }

      const double W = law.energy(F, fibres, t);
      objectivity =
        std::max(objectivity,
                 std::abs(law.energy(rotation<dim>() * F, fibres, t) - W) / std::abs(W));

      const dealii::Tensor<2, dim> tau = P * transpose(F);
      symmetry = std::max(symmetry, (tau - transpose(tau)).norm() / tau.norm());

      const std::vector<double> J(3, determinant(F));
      const std::vector<Fibres<dim>> all_fibres(3, fibres);
      std::vector<dealii::Tensor<2, dim>> stresses(3);
      law.compute_stresses(
        dealii::make_array_view(std::vector<dealii::Tensor<2, dim>>(3, F)),
        dealii::make_array_view(J),
        all_fibres.data(),
        1,
        t,
        dealii::make_array_view(stresses));
      for (const dealii::Tensor<2, dim> &stress : stresses)
        batch = std::max(batch, (stress - P).norm() / P.norm());
    }

  const dealii::Tensor<2, dim> identity = dealii::unit_symmetric_tensor<dim>();
  const double at_rest =
    law.first_piola_kirchhoff_stress(identity, fibres, 0.).norm() /
    law.first_piola_kirchhoff_stress(deformations[0], fibres, 0.).norm();

  std::cout << title << ", " << dim << "D: derivative " << below(derivative, 1e-7)
            << ", objectivity " << below(objectivity, 1e-12) << ", symmetry "
            << below(symmetry, 1e-13) << ", batch " << below(batch, 1e-14)
            << ", reference stress "
            << (law.is_stress_free_in_reference() == (at_rest < 1e-13) ? "ok" : "FAILED")
            << std::endl;
}

template <int dim>
void
check_all()
{
  for (const std::string &name : constitutive_laws<dim>().names())
    check(name, *make_law<dim>(name));

  check("neo-Hookean, raw", *make_law<dim>("neo-Hookean", "set Reference stress = raw"));
  check("neo-Hookean, bulk modulus",
        *make_law<dim>("neo-Hookean", "set Bulk modulus = 3e5"));
  check("transversely isotropic, raw",
        *make_law<dim>("transversely isotropic", "set Reference stress = raw"));
  check("transversely isotropic, bulk modulus",
        *make_law<dim>("transversely isotropic", "set Bulk modulus = 3e5"));
}

int
main()
{
  check_all<2>();
  check_all<3>();
}
