#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>

#include <mitre/simulation/checkpoint_schedule.h>

namespace mitre::simulation
{
  using namespace dealii;

  namespace
  {
    volatile std::sig_atomic_t checkpoint_requested = 0;
    volatile std::sig_atomic_t stop_signal          = 0;
    volatile std::sig_atomic_t time_of_stop         = 0; // [s]

    /// Batch systems send a signal to all processes, and mpirun hands its own one on to
    /// the ranks: what comes so soon after the first [s] is the same wish.
    constexpr std::sig_atomic_t same_wish = 2;

    extern "C" void handle_signal(const int signal)
    {
      if (signal == SIGUSR1)
        {
          checkpoint_requested = 1;
          return;
        }
      struct timespec now;
      clock_gettime(CLOCK_MONOTONIC, &now);
      if (stop_signal == 0)
        {
          time_of_stop = now.tv_sec;
          stop_signal  = signal;
        }
      else if (signal != SIGUSR2 && now.tv_sec - time_of_stop >= same_wish)
        {
          // asked twice: without further ado
          std::signal(signal, SIG_DFL);
          std::raise(signal);
        }
    }


    /// Between the end of the run and the limit of its wall time [s].
    constexpr double smallest_margin = 10.;


    double wall_clock()
    {
      return std::chrono::duration<double>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
    }
  } // namespace


  void CheckpointSchedule::declare_parameters(ParameterHandler &prm)
  {
    prm.declare_entry("Steps between checkpoints",
                      "0",
                      Patterns::Integer(0),
                      "A checkpoint is written when the number of the step is a multiple "
                      "of this; 0: steps do not count.");
    prm.declare_entry("Minutes between checkpoints",
                      "10",
                      Patterns::Double(0.),
                      "A checkpoint is written when so much wall time [min] has passed "
                      "since the last one; 0: time does not count.");
    prm.declare_entry("Number kept",
                      "2",
                      Patterns::Integer(1, 1000000),
                      "Of the complete checkpoints, so many of the last ones are kept.");
    prm.declare_entry(
      "Wall time limit",
      "0",
      Patterns::Double(0.),
      "The run writes a checkpoint and stops, with exit status 75, before "
      "so much wall time [min] has passed since its start, as batch "
      "systems demand; 0: no limit.");
  }


  void CheckpointSchedule::parse_parameters(ParameterHandler &prm)
  {
    step_period = prm.get_integer("Steps between checkpoints");
    wall_period = 60. * prm.get_double("Minutes between checkpoints");
    kept        = prm.get_integer("Number kept");
    wall_limit  = 60. * prm.get_double("Wall time limit");
  }


  void CheckpointSchedule::start_clock()
  {
    program_start = wall_clock();
  }


  void CheckpointSchedule::begin()
  {
    struct sigaction action;
    std::memset(&action, 0, sizeof(action));
    action.sa_handler = handle_signal;
    action.sa_flags   = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (const int signal : {SIGUSR1, SIGUSR2, SIGTERM, SIGINT})
      sigaction(signal, &action, nullptr);
    last_checkpoint = last_decision = wall_clock();
  }


  CheckpointSchedule::Decision CheckpointSchedule::decide(const unsigned int step,
                                                          const MPI_Comm communicator)
  {
    const double now = wall_clock();
    longest_step     = std::max(longest_step, now - last_decision);
    last_decision    = now;

    // Clocks differ; that of the first rank counts.
    const bool root           = Utilities::MPI::this_mpi_process(communicator) == 0;
    std::array<int, 4> wishes = {{0, 0, 0, 0}};
    if (checkpoint_requested != 0)
      {
        checkpoint_requested = 0;
        wishes[0]            = 1;
      }
    wishes[1] = stop_signal;
    if (root && wall_period > 0. && now - last_checkpoint >= wall_period)
      wishes[2] = 1;
    // Two steps and two checkpoints more must fit; the time of the first checkpoint is
    // not known, and programs take a while to start and to end.
    const double margin =
      2. * longest_step +
      std::max({2. * longest_write, 0.02 * wall_limit, smallest_margin});
    if (root && wall_limit > 0. && now - program_start + margin >= wall_limit)
      wishes[3] = 1;
    Utilities::MPI::max(ArrayView<const int>(wishes.data(), wishes.size()),
                        communicator,
                        ArrayView<int>(wishes.data(), wishes.size()));

    Decision decision;
    decision.stop  = wishes[1] != 0 || wishes[3] != 0;
    decision.write = decision.stop || wishes[0] != 0 || wishes[2] != 0 ||
                     (step_period > 0 && step % step_period == 0);
    if (wishes[1] != 0)
      decision.reason = "on signal " + std::to_string(wishes[1]) + " (" +
                        std::string(strsignal(wishes[1])) + ")";
    else if (wishes[3] != 0)
      decision.reason = "before \"Checkpoints / Wall time limit\"";
    return decision;
  }


  void CheckpointSchedule::written(const double seconds)
  {
    longest_write   = std::max(longest_write, seconds);
    last_checkpoint = last_decision = wall_clock();
  }
} // namespace mitre::simulation
