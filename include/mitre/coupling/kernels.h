#ifndef mitre_coupling_kernels_h
#define mitre_coupling_kernels_h

#include <algorithm>
#include <array>
#include <cmath>
#include <experimental/simd>
#include <string>
#include <tuple>
#include <vector>

namespace mitre::coupling
{
  /**
   * One-dimensional regularised delta functions @f$\phi@f$ of the distance in grid
   * spacings. A kernel that reaches n grid points is a class with
   * @code
   *   static constexpr int n_points = n;
   *   template <typename Number>
   *   static std::array<Number, n> weights(const Number r);
   * @endcode
   * weights() returns those of n successive grid points for a point that lies @p r
   * spacings above a grid point: the one below it (0 <= r <= 1) if n is even, the nearest
   * one (-1/2 <= r <= 1/2) if n is odd. That grid point is number (n - 1) / 2 of the n.
   * Number is double or a vector of several points' coordinates.
   *
   * All have sum 1 and first moment 0, so that constants and linear functions are
   * interpolated exactly. "Moments" are those about the point.
   */
  namespace kernels
  {
    /// Square root; round-off below zero, where the exact result is zero, counts as zero.
    template <typename Number>
    Number root(const Number x)
    {
      using std::max;
      using std::sqrt;
      return sqrt(max(x, Number(0.)));
    }


    /**
     * The weights p + t n in which t >= 0 is the larger solution of |p + t n|^2 = C.
     * p has all moments that a kernel asks for but not the sum of squares C; n changes
     * none of them.
     */
    template <typename Number, std::size_t size>
    std::array<Number, size> with_sum_of_squares(const std::array<Number, size> &p,
                                                 const std::array<double, size> &n,
                                                 const double C)
    {
      Number pp = -C, pn = 0;
      double nn = 0;
      for (std::size_t j = 0; j < size; ++j)
        {
          pp += p[j] * p[j];
          pn += n[j] * p[j];
          nn += n[j] * n[j];
        }
      const Number t = (root(pn * pn - nn * pp) - pn) * (1 / nn);
      std::array<Number, size> weights;
      for (std::size_t j = 0; j < size; ++j)
        weights[j] = p[j] + n[j] * t;
      return weights;
    }


    /**
     * The three-point kernel of Roma, Peskin and Berger, J. Comput. Phys. 153 (1999),
     * eq. (22): sum of squares 1/2.
     */
    struct IB3
    {
      static constexpr const char *name = "IB_3";
      static constexpr int n_points     = 3;

      template <typename Number>
      static std::array<Number, 3> weights(const Number r)
      {
        const Number middle = (1. + root(1. - 3. * r * r)) * (1. / 3);
        return {{0.5 * (1. - r) - 0.5 * middle, middle, 0.5 * (1. + r) - 0.5 * middle}};
      }
    };


    /**
     * Peskin's four-point kernel, Acta Numerica 11 (2002), eq. (6.27): sum 1/2 over the
     * even and over the odd points, sum of squares 3/8.
     */
    struct IB4
    {
      static constexpr const char *name = "IB_4";
      static constexpr int n_points     = 4;

      template <typename Number>
      static std::array<Number, 4> weights(const Number r)
      {
        const Number s = 0.125 * root(1. + 4. * r * (1. - r));
        const Number a = 0.375 - 0.25 * r, b = 0.125 + 0.25 * r;
        return {{a - s, a + s, b + s, b - s}};
      }
    };


    /**
     * The five-point kernel of Bao, Kaye and Peskin, arXiv:1505.07529: second moment
     * K = (38 - sqrt(69)) / 60, with which it has three continuous derivatives; third
     * moment 0, constant sum of squares.
     */
    struct IB5
    {
      static constexpr const char *name = "IB_5";
      static constexpr int n_points     = 5;
      static constexpr double K         = 0.49488960228469875;

      /// The sum of squares; it follows from the last weight being 0 at r = -1/2.
      static constexpr double sum_of_squares = 0.39254792818444011;

      template <typename Number>
      static std::array<Number, 5> weights(const Number r)
      {
        // Moments about the grid point in the middle are r, K + r^2 and r^3 + 3 K r; with
        // a weight of 0 there, sums and differences of the others follow.
        const Number even_2 = (K + r * r - 1.) * (1. / 3), even_1 = 1. - even_2;
        const Number odd_2 = (r * (r * r + (3. * K - 1.))) * (1. / 6),
                     odd_1 = r - 2. * odd_2;
        return with_sum_of_squares<Number, 5>({{0.5 * (even_2 - odd_2),
                                                0.5 * (even_1 - odd_1),
                                                Number(0.),
                                                0.5 * (even_1 + odd_1),
                                                0.5 * (even_2 + odd_2)}},
                                              {{1., -4., 6., -4., 1.}},
                                              sum_of_squares);
      }
    };


    /**
     * The six-point kernel of Bao, Kaye and Peskin, J. Comput. Phys. 316 (2016): sum 1/2
     * over the even and over the odd points, second moment K = 59/60 - sqrt(29)/20, with
     * which it has three continuous derivatives; third moment 0, constant sum of squares.
     */
    struct IB6
    {
      static constexpr const char *name = "IB_6";
      static constexpr int n_points     = 6;
      static constexpr double K         = 0.71407509297660818;

