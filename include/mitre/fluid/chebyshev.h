#ifndef mitre_fluid_chebyshev_h
#define mitre_fluid_chebyshev_h

#include <algorithm>
#include <cmath>
#include <utility>

namespace mitre::fluid
{
  /**
   * Ends of the spectrum of a u + b laplace(u) over its diagonal, with the largest
   * @p diffusion_number -b / a * sum(1 / h^2) of all patches. Boundary rows reach a
   * little beyond 4, the bound of the inner ones.
   */
  inline std::pair<double, double> viscous_spectrum(const double diffusion_number)
  {
    return {1. / (1. + 2. * diffusion_number),
            (1. + 5. * diffusion_number) / (1. + 2. * diffusion_number)};
  }


  /**
   * The degree from which on Chebyshev iteration reduces the error by the factor
   * @p reduction (< 1) for a spectrum from @p lower to @p upper, but at most @p maximum.
   */
  inline unsigned int chebyshev_degree(const double lower,
                                       const double upper,
                                       const double reduction,
                                       const unsigned int maximum)
  {
    const double root = std::sqrt(upper / lower);
    const double rate = (root - 1.) / (root + 1.);
    return rate < reduction ? 1
                            : std::min(maximum,
                                       static_cast<unsigned int>(std::ceil(
                                         std::log(reduction) / std::log(rate))));
  }
} // namespace mitre::fluid

#endif
