#include <deal.II/base/mpi.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/fluid/chebyshev.h>
#include <mitre/fluid/pressure_hypre.h>
#include <mitre/fluid/stokes_solver.h>

namespace mitre::fluid
{
  using namespace dealii;
  using grid::VectorType;

  namespace
  {
    /// Chebyshev iterations of a larger degree cost more than multigrid cycles do, which
    /// need some more outer iterations where levels meet at walls (doc/solver.md).
    constexpr unsigned int largest_velocity_degree = 20;

    /// Chebyshev degree of the velocity multigrid's smoother: fewer outer iterations than
    /// with 2, and less time than with 4 or with two cycles (doc/solver.md).
    constexpr unsigned int velocity_smoothing_steps = 3;
  } // namespace

  void StokesSolverParameters::declare_parameters(ParameterHandler &prm)
  {
    prm.declare_entry("Relative tolerance",
                      "1e-6",
                      Patterns::Double(1e-14, 1e-1),
                      "The coupled velocity-pressure system of a step is solved until "
                      "its residual is smaller than this times its right-hand side.");
    prm.declare_entry("Maximum iterations",
                      "100",
                      Patterns::Integer(1),
                      "The run stops if the solver needs more iterations than this.");
    prm.declare_entry("Smoothing steps",
                      "2",
                      Patterns::Integer(1, 10),
                      "Degree of the Chebyshev smoother before and after each coarse "
                      "correction of the pressure multigrid.");
    prm.declare_entry("Pressure cycles",
                      "1",
                      Patterns::Integer(1, 20),
                      "Multigrid cycles for the pressure in each iteration.");
    prm.declare_entry(
      "Pressure preconditioner",
      "multigrid",
      Patterns::Selection("multigrid|hypre"),
      "multigrid: geometric multigrid on the patches; hypre: BoomerAMG on "
      "the assembled operator, which is slower and serves as a check. "
      "Both give the same flow.");
    prm.declare_entry("Residual history",
                      "false",
                      Patterns::Bool(),
                      "Print the residual of each iteration of the solver.");
  }


  void StokesSolverParameters::parse_parameters(ParameterHandler &prm)
  {
    relative_tolerance      = prm.get_double("Relative tolerance");
    maximum_iterations      = prm.get_integer("Maximum iterations");
    smoothing_steps         = prm.get_integer("Smoothing steps");
    pressure_cycles         = prm.get_integer("Pressure cycles");
    pressure_preconditioner = prm.get("Pressure preconditioner") == "hypre"
                                ? PressurePreconditioner::hypre
                                : PressurePreconditioner::multigrid;
    residual_history        = prm.get_bool("Residual history");
  }


  template <int dim>
  struct StokesSolver<dim>::SystemMatrix
  {
    StokesSolver &solver;

    void vmult(BlockVector &dst, const BlockVector &src) const
    {
      // the operators only update the ghost entries of their argument
      BlockVector &x = const_cast<BlockVector &>(src);
      solver.operators.apply_helmholtz(dst.block(0),
                                       x.block(0),
                                       solver.density / solver.dt,
                                       -0.5 * solver.viscosity,
                                       false);
      solver.operators.apply_gradient(dst.block(0), x.block(1), true);
      solver.operators.apply_divergence(dst.block(1), x.block(0));
      dst.block(1) *= -solver.divergence_scale;
    }
  };


  template <int dim>
  struct StokesSolver<dim>::Preconditioner
  {
    StokesSolver &solver;

    void vmult(BlockVector &dst, const BlockVector &src) const
    {
      StokesSolver &s = solver;
      s.solve_velocity(dst.block(0), src.block(0));
      // div (u - grad phi) = - r_p / scale
      s.operators.apply_divergence(s.pressure_rhs, dst.block(0));
      s.pressure_rhs.add(1. / s.divergence_scale, src.block(1));
      s.pressure_rhs *= -1.;
      s.solve_pressure(s.pressure_correction, s.pressure_rhs);
      s.operators.apply_gradient(s.velocity_product, s.pressure_correction, false);
      dst.block(0).add(-1., s.velocity_product);
      // p = (rho / dt) phi - (mu / 2) div grad phi
      dst.block(1).equ(s.density / s.dt, s.pressure_correction);
      dst.block(1).add(0.5 * s.viscosity, s.pressure_rhs);
    }
  };


