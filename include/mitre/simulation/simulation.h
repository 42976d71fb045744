#ifndef mitre_simulation_simulation_h
#define mitre_simulation_simulation_h

#include <deal.II/base/parameter_handler.h>

#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <mitre/coupling/fe_coupling.h>
#include <mitre/coupling/refinement.h>
#include <mitre/fluid/navier_stokes.h>
#include <mitre/instruments/instruments.h>
#include <mitre/io/checkpoint.h>
#include <mitre/io/output.h>
#include <mitre/io/safe_file.h>
#include <mitre/io/statistics_file.h>
#include <mitre/simulation/checkpoint_schedule.h>
#include <mitre/simulation/pressure_control.h>
#include <mitre/simulation/refinement.h>
#include <mitre/simulation/validation.h>
#include <mitre/structure/body.h>
#include <mitre/structure/stable_time_step.h>
#include <mitre/structure/surface_tractions.h>
#include <mitre/structure/tie.h>

namespace mitre::simulation
{
  /**
   * A run: an immersed structure of any number of parts in a fluid, from a parameter file
   * to the last time step.
   *
   * One step is the midpoint scheme (2.14)-(2.19) of the thesis: parts are moved to the
   * middle of the step with the velocity at its beginning, their forces there are spread
   * to the fluid, the fluid is advanced, and the parts are moved over the whole step with
   * the mean of the old and the new velocity, interpolated at the middle positions. The
   * first step is (2.20)-(2.24).
   */
  template <int dim>
  class Simulation
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    /**
     * The text of a parameter file with one boundary condition, constitutive law,
     * constraint and instrument of each kind, named like it: what the parameter reference
     * is made from.
     */
    static std::string example_of_all_plugins();

    /**
     * Reads the parameters and the meshes and builds the grid, or reads the checkpoint to
     * go on from; nothing is written yet. Throws base::UserError for anything that cannot
     * work.
     *
     * @param resume what to do instead of what the parameter "Resume" says: "auto",
     * "never", or the folder of a checkpoint or a run; empty: what the parameter says
     */
    Simulation(dealii::ParameterHandler &prm,
               const std::string &parameter_file,
               const MPI_Comm communicator,
               const std::string &resume = "");

    ~Simulation();

    /// What the run will consist of: parts, materials, sizes, levels, steps.
    void print_summary(std::ostream &out) const;

    /**
     * Looks at parts, grid and boundary conditions for what cannot work or is seldom
     * meant, and writes to @p out what it has understood. Quick, and changes nothing.
     * Collective; what rank 0 finds and writes counts.
     */
    Findings check(std::ostream &out) const;

    /**
     * check(), the longest stable steps of explicit forces, whether the output folder can
     * be written, and two steps on trial, which tell time and memory; nothing is written.
     * Warnings go to @p out and are returned. After this the object is of no further use.
     * Collective. Throws base::UserError with all errors.
     */
    std::vector<std::string> validate(std::ostream &out);

    /**
     * Runs from the start, or from the checkpoint, to the end time. Returns false if the
     * run has been asked to stop before (see CheckpointSchedule), for which it has left a
     * checkpoint.
     */
    bool run();

    /// One time step, without any output. With a "Courant number" to aim at, the step
    /// gets the length that this asks for, and is repeated at half of it if it exceeds
    /// the largest allowed one.
    void advance();

    double time() const
    {
      return current_time;
    }

    const fluid::NavierStokes<dim> &flow() const
    {
      return *fluid;
    }

  private:
    struct Part
    {
      std::unique_ptr<structure::Body<dim>> body;
      coupling::CouplingParameters coupling_parameters;
      bool spacing_is_warned_of = false;

      /// Where forces are split; otherwise null.
      std::unique_ptr<structure::SurfaceTractions<dim>> tractions;

      /// Positions at the beginning and in the middle of the step [cm], velocity [cm/s]
      /// and force density [dyn/cm^dim].
      structure::VectorType X, X_half, U, F;

      /// Rigid parts: where the nodes would be at both times had they moved with the
      /// fluid, at which positions the constraints pull. Otherwise empty.
      structure::VectorType pulled, pulled_half;

      /// The positions from which forces follow.
      structure::VectorType &force_positions()
      {
        return body->is_rigid() ? pulled : X;
      }

      const structure::VectorType &force_positions() const
      {
        return body->is_rigid() ? pulled : X;
      }
    };

    /// A tie, and the numbers of its parts.
    struct TiedParts
    {
      structure::Tie<dim> tie;
      unsigned int part = 0, host = 0;
    };

    /// What a step changes: to go back to when it fails.
    struct StepState
    {
      typename fluid::NavierStokes<dim>::State fluid;
      std::vector<structure::VectorType> X, U, pulled, elastic_force_density;
      double time_step             = 0.;
      double courant_number        = 0.;
      unsigned int last_iterations = 0;
      unsigned int n_repeated      = 0;

      /// Whether it belongs to the grid as it is.
      bool valid = false;
    };

    // in checkpoints.cc
    void open_checkpoint(const std::string &mode);
    void list_files_beside_vertex_files();
    void check_parameters() const;
    void restore_positions();
    void restore_grid();
    void restore_state();
    std::vector<io::CheckpointField>
    checkpoint_fields(typename fluid::NavierStokes<dim>::State &state) const;
    void write_checkpoint(const bool remove_older = true);
    void save_step();
    void restore_step_fields();
    std::string rescue();
    bool all_ranks_are_here() const;

