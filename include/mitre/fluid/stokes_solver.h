#ifndef mitre_fluid_stokes_solver_h
#define mitre_fluid_stokes_solver_h

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <vector>

#include <mitre/fluid/phase_times.h>
#include <mitre/fluid/pressure_multigrid.h>
#include <mitre/fluid/stokes_operators.h>
#include <mitre/fluid/velocity_multigrid.h>

namespace mitre::fluid
{
  template <int dim>
  class PressureHypre;

  /// What solves the pressure's part of the preconditioner.
  enum class PressurePreconditioner
  {
    multigrid, ///< PressureMultigrid
    hypre      ///< PressureHypre
  };


  struct StokesSolverParameters
  {
    double relative_tolerance                      = 1e-6;
    unsigned int maximum_iterations                = 100;
    unsigned int smoothing_steps                   = 2;
    unsigned int pressure_cycles                   = 1;
    PressurePreconditioner pressure_preconditioner = PressurePreconditioner::multigrid;
    bool residual_history                          = false;

    static void declare_parameters(dealii::ParameterHandler &prm);
    void parse_parameters(dealii::ParameterHandler &prm);
  };


  /**
   * Solves the coupled system of one time step, thesis (2.16)-(2.17):
   *
   *   (rho / dt) u - (mu / 2) laplace(u) + grad p = r,    div u = g,
   *
   * by the generalised conjugate residual method (Eisenstat, Elman and Schultz, SIAM J.
   * Numer. Anal. 20 (1983) 345-357), which has the same residuals as FGMRES, at hand in
   * every iteration, and is preconditioned by a projection step (B. E. Griffith, J.
   * Comput. Phys. 228 (2009) 7565-7595): a velocity solve (Chebyshev iteration of a
   * degree that follows from mu dt / (rho h^2), or multigrid cycles where that would be
   * large), a pressure Poisson solve (multigrid cycles), and the correction of velocity
   * and pressure.
   */
  template <int dim>
  class StokesSolver
  {
  public:
    StokesSolver(const StokesOperators<dim> &operators,
                 const StokesSolverParameters &parameters,
                 const double density,
                 const double viscosity);

    ~StokesSolver();

    /// To be called before solve() whenever the time step [s] changes.
    void set_time_step(const double dt);

    /**
     * Improves @p u and @p p, which hold a starting guess with the given boundary values,
     * until the residual's norm is below the relative tolerance times @p reference.
     * @p momentum_residual is r minus the left-hand side for the starting guess, and
     * is overwritten. Returns the number of iterations; throws base::UserError if there
     * are more than allowed.
     */
    unsigned int solve(grid::VectorType &u,
                       grid::VectorType &p,
                       grid::VectorType &momentum_residual,
                       const double reference);

    /**
     * Makes @p u divergence-free: u - grad phi with div grad phi = div u. Returns the
     * number of iterations.
     */
    unsigned int project(grid::VectorType &u, const double tolerance);

    /// Norm of the residual after the last solve(), relative to its reference.
    double last_relative_residual() const
    {
      return relative_residual;
    }

    const PressureMultigrid<dim> &pressure_multigrid() const
    {
      return multigrid;
    }

    /// Time spent in the parts of solve(), and in what else the owner adds.
    PhaseTimes &phase_times()
    {
      return times;
    }

    const PhaseTimes &phase_times() const
    {
      return times;
    }

  private:
    /// A direction z of search and its product w with the system, of norm one.
    struct Direction
    {
      grid::VectorType z_u, z_p, w_u, w_p;
    };

    /// z = (inverse of the projection step) r.
    void precondition(Direction &direction,
                      const grid::VectorType &r_u,
                      const grid::VectorType &r_p);

    void solve_velocity(grid::VectorType &u, const grid::VectorType &r) const;
    void apply_poisson(grid::VectorType &dst, grid::VectorType &phi);
    void pressure_cycle(grid::VectorType &phi, const grid::VectorType &g);
    void solve_pressure(grid::VectorType &phi, const grid::VectorType &g);

    const StokesOperators<dim> &operators;
    const StokesSolverParameters parameters;
    const double density, viscosity;
    double dt = 0.;
    PressureMultigrid<dim> multigrid;
    std::unique_ptr<PressureHypre<dim>> hypre;
    /// Made when a time step first needs it.
    std::unique_ptr<VelocityMultigrid<dim>> velocity_multigrid;
    bool use_velocity_multigrid = false;
    double relative_residual    = 0.;
    PhaseTimes times;

    /// Weight of the divergence in the residual, so that both parts have one unit.
    double divergence_scale = 1.;
    double smallest_h       = 1.;

    unsigned int velocity_degree = 1;
    double velocity_theta = 1., velocity_delta = 0.;
    std::vector<double> velocity_diagonal; // one a patch

    mutable grid::VectorType velocity_update, velocity_product;
    grid::VectorType pressure_rhs, pressure_correction, pressure_product;
    grid::VectorType divergence_residual;
    /// As many as the longest solve so far has needed.
    std::vector<std::unique_ptr<Direction>> directions;
  };
} // namespace mitre::fluid

#endif