  template <int dim>
  StokesSolver<dim>::StokesSolver(const StokesOperators<dim> &operators,
                                  const StokesSolverParameters &parameters,
                                  const double density,
                                  const double viscosity)
    : operators(operators)
    , parameters(parameters)
    , density(density)
    , viscosity(viscosity)
    , multigrid(operators.velocity_space(), parameters.smoothing_steps)
  {
    operators.initialize_velocity(velocity_update);
    operators.initialize_velocity(velocity_product);
    operators.initialize_pressure(pressure_rhs);
    operators.initialize_pressure(pressure_correction);
    operators.initialize_pressure(pressure_product);
    for (BlockVector *vector : {&correction, &residual})
      {
        vector->reinit(2);
        operators.initialize_velocity(vector->block(0));
        operators.initialize_pressure(vector->block(1));
        vector->collect_sizes();
      }
    if (parameters.pressure_preconditioner == PressurePreconditioner::hypre)
      hypre = std::make_unique<PressureHypre<dim>>(operators);
  }


  template <int dim>
  StokesSolver<dim>::~StokesSolver() = default;


  template <int dim>
  void StokesSolver<dim>::set_time_step(const double new_dt)
  {
    dt                                     = new_dt;
    const grid::PatchGrid<dim> &patch_grid = operators.velocity_space().grid();
    velocity_diagonal.resize(patch_grid.n_owned_patches());
    double largest = 0., smallest = std::numeric_limits<double>::max();
    for (unsigned int p = 0; p < patch_grid.n_owned_patches(); ++p)
      {
        double sum = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double h = patch_grid.patch(p).h[d];
            sum += 1. / (h * h);
            smallest = std::min(smallest, h);
          }
        velocity_diagonal[p] = density / dt + viscosity * sum;
        largest              = std::max(largest, 0.5 * viscosity * dt / density * sum);
      }
    largest          = Utilities::MPI::max(largest, patch_grid.communicator());
    smallest_h       = Utilities::MPI::min(smallest, patch_grid.communicator());
    divergence_scale = density * smallest_h / dt;

    const auto [lower, upper] = viscous_spectrum(largest);
    velocity_theta            = 0.5 * (upper + lower);
    velocity_delta            = 0.5 * (upper - lower);
    velocity_degree           = chebyshev_degree(lower, upper, 0.02, 200);

