#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <mitre/base/exceptions.h>
#include <mitre/io/safe_file.h>
#include <mitre/io/statistics_file.h>

namespace mitre::io
{
  namespace
  {
    constexpr unsigned int most_pending_lines = 50;
    constexpr std::chrono::seconds longest_delay(1);
  } // namespace


  StatisticsFile::StatisticsFile(const std::string &file_name,
                                 const std::vector<std::string> &columns,
                                 const MPI_Comm communicator,
                                 const std::optional<double> continue_from)
    : file_name(file_name)
    , communicator(communicator)
    , writes(dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    , n_columns(columns.size())
  {
    call_together(communicator, [&]() {
      if (writes)
        start(columns, continue_from);
    });
  }


  StatisticsFile::~StatisticsFile()
  {
    try
      {
        if (writes)
          write_pending();
      }
    catch (const base::UserError &)
      {
        // Whoever wants to know calls flush().
      }
  }


  void StatisticsFile::start(const std::vector<std::string> &columns,
                             const std::optional<double> continue_from)
  {
    std::string header;
    for (const std::string &column : columns)
      {
        Assert(column.find_first_of(",\n") == std::string::npos,
               dealii::ExcMessage("Names of columns must not contain commas."));
        header += (header.empty() ? "" : ",") + column;
      }

    std::string text = header + "\n";
    if (continue_from)
      if (std::ifstream old(file_name, std::ios::binary); old)
        {
          std::string line;
          std::getline(old, line);
          AssertThrow(line == header,
                      base::UserError("Cannot continue " + file_name +
                                      ": it has the columns \"" + line +
                                      "\", but the run has \"" + header + "\"."));
          // The times have been rounded to ten digits. Of a line that was cut short,
          // getline() meets the end of the file.
          const double last = *continue_from + 1e-9 * std::abs(*continue_from);
          while (std::getline(old, line) && !old.eof() &&
                 std::strtod(line.c_str(), nullptr) <= last)
            text += line + "\n";
        }

    const std::string folder = std::filesystem::path(file_name).parent_path().string();
    if (!folder.empty())
      make_folder(folder);
    write_file(
      file_name, [&](std::ostream &out) { out << text; }, true);
    size  = text.size();
    errno = 0;
    file.open(file_name, std::ios::binary | std::ios::app);
    AssertThrow(file, base::UserError(describe_write_error(file_name, errno)));
    last_written = std::chrono::steady_clock::now();
  }


  void StatisticsFile::write(const std::vector<double> &values)
  {
    call_together(communicator, [&]() {
      if (writes)
        append(values);
    });
  }


  void StatisticsFile::flush()
  {
    call_together(communicator, [&]() {
      if (writes)
        write_pending();
    });
  }


  void StatisticsFile::append(const std::vector<double> &values)
  {
    AssertDimension(values.size(), n_columns);
    std::array<char, 32> number;
    for (unsigned int i = 0; i < values.size(); ++i)
      {
        std::snprintf(
          number.data(), number.size(), i == 0 ? "%.10g" : ",%.10g", values[i]);
        pending += number.data();
      }
    pending += "\n";
    ++n_pending_lines;
    if (n_pending_lines >= most_pending_lines ||
        std::chrono::steady_clock::now() - last_written >= longest_delay)
      write_pending();
  }


  void StatisticsFile::write_pending()
  {
    errno = 0;
    file << pending << std::flush;
    if (!file)
      {
        // A line may have been cut short.
        const int error_number = errno;
        file.close();
        std::error_code ignored;
        std::filesystem::resize_file(file_name, size, ignored);
        throw base::UserError(describe_write_error(file_name, error_number));
      }
    size += pending.size();
    pending.clear();
    n_pending_lines = 0;
    last_written    = std::chrono::steady_clock::now();
  }
} // namespace mitre::io
