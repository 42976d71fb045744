#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <iostream>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameter_reference.h>
#include <mitre/base/parameters.h>
#include <mitre/simulation/simulation.h>

namespace
{
  using namespace mitre;

  const char *const usage =
    "usage: mitre [OPTION] RUN.prm\n"
    "\n"
    "Runs the fluid-structure simulation that the parameter file RUN.prm describes; in\n"
    "parallel as: mpirun -np N mitre RUN.prm\n"
    "\n"
    "  --resume[=WHAT]      WHAT is auto (or left out): go on from the newest "
    "checkpoint\n"
    "                       in the output folder, or start if there is none; never: "
    "start;\n"
    "                       or the folder of a checkpoint or a run. It has precedence "
    "over\n"
    "                       the parameter \"Resume\"\n"
    "  --validate           check the file and everything it names, say what was\n"
    "                       understood and what a step costs (two are taken on trial),\n"
    "                       and stop; nothing is written\n"
    "  --print-parameters   print all parameters with their defaults and explanations; "
    "if\n"
    "                       RUN.prm is given, those of its parts and conditions as well\n"
    "  --parameter-reference  print all parameters, with one part, condition and so on "
    "of\n"
    "                       each kind, as Markdown\n"
    "  --help               print this\n"
    "\n"
    "SIGUSR1 makes a run write a checkpoint; SIGTERM, SIGINT and SIGUSR2 make it write "
    "one\n"
    "and stop. Exit status: 0 if the run has reached its end, 75 if it has stopped "
    "before\n"
    "and left a checkpoint to go on from, 1 after an error.\n";

  /// EX_TEMPFAIL of sysexits.h: "temporary failure; user is invited to retry".
  constexpr int stopped_before_end = 75;

  enum class Mode
  {
    run,
    validate,
    print_parameters
  };

  unsigned int declare(dealii::ParameterHandler &prm)
  {
    const std::string dimension = base::declare_choice(
      prm, "Dimension", "3", {"2", "3"}, "Number of space dimensions of the run.");
    if (dimension == "2")
      simulation::Simulation<2>::declare_parameters(prm);
    else
      simulation::Simulation<3>::declare_parameters(prm);
    return dimension == "2" ? 2 : 3;
  }

  template <int dim>
  int execute(dealii::ParameterHandler &prm,
              const std::string &file,
              const Mode mode,
              const std::string &resume)
  {
    simulation::Simulation<dim> simulation(
      prm, file, MPI_COMM_WORLD, mode == Mode::validate ? "never" : resume);
    const bool root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    if (root)
      simulation.print_summary(std::cout);
    std::ostream out(root ? std::cout.rdbuf() : nullptr);
    if (mode == Mode::validate)
      {
        const std::size_t n = simulation.validate(out).size();
        out << file << " is valid"
            << (n == 0   ? ""
                : n == 1 ? ", with a warning"
                         : ", with " + std::to_string(n) + " warnings")
            << "." << std::endl;
        return 0;
      }
    std::ostream nowhere(nullptr);
    for (const std::string &warning : simulation.check(nowhere).warnings)
      out << "Warning: " << warning << std::endl;
    return simulation.run() ? 0 : stopped_before_end;
  }

  int run_program(const int argc, char **argv)
  {
    const bool root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    Mode mode       = Mode::run;
    std::string file, resume;
    for (int i = 1; i < argc; ++i)
      {
        const std::string argument = argv[i];
        if (argument == "--validate")
          mode = Mode::validate;
        else if (argument == "--resume")
          resume = "auto";
        else if (argument.rfind("--resume=", 0) == 0 && argument.size() > 9)
          resume = argument.substr(9);
        else if (argument == "--print-parameters")
          mode = Mode::print_parameters;
        else if (argument == "--parameter-reference")
          {
            dealii::ParameterHandler prm;
            base::parse_parameter_text(
              prm,
              simulation::Simulation<3>::example_of_all_plugins(),
              "all plugins",
              [](dealii::ParameterHandler &p) { declare(p); });
            if (root)
              base::write_parameter_reference(std::cout, prm, 3);
            return 0;
          }
        else if (argument == "--help" || argument == "-h")
          {
            if (root)
              std::cout << usage;
            return 0;
          }
        else if (argument.empty() || argument[0] == '-' || !file.empty())
          throw base::UserError("Argument \"" + argument + "\" is not understood.\n\n" +
                                usage);
        else
          file = argument;
      }

    dealii::ParameterHandler prm;
    if (mode == Mode::print_parameters)
      {
        if (file.empty())
          declare(prm);
        else
          base::parse_parameter_file(
            prm, file, [](dealii::ParameterHandler &p) { declare(p); });
        if (root)
          prm.print_parameters(std::cout, dealii::ParameterHandler::PRM);
        return 0;
      }
    if (file.empty())
      throw base::UserError(std::string("No parameter file is given.\n\n") + usage);

    base::parse_parameter_file(
      prm, file, [](dealii::ParameterHandler &p) { declare(p); });
    return prm.get("Dimension") == "2" ? execute<2>(prm, file, mode, resume)
                                       : execute<3>(prm, file, mode, resume);
  }
} // namespace


int
main(int argc, char **argv)
{
  // A file that must not grow is an error to report, as a full disk is.
  std::signal(SIGXFSZ, SIG_IGN);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int rank  = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  std::string message;
  try
    {
      return run_program(argc, argv);
    }
  catch (const std::bad_alloc &)
    {
      message = "There is not enough memory.";
    }
  catch (const std::exception &error)
    {
      message = error.what();
    }
  catch (...)
    {
      message = "Unknown error.";
    }

  // Usually all ranks fail alike; the first then speaks for all. If only others do, they
  // speak one after the other when the first has had its time, and MPI_Abort ends those
  // that wait.
  if (rank != 0)
    std::this_thread::sleep_for(
      std::chrono::milliseconds(2000 + 300 * std::min(rank - 1, 20u)));
  std::cout.flush();
  // in one piece, as mpirun puts its own messages between pieces
  std::cerr << "\nmitre: " + message + "\n" << std::flush;
  if (ranks > 1)
    MPI_Abort(MPI_COMM_WORLD, 1);
  return 1;
}
