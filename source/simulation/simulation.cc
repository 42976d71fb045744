#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <iomanip>
#include <new>
#include <optional>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/base/parameter_values.h>
#include <mitre/base/parameters.h>
#include <mitre/base/progress.h>
#include <mitre/coupling/kernels.h>
#include <mitre/fluid/vorticity_map.h>
#include <mitre/io/fibre_files.h>
#include <mitre/io/mesh_reader.h>
#include <mitre/io/safe_file.h>
#include <mitre/simulation/simulation.h>
#include <mitre/structure/fibre_body.h>
#include <mitre/structure/library.h>

namespace mitre::simulation
{
  using namespace dealii;

  namespace
  {
    const char *const component_names[3] = {"x", "y", "z"};

    const std::vector<std::string> part_kinds = {"finite elements", "fibres"};

    double wall_clock()
    {
      return std::chrono::duration<double>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
    }


    std::string describe(const std::exception &error)
    {
      if (dynamic_cast<const std::bad_alloc *>(&error) != nullptr)
        return "There is not enough memory. Use a coarser grid, fewer levels or more "
               "machines.";
      return error.what();
    }
  } // namespace


  template <int dim>
  void Simulation<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.declare_entry("Output folder",
                      "runs/mitre",
                      Patterns::Anything(),
                      "Where the run's files go; made if it is not there.");
    prm.declare_entry("Resume",
                      "auto",
                      Patterns::Anything(),
                      "auto: go on from the newest complete checkpoint in the output "
                      "folder, or start if there is none; never: start, and set "
                      "checkpoints of an earlier run aside; else the folder of a "
                      "checkpoint, or of a run, from which to go on. The option --resume "
                      "of the program has precedence.");

    prm.enter_subsection("Checkpoints");
    CheckpointSchedule::declare_parameters(prm);
    prm.leave_subsection();

    prm.enter_subsection("Time");
    prm.declare_entry("End time", "1", Patterns::Double(0.), "Time at the end [s].");
    prm.declare_entry("Time step",
                      "1e-3",
                      Patterns::Double(1e-15),
                      "Length of all steps [s], or, with a \"Courant number\", of the "
                      "longest.");
    prm.declare_entry("Courant number",
                      "0",
                      Patterns::Double(0.),
                      "0: all steps have the same length. Otherwise each has the length "
                      "in which the flow "
                      "passes this many cells, as far as \"Time step\" allows; it grows "
                      "by at most a tenth "
                      "a step.");
    prm.declare_entry(
      "Smallest time step",
      "1e-9",
      Patterns::Double(1e-15),
      "With a \"Courant number\": the run stops with an error when a step "
      "would have to be shorter than this [s].");
    prm.declare_entry(
      "Maximum Courant number",
      "1",
      Patterns::Double(0.),
      "The run stops with an error if the flow passes more cells than this in a step; "
      "with "
      "a \"Courant number\" to aim at, the step is repeated at half its length instead.");
    prm.leave_subsection();

    prm.enter_subsection("Grid");
    grid::PatchGridParameters<dim>::declare_parameters(prm);
    prm.enter_subsection("Refinement");
    Refinement<dim>::declare_parameters(prm);
    prm.leave_subsection();
    prm.leave_subsection();

    prm.enter_subsection("Fluid");
    fluid::FluidParameters::declare_parameters(prm);
    for (unsigned int c = 0; c < dim; ++c)
      prm.declare_entry(
        std::string("Initial velocity ") + component_names[c],
        "0",
        Patterns::Anything(),
        "Component of the velocity at the start [cm/s], an expression of x, "
        "y, z [cm]; made divergence-free.");
    prm.leave_subsection();

    prm.enter_subsection("Boundary conditions");
    fluid::BoundaryConditions<dim>::declare_parameters(prm);
    prm.leave_subsection();

    prm.enter_subsection("Pressure control");
    PressureControl<dim>::declare_parameters(prm);
    prm.leave_subsection();

    prm.enter_subsection("Structure");
    const auto part_names = base::declare_names(
      prm, "Parts", "", "Names of the parts; each has a subsection \"Part NAME\".");
    for (const std::string &name : part_names)
      {
        prm.enter_subsection("Part " + name);
        const bool of_fibres =
          base::declare_choice(
            prm,
            "Kind",
            part_kinds[0],
            part_kinds,
            "finite elements: a mesh with constitutive laws; fibres: springs, beams and "
            "target points between nodes, which meet the fluid there.") == part_kinds[1];
        if (of_fibres)
          structure::FibreParameters<dim>::declare_parameters(prm);
        else
          structure::BodyParameters<dim>::declare_parameters(prm);
        coupling::CouplingParameters::declare_parameters(prm, of_fibres);
        prm.declare_entry(
          "Comparison shape",
          "",
          base::InputFile(),
          "A line that scripts/report draws beside the part as it is at the end: "
          "comma-separated values with two columns such as \"x [cm],y [cm]\". Without "
          "effect on the run.");
        prm.leave_subsection();
      }
    for (const std::string &name : base::declare_names(
           prm,
           "Ties",
           "",
           "Names of ties, springs between nodes of a part and another part where they "
           "meet; each has a subsection \"Tie NAME\"."))
      {
        prm.enter_subsection("Tie " + name);
        structure::Tie<dim>::declare_parameters(prm);
        prm.leave_subsection();
      }
    prm.leave_subsection();

