// What a run writes to a checkpoint, and how it goes on from one.

#include <deal.II/base/mpi.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <thread>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameter_values.h>
#include <mitre/io/fibre_files.h>
#include <mitre/io/safe_file.h>
#include <mitre/simulation/simulation.h>

namespace mitre::simulation
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    /// Parameters that a run may change when it goes on: those that decide how long it
    /// runs and what it writes, and the step, as a shorter one may be what it needs.
    const std::set<std::string> free_parameters = {"Output folder",
                                                   "Resume",
                                                   "Checkpoints / ",
                                                   "Output / ",
                                                   "Time / End time",
                                                   "Time / Time step",
                                                   "Time / Smallest time step",
                                                   "Fluid / Solver / Residual history",
                                                   " / Comparison shape"};


    /// Ranks wait so long for each other after an error [s]: those that meet it too are
    /// some steps behind at most.
    double patience(const double longest_step)
    {
      return longest_step > 0. ? 3. + 5. * longest_step : 20.;
    }


    double wall_clock()
    {
      return std::chrono::duration<double>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
    }


    /// A yes or no that is the first rank's on all of them; files may be seen
    /// differently.
    bool ask_root(const MPI_Comm communicator, const bool answer)
    {
      return Utilities::MPI::broadcast(communicator, answer ? 1 : 0) == 1;
    }


    std::string join_lines(const std::vector<std::string> &lines)
    {
      std::string text;
      for (const std::string &line : lines)
        text += line + "\n";
      return text;
    }


    std::vector<std::string> split_lines(const std::string &text)
    {
      std::vector<std::string> lines;
      std::istringstream stream(text);
      for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
      return lines;
    }
  } // namespace


  template <int dim>
  void Simulation<dim>::open_checkpoint(const std::string &mode)
  {
    if (mode == "never")
      return;

    // Step 1: which there are.
    std::error_code ignored;
    std::vector<std::string> candidates;
    if (mode == "auto")
      {
        candidates = checkpoints->list();
        if (candidates.empty())
          return;
      }
    else if (ask_root(communicator, fs::exists(mode + "/manifest.txt", ignored)))
      candidates = {mode};
    else
      {
        candidates = io::CheckpointStore(mode, schedule.n_kept(), communicator).list();
        AssertThrow(!candidates.empty(),
                    base::UserError("Resume: there is no checkpoint in " + mode +
                                    "; expected were \"auto\", \"never\", or the folder "
                                    "of a checkpoint or of a run with checkpoints."));
      }

    // Step 2: the newest that is complete.
    std::string problems;
    for (const std::string &candidate : candidates)
      {
        try
          {
            resumed = std::make_unique<io::CheckpointReader>(candidate, communicator);
            break;
          }
        catch (const base::UserError &error)
          {
            problems += std::string("\n  ") + error.what();
            if (root)
              std::cerr << "mitre: warning: the checkpoint " << candidate
                        << " cannot be used: " << error.what()
                        << (candidate != candidates.back()
                              ? " The one before it is tried."
                              : "")
                        << std::endl;
          }
      }
    AssertThrow(resumed,
                base::UserError("No checkpoint can be used:" + problems +
                                "\nTo start from the beginning, use --resume=never."));

    // Step 3: whether it fits the run.
    io::call_together(communicator, [&]() {
      if (root)
        check_parameters();
    });
    is_resumed           = true;
    last_checkpoint      = resumed->folder();
    last_checkpoint_step = resumed->step();
    continues_output =
      ask_root(communicator,
               fs::equivalent(fs::canonical(resumed->folder(), ignored).parent_path(),
                              checkpoints->folder(),
                              ignored));
  }


  // A run depends on these as on the vertex file, which is a parameter. They have their
  // values by default, for checkpoints of programs that did not list them.
  template <int dim>
  void Simulation<dim>::list_files_beside_vertex_files()
  {
    const std::string ending = " / Vertex file";
    std::map<std::string, std::string> found;
    for (const auto &[name, value] : parameter_values)
      if (!value.empty() && name.size() > ending.size() &&
          name.compare(name.size() - ending.size(), ending.size(), ending) == 0)
        {
          for (const std::string kind : {".spring", ".beam", ".target"})
            found[name + " (" + kind + ")"] = "";
          for (const auto &[kind, file] :
               io::files_beside(value.substr(0, value.rfind(", contents "))))
            found[name + " (" + kind + ")"] = base::describe_contents(file);
        }
    parameter_values.insert(found.begin(), found.end());
    parameter_defaults.insert(found.begin(), found.end());
  }


  template <int dim>
  void Simulation<dim>::check_parameters() const
  {
    const std::string changed = base::describe_changed_parameters(
      resumed->parameters(), parameter_values, free_parameters, parameter_defaults);
    if (changed.empty())
      return;
    std::string text;
    for (const std::string &line : split_lines(changed))
      text += "\n  " + line;
    throw base::UserError(
      "Cannot resume from " + resumed->folder() + ", for " + parameter_file +
      " has other parameters than the run that wrote it:" + text +
      "\nSet them back, or start from the beginning with --resume=never, which keeps the "
      "checkpoints under another name.");
  }


  template <int dim>
  void Simulation<dim>::restore_positions()
  {
    const io::CheckpointState &state = resumed->state();
    for (Part &part : parts)
      {
        const std::string prefix = "part " + part.body->name() + " ";
        const std::size_t n      = part.body->mesh().nodes.size() * dim;
        part.body->from_mesh_order(state.get(prefix + "positions [cm]", n), part.X);
        part.body->from_mesh_order(state.get(prefix + "velocities [cm/s]", n), part.U);
        if (part.body->is_rigid())
          part.body->from_mesh_order(state.get(prefix + "pulled positions [cm]", n),
                                     part.pulled);
      }
  }


  template <int dim>
  void Simulation<dim>::restore_grid()
  {
    const bool same_ranks =
      resumed->n_ranks() == Utilities::MPI::n_mpi_processes(communicator);
    wanted_levels(); // for the weights of the partition
    const bool same_partition = patch_grid->set_leaves(
      resumed->leaves(),
      same_ranks ? resumed->leaf_owners() : std::vector<unsigned int>());
    if (root && same_ranks && !same_partition)
      std::cout << "The grid is divided among the ranks in another way than before; "
                   "results will differ by round-off."
                << std::endl;
  }


  template <int dim>
  void Simulation<dim>::restore_state()
  {
    const io::CheckpointState &state = resumed->state();
    const auto integer               = [&](const std::string &name) {
      return static_cast<unsigned int>(state.get_number(name));
    };

    // Step 1: parts, with the nodes on the ranks where they were.
    std::vector<std::vector<unsigned int>> node_owners;
    if (resumed->n_ranks() == Utilities::MPI::n_mpi_processes(communicator))
      for (const Part &part : parts)
        {
          const std::vector<double> &owners = state.get(
            "part " + part.body->name() + " owners", part.body->mesh().nodes.size());
          node_owners.emplace_back(owners.begin(), owners.end());
        }
    distribute_parts(node_owners);
    positions_at_regrid.clear();
    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        structure::Body<dim> &body = *parts[i].body;
        const std::string prefix   = "part " + body.name() + " ";
        const std::size_t n        = body.mesh().nodes.size() * dim;
        structure::VectorType values;
        body.initialize_vector(values);
        body.from_mesh_order(state.get(prefix + "elastic force density [dyn/cm^dim]", n),
                             values);
        body.set_elastic_force_density(values);
        positions_at_regrid.push_back(state.get(prefix + "positions at regrid [cm]", n));
        const std::vector<double> &lookup =
          state.get(prefix + "positions at lookup [cm]");
        if (!lookup.empty())
          {
            body.from_mesh_order(lookup, values);
            fe_coupling->find_elements(i, values);
          }
      }

    // Step 2: the fluid.
    typename fluid::NavierStokes<dim>::State fluid_state;
    for (grid::VectorType *v :
         {&fluid_state.u, &fluid_state.u_old, &fluid_state.advection_old})
      fluid->operators().initialize_velocity(*v);
    for (grid::VectorType *v : {&fluid_state.p, &fluid_state.p_old})
      fluid->operators().initialize_pressure(*v);
    resumed->read_fields(patch_grid->owned_leaves(), checkpoint_fields(fluid_state));
    fluid_state.previous_dt          = state.get_number("fluid previous step [s]");
    fluid_state.has_history          = integer("fluid has history") != 0;
    fluid_state.n_steps_since_change = integer("fluid steps since change");
    fluid->restore(fluid_state);

    // Step 3: the run.
    current_time = state.get_number("time [s]");
    step_number  = integer("step");
    time_step    = state.get_number("time step [s]");
    if (state.numbers.count("counted from step") > 0) // not written at first
      counted_from = {integer("counted from step"),
                      state.get_number("counted from time [s]")};
    if (wanted_courant_number == 0. && time_step != largest_time_step)
      counted_from = {step_number, current_time};
    courant_number   = state.get_number("Courant number");
    last_iterations  = integer("iterations");
    last_measured    = state.get_number("time of statistics [s]");
    iterations_since = integer("iterations since statistics");
    steps_since      = integer("steps since statistics");
    statistics_clock = wall_clock() - state.get_number("wall time since statistics [s]");
    n_regrids        = integer("regrids");
    n_repeated       = integer("repeated steps");
    n_outputs        = integer("outputs");
    if (output_interval > 0. &&
        output_interval != state.get_number("output interval [s]"))
      n_outputs =
        std::floor((current_time - start_time) / output_interval * (1. + 1e-9)) + 1;

    std::vector<std::vector<double>> instrument_states(integer("instruments"));
    for (unsigned int i = 0; i < instrument_states.size(); ++i)
      instrument_states[i] = state.get("instrument " + std::to_string(i));
    instruments.set_state(instrument_states);
    if (pressure_control.is_active())
      pressure_control.set_state(state.get("pressure control [mmHg, dyn/cm^2]"));

    if (continues_output)
      {
        typename io::OutputWriter<dim>::Frames frames;
        for (const std::string &series : split_lines(state.get_text("series")))
          {
            const auto files = split_lines(state.get_text("frames " + series));
            const auto &times =
              state.get("times of frames " + series + " [s]", files.size());
            for (unsigned int i = 0; i < files.size(); ++i)
              frames[series].emplace_back(times[i], files[i]);
          }
        frames_to_continue = frames;
      }
    resumed.reset();
  }


  template <int dim>
  std::vector<io::CheckpointField> Simulation<dim>::checkpoint_fields(
    typename fluid::NavierStokes<dim>::State &state) const
  {
    const unsigned int velocities = fluid->space().n_dofs_per_patch();
    const unsigned int pressures =
      Utilities::fixed_power<dim>(patch_grid->n_cells_per_side());
    return {{&state.u, velocities},
            {&state.u_old, velocities},
            {&state.advection_old, velocities},
            {&state.p, pressures},
            {&state.p_old, pressures}};
  }


  template <int dim>
  void Simulation<dim>::write_checkpoint(const bool remove_older)
  {
    if (last_checkpoint_step == static_cast<long>(step_number))
      return;

    // Step 1: what has been written until now must be there when the run goes on.
    statistics->flush();
    io::call_together(communicator, [&]() {
      if (root)
        io::synchronise(output_folder + "/statistics.csv");
    });
    output->synchronise();

    // Step 2: the state.
    io::CheckpointState state;
    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        const Part &part                            = parts[i];
        const std::string prefix                    = "part " + part.body->name() + " ";
        state.numbers[prefix + "positions [cm]"]    = part.body->to_mesh_order(part.X);
        state.numbers[prefix + "velocities [cm/s]"] = part.body->to_mesh_order(part.U);
        if (part.body->is_rigid())
          state.numbers[prefix + "pulled positions [cm]"] =
            part.body->to_mesh_order(part.pulled);
        state.numbers[prefix + "elastic force density [dyn/cm^dim]"] =
          part.body->to_mesh_order(part.body->elastic_force_density());
        state.numbers[prefix + "positions at regrid [cm]"] = positions_at_regrid[i];
        const structure::VectorType *lookup = fe_coupling->lookup_positions(i);
        state.numbers[prefix + "positions at lookup [cm]"] =
          lookup == nullptr ? std::vector<double>() : part.body->to_mesh_order(*lookup);
        const std::vector<unsigned int> owners = part.body->node_owners();
        state.numbers[prefix + "owners"].assign(owners.begin(), owners.end());
      }

    typename fluid::NavierStokes<dim>::State fluid_state;
    fluid->save(fluid_state);
    const auto set = [&](const std::string &name, const double value) {
      state.numbers[name] = {value};
    };
    set("fluid previous step [s]", fluid_state.previous_dt);
    set("fluid has history", fluid_state.has_history ? 1. : 0.);
    set("fluid steps since change", fluid_state.n_steps_since_change);
    set("time [s]", current_time);
    set("step", step_number);
    set("time step [s]", time_step);
    set("counted from step", counted_from.first);
    set("counted from time [s]", counted_from.second);
    set("Courant number", courant_number);
    set("iterations", last_iterations);
    set("time of statistics [s]", last_measured);
    set("iterations since statistics", iterations_since);
    set("steps since statistics", steps_since);
    set("wall time since statistics [s]", wall_clock() - statistics_clock);
    set("regrids", n_regrids);
    set("repeated steps", n_repeated);
    set("outputs", n_outputs);
    set("output interval [s]", output_interval);

    const std::vector<std::vector<double>> instrument_states = instruments.state();
    set("instruments", instrument_states.size());
    for (unsigned int i = 0; i < instrument_states.size(); ++i)
      state.numbers["instrument " + std::to_string(i)] = instrument_states[i];

    if (pressure_control.is_active())
      state.numbers["pressure control [mmHg, dyn/cm^2]"] = pressure_control.state();

    std::string all_series;
    for (const auto &[series, frames] : output->written_frames())
      {
        all_series += series + "\n";
        std::vector<std::string> files;
        for (const auto &[time, file] : frames)
          {
            state.numbers["times of frames " + series + " [s]"].push_back(time);
            files.push_back(file);
          }
        state.texts["frames " + series] = join_lines(files);
      }
    state.texts["series"] = all_series;

    // Step 3: to the disk.
    last_checkpoint      = checkpoints->write(step_number,
                                         current_time,
                                         state,
                                         parameter_values,
                                         patch_grid->owned_leaves(),
                                         checkpoint_fields(fluid_state),
                                         remove_older);
    last_checkpoint_step = step_number;
  }


  template <int dim>
  void Simulation<dim>::save_step()
  {
    before_step.valid = false;
    fluid->save(before_step.fluid);
    before_step.X.resize(parts.size());
    before_step.U.resize(parts.size());
    before_step.pulled.resize(parts.size());
    before_step.elastic_force_density.resize(parts.size());
    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        before_step.X[i]                     = parts[i].X;
        before_step.U[i]                     = parts[i].U;
        before_step.pulled[i]                = parts[i].pulled;
        before_step.elastic_force_density[i] = parts[i].body->elastic_force_density();
      }
    before_step.time_step       = time_step;
    before_step.courant_number  = courant_number;
    before_step.last_iterations = last_iterations;
    before_step.n_repeated      = n_repeated;
    before_step.valid           = true;
  }


  template <int dim>
  void Simulation<dim>::restore_step_fields()
  {
    fluid->restore(before_step.fluid);
    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        parts[i].X      = before_step.X[i];
        parts[i].U      = before_step.U[i];
        parts[i].pulled = before_step.pulled[i];
        parts[i].body->set_elastic_force_density(before_step.elastic_force_density[i]);
      }
  }


  // An error is usually met by all ranks together. Where it is not, the others never come
  // here, and no collective function may be called.
  template <int dim>
  bool Simulation<dim>::all_ranks_are_here() const
  {
    MPI_Request request;
    MPI_Ibarrier(rescue_communicator, &request);
    const double begin = wall_clock();
    int done           = 0;
    while (true)
      {
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
        if (done != 0 || wall_clock() - begin > patience(longest_step))
          return done != 0;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
  }


  template <int dim>
  std::string Simulation<dim>::rescue()
  {
    if (!before_step.valid || !all_ranks_are_here())
      return "";
    restore_step_fields();
    time_step       = before_step.time_step;
    courant_number  = before_step.courant_number;
    last_iterations = before_step.last_iterations;
    n_repeated      = before_step.n_repeated;

    const std::string flow = "\nBefore this step " + describe_fastest_flow() + ".";
    std::ostringstream text;
    text << flow;
    try
      {
        // The step may fail because this state is bad already.
        write_checkpoint(false);
        text << "\nThe state before this step, at t = " << current_time
             << " s after step " << step_number << ", is in " << last_checkpoint << ".";
        const std::vector<std::string> all = checkpoints->list();
        if (all.size() > 1 && all[0] == last_checkpoint)
          text << " To go on from the one before it, use --resume=" << all[1] << ".";
      }
    catch (const std::exception &error)
      {
        text << "\nThe state before this step could not be saved: " << error.what();
      }
    return text.str();
  }


#define MITRE_INSTANTIATE(dim)                                                           \
  template void Simulation<dim>::open_checkpoint(const std::string &);                   \
  template void Simulation<dim>::list_files_beside_vertex_files();                       \
  template void Simulation<dim>::check_parameters() const;                               \
  template void Simulation<dim>::restore_positions();                                    \
  template void Simulation<dim>::restore_grid();                                         \
  template void Simulation<dim>::restore_state();                                        \
  template std::vector<io::CheckpointField> Simulation<dim>::checkpoint_fields(          \
    fluid::NavierStokes<dim>::State &) const;                                            \
  template void Simulation<dim>::write_checkpoint(const bool);                           \
  template void Simulation<dim>::save_step();                                            \
  template void Simulation<dim>::restore_step_fields();                                  \
  template bool Simulation<dim>::all_ranks_are_here() const;                             \
  template std::string Simulation<dim>::rescue();

  MITRE_INSTANTIATE(2)
  MITRE_INSTANTIATE(3)
#undef MITRE_INSTANTIATE
} // namespace mitre::simulation
