#ifndef mitre_simulation_checkpoint_schedule_h
#define mitre_simulation_checkpoint_schedule_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <string>

namespace mitre::simulation
{
  /**
   * When a run writes checkpoints and when it stops before its end: every so many steps
   * and minutes, on signals, and before a limit of its wall time.
   *
   * SIGUSR1 asks for a checkpoint. SIGTERM, SIGINT and SIGUSR2 ask for one and for the
   * end of the run after it; another SIGTERM or SIGINT, two seconds later or more, ends
   * the process at once. Their handlers do nothing but set a flag, which decide() looks
   * at after a step.
   */
  class CheckpointSchedule
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);
    void parse_parameters(dealii::ParameterHandler &prm);

    /// Number of checkpoints that are kept.
    unsigned int n_kept() const
    {
      return kept;
    }

    /// Starts the clock of the wall time limit; when the program starts.
    void start_clock();

    /// Sets the handlers of the signals and starts the clock of the checkpoints.
    void begin();

    struct Decision
    {
      bool write = false;
      bool stop  = false;

      /// Why the run stops, for a message.
      std::string reason;
    };

    /// What to do after step @p step, the same on all ranks. Collective: one reduction of
    /// four integers.
    Decision decide(const unsigned int step, const MPI_Comm communicator);

    /// Says that a checkpoint has been written, and how long that took [s].
    void written(const double seconds);

  private:
    unsigned int kept        = 2;
    unsigned int step_period = 0;
    double wall_period       = 0.; ///< [s]
    double wall_limit        = 0.; ///< [s]

    double program_start   = 0.;
    double last_checkpoint = 0.;
    double last_decision   = 0.;
    double longest_step    = 0.; ///< [s]
    double longest_write   = 0.; ///< [s]
  };
} // namespace mitre::simulation

#endif
