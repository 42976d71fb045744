// A table has the header and one line a step, with ten digits. A run that continues at
// t = 0.3 keeps the lines until then (0.1 + 0.2 is a little more than 0.3 in binary
// numbers, and 0.3 is kept), and drops later ones and one that a kill has cut short.
// Other columns are an error, and leave the file as it was. A new table replaces an old
// one.

#include <deal.II/base/mpi.h>

#include <fstream>
#include <iostream>
#include <limits>

#include <mitre/base/exceptions.h>
#include <mitre/io/statistics_file.h>

#include "vtu_file.h"

using mitre::io::StatisticsFile;

const std::string file_name = "folder/statistics.csv";
const std::vector<std::string> columns{"time [s]", "flow [mL/s]", "iterations [1]"};

void
show(const std::string &what)
{
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::cout << what << "\n" << vtu::read_text(file_name);
  MPI_Barrier(MPI_COMM_WORLD);
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const bool first = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  {
    StatisticsFile file(file_name, columns, MPI_COMM_WORLD);
    file.write({0.1, 100. / 3., 7.});
    file.flush();
    show("one line");
    file.write({0.1 + 0.2, -1e-7, 12.});
    file.write({0.4, std::numeric_limits<double>::quiet_NaN(), 1.});
  }
  show("three lines");
  if (first)
    std::ofstream(file_name, std::ios::app) << "0.5,12";
  {
    StatisticsFile file(file_name, columns, MPI_COMM_WORLD, 0.3);
    file.write({0.35, 2., 3.});
  }
  show("continued");
  if (first)
    std::ofstream(file_name, std::ios::app) << "0.3";
  {
    StatisticsFile file(file_name, columns, MPI_COMM_WORLD, 1.);
  }
  show("line cut short");
  try
    {
      StatisticsFile file(
        file_name, {"time [s]", "pressure [mmHg]"}, MPI_COMM_WORLD, 0.3);
    }
  catch (const mitre::base::UserError &error)
    {
      show(error.what());
    }
  {
    StatisticsFile file(file_name, columns, MPI_COMM_WORLD);
  }
  show("anew");
}
