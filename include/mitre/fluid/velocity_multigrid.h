#ifndef mitre_fluid_velocity_multigrid_h
#define mitre_fluid_velocity_multigrid_h

#include <memory>
#include <vector>

#include <mitre/fluid/stokes_operators.h>

namespace mitre::fluid
{
  /**
   * Geometric multigrid for the viscous operator a u + b laplace(u) with a > 0 >= b on
   * the composite grid, with zero velocity where it is given.
   *
   * As in PressureMultigrid all levels keep the leaves of the forest, and a level halves
   * the number m of cells along the sides of the patches, n, n/2, .., 2. Each level has a
   * staggered space and difference operators of its own, so that boundaries and
   * coarse-fine interfaces are what they are on the finest. The smoother is Chebyshev
   * iteration with the inverse diagonal, for the upper part of the spectrum only. On the
   * coarsest level, where -b / (a h^2) has become small, it covers the whole spectrum.
   * Residuals are weighted (1/4, 1/2, 1/4) along a component's own direction and averaged
   * along the others; corrections are interpolated linearly.
   */
  template <int dim>
  class VelocityMultigrid
  {
  public:
    /**
     * @param smoothing_steps Chebyshev degree before and after each coarse correction
     */
    VelocityMultigrid(const StokesOperators<dim> &operators,
                      const unsigned int smoothing_steps);

    /// To be called before vmult(); a in g/(cm^3 s), b in g/(cm s).
    void set_coefficients(const double a, const double b);

    /// One V-cycle from zero for a dst + b laplace(dst) = src.
    void vmult(grid::VectorType &dst, const grid::VectorType &src);

    unsigned int n_levels() const
    {
      return levels.size();
    }

    std::size_t memory_consumption() const;

  private:
    struct Level
    {
      // those of the coarser levels; the finest has the solver's
      std::unique_ptr<grid::PatchGrid<dim>> own_grid;
      std::unique_ptr<grid::StaggeredSpace<dim>> own_space;
      std::unique_ptr<StokesOperators<dim>> own_operators;
      const StokesOperators<dim> *operators;

      grid::VectorType solution, rhs, update, product;
      /// One over the diagonal; copies at interfaces have that of their masters, so that
      /// what is consistent stays so.
      grid::VectorType inverse_diagonal;
      /// Ends of the spectrum of the operator over its diagonal.
      double lower, upper;
    };

    void smooth(Level &level,
                const unsigned int degree,
                const double lower,
                const bool zero_start);
    void restrict_residual(const Level &fine, Level &coarse) const;
    void prolongate_correction(const Level &coarse, Level &fine) const;
    void cycle(const unsigned int l);

    const unsigned int n_smoothing_steps;
    std::vector<std::unique_ptr<Level>> levels;
    double a = 1., b = 0.;
    unsigned int coarsest_degree = 1;
  };
} // namespace mitre::fluid

#endif
