#include <deal.II/base/mpi.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>

#include <algorithm>
#include <array>
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


  namespace
  {
    /// Directions that are kept before the iteration starts again.
    constexpr unsigned int largest_basis = 50;

    /// Sums of products of owned entries: the local parts of x.x and x.y.
    struct Products
    {
      double xx = 0., xy = 0.;

      void add(const VectorType &x, const VectorType &y)
      {
        constexpr std::size_t width = 8;
        std::array<double, width> a{}, b{};
        const double *xs = x.begin(), *ys = y.begin();
        const std::size_t size = x.locally_owned_size(), whole = size - size % width;
        for (std::size_t i = 0; i < whole; i += width)
          for (std::size_t k = 0; k < width; ++k)
            {
              a[k] += xs[i + k] * xs[i + k];
              b[k] += xs[i + k] * ys[i + k];
            }
        for (std::size_t i = whole; i < size; ++i)
          {
            a[0] += xs[i] * xs[i];
            b[0] += xs[i] * ys[i];
          }
        for (std::size_t k = 0; k < width; ++k)
          {
            xx += a[k];
            xy += b[k];
          }
      }
    };

    /// Sums over all ranks of the products of (x_u, x_p) and (y_u, y_p).
    Products products(const VectorType &x_u,
                      const VectorType &x_p,
                      const VectorType &y_u,
                      const VectorType &y_p)
    {
      Products sum;
      sum.add(x_u, y_u);
      sum.add(x_p, y_p);
      const double own[2] = {sum.xx, sum.xy};
      double all[2];
      MPI_Allreduce(own, all, 2, MPI_DOUBLE, MPI_SUM, x_u.get_mpi_communicator());
      return {all[0], all[1]};
    }

    /// x += alpha z and r -= alpha w; returns the local part of the new r.r.
    double update(VectorType &x,
                  const VectorType &z,
                  VectorType &r,
                  const VectorType &w,
                  const double alpha)
    {
      constexpr std::size_t width = 8;
      std::array<double, width> sum{};
      double *xs = x.begin(), *rs = r.begin();
      const double *zs = z.begin(), *ws = w.begin();
      const std::size_t size = x.locally_owned_size(), whole = size - size % width;
      for (std::size_t i = 0; i < whole; i += width)
        for (std::size_t k = 0; k < width; ++k)
          {
            xs[i + k] += alpha * zs[i + k];
            rs[i + k] -= alpha * ws[i + k];
            sum[k] += rs[i + k] * rs[i + k];
          }
      for (std::size_t i = whole; i < size; ++i)
        {
          xs[i] += alpha * zs[i];
          rs[i] -= alpha * ws[i];
          sum[0] += rs[i] * rs[i];
        }
      double total = 0.;
      for (const double s : sum)
        total += s;
      return total;
    }
  } // namespace


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
    operators.initialize_pressure(divergence_residual);
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
  void StokesSolver<dim>::precondition(Direction &direction,
                                       const VectorType &r_u,
                                       const VectorType &r_p)
  {
    VectorType &z_u = direction.z_u, &z_p = direction.z_p;
    {
      const PhaseTimes::Scope timed(times, Phase::velocity);
      solve_velocity(z_u, r_u);
    }
    // div (u - grad phi) = - r_p / scale
    operators.apply_divergence(pressure_rhs, z_u, -1.);
    pressure_rhs.add(-1. / divergence_scale, r_p);
    {
      const PhaseTimes::Scope timed(times, Phase::pressure);
      solve_pressure(pressure_correction, pressure_rhs);
    }
    operators.apply_gradient(z_u, pressure_correction, true, -1.);
    // p = (rho / dt) phi - (mu / 2) div grad phi
    double *p         = z_p.begin();
    const double *phi = pressure_correction.begin(), *g = pressure_rhs.begin();
    const double a = density / dt, b = 0.5 * viscosity;
    const std::size_t size = z_p.locally_owned_size();
    for (std::size_t i = 0; i < size; ++i)
      p[i] = a * phi[i] + b * g[i];
  }


  template <int dim>
  unsigned int StokesSolver<dim>::solve(VectorType &u,
                                        VectorType &p,
                                        VectorType &r_u,
                                        const double reference)
  {
    const PhaseTimes::Scope timed(times, Phase::krylov);
    const grid::StaggeredSpace<dim> &space = operators.velocity_space();
    const MPI_Comm communicator            = space.grid().communicator();
    VectorType &r_p                        = divergence_residual;
    space.zero_fixed_faces(r_u);
    operators.apply_divergence(r_p, u, divergence_scale);

    const double tolerance = parameters.relative_tolerance * reference;
    const double start     = std::sqrt(products(r_u, r_p, r_u, r_p).xx);
    AssertThrow(
      std::isfinite(start),
      base::UserError("The flow has become infinite or undefined. The time step "
                      "is probably too large for the stiffness of the structure "
                      "or the speed of the flow."));
    const bool print =
      parameters.residual_history && Utilities::MPI::this_mpi_process(communicator) == 0;
    const auto report = [&](const unsigned int iteration, const double value) {
      if (print)
        std::cout << "Stokes solver: iteration " << iteration << ", relative residual "
                  << value / reference << std::endl;
    };

    double size             = start;
    unsigned int iterations = 0, n_basis = 0;
    report(0, size);
    while (size > tolerance)
      {
        if (iterations == parameters.maximum_iterations || !std::isfinite(size))
          {
            std::ostringstream message;
            message
              << "The velocity-pressure solver has not converged in " << iterations
              << " iterations: the residual went from " << start << " to " << size
              << ", but " << tolerance
              << " is wanted. Try a smaller time step, more \"Maximum iterations\", "
                 "or a larger \"Relative tolerance\" (section Fluid / Solver).";
            throw base::UserError(message.str());
          }
        if (n_basis == largest_basis)
          n_basis = 0;
        if (n_basis == directions.size())
          {
            directions.push_back(std::make_unique<Direction>());
            operators.initialize_velocity(directions.back()->z_u);
            operators.initialize_velocity(directions.back()->w_u);
            operators.initialize_pressure(directions.back()->z_p);
            operators.initialize_pressure(directions.back()->w_p);
          }
        Direction &next = *directions[n_basis];
        {
          const PhaseTimes::Scope timed_operators(times, Phase::operators);
          precondition(next, r_u, r_p);
          operators.apply_stokes(next.w_u,
                                 next.w_p,
                                 next.z_u,
                                 next.z_p,
                                 density / dt,
                                 -0.5 * viscosity,
                                 -divergence_scale);
        }
        for (unsigned int k = 0; k < n_basis; ++k)
          {
            const Direction &old = *directions[k];
            const double share   = products(old.w_u, old.w_p, next.w_u, next.w_p).xy;
            next.z_u.add(-share, old.z_u);
            next.z_p.add(-share, old.z_p);
            next.w_u.add(-share, old.w_u);
            next.w_p.add(-share, old.w_p);
          }
        const Products dots  = products(next.w_u, next.w_p, r_u, r_p);
        const double alpha   = dots.xx > 0. ? dots.xy / dots.xx : 0.;
        const double squares = update(u, next.z_u, r_u, next.w_u, alpha) +
                               update(p, next.z_p, r_p, next.w_p, alpha);
        size = std::sqrt(Utilities::MPI::sum(squares, communicator));
        report(++iterations, size);
        if (size > tolerance && dots.xx > 0.)
          {
            const double scale = 1. / std::sqrt(dots.xx);
            for (VectorType *v : {&next.z_u, &next.z_p, &next.w_u, &next.w_p})
              *v *= scale;
          }
        ++n_basis;
      }
    relative_residual = reference > 0. ? size / reference : 0.;
    if (iterations == 0)
      return 0;
    if (multigrid.is_singular())
      p.add(-operators.mean_pressure(p));
    space.synchronize(u);
    return iterations;
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
