#ifndef mitre_fluid_navier_stokes_h
#define mitre_fluid_navier_stokes_h

#include <array>
#include <functional>
#include <memory>

#include <mitre/fluid/advection.h>
#include <mitre/fluid/boundary_conditions/interface.h>
#include <mitre/fluid/feedback_forcing.h>
#include <mitre/fluid/stokes_solver.h>
#include <mitre/grid/solution_transfer.h>

namespace mitre::fluid
{
  struct FluidParameters
  {
    double density            = 1.;
    double viscosity          = 0.04;
    AdvectionScheme advection = AdvectionScheme::ppm;
    StokesSolverParameters solver;

    static void declare_parameters(dealii::ParameterHandler &prm);
    void parse_parameters(dealii::ParameterHandler &prm);
  };


  /**
   * The incompressible fluid on the adaptive staggered grid: its state, and one time step
   * of the scheme (2.16)-(2.24) of the thesis: Crank-Nicolson for viscosity,
   * Adams-Bashforth for advection, one coupled velocity-pressure solve a step.
   *
   * A step of a coupled problem is
   *
   *   if (fluid.is_first_step()) { fluid.predict(t, dt, f(t)); ... f from the midpoint }
   *   fluid.advance(t, dt, f(t + dt/2));
   *
   * where predict() computes the provisional velocity (2.20)-(2.21) that the first
   * step's midpoint advection uses. Steps may differ in length: Adams-Bashforth
   * extrapolates from the last two times as they are, with the factors 1 + r/2 and -r/2
   * for steps in the ratio r.
   */
  template <int dim>
  class NavierStokes
  {
  public:
    NavierStokes(grid::PatchGrid<dim> &patch_grid,
                 const BoundaryConditions<dim> &boundary_conditions,
                 const FluidParameters &parameters);

    /// Velocity component c at a point, as an initial value.
    using VelocityFunction =
      std::function<double(const dealii::Point<dim> &, const unsigned int)>;

    /// Sets the velocity [cm/s] from a function and makes it divergence-free.
    void set_velocity(const VelocityFunction &function, const double time);

    bool is_first_step() const
    {
      return !has_history;
    }

    /// Provisional velocity of the first step, from the force density [dyn/cm^3] at
    /// @p time.
    void predict(const double time, const double dt, const grid::VectorType &force);

    /**
     * One step from @p time to time + dt with the force density at its middle. Returns
     * the number of iterations of the solver.
     */
    unsigned int
    advance(const double time, const double dt, const grid::VectorType &force);

    /// What a step changes, to be kept by save() and put back by restore().
    struct State
    {
      grid::VectorType u, u_old, p, p_old, advection_old;
      double previous_dt                = 0.;
      bool has_history                  = false;
      unsigned int n_steps_since_change = 0;
    };

    /// Copies the state, for a step that may have to be repeated.
    void save(State &state) const;

    /// Goes back to what save() copied; the grid must be the same.
    void restore(const State &state);

    /// Carries the state to a grid with the wanted levels; returns whether it changed.
    bool regrid(const std::function<int(const dealii::BoundingBox<dim> &)> &wanted_level,
                const double time);

    /// Makes @p field, with a value at each velocity, divergence-free and zero on the
    /// faces whose velocity is given. Returns the number of iterations.
    /// @param tolerance for the norm of the divergence, relative to that before
    unsigned int project(grid::VectorType &field, const double tolerance);

    /// u^n [cm/s], consistent.
    const grid::VectorType &velocity() const
    {
      return u;
    }

    /// u^(n-1): the velocity before the last advance().
    const grid::VectorType &previous_velocity() const
    {
      return u_old;
    }

    /// p^(n-1/2) [dyn/cm^2].
    const grid::VectorType &pressure() const
    {
      return p;
    }

    const grid::StaggeredSpace<dim> &space() const
    {
      return *velocity_space;
    }

    const StokesOperators<dim> &operators() const
    {
      return *stokes_operators;
    }

    const StokesSolver<dim> &solver() const
    {
      return *stokes_solver;
    }

    const FluidParameters &fluid_parameters() const
    {
      return parameters;
    }

    /// Number of iterations of the projection after the last change of the grid.
    unsigned int last_projection_iterations() const
    {
      return projection_iterations;
    }

  private:
    void setup_operators();
    void setup_solver();
    /// The vectors that hold nothing between two steps.
    std::array<grid::VectorType *, 5> scratch_velocities()
    {
      return {{&u_new, &advection_new, &provisional, &rhs, &work}};
    }
    void set_time_step(const double dt);
    void set_fixed_faces(grid::VectorType &velocity, const double time) const;
    std::function<double(const grid::BoundaryTerm<dim> &)>
    prescribed(const double time) const;
    void compute_advection(grid::VectorType &dst,
                           const grid::VectorType &velocity,
                           const double time);
    /// The advection term is weight * advection_new + (1 - weight) * advection_old.
    unsigned int solve(grid::VectorType &u_new,
                       grid::VectorType &p_new,
                       const double weight,
                       const grid::VectorType &force,
                       const double time,
                       const double dt);

    grid::PatchGrid<dim> &patch_grid;
    const BoundaryConditions<dim> &boundary_conditions;
    const FluidParameters parameters;
    const bool velocities_zero;

    const std::shared_ptr<grid::RowCache<dim>> row_cache =
      std::make_shared<grid::RowCache<dim>>();
    std::unique_ptr<grid::StaggeredSpace<dim>> velocity_space;
    std::unique_ptr<StokesOperators<dim>> stokes_operators;
    std::unique_ptr<StokesSolver<dim>> stokes_solver;
    std::unique_ptr<Advection<dim>> advection;
    std::unique_ptr<FeedbackForcing<dim>> feedback;

    grid::VectorType u, u_old, p, p_old;
    grid::VectorType advection_old;
    grid::VectorType provisional;
    grid::VectorType u_new, p_new, advection_new, rhs, work;
    double last_dt                     = 0.; ///< what the solver is set up for
    double previous_dt                 = 0.; ///< length of the last step
    bool has_history                   = false;
    bool has_predicted                 = false;
    unsigned int n_steps_since_change  = 0;
    unsigned int projection_iterations = 0;
  };
} // namespace mitre::fluid

#endif
