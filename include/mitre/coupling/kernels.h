#ifndef mitre_coupling_kernels_h
#define mitre_coupling_kernels_h

#include <cmath>
#include <string>
#include <vector>

namespace mitre::coupling
{
  /// The weights of four grid points (vector extension of gcc and clang).
  using FourDoubles = double __attribute__((vector_size(32)));


  /**
   * One-dimensional regularised delta functions @f$\phi@f$ of the distance in grid
   * spacings; the weights of a point in dim dimensions are products of them.
   *
   * A kernel is a class with
   * @code
   *   // The point's coordinate in spacings from grid point 0 is index + 1 + r: the
   * weights
   *   // are those of the grid points index, .., index + 3.
   *   static double index_plus_one(double coordinate);
   *   static double root(double r);
   *   static FourDoubles weights(double r, double root);
   * @endcode
   * where root() is the costly part, evaluated for many points at a time. All kernels
   * here reach four grid points at most, so that a halo of two layers about a patch
   * suffices for all points in it, for face and cell centred components both.
   */
  namespace kernels
  {
    /**
     * Peskin's four-point kernel, Acta Numerica 11 (2002), eq. (6.27): sum 1 also over
     * the even and the odd points alone, first moment 0, sum of squares 3/8.
     */
    struct IB4
    {
      static constexpr const char *name = "IB_4";

      static double index_plus_one(const double coordinate)
      {
        return std::floor(coordinate);
      }

      static double root(const double r)
      {
        const double square = 1 + 4 * r * (1 - r);
        return std::sqrt(square > 0 ? square : 0);
      }

      static FourDoubles weights(const double r, const double root)
      {
        constexpr FourDoubles constant = {0.375, 0.375, 0.125, 0.125};
        constexpr FourDoubles linear   = {-0.25, -0.25, 0.25, 0.25};
        constexpr FourDoubles of_root  = {-0.125, 0.125, 0.125, -0.125};
        return constant + linear * r + of_root * root;
      }
    };


    /**
     * The three-point kernel of Roma, Peskin and Berger, J. Comput. Phys. 153 (1999),
     * eq. (22): sum 1, first moment 0, sum of squares 1/2.
     */
    struct IB3
    {
      static constexpr const char *name = "IB_3";

      static double index_plus_one(const double coordinate)
      {
        return std::floor(coordinate + 0.5);
      }

      static double root(const double r)
      {
        const double square = 1 - 3 * r * r;
        return std::sqrt(square > 0 ? square : 0);
      }

      static FourDoubles weights(const double r, const double root)
      {
        constexpr double sixth         = 1. / 6;
        constexpr FourDoubles constant = {2 * sixth, 2 * sixth, 2 * sixth, 0};
        constexpr FourDoubles linear   = {-0.5, 0, 0.5, 0};
        constexpr FourDoubles of_root  = {-sixth, 2 * sixth, -sixth, 0};
        return constant + linear * r + of_root * root;
      }
    };
  } // namespace kernels


  /// The layers that a padded patch must have about it for the kernels above.
  constexpr unsigned int kernel_halo_width = 2;


  /// The names of the kernels, for parameter files.
  const std::vector<std::string> &kernel_names();


  /**
   * Call @p function with a kernel object of the given name: the place that turns a name
   * into a type. Another kernel is a struct above, a line here and a line in
   * kernel_names().
   */
  template <typename Function>
  auto with_kernel(const std::string &name, Function &&function)
  {
    if (name == kernels::IB3::name)
      return function(kernels::IB3());
    return function(kernels::IB4());
  }
} // namespace mitre::coupling

#endif