      /// The sum of squares; it follows from the last weight being 0 at r = 0.
      static constexpr double sum_of_squares = 0.32577761539018641;

      template <typename Number>
      static std::array<Number, 6> weights(const Number r)
      {
        // As in IB5, here with a weight of 0 at the last of the points.
        const Number even_2 = 0.25 * (K + r * r - 0.5);
        const Number odd_2  = (r * (r * r + (3. * K - 1.))) * (1. / 6),
                     odd_1  = r - 2. * odd_2;
        return with_sum_of_squares<Number, 6>({{0.5 * (even_2 - odd_2),
                                                0.5 * (0.5 - odd_1),
                                                0.5 - even_2,
                                                0.5 * (0.5 + odd_1),
                                                0.5 * (even_2 + odd_2),
                                                Number(0.)}},
                                              {{1., -3., 2., 2., -3., 1.}},
                                              sum_of_squares);
      }
    };


    /**
     * The cardinal B-spline of n points, a piecewise polynomial of degree n - 1 with n -
     * 2 continuous derivatives (Schoenberg 1946): it reproduces polynomials up to that
     * degree, so that from n = 3 on the second moment, n/12, does not depend on the
     * place, and from n = 4 on the third one vanishes.
     */
    template <int n>
    struct BSpline
    {
      static_assert(n >= 2 && n <= 6);
      static constexpr const char *name = std::array<const char *, 5>{
        {"BSPLINE_2", "BSPLINE_3", "BSPLINE_4", "BSPLINE_5", "BSPLINE_6"}}[n - 2];
      static constexpr int n_points = n;

      template <typename Number>
      static std::array<Number, n> weights(const Number r)
      {
        // Cox and de Boor's recursion between knots at distance t below and 1 - t above.
        const Number t = n % 2 == 0 ? r : r + 0.5;
        std::array<Number, n> b;
        b[0] = 1.;
        for (int k = 2; k <= n; ++k)
          {
            const double scale = 1. / (k - 1);
            b[k - 1]           = scale * t * b[k - 2];
            for (int j = k - 2; j > 0; --j)
              b[j] = scale * ((t + (k - 1. - j)) * b[j - 1] + (j + 1. - t) * b[j]);
            b[0] = scale * (1. - t) * b[0];
          }
        return b;
      }
    };


    /// The same function in all directions.
    template <typename OneDimensional>
    struct Isotropic
    {
      static constexpr const char *name = OneDimensional::name;
      using Normal                      = OneDimensional;
      using Across                      = OneDimensional;
    };


    /**
     * Composite B-splines (Gruninger, Barrett, Fang, Forest and Griffith, "Composite
     * B-spline regularized delta functions for the immersed boundary method"): for a
     * velocity component, the B-spline of n points along the component's direction, that
     * of n - 1 points across. As the derivative of the one is the difference of the
     * other, the velocity that is interpolated from a grid velocity without divergence is
     * itself free of divergence at every place.
     */
    template <int n>
    struct CompositeBSpline
    {
      static constexpr const char *name =
        std::array<const char *, 4>{{"CBS32", "CBS43", "CBS54", "CBS65"}}[n - 3];
      using Normal = BSpline<n>;
      using Across = BSpline<n - 1>;
    };
  } // namespace kernels


  /// All kernels. Another one is a struct above and a line here.
  using Kernels = std::tuple<kernels::Isotropic<kernels::IB4>,
                             kernels::Isotropic<kernels::IB3>,
                             kernels::Isotropic<kernels::IB5>,
                             kernels::Isotropic<kernels::IB6>,
                             kernels::Isotropic<kernels::BSpline<2>>,
                             kernels::Isotropic<kernels::BSpline<3>>,
                             kernels::Isotropic<kernels::BSpline<4>>,
                             kernels::Isotropic<kernels::BSpline<5>>,
                             kernels::Isotropic<kernels::BSpline<6>>,
                             kernels::CompositeBSpline<3>,
                             kernels::CompositeBSpline<4>,
                             kernels::CompositeBSpline<5>,
                             kernels::CompositeBSpline<6>>;


  /// The names of the kernels, for parameter files.
  const std::vector<std::string> &kernel_names();

  /// Throws base::UserError with the names of all kernels.
  [[noreturn]] void throw_unknown_kernel(const std::string &name);


  /// Call @p function with an object of the kernel with the given name. Throws
  /// base::UserError if there is none.
  template <typename Function>
  void with_kernel(const std::string &name, const Function &function)
  {
    bool found             = false;
    const auto call_if_own = [&](const auto kernel) {
      if (name == decltype(kernel)::name)
        {
          found = true;
          function(kernel);
        }
    };
    std::apply([&](const auto... kernel) { (call_if_own(kernel), ...); }, Kernels());
    if (!found)
      throw_unknown_kernel(name);
  }


  /// Layers that a padded patch must have about it: 2, or 3 for kernels of more than four
  /// points.
  unsigned int kernel_halo_width(const std::string &name);


  /// How far from a point the kernel of this name is not zero [grid spacings].
  double kernel_reach(const std::string &name);
} // namespace mitre::coupling

#endif
