// Stresses of the laws with their published default constants, beside numbers that were
// computed by another program from the formulas below, in which the law's pressure does
// not occur. [dyn/cm^2]
//
// In an incompressible equibiaxial stretch l, F = diag(l, l, l^-2), or uniaxial stretch,
// F = diag(l, l^-1/2, l^-1/2), the difference of Cauchy stresses is
//   Mooney-Rivlin           equibiaxial  s11 - s33 = 2 (l^2 - l^-4) (C1 + C2 l^2)
//                           uniaxial     s11 - s33 = 2 (l^2 - 1/l) (C1 + C2/l)
//   Holzapfel-Gasser-Ogden  equibiaxial, fibres at +-g to x: with I1 = 2 l^2 + l^-4,
//                           E = kappa (I1 - 3) + (1 - 3 kappa) (l^2 - 1), T = k1 E exp(k2
//                           E^2) s11 - s33 = (mu + 4 T kappa) (l^2 - l^-4)
//                                     + 4 T (1 - 3 kappa) l^2 cos(g)^2
//   May-Newman-Yin          equibiaxial, Q = c1 (I1 - 3)^2 + c2 (l - 1)^4:
//                           s22 - s33 = 4 c0 exp(Q) c1 (I1 - 3) (l^2 - l^-4)
//                           s11 - s22 = 4 c0 exp(Q) c2 (l - 1)^3 l
//   Guccione                equibiaxial, e = (l^2 - 1)/2, d = (l^-4 - 1)/2,
//                           Q = b_f e^2 + b_t (e^2 + d^2):
//                           s11 - s33 = C exp(Q) (b_f e l^2 - b_t d l^-4)
//                           s22 - s33 = C exp(Q) b_t (e l^2 - d l^-4)
//   toe-linear collagen     uniaxial     s11 - s33 = 2 C1 (l^2 - 1/l) + l T,
//                           in the toe T = E/a (exp(a (l - l*)) - exp(a (1 - l*))),
//                           beyond T = E/a (1 - exp(a (1 - l*))) + E (l - l*)
// and in other deformations
//   Holzapfel-Ogden         simple shear x = X + g Y, fibres along x, sheets along y:
//                           s12 = a g exp(b g^2) + 2 a_s g^3 exp(b_s g^4)
//                               + a_fs g exp(b_fs g^2)
//   St Venant-Kirchhoff     F = diag(l, 1, 1): P11 = (lambda + 2 mu) l (l^2 - 1)/2,
//                           P22 = lambda (l^2 - 1)/2
//   neo-Hookean, split      F = diag(l, 1, 1): P11 = 2 C1 l^(-2/3) (l - (l^2 + 2)/(3 l)),
//   in
//                           2D as in 3D; F = l I: only the volumetric energy counts, P11
//                           = U'(J) l^2 with U' = kappa ln(J)/J, kappa (J - 1), kappa/2
//                           (J - 1/J)

#include <iomanip>

#include "structure_tests.h"

using namespace structure_tests;

dealii::Tensor<2, 3>
diagonal(const double x, const double y, const double z)
{
  dealii::Tensor<2, 3> F;
  F[0][0] = x;
  F[1][1] = y;
  F[2][2] = z;
  return F;
}

dealii::Tensor<2, 3>
equibiaxial(const double l)
{
  return diagonal(l, l, 1 / (l * l));
}

dealii::Tensor<2, 3>
uniaxial(const double l)
{
  return diagonal(l, 1 / std::sqrt(l), 1 / std::sqrt(l));
}

/// Fibres at these angles to x in degrees.
Fibres<3>
fibres_at(const double first, const double second)
{
  Fibres<3> fibres;
  const double degree = dealii::numbers::PI / 180;
  fibres[0][0]        = std::cos(first * degree);
  fibres[0][1]        = std::sin(first * degree);
  fibres[1][0]        = std::cos(second * degree);
  fibres[1][1]        = std::sin(second * degree);
  return fibres;
}

dealii::Tensor<2, 3>
cauchy(const std::string &law,
       const dealii::Tensor<2, 3> &F,
       const Fibres<3> &fibres = fibres_at(0, 90))
{
  return make_law<3>(law)->first_piola_kirchhoff_stress(F, fibres, 0.) * transpose(F) /
         determinant(F);
}

void
print(const std::string &what, const double value)
{
  std::cout << what << ' ' << value << std::endl;
}

int
main()
{
  std::cout << std::setprecision(10);
  auto s = cauchy("Mooney-Rivlin", equibiaxial(1.3));
  print("Mooney-Rivlin, equibiaxial 1.3", s[0][0] - s[2][2]);
  s = cauchy("Mooney-Rivlin", uniaxial(1.5));
  print("Mooney-Rivlin, uniaxial 1.5", s[0][0] - s[2][2]);

  auto P = make_law<3>("St Venant-Kirchhoff")
             ->first_piola_kirchhoff_stress(diagonal(1.2, 1, 1), fibres_at(0, 90), 0.);
  print("St Venant-Kirchhoff, P11", P[0][0]);
  print("St Venant-Kirchhoff, P22", P[1][1]);

  s = cauchy("Holzapfel-Gasser-Ogden", equibiaxial(1.05), fibres_at(49.98, -49.98));
  print("Holzapfel-Gasser-Ogden, along", s[0][0] - s[2][2]);
  print("Holzapfel-Gasser-Ogden, across", s[1][1] - s[2][2]);

  dealii::Tensor<2, 3> shear = dealii::unit_symmetric_tensor<3>();
  shear[0][1]                = 0.3;
  print("Holzapfel-Ogden, shear 0.3", cauchy("Holzapfel-Ogden", shear)[0][1]);

  s = cauchy("May-Newman-Yin", equibiaxial(1.12));
  print("May-Newman-Yin, across", s[1][1] - s[2][2]);
  print("May-Newman-Yin, along minus across", s[0][0] - s[1][1]);

  s = cauchy("Guccione", equibiaxial(1.15));
  print("Guccione, along", s[0][0] - s[2][2]);
  print("Guccione, across", s[1][1] - s[2][2]);

  for (const double l : {1.1, 1.3})
    {
      s = cauchy("toe-linear collagen", uniaxial(l));
      print(l < 1.2 ? "toe-linear collagen, toe" : "toe-linear collagen, linear",
            s[0][0] - s[2][2]);
    }

  const std::string split = "set Isochoric split = true\n";
  P                       = make_law<3>("neo-Hookean", split)
        ->first_piola_kirchhoff_stress(diagonal(1.2, 1, 1), {}, 0.);
  print("neo-Hookean, split, P11", P[0][0]);
  dealii::Tensor<2, 2> F_2;
  F_2[0][0] = 1.2;
  F_2[1][1] = 1;
  print(
    "neo-Hookean, split, P11 in 2D",
    make_law<2>("neo-Hookean", split)->first_piola_kirchhoff_stress(F_2, {}, 0.)[0][0]);
  for (const std::string energy : {"log squared", "quadratic", "Simo-Taylor"})
    print("neo-Hookean, split, dilated, " + energy,
          make_law<3>("neo-Hookean",
                      split + "set Bulk modulus = 1e6\nset Volumetric energy = " + energy)
            ->first_piola_kirchhoff_stress(diagonal(1.1, 1.1, 1.1), {}, 0.)[0][0]);
}
