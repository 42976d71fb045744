#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <mitre/base/exceptions.h>
#include <mitre/fluid/navier_stokes.h>

namespace mitre::fluid
{
  using namespace dealii;
  using grid::VectorType;

  void FluidParameters::declare_parameters(ParameterHandler &prm)
  {
    prm.declare_entry("Density", "1", Patterns::Double(1e-12), "Mass density [g/cm^3].");
    prm.declare_entry("Viscosity",
                      "0.04",
                      Patterns::Double(0.),
                      "Dynamic viscosity [g/(cm s)] (= poise).");
    prm.declare_entry("Advection scheme",
                      "PPM",
                      Patterns::Selection("PPM|monotone PPM|CUI|centered|none"),
                      "PPM: piecewise parabolic, upwind, limited so that smooth extrema "
                      "are kept; monotone PPM: limited everywhere; CUI: limited cubic "
                      "upwind interpolation; centered; none: Stokes flow.");
    prm.enter_subsection("Solver");
    StokesSolverParameters::declare_parameters(prm);
    prm.leave_subsection();
  }


  void FluidParameters::parse_parameters(ParameterHandler &prm)
  {
    density   = prm.get_double("Density");
    viscosity = prm.get_double("Viscosity");
    advection = advection_scheme(prm.get("Advection scheme"));
    prm.enter_subsection("Solver");
    solver.parse_parameters(prm);
    prm.leave_subsection();
  }


  template <int dim>
  NavierStokes<dim>::NavierStokes(grid::PatchGrid<dim> &patch_grid,
                                  const BoundaryConditions<dim> &boundary_conditions,
                                  const FluidParameters &parameters)
    : patch_grid(patch_grid)
    , boundary_conditions(boundary_conditions)
    , parameters(parameters)
    , velocities_zero(boundary_conditions.all_velocities_zero())
  {
    setup_operators();
    setup_solver();
    for (VectorType *v : {&u, &advection_old})
      stokes_operators->initialize_velocity(*v);
    stokes_operators->initialize_pressure(p);
  }


  template <int dim>
  void NavierStokes<dim>::setup_operators()
  {
    // these refer to the operators
    stokes_solver.reset();
    advection.reset();
    feedback.reset();
    velocity_space = std::make_unique<grid::StaggeredSpace<dim>>(
      patch_grid, boundary_conditions.kinds(), row_cache);
    stokes_operators = std::make_unique<StokesOperators<dim>>(*velocity_space);
  }


  template <int dim>
  void NavierStokes<dim>::setup_solver()
  {
    stokes_solver = std::make_unique<StokesSolver<dim>>(
      *stokes_operators, parameters.solver, parameters.density, parameters.viscosity);
    if (advection == nullptr)
      advection = std::make_unique<Advection<dim>>(*velocity_space, parameters.advection);
    feedback =
      std::make_unique<FeedbackForcing<dim>>(*velocity_space, boundary_conditions);
    stokes_operators->initialize_velocity(u_old);
    for (VectorType *v : scratch_velocities())
      stokes_operators->initialize_velocity(*v);
    for (VectorType *v : {&p_old, &p_new})
      stokes_operators->initialize_pressure(*v);
    last_dt              = 0.;
    n_steps_since_change = 0;
  }


  template <int dim>
  void NavierStokes<dim>::set_time_step(const double dt)
  {
    if (dt != last_dt)
      stokes_solver->set_time_step(dt);
    last_dt = dt;
  }


  template <int dim>
  void NavierStokes<dim>::set_fixed_faces(VectorType &velocity, const double time) const
  {
    for (const auto &face : velocity_space->fixed_faces())
      {
        const auto &condition = boundary_conditions.condition(face.condition);
        velocity.local_element(face.dof) =
          condition.kind() == grid::BoundaryKind::slip
            ? 0.
            : condition.velocity(face.x, face.side / 2, time);
      }
  }


