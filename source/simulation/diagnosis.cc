// What is known about a run before its first step, and about the state in which a step
// has failed.

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/base/units.h>
#include <mitre/io/safe_file.h>
#include <mitre/simulation/simulation.h>
#include <mitre/structure/stable_time_step.h>

namespace mitre::simulation
{
  using namespace dealii;

  namespace
  {
    double wall_clock()
    {
      return std::chrono::duration<double>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
    }


    /**
     * Times between @p start and @p end [s] at which some material of @p body is
     * stiffest: those of the largest of a hundred values of its time factor. A factor
     * that does not change says nothing; if there is no other, it is the start.
     */
    template <int dim>
    std::vector<double>
    stiffest_times(const structure::Body<dim> &body, const double start, const double end)
    {
      std::vector<double> times;
      if (const auto *solid =
            dynamic_cast<const structure::FiniteElementBody<dim> *>(&body))
        for (const structure::Material<dim> &material : solid->materials())
          {
            double smallest = std::numeric_limits<double>::max(), largest = -smallest;
            double stiffest = start;
            for (unsigned int i = 0; i < 100; ++i)
              {
                const double t     = start + (end - start) * i / 99.;
                const double value = material.time_factor.value(t);
                smallest           = std::min(smallest, value);
                if (value > largest)
                  {
                    largest  = value;
                    stiffest = t;
                  }
              }
            if (largest > smallest)
              times.push_back(stiffest);
          }
      if (times.empty())
        times.push_back(start);
      std::sort(times.begin(), times.end());
      times.erase(std::unique(times.begin(), times.end()), times.end());
      return times;
    }


    /// "2 h 13 min"
    std::string duration(const double seconds)
    {
      std::ostringstream text;
      if (seconds < 120.)
        text << std::setprecision(2) << seconds << " s";
      else if (seconds < 7200.)
        text << std::lround(seconds / 60.) << " min";
      else
        text << std::setprecision(3) << seconds / 3600. << " h";
      return text.str();
    }
  } // namespace


  template <int dim>
  Findings Simulation<dim>::check(std::ostream &out) const
  {
    Findings findings;
    check_fluid(fluid_parameters, findings);
    const double pressure_difference = check_boundaries(
      boundary_conditions, *patch_grid, start_time, end_time, findings, out);
    if (pressure_difference > 0.)
      {
        // Bernoulli: all of the difference has become speed.
        const double speed =
          std::sqrt(2. * pressure_difference / fluid_parameters.density);
        out << "  pressures differ by up to " << pressure_difference / base::mmHg
            << " mmHg, which can drive a jet of " << speed
            << " cm/s; it would pass a cell in "
            << patch_grid->cell_width(patch_grid->maximum_level(), 0) / speed << " s\n";
      }

    for (const Part &part : parts)
      {
        const std::string section = "Structure / Part " + part.body->name() + " / ";
        const auto value          = [&](const std::string &entry) {
          const auto found = parameter_values.find(section + entry);
          return found == parameter_values.end() ? std::string() : found->second;
        };
        const PartView<dim> view{*part.body, part.coupling_parameters, part.X};
        out << "  part " << part.body->name() << ":\n";
        for (const std::string &material : base::parse_names(value("Materials")))
          out << "    material " << material << " (id "
              << value("Material " + material + " / Material id")
              << "): " << value("Material " + material + " / Law") << '\n';
        for (const std::string &constraint : base::parse_names(value("Constraints")))
          out << "    constraint " << constraint << ": "
              << value("Constraint " + constraint + " / Type") << '\n';
        check_part(view, *patch_grid, findings, out);
        check_levels(view, *patch_grid, findings);
      }
    check_tables(parameter_values, start_time, end_time, findings);
    return findings;
  }