    // in diagnosis.cc
    /// Where the flow is fastest and which node is nearest, for messages: "the flow is
    /// fastest, ...". Collective.
    std::string describe_fastest_flow() const;

    /// The stable step of a part at rest, whose nodes move with the fluid about them and
    /// whose materials are as stiff as at time @p t [s].
    structure::StableTimeStep estimate_stable_step(const unsigned int part,
                                                   const double t);

    bool run_to_end();
    void start();
    void prepare_output();
    void read_parts(dealii::ParameterHandler &prm);
    void read_ties(dealii::ParameterHandler &prm);

    /// Takes the transmission forces of a part's surface at positions @p X out of its
    /// force density and appends them to @p extra.
    void split_forces(const unsigned int part,
                      const structure::VectorType &X,
                      const double t,
                      std::vector<coupling::PointForces<dim>> &extra);

    /// Adds the forces of ties to the force densities of the parts; @p middle as in
    /// spread_forces().
    void add_tie_forces(const bool middle);
    std::function<int(const dealii::BoundingBox<dim> &)> wanted_levels();
    bool regrid();
    double next_time_step() const;
    void step(const double dt);

    /// What boundary conditions prescribe at @p t, for interpolation next to them.
    void set_kernel_boundary_values(const double t);

    /// Adds the column of each part to @p values, and warns once of too wide a spacing.
    void measure_point_spacing(std::vector<double> &values);
    void check_courant_number() const;
    void distribute_parts(const std::vector<std::vector<unsigned int>> &node_owners = {});
    void setup_coupling();
    double largest_displacement_since_regrid() const;
    void spread_forces(const bool middle, const double t);
    void measure(const unsigned int iterations, const double wall_time);
    void write_fields();
    std::vector<std::string> statistics_columns() const;
    instruments::Observation<dim> observation();

    const MPI_Comm communicator;
    const bool root;
    const std::string parameter_file;

    std::string output_folder;
    CheckpointSchedule schedule;
    std::unique_ptr<io::CheckpointStore> checkpoints;

    /// The checkpoint that the run goes on from, until it has been read.
    std::unique_ptr<io::CheckpointReader> resumed;
    bool is_resumed = false;

    /// Whether it lies in the output folder, whose files are then continued.
    bool continues_output = false;

    /// The frames of the collections that are continued.
    typename io::OutputWriter<dim>::Frames frames_to_continue;

    /// The last checkpoint's folder and step.
    std::string last_checkpoint;
    long last_checkpoint_step = -1;

    /// Of all parameters (root).
    std::map<std::string, std::string> parameter_values, parameter_defaults;

    double start_time = 0., end_time, output_interval;
    double largest_time_step, smallest_time_step;

    /// The step and the time after which all fixed steps have had one length [s].
    std::pair<unsigned int, double> counted_from{0, 0.};
    unsigned int statistics_interval;
    double wanted_courant_number, maximum_courant_number;

    fluid::FluidParameters fluid_parameters;
    fluid::BoundaryConditions<dim> boundary_conditions;
    std::vector<base::Expression<dim>> initial_velocity;

    std::unique_ptr<grid::PatchGrid<dim>> patch_grid;
    Refinement<dim> refinement;
    std::vector<Part> parts;
    std::vector<TiedParts> ties;
    std::unique_ptr<fluid::NavierStokes<dim>> fluid;
    std::unique_ptr<coupling::FECoupling<dim>> fe_coupling;
    std::unique_ptr<grid::VelocityHalo<dim>> kernel_halo;
    std::shared_ptr<coupling::RefinementMap<dim>> refinement_map;
    instruments::Instruments<dim> instruments;
    PressureControl<dim> pressure_control;

    /// Of the output folder (root).
    std::unique_ptr<io::FolderLock> folder_lock;

    std::unique_ptr<io::OutputWriter<dim>> output;
    std::unique_ptr<io::StatisticsFile> statistics;

    double current_time          = 0.;
    unsigned int step_number     = 0;
    unsigned int last_iterations = 0;
    unsigned int n_regrids       = 0;
    double courant_number        = 0.;
    double time_step             = 0.; ///< of the last step
    double last_measured         = 0.; ///< time of the last line of statistics
    unsigned int n_repeated      = 0;  ///< steps that were too long
    unsigned int n_outputs       = 0;  ///< of fields

    /// Since the last line of statistics: largest number of iterations, steps, and wall
    /// time at its end [s].
    unsigned int iterations_since = 0, steps_since = 0;
    double statistics_clock = 0.;

    StepState before_step;

    /// For messages.
    enum class Stage
    {
      preparation,
      step,
      between_steps
    };
    Stage stage = Stage::preparation;

    /// Wall time of the longest step of this program so far [s].
    double longest_step = 0.;

    /// For all_ranks_are_here().
    MPI_Comm rescue_communicator = MPI_COMM_NULL;
    grid::VectorType grid_force, middle_velocity;

    /// Node positions of each part when the grid was last built, in the order of its
    /// mesh.
    std::vector<std::vector<double>> positions_at_regrid;
  };
} // namespace mitre::simulation

#endif
