// The stress of (5.6) worked out by hand for a stretch of 1.1 along the fibre and 0.9
// across, with the constants of the anterior leaflet: raw, P_xx = 2 C1 1.1 + 2 a_f (I_f -
// 1) exp(b_f (I_f - 1)^2) 1.1 with I_f = 1.21, and P_yy = 2 C1 0.9. Fibres along y are
// shortened, so that they carry nothing. Stress-free subtracts 2 C1/1.1 and 2 C1/0.9.

#include <iomanip>

#include "structure_tests.h"

using namespace structure_tests;

int
main()
{
  const std::string constants = "set C1 = 1.7370e5\n"
                                "set a_f = 3.1275e5\n"
                                "set b_f = 55.9258\n";
  dealii::Tensor<2, 2> F;
  F[0][0] = 1.1;
  F[1][1] = 0.9;
  Fibres<2> along_x, along_y;
  along_x[0][0] = 1;
  along_y[0][1] = 1;

  const double fibre = 2 * 3.1275e5 * 0.21 * std::exp(55.9258 * 0.21 * 0.21) * 1.1;
  const double xx = 2 * 1.7370e5 * 1.1, yy = 2 * 1.7370e5 * 0.9;

  for (const bool stress_free : {false, true})
    {
      const auto law = make_law<2>(
        "transversely isotropic",
        constants + "set Reference stress = " + (stress_free ? "stress-free" : "raw"));
      const auto P         = law->first_piola_kirchhoff_stress(F, along_x, 0.);
      const auto R         = law->first_piola_kirchhoff_stress(F, along_y, 0.);
      const double minus_x = stress_free ? 2 * 1.7370e5 / 1.1 : 0,
                   minus_y = stress_free ? 2 * 1.7370e5 / 0.9 : 0;
      std::cout << below(std::abs(P[0][0] - (xx - minus_x + fibre)), 1e-8) << ' '
                << below(std::abs(P[1][1] - (yy - minus_y)), 1e-8) << ' '
                << below(std::abs(R[0][0] - (xx - minus_x)), 1e-8) << ' '
                << below(std::abs(R[1][1] - (yy - minus_y)), 1e-8) << ' '
                << below(P[0][1] * P[0][1] + P[1][0] * P[1][0], 1e-20) << std::endl;
    }
}