  template <int dim>
  std::function<double(const grid::BoundaryTerm<dim> &)>
  NavierStokes<dim>::prescribed(const double time) const
  {
    if (velocities_zero)
      return {};
    return [this, time](const grid::BoundaryTerm<dim> &term) {
      return boundary_conditions.condition(term.condition)
        .velocity(term.x, term.component, time);
    };
  }


  template <int dim>
  void NavierStokes<dim>::set_velocity(const VelocityFunction &function,
                                       const double time)
  {
    typename grid::StaggeredSpace<dim>::Index index;
    for (unsigned int q = 0; q < patch_grid.n_owned_patches(); ++q)
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int i = 0; i < velocity_space->n_dofs_per_component(); ++i)
          {
            unsigned int rest = i;
            for (unsigned int d = 0; d < dim; ++d)
              {
                index[d] = rest % velocity_space->extent(c, d);
                rest /= velocity_space->extent(c, d);
              }
            u.local_element(velocity_space->first_dof(q, c) + i) =
              function(velocity_space->position(q, c, index), c);
          }
    set_fixed_faces(u, time);
    velocity_space->synchronize(u);
    const double speed = u.linfty_norm();
    if (speed > 0.)
      stokes_solver->project(u, 1e-10 * speed);
    u_old       = u;
    p           = 0.;
    p_old       = 0.;
    has_history = false;
  }


  template <int dim>
  void NavierStokes<dim>::compute_advection(VectorType &dst,
                                            const VectorType &velocity,
                                            const double time)
  {
    const PhaseTimes::Scope timed(stokes_solver->phase_times(), Phase::advection);
    advection->apply(dst, velocity, prescribed(time));
  }


  template <int dim>
  unsigned int NavierStokes<dim>::solve(VectorType &velocity,
                                        VectorType &pressure,
                                        const double weight,
                                        const VectorType &force,
                                        const double time,
                                        const double dt)
  {
    const PhaseTimes::Scope timed(stokes_solver->phase_times(), Phase::operators);
    set_time_step(dt);
    set_fixed_faces(velocity, time + dt);

    // the residual for the starting guess v:
    // (rho / dt) (u - v) + (mu / 2) laplace(u + v) - rho A + f - grad p
    const std::size_t n_entries = u.locally_owned_size();
    {
      double *sum       = work.begin();
      const double *now = u.begin(), *guess = velocity.begin();
      for (std::size_t i = 0; i < n_entries; ++i)
        sum[i] = now[i] + guess[i];
    }
    if (!velocities_zero)
      {
        const auto values_now = prescribed(time), values_new = prescribed(time + dt);
        stokes_operators->set_boundary_values([&](const grid::BoundaryTerm<dim> &term) {
          return values_now(term) + values_new(term);
        });
      }
    stokes_operators->apply_helmholtz(
      rhs, work, 0., 0.5 * parameters.viscosity, !velocities_zero);
    stokes_operators->apply_gradient(rhs, pressure, true, -1.);

    if (feedback->active())
      feedback->compute_force(work, u, time, parameters.density / dt);
    else
      work = 0.;
    for (const auto &face : velocity_space->open_faces())
      {
        const double h        = patch_grid.patch(face.patch).h[face.side / 2];
        const auto &condition = boundary_conditions.condition(face.condition);
        double outside        = condition.pressure(face.x, time + 0.5 * dt);
        const double beta     = condition.backflow_stabilisation();
        if (beta > 0.)
          {
            double inward = u.local_element(face.dof);
            if (n_steps_since_change >= 2)
              inward += 0.5 * dt / previous_dt * (inward - u_old.local_element(face.dof));
            if (face.side % 2 == 1)
              inward = -inward;
            if (inward > 0.)
              outside -= 0.5 * beta * parameters.density * inward * inward;
          }
        work.local_element(face.dof) += (face.side % 2 == 0 ? 2. : -2.) * outside / h;
      }

    // what the residual is compared with: the same without the starting guess
    double squares = 0.;
    {
      constexpr std::size_t width = 8;
      std::array<double, width> sum{};
      const double a = parameters.density / dt, b = -parameters.density * weight,
                   c    = -parameters.density * (1. - weight);
      double *r         = rhs.begin();
      const double *now = u.begin(), *guess = velocity.begin(), *f = force.begin(),
                   *more = work.begin(), *advection_now = advection_new.begin(),
                   *advection_before = advection_old.begin();
      const auto entry               = [&](const std::size_t i, const std::size_t k) {
        const double rest =
          b * advection_now[i] + c * advection_before[i] + f[i] + more[i];
        const double whole = a * now[i] + rest;
        r[i] += a * (now[i] - guess[i]) + rest;
        sum[k] += whole * whole;
      };
      const std::size_t whole = n_entries - n_entries % width;
      for (std::size_t i = 0; i < whole; i += width)
        for (std::size_t k = 0; k < width; ++k)
          entry(i + k, k);
      for (std::size_t i = whole; i < n_entries; ++i)
        entry(i, 0);
      for (const double s : sum)
        squares += s;
    }
    velocity_space->zero_fixed_faces(rhs);
    const double size =
      std::sqrt(Utilities::MPI::sum(squares, patch_grid.communicator()));
    const double start = rhs.l2_norm();
    return stokes_solver->solve(velocity, pressure, rhs, std::max(size, start));
  }


  template <int dim>
  void
  NavierStokes<dim>::predict(const double time, const double dt, const VectorType &force)
  {
    compute_advection(advection_new, u, time);
    provisional = u;
    p_new       = p;
    solve(provisional, p_new, 1., force, time, dt);
    has_predicted = true;
  }


  template <int dim>
  unsigned int
  NavierStokes<dim>::advance(const double time, const double dt, const VectorType &force)
  {
    unsigned int iterations;
    if (!has_history)
      {
        // (2.20)-(2.24): advection at the midpoint from a provisional velocity
        if (!has_predicted)
          predict(time, dt, force);
        work = u;
        work.sadd(0.5, 0.5, provisional);
        compute_advection(advection_old, u, time);
        compute_advection(advection_new, work, time + 0.5 * dt);
        u_new      = provisional;
        iterations = solve(u_new, p_new, 1., force, time, dt);
      }
    else
      {
        // (2.16): extrapolation from the last two times
        const double ratio = dt / previous_dt;
        compute_advection(advection_new, u, time);
        const double reach = n_steps_since_change >= 2 ? ratio : 0.;
        const auto extrapolate =
          [reach](VectorType &next, const VectorType &now, const VectorType &before) {
            double *x       = next.begin();
            const double *y = now.begin(), *z = before.begin();
            const std::size_t n_entries = next.locally_owned_size();
            for (std::size_t i = 0; i < n_entries; ++i)
              x[i] = y[i] + reach * (y[i] - z[i]);
          };
        extrapolate(u_new, u, u_old);
        extrapolate(p_new, p, p_old);
        iterations = solve(u_new, p_new, 1. + 0.5 * ratio, force, time, dt);
        advection_old.swap(advection_new);
      }
    u_old.swap(u);
    u.swap(u_new);
    p_old.swap(p);
    p.swap(p_new);
    has_history   = true;
    has_predicted = false;
    previous_dt   = dt;
    ++n_steps_since_change;
    return iterations;
  }


  template <int dim>
  void NavierStokes<dim>::save(State &state) const
  {
    state.u                    = u;
    state.u_old                = u_old;
    state.p                    = p;
    state.p_old                = p_old;
    state.advection_old        = advection_old;
    state.previous_dt          = previous_dt;
    state.has_history          = has_history;
    state.n_steps_since_change = n_steps_since_change;
  }


  template <int dim>
  void NavierStokes<dim>::restore(const State &state)
  {
    u                    = state.u;
    u_old                = state.u_old;
    p                    = state.p;
    p_old                = state.p_old;
    advection_old        = state.advection_old;
    previous_dt          = state.previous_dt;
    has_history          = state.has_history;
    has_predicted        = false;
    n_steps_since_change = state.n_steps_since_change;
  }


  template <int dim>
  bool NavierStokes<dim>::regrid(
    const std::function<int(const BoundingBox<dim> &)> &wanted_level,
    const double time)
  {
    std::unique_ptr<grid::SolutionTransfer<dim>> transfer;
    bool rebuilt      = false;
    const auto before = [&]() {
      // The memory of what a step needs serves the copies: pages that are new to a
      // process are far more expensive than what is done with them.
      for (VectorType *v : scratch_velocities())
        v->reinit(0);
      if (advection == nullptr)
        advection =
          std::make_unique<Advection<dim>>(*velocity_space, parameters.advection);
      transfer = std::make_unique<grid::SolutionTransfer<dim>>(
        patch_grid,
        *velocity_space,
        advection->velocity_halo(),
        stokes_operators->pressure_halo(),
        std::vector<VectorType *>{&u, &advection_old},
        std::vector<VectorType *>{&p});
    };
    const auto after = [&](const bool changed) {
      if (changed)
        {
          // the transfer refers to the old spaces until it has finished
          const auto old_space     = std::move(velocity_space);
          const auto old_operators = std::move(stokes_operators);
          setup_operators();
          for (VectorType *v : {&u, &advection_old})
            stokes_operators->initialize_velocity(*v);
          stokes_operators->initialize_pressure(p);
          transfer->finish(*velocity_space, {&u, &advection_old}, {&p});
          // what the transfer has added to the divergence has no mean over these blocks
          set_fixed_faces(u, time);
          stokes_operators->equalize_divergence_in_blocks(u);
          rebuilt = true;
        }
      else
        {
          transfer->give_back();
          for (VectorType *v : scratch_velocities())
            stokes_operators->initialize_velocity(*v);
        }
      transfer.reset();
    };
    // the root mean square over the box: what finer cells inherit does not count more
    const auto size_of_divergence = [this]() {
      stokes_operators->apply_divergence(p_new, u);
      const unsigned int n_cells =
        Utilities::fixed_power<dim>(patch_grid.n_cells_per_side());
      double sum[2] = {0., 0.};
      for (unsigned int q = 0; q < patch_grid.n_owned_patches(); ++q)
        {
          double volume = 1., squares = 0.;
          for (const double h : patch_grid.patch(q).h)
            volume *= h;
          for (unsigned int i = 0; i < n_cells; ++i)
            {
              const double value = p_new.local_element(q * n_cells + i);
              squares += value * value;
            }
          sum[0] += volume * squares;
          sum[1] += volume * n_cells;
        }
      double total[2];
      MPI_Allreduce(sum, total, 2, MPI_DOUBLE, MPI_SUM, patch_grid.communicator());
      return std::sqrt(total[0] / total[1]);
    };
    const double divergence_before = size_of_divergence();
    patch_grid.adapt(wanted_level, before, after);
    if (!rebuilt)
      return false;
    setup_solver();
    // given velocities may have another mean on new faces
    double width = std::numeric_limits<double>::max();
    for (unsigned int d = 0; d < dim; ++d)
      width = std::min(width, patch_grid.cell_width(patch_grid.maximum_level(), d));
    const double wanted   = std::max(1e-10 * u.linfty_norm() / width, divergence_before);
    const double found    = size_of_divergence();
    projection_iterations = 0;
    // with a margin, as round-off shall not decide
    if (found > 1.5 * wanted)
      projection_iterations = stokes_solver->project(u, wanted / found * p_new.l2_norm());
    u_old = u;
    p_old = p;
    return true;
  }


  template <int dim>
  unsigned int NavierStokes<dim>::project(VectorType &field, const double tolerance)
  {
    velocity_space->zero_fixed_faces(field);
    velocity_space->synchronize(field);
    stokes_operators->apply_divergence(p_new, field);
    const double size = p_new.l2_norm();
    return size > 0. ? stokes_solver->project(field, tolerance * size) : 0;
  }


  template class NavierStokes<2>;
  template class NavierStokes<3>;
} // namespace mitre::fluid