    use_velocity_multigrid = velocity_degree > largest_velocity_degree;
    if (use_velocity_multigrid)
      {
        if (!velocity_multigrid)
          velocity_multigrid =
            std::make_unique<VelocityMultigrid<dim>>(operators, velocity_smoothing_steps);
        velocity_multigrid->set_coefficients(density / dt, -0.5 * viscosity);
      }
  }


  template <int dim>
  void StokesSolver<dim>::solve_velocity(VectorType &u, const VectorType &r) const
  {
    if (use_velocity_multigrid)
      {
        velocity_multigrid->vmult(u, r);
        return;
      }
    const unsigned int per_patch = operators.velocity_space().n_dofs_per_patch();
    const double sigma           = velocity_theta / std::max(velocity_delta, 1e-300);
    double rho                   = 1. / sigma;
    double *update = velocity_update.begin(), *value = u.begin();
    const double *rhs = r.begin();
    for (std::size_t p = 0; p < velocity_diagonal.size(); ++p)
      {
        const double gain = 1. / (velocity_theta * velocity_diagonal[p]);
        for (std::size_t i = p * per_patch; i < (p + 1) * per_patch; ++i)
          {
            update[i] = gain * rhs[i];
            value[i]  = update[i];
          }
      }
    for (unsigned int step = 1; step < velocity_degree; ++step)
      {
        operators.apply_helmholtz(
          velocity_product, u, density / dt, -0.5 * viscosity, false);
        const double rho_new  = 1. / (2. * sigma - rho);
        const double *product = velocity_product.begin();
        for (std::size_t p = 0; p < velocity_diagonal.size(); ++p)
          {
            const double gain = 2. * rho_new / (velocity_delta * velocity_diagonal[p]);
            const double keep = rho_new * rho;
            for (std::size_t i = p * per_patch; i < (p + 1) * per_patch; ++i)
              {
                update[i] = keep * update[i] + gain * (rhs[i] - product[i]);
                value[i] += update[i];
              }
          }
        rho = rho_new;
      }
    // diagonals differ between levels, so copies on interfaces have to follow again
    if (operators.velocity_space().grid().has_coarse_fine_interfaces())
      operators.velocity_space().synchronize(u);
  }


  template <int dim>
  void StokesSolver<dim>::apply_poisson(VectorType &dst, VectorType &phi)
  {
    operators.apply_gradient(velocity_product, phi, false);
    operators.apply_divergence(dst, velocity_product);
    dst *= -1.;
  }


  template <int dim>
  void StokesSolver<dim>::pressure_cycle(VectorType &phi, const VectorType &g)
  {
    if (hypre)
      hypre->vmult(phi, g);
    else
      multigrid.vmult(phi, g);
  }


  template <int dim>
  void StokesSolver<dim>::solve_pressure(VectorType &phi, const VectorType &g)
  {
    pressure_cycle(phi, g);
    for (unsigned int cycle = 1; cycle < parameters.pressure_cycles; ++cycle)
      {
        apply_poisson(pressure_product, phi);
        pressure_product.sadd(-1., 1., g);
        VectorType more(pressure_product);
        pressure_cycle(more, pressure_product);
        phi.add(1., more);
      }
  }


  template <int dim>
  unsigned int StokesSolver<dim>::solve(VectorType &u,
                                        VectorType &p,
                                        VectorType &momentum_residual,
                                        const double reference)
  {
    const grid::StaggeredSpace<dim> &space = operators.velocity_space();
    residual.block(0)                      = momentum_residual;
    space.zero_fixed_faces(residual.block(0));
    operators.apply_divergence(residual.block(1), u);
    residual.block(1) *= divergence_scale;
    correction = 0.;

    const double tolerance = parameters.relative_tolerance * reference;
    const double start     = residual.l2_norm();
    AssertThrow(
      std::isfinite(start),
      base::UserError("The flow has become infinite or undefined. The time step "
                      "is probably too large for the stiffness of the structure "
                      "or the speed of the flow."));
    if (start <= tolerance)
      {
        relative_residual = reference > 0. ? start / reference : 0.;
        return 0;
      }
    SolverControl control(parameters.maximum_iterations, tolerance, false, false);
    typename SolverFGMRES<BlockVector>::AdditionalData data(
      std::min(50u, parameters.maximum_iterations));
    SolverFGMRES<BlockVector> solver(control, data);
    if (parameters.residual_history &&
        Utilities::MPI::this_mpi_process(space.grid().communicator()) == 0)
      solver.connect(
        [&](const unsigned int iteration, const double value, const BlockVector &) {
          std::cout << "Stokes solver: iteration " << iteration << ", relative residual "
                    << value / reference << std::endl;
          return SolverControl::success;
        });
    const SystemMatrix matrix{*this};
    const Preconditioner preconditioner{*this};
    try
      {
        solver.solve(matrix, correction, residual, preconditioner);
      }
    catch (const SolverControl::NoConvergence &)
      {
        std::ostringstream message;
        message << "The velocity-pressure solver has not converged in "
                << control.last_step() << " iterations: the residual went from " << start
                << " to " << control.last_value() << ", but " << tolerance
                << " is wanted. Try a smaller time step, more \"Maximum iterations\", or "
                   "a larger \"Relative tolerance\" (section Fluid / Solver).";
        throw base::UserError(message.str());
      }
    relative_residual = control.last_value() / reference;
    u.add(1., correction.block(0));
    p.add(1., correction.block(1));
    if (multigrid.is_singular())
      p.add(-operators.mean_pressure(p));
    space.synchronize(u);
    return control.last_step();
  }


  template <int dim>
  unsigned int StokesSolver<dim>::project(VectorType &u, const double tolerance)
  {
    struct PoissonMatrix
    {
      StokesSolver &solver;
      void vmult(VectorType &dst, const VectorType &src) const
      {
        // the operators only update the ghost entries of their argument
        solver.apply_poisson(dst, const_cast<VectorType &>(src));
      }
    };
    struct Cycle
    {
      StokesSolver &solver;
      void vmult(VectorType &dst, const VectorType &src) const
      {
        solver.pressure_cycle(dst, src);
      }
    };
    operators.velocity_space().synchronize(u);
    operators.apply_divergence(pressure_rhs, u);
    pressure_rhs *= -1.;
    pressure_correction = 0.;
    SolverControl control(parameters.maximum_iterations, tolerance, false, false);
    if (pressure_rhs.l2_norm() <= tolerance)
      return 0;
    SolverFGMRES<VectorType> solver(
      control, typename SolverFGMRES<VectorType>::AdditionalData(40));
    const PoissonMatrix matrix{*this};
    const Cycle cycle{*this};
    try
      {
        solver.solve(matrix, pressure_correction, pressure_rhs, cycle);
      }
    catch (const SolverControl::NoConvergence &)
      {
        throw base::UserError("The projection of the velocity has not converged in " +
                              std::to_string(control.last_step()) +
                              " iterations: the divergence is still " +
                              std::to_string(control.last_value()) + ".");
      }
    operators.apply_gradient(velocity_product, pressure_correction, false);
    u.add(-1., velocity_product);
    operators.velocity_space().synchronize(u);
    return control.last_step();
  }


  template class StokesSolver<2>;
  template class StokesSolver<3>;
} // namespace mitre::fluid
