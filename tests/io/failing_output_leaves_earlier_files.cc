// When no file may grow beyond 4 KiB any more, as on a full disk, frames cannot be
// written: the error names the file, and the frames, the collections and the table from
// before are as they were, without remains of the failed ones. A folder that cannot be
// made is an error too, and so is a part with the fluid's name.

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sys/resource.h>

#include <mitre/base/exceptions.h>
#include <mitre/io/output.h>
#include <mitre/io/statistics_file.h>

#include "../structure/structure_tests.h"
#include "io_tests.h"
#include "vtu_file.h"

using namespace io_tests;

void
expect_error(const std::string &what, const std::function<void()> &action)
{
  // Nothing is printed while files must not grow, for the output may be one.
  std::string message = "FAILED: no error";
  struct rlimit limit;
  getrlimit(RLIMIT_FSIZE, &limit);
  const struct rlimit before = limit;
  limit.rlim_cur             = 4096;
  setrlimit(RLIMIT_FSIZE, &limit);
  try
    {
      action();
    }
  catch (const base::UserError &error)
    {
      message = error.what();
    }
  setrlimit(RLIMIT_FSIZE, &before);
  std::cout << what << ": " << message << std::endl;
}

std::map<std::string, std::string>
read_all(const std::string &folder)
{
  std::map<std::string, std::string> files;
  for (const auto &entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().string()] = vtu::read_text(entry.path().string());
  return files;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::signal(SIGXFSZ, SIG_IGN);
  std::filesystem::remove_all("run");

  const Case<2> flow;
  structure::BodyParameters<2> parameters = structure_tests::make_parameters<2>();
  const structure::FiniteElementBody<2> body(
    parameters,
    structure_tests::make_box<2>(structure::ElementShape::simplex, 20),
    MPI_COMM_WORLD);
  structure::VectorType X;
  body.initialize_vector(X);
  body.set_to_reference_positions(X);

  io::OutputWriter<2> writer("run", MPI_COMM_WORLD);
  writer.write_fluid(*flow.space, flow.u, flow.p, 0.);
  writer.write_part(body, X, X, 0.);
  io::StatisticsFile statistics(
    "run/statistics.csv", {"time [s]", "flow [mL/s]"}, MPI_COMM_WORLD);
  for (unsigned int i = 0; i < 500; ++i)
    statistics.write({0.001 * i, 100.});
  statistics.flush();
  const auto before = read_all("run");

  expect_error("fluid", [&]() { writer.write_fluid(*flow.space, flow.u, flow.p, 0.1); });
  expect_error("part", [&]() { writer.write_part(body, X, X, 0.1); });
  expect_error("table", [&]() {
    for (unsigned int i = 500; i < 600; ++i)
      statistics.write({0.001 * i, 100.});
  });
  std::cout << before.size() << " files "
            << (read_all("run") == before ? "are as before" : "FAILED: have changed")
            << std::endl;

  // There is room again: the frames are numbered as if nothing had happened.
  writer.write_fluid(*flow.space, flow.u, flow.p, 0.2);
  writer.write_part(body, X, X, 0.2);
  for (const std::string name : {"fluid", "box"})
    {
      const std::string text = vtu::read_text("run/output/" + name + ".pvd");
      for (unsigned int i = 0; i < vtu::attributes(text, "file").size(); ++i)
        std::cout << vtu::attributes(text, "timestep")[i] << ' '
                  << vtu::attributes(text, "file")[i] << std::endl;
    }

  expect_error("folder", []() {
    io::OutputWriter<2> nowhere("run/statistics.csv/run", MPI_COMM_WORLD);
  });
  expect_error("folder", []() {
    io::StatisticsFile nowhere(
      "run/output/fluid.pvd/s.csv", {"time [s]"}, MPI_COMM_WORLD);
  });
  parameters.name = "fluid";
  const structure::FiniteElementBody<2> fluid(
    parameters,
    structure_tests::make_box<2>(structure::ElementShape::simplex, 4),
    MPI_COMM_WORLD);
  body.initialize_vector(X);
  expect_error("name", [&]() { writer.write_part(fluid, X, X, 0.); });
}