  template <int dim>
  structure::StableTimeStep Simulation<dim>::estimate_stable_step(const unsigned int part,
                                                                  const double t)
  {
    grid::VectorType spread;
    fluid->operators().initialize_velocity(spread);
    std::vector<structure::VectorType> densities(parts.size()), velocities(parts.size());
    std::vector<const structure::VectorType *> density_pointers;
    std::vector<structure::VectorType *> velocity_pointers;
    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        parts[i].body->initialize_vector(densities[i]);
        parts[i].body->initialize_vector(velocities[i]);
        density_pointers.push_back(&densities[i]);
        velocity_pointers.push_back(&velocities[i]);
      }
    return structure::estimate_stable_time_step(
      *parts[part].body,
      parts[part].X,
      t,
      fluid_parameters.density,
      [&](const structure::VectorType &density, structure::VectorType &acceleration) {
        densities[part] = density;
        fe_coupling->spread(density_pointers, spread);
        fluid->project(spread, 1e-4);
        fe_coupling->interpolate(spread, velocity_pointers);
        acceleration = velocities[part];
      });
  }


  template <int dim>
  std::vector<std::string> Simulation<dim>::validate(std::ostream &out)
  {
    // Step 1: what can be seen at once.
    Findings findings = check(out);
    try
      {
        io::call_together(communicator, [&]() {
          if (root)
            check_output_folder(output_folder);
        });
      }
    catch (const base::UserError &error)
      {
        findings.errors.emplace_back(error.what());
      }

    // Step 2: which steps the explicit forces bear. Estimates for the elastic forces of
    // the parts belong into the same list.
    std::vector<StepLimit> limits;
    try
      {
        std::vector<PartView<dim>> views;
        std::vector<const structure::VectorType *> positions;
        for (const Part &part : parts)
          {
            views.push_back({*part.body, part.coupling_parameters, part.X});
            positions.push_back(&part.X);
          }
        fe_coupling->update_points(positions);
        const std::size_t n_points =
          Utilities::MPI::sum(fe_coupling->n_points(), communicator);
        out << "  " << n_points << " quadrature points between parts and grid\n";
        limits = constraint_step_limits(
          views, *fe_coupling, fluid->operators(), fluid_parameters.density);
      }
    catch (const base::UserError &error)
      {
        findings.errors.emplace_back(error.what());
      }
    out << "  longest stable steps, for a \"Time step\" of " << largest_time_step
        << " s:\n";
    for (unsigned int i = 0; i < parts.size(); ++i)
      if (!parts[i].body->is_rigid())
        for (const double t : stiffest_times(*parts[i].body, start_time, end_time))
          {
            const structure::StableTimeStep estimate = estimate_stable_step(i, t);
            if (!estimate.limited_by.empty())
              {
                std::ostringstream cause;
                cause << "part " << estimate.part << " (" << estimate.limited_by;
                if (t > start_time)
                  cause << " at t = " << t << " s";
                cause << ")";
                limits.push_back(
                  {cause.str(), estimate.time_step, "a smaller stiffness of the part"});
              }
          }
    check_step_limits(limits, largest_time_step, findings, out);
    if (parts.empty())
      out << "    no explicit forces\n";

    // Step 3: two steps on trial. The second is like those that follow.
    if (findings.errors.empty())
      try
        {
          start();
          advance();
          const double begin = wall_clock();
          if (current_time < end_time)
            advance();
          const double seconds = Utilities::MPI::max(wall_clock() - begin, communicator);
          out << "  two steps on trial: Courant number " << courant_number
              << ", solver iterations " << last_iterations << ", " << seconds
              << " s a step on " << Utilities::MPI::n_mpi_processes(communicator)
              << " rank(s)\n    " << std::ceil((end_time - start_time) / time_step - 1e-6)
              << " such steps would take "
              << duration(seconds * (end_time - start_time) / time_step)
              << ", without output and changes of the grid\n";
        }
      catch (const base::UserError &error)
        {
          findings.errors.push_back(std::string("The first steps fail: ") + error.what());
        }
    Utilities::System::MemoryStats memory;
    Utilities::System::get_memory_stats(memory);
    const auto megabytes =
      Utilities::MPI::min_max_avg(memory.VmHWM / 1024., communicator);
    out << "  memory: " << std::lround(megabytes.sum) << " MB, at most "
        << std::lround(megabytes.max) << " MB a rank" << std::endl;

    // Step 4: the judgement.
    for (const std::string &warning : findings.warnings)
      out << "Warning: " << warning << std::endl;
    if (!findings.errors.empty())
      {
        std::string message = parameter_file + " cannot work:";
        for (const std::string &error : findings.errors)
          message += "\n  " + error;
        throw base::UserError(message);
      }
    return findings.warnings;
  }


  template <int dim>
  std::string Simulation<dim>::describe_fastest_flow() const
  {
    // Step 1: the fastest face of each rank, or one whose velocity is not finite.
    std::array<double, dim + 1> mine; // speed and place
    mine.fill(-1.);
    const grid::StaggeredSpace<dim> &space = fluid->space();
    for (unsigned int p = 0; p < patch_grid->n_owned_patches(); ++p)
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int i = 0; i < space.n_dofs_per_component(); ++i)
          {
            const double value =
              std::abs(fluid->velocity().local_element(space.first_dof(p, c) + i));
            const double speed =
              std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
            if (speed <= mine[0])
              continue;
            std::array<int, dim> index;
            for (unsigned int d = 0, rest = i; d < dim; ++d)
              {
                index[d] = rest % space.extent(c, d);
                rest /= space.extent(c, d);
              }
            const Point<dim> x = space.position(p, c, index);
            mine[0]            = speed;
            for (unsigned int d = 0; d < dim; ++d)
              mine[d + 1] = x[d];
          }
    const auto all  = Utilities::MPI::all_gather(communicator, mine);
    const auto &top = *std::max_element(all.begin(), all.end());
    Point<dim> place;
    for (unsigned int d = 0; d < dim; ++d)
      place[d] = top[d + 1];
    std::ostringstream text;
    if (std::isfinite(top[0]))
      text << "the flow is fastest, " << top[0] << " cm/s, at "
           << structure::to_string(place) << " cm";
    else
      text << "the velocity of the flow is not finite at " << structure::to_string(place)
           << " cm";

    // Step 2: the node that is nearest to it.
    double nearest = std::numeric_limits<double>::max();
    std::string node;
    for (const Part &part : parts)
      {
        const std::vector<double> x = part.body->to_mesh_order(part.X);
        for (std::size_t i = 0; i < x.size(); i += dim)
          {
            double square = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              square += (x[i + d] - place[d]) * (x[i + d] - place[d]);
            if (square < nearest)
              {
                nearest = square;
                node    = "part " + part.body->name() + " whose place at rest is " +
                       structure::to_string(part.body->mesh().nodes[i / dim]);
              }
          }
      }
    if (!node.empty())
      text << ", " << std::sqrt(nearest) << " cm from the node of " << node;
    return text.str();
  }


#define MITRE_INSTANTIATE(dim)                                                           \
  template Findings Simulation<dim>::check(std::ostream &) const;                        \
  template std::vector<std::string> Simulation<dim>::validate(std::ostream &);           \
  template std::string Simulation<dim>::describe_fastest_flow() const;

  MITRE_INSTANTIATE(2)
  MITRE_INSTANTIATE(3)
#undef MITRE_INSTANTIATE
} // namespace mitre::simulation
