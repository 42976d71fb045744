#ifndef mitre_io_statistics_file_h
#define mitre_io_statistics_file_h

#include <deal.II/base/mpi.h>

#include <chrono>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace mitre::io
{
  /**
   * A table that grows by a line a time step, in the form of comma-separated values: the
   * first line names the columns with their units, "time [s],flow [mL/s]". Rank 0 writes
   * it. Lines reach the disk within about a second, and all of them when the object is
   * destroyed.
   */
  class StatisticsFile
  {
  public:
    /**
     * Collective. Throws base::UserError on all ranks, which names the file, if it cannot
     * be written, or if it is to be continued and has other columns than @p columns.
     *
     * @param columns name and unit of each, without commas; the first one is time
     * @param continue_from if given, the file that is there is continued: its lines up to
     * this time stay, later ones and one that was cut short are dropped. Otherwise, or if
     * there is no file yet, it begins anew.
     */
    StatisticsFile(const std::string &file_name,
                   const std::vector<std::string> &columns,
                   const MPI_Comm communicator,
                   const std::optional<double> continue_from = {});

    StatisticsFile(const StatisticsFile &)            = delete;
    StatisticsFile &operator=(const StatisticsFile &) = delete;

    ~StatisticsFile();

    /**
     * Add a line; rank 0's values count. Collective. Throws base::UserError on all ranks
     * if earlier lines could not be written, for instance because the disk is full; the
     * file then ends with a complete line.
     */
    void write(const std::vector<double> &values);

    /// Write to disk what has not been written yet. Collective; throws as write() does.
    void flush();

  private:
    void start(const std::vector<std::string> &columns,
               const std::optional<double> continue_from);
    void append(const std::vector<double> &values);
    void write_pending();

    const std::string file_name;
    const MPI_Comm communicator;
    const bool writes;
    unsigned int n_columns;

    std::ofstream file;
    std::uintmax_t size = 0; ///< of the file's complete lines [bytes]
    std::string pending;
    unsigned int n_pending_lines = 0;
    std::chrono::steady_clock::time_point last_written;
  };
} // namespace mitre::io

#endif
