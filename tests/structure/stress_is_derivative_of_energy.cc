// For every constitutive law of the registry, with its default parameters and with each
// value of the options that it shares with others (reference stress, volumetric energy,
// isochoric split, fibres in compression): P is the derivative of W (fourth-order
// differences with step 2e-5: where the exponentials of fibres grow by a factor e in
// 2e-3, the error is of order (2e-5/2e-3)^4 = 1e-8, and round-off 1e-16/2e-5, so that
// 1e-7 is safe), W(QF) = W(F) for a rotation Q, the Kirchhoff stress P F^T is symmetric,
// the stress vanishes at F = I where the law says so and does not where it says not, the
// batched evaluation gives the same as the single one, and in 2D the law is the one in 3D
// in plane strain.

#include <sstream>

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

/// The largest errors of all variants of a law.
struct Errors
{
  double derivative = 0, objectivity = 0, symmetry = 0, batch = 0, plane_strain = 0;
  bool reference_stress = true;
};

template <int dim, int other_dim>
dealii::Tensor<2, other_dim>
embed(const dealii::Tensor<2, dim> &F)
{
  dealii::Tensor<2, other_dim> result;
  if (other_dim > dim)
    result[other_dim - 1][other_dim - 1] = 1;
  for (unsigned int i = 0; i < (dim < other_dim ? dim : other_dim); ++i)
    for (unsigned int j = 0; j < (dim < other_dim ? dim : other_dim); ++j)
      result[i][j] = F[i][j];
  return result;
}

template <int dim>
Fibres<dim>
make_fibres(const unsigned int n_families)
{
  Fibres<dim> fibres;
  for (unsigned int f = 0; f < n_families; ++f)
    {
      fibres[f][0] = std::cos(0.3 + f);
      fibres[f][1] = std::sin(0.3 + f);
    }
  return fibres;
}

template <int dim>
void
check(const std::string &name, const std::string &options, Errors &errors)
{
  const auto law           = make_law<dim>(name, options);
  const Fibres<dim> fibres = make_fibres<dim>(law->n_fibre_families());

  // Fibres are stretched in the first deformation and shortened in the second.
  std::vector<dealii::Tensor<2, dim>> deformations(2);
  for (unsigned int k = 0; k < 2; ++k)
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        deformations[k][i][j] =
          (i == j ? (k == 0 ? 1.15 : 0.9) : 0.) + 0.05 * std::sin(1. + 3 * i + 5 * j);

  for (const dealii::Tensor<2, dim> &F : deformations)
    {
      const double t = 0.1, step = 2e-5;
      const dealii::Tensor<2, dim> P = law->first_piola_kirchhoff_stress(F, fibres, t);
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            const auto energy = [&](const double distance) {
              dealii::Tensor<2, dim> moved = F;
              moved[i][j] += distance;
              return law->energy(moved, fibres, t);
            };
            const double difference = (8 * (energy(step) - energy(-step)) -
                                       (energy(2 * step) - energy(-2 * step))) /
                                      (12 * step);
            errors.derivative =
              std::max(errors.derivative, std::abs(difference - P[i][j]) / P.norm());
          }

      const double W = law->energy(F, fibres, t);
      errors.objectivity =
        std::max(errors.objectivity,
                 std::abs(law->energy(rotation<dim>() * F, fibres, t) - W) / std::abs(W));

      const dealii::Tensor<2, dim> tau = P * transpose(F);
      errors.symmetry =
        std::max(errors.symmetry, (tau - transpose(tau)).norm() / tau.norm());

      const std::vector<double> J(3, determinant(F));
      const std::vector<Fibres<dim>> all_fibres(3, fibres);
      std::vector<dealii::Tensor<2, dim>> stresses(3);
      law->compute_stresses(
        dealii::make_array_view(std::vector<dealii::Tensor<2, dim>>(3, F)),
        dealii::make_array_view(J),
        all_fibres.data(),
        1,
        t,
        dealii::make_array_view(stresses));
      for (const dealii::Tensor<2, dim> &stress : stresses)
        errors.batch = std::max(errors.batch, (stress - P).norm() / P.norm());

      if (dim == 2)
        {
          const auto solid         = make_law<3>(name, options);
          const Fibres<3> fibres_3 = make_fibres<3>(law->n_fibre_families());
          const auto F_3           = embed<dim, 3>(F);
          const auto P_3 = solid->first_piola_kirchhoff_stress(F_3, fibres_3, t);
          errors.plane_strain =
            std::max({errors.plane_strain,
                      (embed<3, dim>(P_3) - P).norm() / P.norm(),
                      std::abs(solid->energy(F_3, fibres_3, t) - W) / std::abs(W)});
        }
    }

  const dealii::Tensor<2, dim> identity = dealii::unit_symmetric_tensor<dim>();
  const double at_rest = law->first_piola_kirchhoff_stress(identity, fibres, 0.).norm() /
                         law
                           ->first_piola_kirchhoff_stress(
                             identity + 0.2 * (deformations[0] - identity), fibres, 0.)
                           .norm();
  errors.reference_stress =
    errors.reference_stress && law->is_stress_free_in_reference() == (at_rest < 1e-13);
}

template <int dim>
void
check_all()
{
  const std::vector<std::vector<std::string>> options = {
    {"Reference stress", "set Reference stress = raw"},
    {"Bulk modulus", "set Bulk modulus = 3e5"},
    {"Volumetric energy", "set Bulk modulus = 3e5\nset Volumetric energy = quadratic"},
    {"Volumetric energy", "set Bulk modulus = 3e5\nset Volumetric energy = Simo-Taylor"},
    {"Isochoric split", "set Isochoric split = true"},
    {"Isochoric split", "set Isochoric split = true\nset Bulk modulus = 3e5"},
    {"Fibres in compression", "set Fibres in compression = elastic"},
    {"Fibres in compression", "set Fibres in compression = slack"},
    // so that the first deformation reaches the linear part
    {"Transition stretch", "set Transition stretch = 1.05"}};

  for (const std::string &name : constitutive_laws<dim>().names())
    {
      dealii::ParameterHandler prm;
      constitutive_laws<dim>().declare_parameters(name, prm);
      std::ostringstream declared;
      prm.print_parameters(declared, dealii::ParameterHandler::ShortText);

      Errors errors;
      unsigned int n_variants = 1;
      check<dim>(name, "", errors);
      for (const auto &option : options)
        {
          if (declared.str().find("set " + option[0]) != std::string::npos)
            {
              ++n_variants;
              check<dim>(name, option[1], errors);
            }
        }
      std::cout << name << ", " << dim << "D, " << n_variants << " variants: derivative "
                << below(errors.derivative, 1e-7) << ", objectivity "
                << below(errors.objectivity, 1e-12) << ", symmetry "
                << below(errors.symmetry, 1e-13) << ", batch "
                << below(errors.batch, 1e-12) << ", plane strain "
                << below(errors.plane_strain, 1e-12) << ", reference stress "
                << (errors.reference_stress ? "ok" : "FAILED") << std::endl;
    }
}

int
main()
{
  check_all<2>();
  check_all<3>();
}