    prm.enter_subsection("Instruments");
    instruments::Instruments<dim>::declare_parameters(prm);
    prm.leave_subsection();

    prm.enter_subsection("Output");
    prm.declare_entry(
      "Time between fields",
      "0.01",
      Patterns::Double(0.),
      "Time between two outputs of the fluid and the parts [s]; 0: none.");
    prm.declare_entry("Steps between statistics",
                      "10",
                      Patterns::Integer(1),
                      "Time steps between two lines of statistics.csv.");
    prm.leave_subsection();
  }


  namespace
  {
    /// A list of names, and a subsection for each in which @p entry has that name.
    std::string one_of_each(const std::string &list,
                            const std::string &subsection,
                            const std::string &entry,
                            const std::vector<std::string> &names)
    {
      std::string all, sections;
      for (const std::string &name : names)
        {
          all += (all.empty() ? "" : ", ") + name;
          sections += "subsection " + subsection + " " + name + "\n  set " + entry +
                      " = " + name + "\nend\n";
        }
      return "set " + list + " = " + all + "\n" + sections;
    }
  } // namespace


  template <int dim>
  std::string Simulation<dim>::example_of_all_plugins()
  {
    return "set Dimension = " + std::to_string(dim) +
           "\n"
           "subsection Grid\nsubsection Refinement\n"
           "set Refinement boxes = NAME\n"
           "end\nend\n"
           "subsection Boundary conditions\n" +
           one_of_each("Conditions",
                       "Condition",
                       "Type",
                       fluid::boundary_condition_registry<dim>().names()) +
           "end\n"
           "subsection Structure\n"
           "set Parts = NAME, FIBRES\n"
           "set Ties = NAME\n"
           "subsection Part FIBRES\n"
           "set Kind = fibres\n" +
           one_of_each(
             "Spring laws", "Spring law", "Type", structure::spring_laws().names()) +
           "end\n"
           "subsection Part NAME\n" +
           one_of_each("Materials",
                       "Material",
                       "Law",
                       structure::constitutive_laws<dim>().names()) +
           one_of_each(
             "Constraints", "Constraint", "Type", structure::constraints<dim>().names()) +
           one_of_each("Loads", "Load", "Type", structure::loads<dim>().names()) +
           "end\nend\n"
           "subsection Instruments\n" +
           one_of_each("Instruments",
                       "Instrument",
                       "Type",
                       instruments::instrument_registry<dim>().names()) +
           "end\n";
  }


  template <int dim>
  Simulation<dim>::Simulation(ParameterHandler &prm,
                              const std::string &parameter_file,
                              const MPI_Comm communicator,
                              const std::string &resume)
    : communicator(communicator)
    , root(Utilities::MPI::this_mpi_process(communicator) == 0)
    , parameter_file(parameter_file)
  {
    schedule.start_clock();
    output_folder = prm.get("Output folder");
    prm.enter_subsection("Checkpoints");
    schedule.parse_parameters(prm);
    prm.leave_subsection();
    checkpoints = std::make_unique<io::CheckpointStore>(
      output_folder, schedule.n_kept(), communicator);
    io::call_together(communicator, [&]() {
      if (root)
        {
          parameter_values   = base::list_parameter_values(prm);
          parameter_defaults = base::list_parameter_defaults(prm);
          list_files_beside_vertex_files();
        }
    });
    open_checkpoint(resume.empty() ? prm.get("Resume") : resume);

    prm.enter_subsection("Time");
    end_time               = prm.get_double("End time");
    largest_time_step      = prm.get_double("Time step");
    smallest_time_step     = prm.get_double("Smallest time step");
    wanted_courant_number  = prm.get_double("Courant number");
    maximum_courant_number = prm.get_double("Maximum Courant number");
    if (wanted_courant_number > maximum_courant_number)
      throw base::UserError("\"Time / Courant number\" is " + prm.get("Courant number") +
                            ", more than the \"Maximum Courant number\" of " +
                            prm.get("Maximum Courant number") +
                            " at which steps are repeated.");
    prm.leave_subsection();

    prm.enter_subsection("Output");
    output_interval     = prm.get_double("Time between fields");
    statistics_interval = prm.get_integer("Steps between statistics");
    prm.leave_subsection();

    prm.enter_subsection("Fluid");
    fluid_parameters.parse_parameters(prm);
    for (unsigned int c = 0; c < dim; ++c)
      {
        const std::string entry = std::string("Initial velocity ") + component_names[c];
        initial_velocity.emplace_back(prm.get(entry), "Fluid / " + entry);
      }
    prm.leave_subsection();

    prm.enter_subsection("Boundary conditions");
    boundary_conditions.parse_parameters(prm);
    prm.leave_subsection();
    prm.enter_subsection("Pressure control");
    pressure_control.parse_parameters(prm, boundary_conditions);
    prm.leave_subsection();

    prm.enter_subsection("Grid");
    grid::PatchGridParameters<dim> grid_parameters;
    grid_parameters.parse_parameters(prm);
    prm.enter_subsection("Refinement");
    refinement.parse_parameters(prm);
    prm.leave_subsection();
    prm.leave_subsection();
    patch_grid = std::make_unique<grid::PatchGrid<dim>>(communicator, grid_parameters);

    prm.enter_subsection("Structure");
    read_parts(prm);
    read_ties(prm);
    prm.leave_subsection();
    if (resumed)
      restore_positions();

    if (resumed)
      restore_grid();
    else
      patch_grid->adapt(wanted_levels());
    fluid = std::make_unique<fluid::NavierStokes<dim>>(
      *patch_grid, boundary_conditions, fluid_parameters);
    fe_coupling = std::make_unique<coupling::FECoupling<dim>>(*patch_grid);
    for (const Part &part : parts)
      fe_coupling->add_part(*part.body, part.coupling_parameters);
    if (!resumed)
      distribute_parts();

    prm.enter_subsection("Instruments");
    instruments.parse_parameters(prm);
    prm.leave_subsection();
    if (resumed)
      restore_state();
  }


  template <int dim>
  Simulation<dim>::~Simulation()
  {
    // Not after an error, when other ranks may never come here.
    if (rescue_communicator != MPI_COMM_NULL && std::uncaught_exceptions() == 0)
      MPI_Comm_free(&rescue_communicator);
  }


  template <int dim>
  void Simulation<dim>::read_parts(ParameterHandler &prm)
  {
    for (const std::string &name : base::parse_names(prm.get("Parts")))
      {
        prm.enter_subsection("Part " + name);
        Part part;
        const bool of_fibres = prm.get("Kind") == part_kinds[1];
        structure::FibreParameters<dim> fibre_parameters;
        structure::BodyParameters<dim> body_parameters;
        if (of_fibres)
          fibre_parameters.parse_parameters(prm, name);
        else
          body_parameters.parse_parameters(prm, name);
        part.coupling_parameters.parse_parameters(prm, of_fibres);
        // Forces that are spread from nodes balance with lumped masses.
        if (part.coupling_parameters.points == coupling::PointChoice::nodes)
          body_parameters.consistent_mass = false;
        const int finest = patch_grid->maximum_level();
        if (part.coupling_parameters.level > finest)
          throw base::UserError("Part " + name + ": \"Grid level\" is " +
                                std::to_string(part.coupling_parameters.level) +
                                ", but \"Grid / Maximum level\" is only " +
                                std::to_string(finest) + ".");
        prm.leave_subsection();

        if (of_fibres)
          {
            if (fibre_parameters.vertex_file.empty())
              throw base::UserError("Part " + name +
                                    ": the parameter \"Vertex file\" is not set.");
            structure::FibreNetwork<dim> network =
              io::read_fibres<dim>(fibre_parameters.vertex_file, communicator);
            part.body = std::make_unique<structure::FibreBody<dim>>(
              std::move(fibre_parameters), std::move(network), communicator);
          }
        else
          {
            if (body_parameters.mesh_file.empty())
              throw base::UserError("Part " + name +
                                    ": the parameter \"Mesh file\" is not set.");
            structure::Mesh<dim> mesh =
              io::read_mesh<dim>(body_parameters.mesh_file, communicator);
            auto body = std::make_unique<structure::FiniteElementBody<dim>>(
              std::move(body_parameters), std::move(mesh), communicator);
            if (part.coupling_parameters.split_forces)
              {
                if (body->is_rigid())
                  throw base::UserError("Part " + name +
                                        ": \"Split forces\" is true, but the part is "
                                        "rigid and has no elastic forces.");
                if (part.coupling_parameters.points == coupling::PointChoice::nodes)
                  throw base::UserError("Part " + name +
                                        ": \"Split forces\" is true, for which "
                                        "\"Coupling\" must be 'elemental'; found "
                                        "'nodal'.");
                part.tractions =
                  std::make_unique<structure::SurfaceTractions<dim>>(*body);
              }
            part.body = std::move(body);
          }

        // parts must lie in the box before the grid can be built around them
        const auto &box = patch_grid->box();
        for (const Point<dim> &node : part.body->mesh().nodes)
          for (unsigned int d = 0; d < dim; ++d)
            {
              const auto &[lower, upper] = box.get_boundary_points();
              if (!patch_grid->periodic()[d] &&
                  !(node[d] >= lower[d] && node[d] <= upper[d]))
                {
                  std::ostringstream message;
                  message << "Part " << name << ": a node of " << part.body->mesh().source
                          << " is at (" << node << ") cm, outside of the fluid box from ("
                          << lower << ") to (" << upper
                          << ") cm. Are mesh and box both in cm?";
                  throw base::UserError(message.str());
                }
            }
        part.body->initialize_vector(part.X);
        part.body->set_to_reference_positions(part.X);
        part.body->initialize_vector(part.U);
        if (part.body->is_rigid())
          {
            part.body->set_to_held_positions(start_time, part.X);
            part.pulled = part.X;
          }
        parts.push_back(std::move(part));
      }
  }


  template <int dim>
  void Simulation<dim>::read_ties(ParameterHandler &prm)
  {
    std::vector<std::string> known;
    for (const Part &part : parts)
      known.push_back(part.body->name());
    for (const std::string &name : base::parse_names(prm.get("Ties")))
      {
        prm.enter_subsection("Tie " + name);
        TiedParts tied;
        tied.tie.parse_parameters(prm, name);
        prm.leave_subsection();
        const auto number = [&](const std::string &part) {
          const auto found = std::find(known.begin(), known.end(), part);
          if (found == known.end())
            throw base::UserError("Tie " + name + ": there is no part '" + part + "'. " +
                                  base::suggest_name(part, known));
          return static_cast<unsigned int>(found - known.begin());
        };
        tied.part = number(tied.tie.part());
        tied.host = number(tied.tie.host());
        if (parts[tied.part].body->is_rigid())
          throw base::UserError("Tie " + name + ": the part " + tied.tie.part() +
                                " is rigid; \"Part\" must name one that can move.");
        tied.tie.reinit(parts[tied.part].body->mesh(), parts[tied.host].body->mesh());
        ties.push_back(std::move(tied));
      }
  }


  template <int dim>
  std::function<int(const BoundingBox<dim> &)> Simulation<dim>::wanted_levels()
  {
    refinement_map = std::make_shared<coupling::RefinementMap<dim>>(*patch_grid);
    positions_at_regrid.clear();
    for (const Part &part : parts)
      {
        refinement_map->add(
          *part.body, part.X, part.coupling_parameters, refinement.buffer());
        positions_at_regrid.push_back(part.body->to_mesh_order(part.X));
      }
    // a quadrature point costs about a thousandth of the 8^3 cells of a patch
    patch_grid->extra_weight = [map = refinement_map](const BoundingBox<dim> &leaf) {
      return static_cast<unsigned int>(std::min(1e6, map->n_points(leaf)));
    };
    std::shared_ptr<fluid::VorticityMap<dim>> vorticity;
    if (fluid && refinement.vorticity_change() > 0.)
      vorticity =
        std::make_shared<fluid::VorticityMap<dim>>(fluid->space(),
                                                   fluid->velocity(),
                                                   refinement.vorticity_change(),
                                                   refinement.vorticity_level());
    return [this, vorticity](const BoundingBox<dim> &leaf) {
      const int level =
        std::max(refinement.wanted_level(leaf), refinement_map->wanted_level(leaf));
      return vorticity ? std::max(level, vorticity->wanted_level(leaf)) : level;
    };
  }


  template <int dim>
  void Simulation<dim>::distribute_parts(
    const std::vector<std::vector<unsigned int>> &node_owners)
  {
    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        Part &part = parts[i];
        part.body->distribute(
          [&](const std::vector<Point<dim>> &points) {
            return node_owners.empty() ? fe_coupling->owners_of(points) : node_owners[i];
          },
          part.X,
          part.body->is_rigid()
            ? std::vector<structure::VectorType *>{&part.U, &part.pulled}
            : std::vector<structure::VectorType *>{&part.U});
        part.body->initialize_vector(part.X_half);
        part.body->initialize_vector(part.F);
      }
    kernel_halo =
      std::make_unique<grid::VelocityHalo<dim>>(fluid->space(),
                                                fe_coupling->halo_width(),
                                                grid::HaloShape::full,
                                                grid::BoundaryExtension::reflection);
    kernel_halo->make_own_partitioner();
    fe_coupling->reinit(*kernel_halo);
    fluid->operators().initialize_velocity(grid_force);
    fluid->operators().initialize_velocity(middle_velocity);
  }


  template <int dim>
  double Simulation<dim>::largest_displacement_since_regrid() const
  {
    double largest = 0.;
    for (std::size_t i = 0; i < parts.size(); ++i)
      {
        const std::vector<double> now   = parts[i].body->to_mesh_order(parts[i].X);
        const std::vector<double> &then = positions_at_regrid[i];
        const int level                 = parts[i].coupling_parameters.level;
        const double h                  = patch_grid->cell_width(
          level < 0 ? static_cast<int>(patch_grid->maximum_level()) : level, 0);
        for (std::size_t k = 0; k < now.size(); k += dim)
          {
            double square = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              square += (now[k + d] - then[k + d]) * (now[k + d] - then[k + d]);
            largest = std::max(largest, std::sqrt(square) / h);
          }
      }
    return largest;
  }


  template <int dim>
  bool Simulation<dim>::regrid()
  {
    const bool changed = fluid->regrid(wanted_levels(), current_time);
    if (changed)
      {
        distribute_parts();
        ++n_regrids;
      }
    return changed;
  }


  template <int dim>
  void Simulation<dim>::spread_forces(const bool middle, const double t)
  {
    std::vector<const structure::VectorType *> forces;
    std::vector<coupling::PointForces<dim>> extra;
    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        Part &part       = parts[i];
        const bool rigid = part.body->is_rigid();
        const structure::VectorType &X =
          middle ? (rigid ? part.pulled_half : part.X_half) : part.force_positions();
        part.body->compute_force_density(X, part.U, t, part.F);
        if (part.tractions)
          split_forces(i, X, t, extra);
        forces.push_back(&part.F);
      }
    add_tie_forces(middle);
    fe_coupling->spread(forces, grid_force, nullptr, extra);
  }


  template <int dim>
  void Simulation<dim>::split_forces(const unsigned int i,
                                     const structure::VectorType &X,
                                     const double t,
                                     std::vector<coupling::PointForces<dim>> &extra)
  {
    // Step 1: the forces on those points that lie in patches of this rank.
    Part &part      = parts[i];
    const int level = part.coupling_parameters.level;
    const double h  = patch_grid->cell_width(
      level < 0 ? static_cast<int>(patch_grid->maximum_level()) : level, 0);
    structure::SurfaceForces<dim> surface;
    part.tractions->compute(
      part.body->to_mesh_order(X),
      t,
      h / part.coupling_parameters.point_density,
      [this](const Point<dim> &x) {
        return patch_grid->locate(x) != numbers::invalid_unsigned_int;
      },
      surface);
    Utilities::MPI::sum(surface.moments, communicator, surface.moments);

    // Step 2: what the force density has of them.
    structure::VectorType moments, density;
    part.body->initialize_vector(moments);
    part.body->initialize_vector(density);
    part.body->from_mesh_order(surface.moments, moments);
    part.body->project(density, moments);
    part.F -= density;
    extra.push_back({i, std::move(surface.points), std::move(surface.forces)});
  }


  template <int dim>
  void Simulation<dim>::add_tie_forces(const bool middle)
  {
    for (const TiedParts &tied : ties)
      {
        std::array<std::vector<double>, 2> positions, forces;
        const std::array<Part *, 2> pair = {{&parts[tied.part], &parts[tied.host]}};
        for (unsigned int i = 0; i < 2; ++i)
          {
            positions[i] =
              pair[i]->body->to_mesh_order(middle ? pair[i]->X_half : pair[i]->X);
            forces[i].assign(positions[i].size(), 0.);
          }
        tied.tie.add_forces(positions[0], positions[1], forces[0], forces[1]);
        for (unsigned int i = 0; i < 2; ++i)
          {
            // What holds a rigid part takes the force.
            structure::Body<dim> &body = *pair[i]->body;
            if (body.is_rigid())
              continue;
            structure::VectorType force, density;
            body.initialize_vector(force);
            body.initialize_vector(density);
            body.from_mesh_order(forces[i], force);
            body.project(density, force);
            pair[i]->F += density;
          }
      }
  }


  template <int dim>
  void Simulation<dim>::set_kernel_boundary_values(const double t)
  {
    if (boundary_conditions.all_velocities_zero())
      return;
    kernel_halo->set_boundary_values([this, t](const grid::BoundaryTerm<dim> &term) {
      return boundary_conditions.condition(term.condition)
        .velocity(term.x, term.component, t);
    });
  }


  template <int dim>
  void Simulation<dim>::step(const double dt)
  {
    if (parts.empty())
      {
        grid_force      = 0.;
        last_iterations = fluid->advance(current_time, dt, grid_force);
      }
    else
      {
        std::vector<const structure::VectorType *> positions, middle_positions;
        std::vector<structure::VectorType *> velocities;
        for (Part &part : parts)
          {
            positions.push_back(&part.X);
            middle_positions.push_back(&part.X_half);
            velocities.push_back(&part.U);
          }

        // (2.14), (2.23): to the middle of the step with the velocity at its beginning
        fe_coupling->update_points(positions);
        set_kernel_boundary_values(current_time);
        fe_coupling->interpolate(fluid->velocity(), velocities);
        if (fluid->is_first_step())
          {
            spread_forces(false, current_time);
            fluid->predict(current_time, dt, grid_force);
          }
        for (Part &part : parts)
          {
            structure::VectorType &half =
              part.body->is_rigid() ? part.pulled_half : part.X_half;
            half = part.force_positions();
            half.add(0.5 * dt, part.U);
            if (part.body->is_rigid())
              {
                part.X_half = part.X;
                part.body->set_to_held_positions(current_time + 0.5 * dt, part.X_half);
              }
          }

        // (2.16)-(2.18)
        fe_coupling->update_points(middle_positions);
        spread_forces(true, current_time + 0.5 * dt);
        last_iterations = fluid->advance(current_time, dt, grid_force);

        // (2.19)
        middle_velocity = fluid->velocity();
        middle_velocity.sadd(0.5, 0.5, fluid->previous_velocity());
        set_kernel_boundary_values(current_time + 0.5 * dt);
        fe_coupling->interpolate(middle_velocity, velocities);
        for (Part &part : parts)
          {
            part.force_positions().add(dt, part.U);
            if (part.body->is_rigid())
              part.body->set_to_held_positions(current_time + dt, part.X);
          }
      }
    courant_number = fluid->operators().max_courant_number(fluid->velocity(), dt);
  }


  template <int dim>
  void Simulation<dim>::check_courant_number() const
  {
    if (courant_number <= maximum_courant_number)
      return;
    std::ostringstream message;
    message << "At t = " << current_time + time_step << " s the flow passes "
            << courant_number << " cells in a time step of " << time_step
            << " s, more than the " << maximum_courant_number
            << " that \"Time / Maximum Courant number\" allows";
    if (wanted_courant_number > 0.)
      message << ", and half of it would be shorter than the \"Smallest time step\" of "
              << smallest_time_step << " s";
    message << "; " << describe_fastest_flow()
            << ". Usually the time step is too large for the stiffness of a part or of "
               "its constraints; try half of it.";
    throw base::UserError(message.str());
  }


  template <int dim>
  double Simulation<dim>::next_time_step() const
  {
    if (wanted_courant_number == 0.)
      return largest_time_step;
    double dt = largest_time_step;
    if (step_number > 0)
      dt = std::min(dt, 1.1 * time_step);
    const double courant = fluid->operators().max_courant_number(fluid->velocity(), dt);
    if (courant > wanted_courant_number)
      dt *= wanted_courant_number / courant;

    // The end is reached by a step of the same length as the others, or a shorter one.
    const double rest = end_time - current_time;
    return rest < dt * (1. + 1e-9) ? rest : rest < 2. * dt ? 0.5 * rest : dt;
  }


  template <int dim>
  void Simulation<dim>::advance()
  {
    save_step();
    const double begin = current_time;
    time_step          = next_time_step();
    if (wanted_courant_number == 0.)
      {
        step(time_step);
        check_courant_number();
        ++step_number;
        current_time =
          counted_from.second + (step_number - counted_from.first) * time_step;
      }
    else
      {
        step(time_step);
        while (!(courant_number <= maximum_courant_number))
          {
            if (0.5 * time_step < smallest_time_step)
              check_courant_number();
            time_step *= 0.5;
            ++n_repeated;
            restore_step_fields();
            step(time_step);
          }
        ++step_number;
        current_time += time_step;
        if (end_time - current_time < 1e-9 * time_step)
          current_time = end_time;
      }
    if (pressure_control.is_active())
      pressure_control.update(*fluid, begin, time_step);

    if (refinement.interval() > 0 && step_number % refinement.interval() == 0 &&
        patch_grid->maximum_level() > patch_grid->minimum_level() &&
        (refinement.vorticity_change() > 0. ||
         largest_displacement_since_regrid() > 0.5 * refinement.buffer()))
      {
        before_step.valid = false;
        regrid();
      }
  }


  template <int dim>
  instruments::Observation<dim> Simulation<dim>::observation()
  {
    instruments::Observation<dim> result;
    result.time                = current_time;
    result.dt                  = current_time - last_measured;
    result.fluid               = fluid.get();
    result.coupling            = parts.empty() ? nullptr : fe_coupling.get();
    result.boundary_conditions = &boundary_conditions;
    if (!parts.empty())
      set_kernel_boundary_values(current_time);
    for (const Part &part : parts)
      result.parts.push_back(
        {part.body.get(), &part.X, &part.U, &part.force_positions()});
    return result;
  }


  template <int dim>
  std::vector<std::string> Simulation<dim>::statistics_columns() const
  {
    std::vector<std::string> columns = {"time [s]",
                                        "solver iterations",
                                        "cells",
                                        "time step [s]",
                                        "Courant number",
                                        "largest divergence [1/s]",
                                        "wall time per step [s]"};
    for (const Part &part : parts)
      for (const auto &constraint : part.body->constraints())
        columns.push_back(part.body->name() + " " + constraint.name +
                          " displacement [cm]");
    for (const TiedParts &tied : ties)
      columns.push_back(tied.tie.name() + " distance [cm]");
    for (const Part &part : parts)
      columns.push_back(part.body->name() + " point spacing [cells]");
    for (const std::vector<std::string> &more :
         {pressure_control.columns(), instruments.columns()})
      columns.insert(columns.end(), more.begin(), more.end());
    return columns;
  }


  template <int dim>
  void Simulation<dim>::measure(const unsigned int iterations, const double wall_time)
  {
    std::vector<double> values = {current_time,
                                  static_cast<double>(iterations),
                                  static_cast<double>(patch_grid->n_global_cells()),
                                  time_step,
                                  courant_number,
                                  fluid->operators().max_divergence(fluid->velocity()),
                                  wall_time};
    for (const Part &part : parts)
      for (const double displacement : part.body->compute_constraint_displacements(
             part.force_positions(), current_time))
        values.push_back(displacement);
    for (const TiedParts &tied : ties)
      values.push_back(tied.tie.largest_distance(
        parts[tied.part].body->to_mesh_order(parts[tied.part].X),
        parts[tied.host].body->to_mesh_order(parts[tied.host].X)));
    measure_point_spacing(values);
    values.insert(
      values.end(), pressure_control.values().begin(), pressure_control.values().end());
    for (const double value : instruments.measure(observation()))
      values.push_back(value);
    statistics->write(values);
    last_measured = current_time;
  }


  // Fluid passes between points that are farther apart than about the grid's spacing.
  template <int dim>
  void Simulation<dim>::measure_point_spacing(std::vector<double> &values)
  {
    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        const double spacing = fe_coupling->largest_spacing(i);
        values.push_back(spacing);
        if (root && spacing > 1. && !parts[i].spacing_is_warned_of)
          {
            std::cout << "Warning: at t = " << current_time << " s, points of part "
                      << parts[i].body->name() << " are " << std::setprecision(3)
                      << spacing << std::setprecision(6)
                      << " grid spacings apart; fluid may pass between them. "
                      << (parts[i].body->mesh().shape == structure::ElementShape::segment
                            ? "More nodes prevent it."
                          : parts[i].coupling_parameters.points ==
                              coupling::PointChoice::nodes
                            ? "\"Coupling = elemental\" or a finer mesh prevents it."
                            : "A larger \"Point density\" prevents it.")
                      << std::endl;
            parts[i].spacing_is_warned_of = true;
          }
      }
  }


  template <int dim>
  void Simulation<dim>::write_fields()
  {
    output->write_fluid(
      fluid->space(), fluid->velocity(), fluid->pressure(), current_time);
    for (const Part &part : parts)
      output->write_part(*part.body, part.X, part.U, current_time);
  }


  template <int dim>
  void Simulation<dim>::print_summary(std::ostream &out) const
  {
    out << "Mitre: " << parameter_file << ", " << dim << " dimensions, "
        << Utilities::MPI::n_mpi_processes(communicator) << " rank(s)\n";
    const auto &[lower, upper] = patch_grid->box().get_boundary_points();
    out << "  box from (" << lower << ") to (" << upper << ") cm\n"
        << "  grid of " << patch_grid->n_global_patches() << " patches, "
        << patch_grid->n_global_cells() << " cells, spacing "
        << patch_grid->cell_width(patch_grid->maximum_level(), 0)
        << " cm at the finest level " << patch_grid->maximum_level() << '\n';
    for (const Part &part : parts)
      out << "  part " << part.body->name() << ": " << part.body->description() << '\n';
    for (const TiedParts &tied : ties)
      out << "  tie " << tied.tie.name() << ": " << tied.tie.n_nodes() << " nodes of "
          << tied.tie.part() << " to " << tied.tie.host() << '\n';
    if (wanted_courant_number > 0.)
      out << "  steps of at most " << largest_time_step << " s, Courant number "
          << wanted_courant_number;
    else
      out << "  "
          << counted_from.first +
               std::lround((end_time - counted_from.second) / largest_time_step)
          << " steps of " << largest_time_step << " s"
          << (counted_from.first == 0
                ? ""
                : " since step " + std::to_string(counted_from.first) +
                    ", of other length before");
    if (is_resumed)
      out << ", resumed from " << last_checkpoint << " after step " << step_number
          << " at t = " << current_time << " s,";
    out << " to t = " << end_time << " s; output in " << output_folder << std::endl;
  }


  template <int dim>
  bool Simulation<dim>::run()
  {
    try
      {
        return run_to_end();
      }
    catch (const std::exception &error)
      {
        std::ostringstream text;
        text << describe(error);
        if (stage == Stage::step)
          text << "\nThe run stops in step " << step_number + 1
               << ", which begins at t = " << current_time << " s." << rescue();
        else if (stage == Stage::between_steps)
          text << "\nThe run stops after step " << step_number
               << ", at t = " << current_time
               << " s. When that has been put right, start it again.";
        text << (last_checkpoint.empty()
                   ? "\nThe run has written no checkpoint."
                   : "\nThe newest checkpoint is " + last_checkpoint + ".");
        throw base::UserError(text.str());
      }
  }


  template <int dim>
  void Simulation<dim>::prepare_output()
  {
    io::call_together(communicator, [&]() {
      if (root)
        {
          io::make_folder(output_folder);
          folder_lock = std::make_unique<io::FolderLock>(output_folder);
        }
    });

    // Files of an earlier run: continued, or at least not mixed with those of this one.
    if (continues_output)
      {
        const unsigned int n = checkpoints->set_later_ones_aside(step_number);
        if (root && n > 0)
          std::cout << n << " later checkpoint(s) in " << checkpoints->folder()
                    << " are not used and now end with .unused." << std::endl;
      }
    else
      {
        const std::string aside = checkpoints->set_all_aside();
        if (root && !aside.empty())
          std::cout << "The checkpoints of an earlier run are now in " << aside << "."
                    << std::endl;
      }

    io::call_together(communicator, [&]() {
      if (root)
        {
          io::write_file(
            (std::filesystem::path(output_folder) / "parameters.prm").string(),
            [&](std::ostream &out) { out << base::expand_includes(parameter_file); });
        }
    });
    output = std::make_unique<io::OutputWriter<dim>>(output_folder, communicator);
    if (continues_output)
      output->continue_after(frames_to_continue);
    statistics = std::make_unique<io::StatisticsFile>(
      output_folder + "/statistics.csv",
      statistics_columns(),
      communicator,
      continues_output ? std::optional<double>(current_time) : std::optional<double>());
  }


  template <int dim>
  void Simulation<dim>::start()
  {
    const auto set_initial_velocity = [this]() {
      fluid->set_velocity(
        [this](const Point<dim> &x, const unsigned int c) {
          return initial_velocity[c].value(x);
        },
        start_time);
    };
    current_time = start_time;
    set_initial_velocity();
    if (refinement.vorticity_change() > 0.)
      for (unsigned int level = patch_grid->minimum_level();
           level < patch_grid->maximum_level() && regrid();
           ++level)
        set_initial_velocity();
    n_regrids     = 0;
    step_number   = 0;
    counted_from  = {0, start_time};
    last_measured = start_time;
    n_outputs     = 0;

    // What instruments find wrong shall be known before any file is touched. No time
    // passes, so that none of them adds anything up.
    instruments.measure(observation());
  }


  template <int dim>
  bool Simulation<dim>::run_to_end()
  {
    schedule.begin();
    MPI_Comm_dup(communicator, &rescue_communicator);
    if (!is_resumed)
      start();
    prepare_output();

    const unsigned int n_steps =
      counted_from.first +
      std::lround((end_time - counted_from.second) / largest_time_step);
    const auto finished = [&]() {
      return wanted_courant_number > 0. ? current_time >= end_time
                                        : step_number >= n_steps;
    };

    if (!is_resumed)
      {
        if (output_interval > 0.)
          {
            write_fields();
            ++n_outputs;
          }
        if (!parts.empty())
          {
            std::vector<const structure::VectorType *> positions;
            for (const Part &part : parts)
              positions.push_back(&part.X);
            fe_coupling->update_points(positions);
          }
        measure(0, 0.);
        statistics_clock = wall_clock();
        iterations_since = 0;
        steps_since      = 0;
      }

    base::Progress progress(std::cout, current_time, end_time, "s");
    while (!finished())
      {
        stage              = Stage::step;
        const double begin = wall_clock();
        advance();
        longest_step = std::max(longest_step, wall_clock() - begin);
        stage        = Stage::between_steps;

        iterations_since = std::max(iterations_since, last_iterations);
        ++steps_since;

        if (step_number % statistics_interval == 0 || finished())
          {
            const double now = wall_clock();
            measure(iterations_since, (now - statistics_clock) / steps_since);
            statistics_clock = now;
            iterations_since = 0;
            steps_since      = 0;
          }
        if (output_interval > 0. &&
            (current_time >= (n_outputs - 1e-6) * output_interval + start_time ||
             finished()))
          {
            const double begin = wall_clock();
            write_fields();
            ++n_outputs;
            statistics_clock += wall_clock() - begin;
          }
        if (root)
          {
            std::ostringstream note;
            note << "step " << step_number << ", " << last_iterations << " iterations, "
                 << patch_grid->n_global_cells() << " cells, Courant number "
                 << std::setprecision(2) << courant_number;
            progress.update(current_time, note.str());
          }

        const CheckpointSchedule::Decision decision =
          schedule.decide(step_number, communicator);
        if (decision.write)
          {
            const double begin = wall_clock();
            write_checkpoint();
            const double seconds = wall_clock() - begin;
            schedule.written(seconds);
            statistics_clock += seconds;
            if (root)
              {
                progress.interrupt();
                std::cout << "Checkpoint " << last_checkpoint
                          << " at t = " << current_time << " s: " << std::setprecision(3)
                          << checkpoints->last_size() * 1e-6 << " MB in " << seconds
                          << " s" << std::setprecision(6) << std::endl;
              }
          }
        if (decision.stop && !finished())
          {
            statistics->flush();
            if (root)
              std::cout << "The run stops at t = " << current_time << " s, after step "
                        << step_number << ", " << decision.reason
                        << "; run it again to go on." << std::endl;
            return false;
          }
      }
    statistics->flush();
    if (root)
      progress.finish();
    if (root && n_regrids > 0)
      std::cout << "The grid has been rebuilt " << n_regrids << " times." << std::endl;
    if (root && n_repeated > 0)
      std::cout << n_repeated << " steps were too long and repeated at half their length."
                << std::endl;
    return true;
  }


  template class Simulation<2>;
  template class Simulation<3>;
} // namespace mitre::simulation
