#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <mitre/base/exceptions.h>
#include <mitre/io/checkpoint.h>
#include <mitre/io/safe_file.h>

namespace mitre::io
{
  namespace fs = std::filesystem;
  using base::UserError;

  namespace
  {
    constexpr unsigned int format_version = 1;
    const std::string manifest_name       = "manifest.txt";

    struct Sum
    {
      std::uint64_t size = 0;
      std::uint32_t crc  = 0;
    };

    void add_to_sum(Sum &sum, const void *data, const std::size_t n)
    {
      const auto *bytes = static_cast<const Bytef *>(data);
      for (std::size_t done = 0; done < n;)
        {
          const uInt piece = std::min<std::size_t>(n - done, 1u << 30);
          sum.crc          = crc32(sum.crc, bytes + done, piece);
          done += piece;
        }
      sum.size += n;
    }


    /// A file that is written from its beginning to its end, and is then on the disk.
    class NewFile
    {
    public:
      explicit NewFile(const std::string &name)
        : name(name)
        , descriptor(::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666))
      {
        check(descriptor >= 0);
      }

      NewFile(const NewFile &)            = delete;
      NewFile &operator=(const NewFile &) = delete;

      ~NewFile()
      {
        if (descriptor >= 0)
          ::close(descriptor);
      }

      void write(const void *data, const std::size_t n)
      {
        const char *bytes = static_cast<const char *>(data);
        for (std::size_t done = 0; done < n;)
          {
            const ssize_t written = ::write(
              descriptor, bytes + done, std::min<std::size_t>(n - done, 1u << 30));
            if (written < 0 && errno == EINTR)
              continue;
            check(written > 0);
            done += written;
          }
        add_to_sum(sum, data, n);
      }

      void write(const std::string &text)
      {
        write(text.data(), text.size());
      }

      Sum finish()
      {
        check(::fsync(descriptor) == 0);
        const int closed = ::close(descriptor);
        descriptor       = -1;
        check(closed == 0);
        return sum;
      }

    private:
      void check(const bool good) const
      {
        if (!good)
          throw UserError(describe_write_error(name, errno));
      }

      const std::string name;
      int descriptor;
      Sum sum;
    };


    Sum sum_of_file(const std::string &name)
    {
      std::ifstream file(name, std::ios::binary);
      if (!file)
        throw UserError("it cannot be opened");
      std::vector<char> buffer(1u << 20);
      Sum sum;
      while (file)
        {
          file.read(buffer.data(), buffer.size());
          add_to_sum(sum, buffer.data(), file.gcount());
        }
      if (file.bad())
        throw UserError("it cannot be read");
      return sum;
    }


    std::string hexadecimal(const std::uint32_t sum)
    {
      std::array<char, 16> text;
      std::snprintf(text.data(), text.size(), "%08x", sum);
      return text.data();
    }


    std::string exact(const double value)
    {
      std::array<char, 32> text;
      std::snprintf(text.data(), text.size(), "%.17g", value);
      return text.data();
    }


    std::string read_all(const std::string &name)
    {
      std::ifstream file(name, std::ios::binary);
      std::stringstream text;
      text << file.rdbuf();
      if (!file)
        throw UserError(name + " cannot be read.");
      return text.str();
    }


    std::string fields_name(const unsigned int rank)
    {
      return "fields." + std::to_string(rank) + ".bin";
    }


    std::string serialise(const CheckpointState &state)
    {
      std::string text;
      for (const auto &[name, values] : state.numbers)
        {
          text += "numbers " + std::to_string(values.size()) + " " + name + "\n";
          text.append(reinterpret_cast<const char *>(values.data()),
                      values.size() * sizeof(double));
          text += "\n";
        }
      for (const auto &[name, value] : state.texts)
        text += "text " + std::to_string(value.size()) + " " + name + "\n" + value + "\n";
      return text;
    }


    CheckpointState deserialise_state(const std::string &text, const std::string &file)
    {
      CheckpointState state;
      std::size_t at = 0;
      while (at < text.size())
        {
          const std::size_t end = text.find('\n', at);
          std::istringstream line(text.substr(at, end - at));
          std::string kind, name;
          std::size_t n = 0;
          line >> kind >> n;
          line.get();
          std::getline(line, name);
          at                 = end + 1;
          const bool is_text = kind == "text";
          // n first, for a damaged one times the size of a number may be small again.
          if (end == std::string::npos || (!is_text && kind != "numbers") ||
              n > text.size() - at || (!is_text && n * sizeof(double) > text.size() - at))
            throw UserError(file + " is not understood.");
          const std::size_t bytes = is_text ? n : n * sizeof(double);
          if (is_text)
            state.texts[name] = text.substr(at, n);
          else
            {
              state.numbers[name].resize(n);
              if (n > 0)
                std::memcpy(state.numbers[name].data(), text.data() + at, bytes);
            }
          at += bytes + 1;
        }
      return state;
    }


    /// The step of a folder's name, such as 00000120; false for other names.
    bool parse_step(const std::string &name, std::uint64_t &step)
    {
      if (name.size() < 8 || name.size() > 18 ||
          name.find_first_not_of("0123456789") != std::string::npos)
        return false;
      step = std::stoull(name);
      return true;
    }


    void remove_folder(const std::string &name)
    {
      std::error_code ignored;
      fs::remove_all(name, ignored);
    }


    void rename_folder(const std::string &from, const std::string &to)
    {
      std::error_code error;
      fs::rename(from, to, error);
      if (error)
        throw UserError("Cannot rename " + from + " to " + to + ": " + error.message() +
                        ".");
    }


    /// NAME.FIRST (NAME itself for 0), or with the next number that is not there yet.
    std::string free_name(const std::string &name, const unsigned int first)
    {
      std::error_code ignored;
      std::string result = first == 0 ? name : name + "." + std::to_string(first);
      for (unsigned int i = first + 1; fs::exists(result, ignored); ++i)
        result = name + "." + std::to_string(i);
      return result;
    }
  } // namespace


  const std::vector<double> &CheckpointState::get(const std::string &name,
                                                  const std::size_t size) const
  {
    const auto found = numbers.find(name);
    if (found == numbers.end())
      throw UserError("The checkpoint does not have \"" + name + "\".");
    if (size > 0 && found->second.size() != size)
      throw UserError("The checkpoint has " + std::to_string(found->second.size()) +
                      " numbers for \"" + name + "\", but the run needs " +
                      std::to_string(size) + ".");
    return found->second;
  }


  double CheckpointState::get_number(const std::string &name) const
  {
    return get(name, 1)[0];
  }


  const std::string &CheckpointState::get_text(const std::string &name) const
  {
    const auto found = texts.find(name);
    if (found == texts.end())
      throw UserError("The checkpoint does not have \"" + name + "\".");
    return found->second;
  }


  CheckpointReader::CheckpointReader(const std::string &folder,
                                     const MPI_Comm communicator)
    : path(folder)
    , communicator(communicator)
  {
    call_together(communicator, [&]() { read_manifest(); });
    call_together(communicator, [&]() { check_files(); });
    call_together(communicator, [&]() {
      const std::string all = read_all(path + "/parameters.txt");
      std::istringstream lines(all);
      for (std::string line; std::getline(lines, line);)
        {
          const std::size_t sign = line.find(" = ");
          parameters_[line.substr(0, sign)] =
            sign == std::string::npos ? "" : line.substr(sign + 3);
        }
      state_ = deserialise_state(read_all(path + "/state.bin"), path + "/state.bin");

      const std::string grid = read_all(path + "/grid.bin");
      std::uint64_t n_leaves = 0;
      bool too_many          = false; // so that the sum cannot overflow
      for (const std::uint64_t n : owner_counts)
        {
          too_many = too_many || n > grid.size();
          n_leaves += n;
        }
      if (too_many || grid.size() != n_leaves * 4 * sizeof(std::int32_t))
        throw UserError(path + "/grid.bin does not have the " + std::to_string(n_leaves) +
                        " leaves that the manifest tells of.");
      std::vector<std::int32_t> entries(n_leaves * 4);
      if (n_leaves > 0)
        std::memcpy(entries.data(), grid.data(), grid.size());
      for (std::uint64_t i = 0; i < n_leaves; ++i)
        leaves_.push_back(
          {entries[4 * i],
           {{entries[4 * i + 1], entries[4 * i + 2], entries[4 * i + 3]}}});
    });
  }


  void CheckpointReader::read_manifest()
  {
    const std::string name = path + "/" + manifest_name;
    std::error_code ignored;
    if (!fs::is_regular_file(name, ignored))
      throw UserError(path + " has no " + manifest_name + ", so it is no checkpoint.");
    const std::string text = read_all(name);

    // The last line is the sum of all before it.
    const std::string key  = "checksum ";
    const std::size_t last = text.rfind("\n" + key);
    Sum sum;
    if (last != std::string::npos)
      add_to_sum(sum, text.data(), last + 1);
    if (last == std::string::npos ||
        text.substr(last + 1) != key + hexadecimal(sum.crc) + "\n")
      throw UserError(name + " is damaged: its checksum is not that of its text.");

    std::istringstream lines(text.substr(0, last + 1));
    std::string word, line;
    while (lines >> word)
      {
        if (word == "format")
          {
            unsigned int version = 0;
            lines >> version;
            if (version != format_version)
              throw UserError(name + ": the format has version " +
                              std::to_string(version) + ", this program reads version " +
                              std::to_string(format_version) + ".");
          }
        else if (word == "step")
          lines >> step_number;
        else if (word == "time")
          lines >> time_;
        else if (word == "entries_per_patch")
          lines >> entries_per_patch;
        else if (word == "patches_of_rank")
          {
            owner_counts.emplace_back();
            lines >> owner_counts.back();
          }
        else if (word == "file")
          {
            File file;
            std::string crc;
            lines >> file.name >> file.size >> crc;
            file.sum = std::strtoul(crc.c_str(), nullptr, 16);
            files.push_back(file);
          }
        std::getline(lines, line);
      }
    if (owner_counts.empty() || files.size() != owner_counts.size() + 3)
      throw UserError(name + " is not complete.");
  }


  void CheckpointReader::check_files() const
  {
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);
    const unsigned int n    = dealii::Utilities::MPI::n_mpi_processes(communicator);
    for (std::size_t i = rank; i < files.size(); i += n)
      {
        const std::string name = path + "/" + files[i].name;
        try
          {
            const Sum sum = sum_of_file(name);
            if (sum.size != files[i].size)
              throw UserError("it has " + std::to_string(sum.size) +
                              " bytes instead of " + std::to_string(files[i].size));
            if (sum.crc != files[i].sum)
              throw UserError("its CRC-32 is " + hexadecimal(sum.crc) + " instead of " +
                              hexadecimal(files[i].sum));
          }
        catch (const UserError &error)
          {
            throw UserError(name + " is damaged: " + error.what() + ".");
          }
      }
  }


  std::vector<unsigned int> CheckpointReader::leaf_owners() const
  {
    std::vector<unsigned int> owners;
    for (unsigned int r = 0; r < owner_counts.size(); ++r)
      owners.insert(owners.end(), owner_counts[r], r);
    return owners;
  }


  void CheckpointReader::read_fields(const std::vector<grid::Leaf> &owned_leaves,
                                     const std::vector<CheckpointField> &fields) const
  {
    call_together(communicator, [&]() {
      unsigned int total = 0;
      for (const CheckpointField &field : fields)
        total += field.entries_per_patch;
      if (total != entries_per_patch)
        throw UserError(path + " has " + std::to_string(entries_per_patch) +
                        " numbers a patch, but the run needs " + std::to_string(total) +
                        ".");

      // Step 1: where each leaf is.
      struct Place
      {
        unsigned int rank;
        std::uint64_t position;
        std::size_t patch;
      };
      std::map<std::array<int, 4>, std::pair<unsigned int, std::uint64_t>> known;
      const auto key = [](const grid::Leaf &leaf) {
        return std::array<int, 4>{
          {leaf.level, leaf.index[0], leaf.index[1], leaf.index[2]}};
      };
      std::size_t number = 0;
      for (unsigned int r = 0; r < owner_counts.size(); ++r)
        for (std::uint64_t i = 0; i < owner_counts[r]; ++i)
          known[key(leaves_[number++])] = {r, i};
      std::vector<Place> places;
      for (std::size_t p = 0; p < owned_leaves.size(); ++p)
        {
          const auto found = known.find(key(owned_leaves[p]));
          AssertThrow(found != known.end(), dealii::ExcInternalError());
          places.push_back({found->second.first, found->second.second, p});
        }
      std::sort(places.begin(), places.end(), [](const Place &a, const Place &b) {
        return std::make_pair(a.rank, a.position) < std::make_pair(b.rank, b.position);
      });

      // Step 2: read, runs of consecutive leaves at once.
      for (std::size_t begin = 0; begin < places.size();)
        {
          const unsigned int r   = places[begin].rank;
          const std::string name = path + "/" + fields_name(r);
          std::ifstream file(name, std::ios::binary);
          std::size_t end_of_file = begin;
          while (end_of_file < places.size() && places[end_of_file].rank == r)
            ++end_of_file;
          std::uint64_t offset = 0;
          std::vector<double> buffer;
          for (const CheckpointField &field : fields)
            {
              const std::size_t size = field.entries_per_patch;
              for (std::size_t i = begin, j; i < end_of_file; i = j)
                {
                  j = i + 1;
                  while (j < end_of_file &&
                         places[j].position == places[i].position + (j - i))
                    ++j;
                  buffer.resize((j - i) * size);
                  file.seekg((offset + places[i].position * size) * sizeof(double));
                  file.read(reinterpret_cast<char *>(buffer.data()),
                            buffer.size() * sizeof(double));
                  if (!file)
                    throw UserError(name + " cannot be read.");
                  for (std::size_t k = i; k < j; ++k)
                    std::copy(buffer.begin() + (k - i) * size,
                              buffer.begin() + (k - i + 1) * size,
                              field.values->begin() + places[k].patch * size);
                }
              offset += owner_counts[r] * size;
            }
          begin = end_of_file;
        }
    });
  }


  CheckpointStore::CheckpointStore(const std::string &run_folder,
                                   const unsigned int n_kept,
                                   const MPI_Comm communicator)
    : path(run_folder + "/checkpoints")
    , n_kept(n_kept)
    , communicator(communicator)
  {
  }


  std::string CheckpointStore::write(const std::uint64_t step,
                                     const double time,
                                     const CheckpointState &state,
                                     const std::map<std::string, std::string> &parameters,
                                     const std::vector<grid::Leaf> &owned_leaves,
                                     const std::vector<CheckpointField> &fields,
                                     const bool remove_older) const
  {
    namespace MPI                  = dealii::Utilities::MPI;
    const unsigned int rank        = MPI::this_mpi_process(communicator);
    const bool root                = rank == 0;
    const std::string name         = dealii::Utilities::int_to_string(step, 8);
    const std::string final_folder = path + "/" + name;
    const std::string folder       = final_folder + ".tmp";

    // Step 1: nothing that cannot be continued.
    call_together(communicator, [&]() {
      for (const CheckpointField &field : fields)
        for (std::size_t i = 0; i < field.values->locally_owned_size(); ++i)
          if (!std::isfinite(field.values->local_element(i)))
            throw UserError("The flow has become infinite or undefined at time " +
                            exact(time) + " s, so that no checkpoint is written.");
      for (const auto &[array, values] : state.numbers)
        for (const double value : values)
          if (!std::isfinite(value))
            throw UserError("\"" + array +
                            "\" has become infinite or undefined at time " + exact(time) +
                            " s, so that no checkpoint is written.");
    });

    // Step 2: a folder without the remains of earlier attempts.
    call_together(communicator, [&]() {
      if (!root)
        return;
      make_folder(path);
      std::error_code ignored;
      for (const auto &entry : fs::directory_iterator(path, ignored))
        if (entry.path().extension() == ".tmp" || entry.path().extension() == ".removed")
          remove_folder(entry.path().string());
      make_folder(folder);
    });

    try
      {
        // Step 3: the files; what has been written is read again.
        const auto write_checked = [&](const std::string &file,
                                       const std::function<void(NewFile &)> &action) {
          Sum sum;
          {
            NewFile out(folder + "/" + file);
            action(out);
            sum = out.finish();
          }
          Sum found;
          try
            {
              found = sum_of_file(folder + "/" + file);
            }
          catch (const UserError &error)
            {
              throw UserError("Cannot check " + folder + "/" + file + ": " +
                              error.what() + ".");
            }
          if (found.size != sum.size || found.crc != sum.crc)
            throw UserError(folder + "/" + file +
                            " does not hold what has been written to it.");
          return sum;
        };

        Sum own;
        call_together(communicator, [&]() {
          own = write_checked(fields_name(rank), [&](NewFile &out) {
            for (const CheckpointField &field : fields)
              out.write(field.values->begin(),
                        field.values->locally_owned_size() * sizeof(double));
          });
        });

        std::vector<std::int32_t> own_leaves;
        for (const grid::Leaf &leaf : owned_leaves)
          {
            own_leaves.push_back(leaf.level);
            own_leaves.insert(own_leaves.end(), leaf.index.begin(), leaf.index.end());
          }
        const auto sums =
          MPI::gather(communicator, std::array<std::uint64_t, 2>{{own.size, own.crc}});
        const auto leaves              = MPI::gather(communicator, own_leaves);
        unsigned int entries_per_patch = 0;
        for (const CheckpointField &field : fields)
          entries_per_patch += field.entries_per_patch;

        call_together(communicator, [&]() {
          if (!root)
            return;
          std::vector<std::pair<std::string, Sum>> files;
          for (unsigned int r = 0; r < sums.size(); ++r)
            files.push_back(
              {fields_name(r), {sums[r][0], static_cast<std::uint32_t>(sums[r][1])}});
          files.emplace_back("grid.bin", write_checked("grid.bin", [&](NewFile &out) {
                               for (const auto &list : leaves)
                                 out.write(list.data(),
                                           list.size() * sizeof(std::int32_t));
                             }));
          files.emplace_back("state.bin", write_checked("state.bin", [&](NewFile &out) {
                               out.write(serialise(state));
                             }));
          files.emplace_back("parameters.txt",
                             write_checked("parameters.txt", [&](NewFile &out) {
                               for (const auto &[parameter, value] : parameters)
                                 out.write(parameter + " = " + value + "\n");
                             }));

          std::string text =
            "Checkpoint of a run of Mitre; see doc/checkpoints.md.\nformat " +
            std::to_string(format_version) + "\nstep " + std::to_string(step) +
            "\ntime " + exact(time) + " s\nentries_per_patch " +
            std::to_string(entries_per_patch) + "\n";
          for (const auto &list : leaves)
            text += "patches_of_rank " + std::to_string(list.size() / 4) + "\n";
          n_bytes = 0;
          for (const auto &[file, sum] : files)
            {
              text += "file " + file + " " + std::to_string(sum.size) + " " +
                      hexadecimal(sum.crc) + "\n";
              n_bytes += sum.size;
            }
          Sum sum;
          add_to_sum(sum, text.data(), text.size());
          text += "checksum " + hexadecimal(sum.crc) + "\n";
          n_bytes +=
            write_checked(manifest_name, [&](NewFile &out) { out.write(text); }).size;
          synchronise(folder);

          // Step 4: its own name.
          std::error_code ignored;
          if (fs::exists(final_folder, ignored))
            rename_folder(final_folder, free_name(final_folder + ".unused", 0));
          rename_folder(folder, final_folder);
          synchronise(path);
        });
      }
    catch (const UserError &)
      {
        if (root)
          remove_folder(folder);
        throw;
      }

    // Step 5: older ones, which first lose their names.
    const std::vector<std::string> all = list();
    if (root && remove_older)
      for (std::size_t i = n_kept; i < all.size(); ++i)
        {
          std::error_code error;
          fs::rename(all[i], all[i] + ".removed", error);
          if (!error)
            remove_folder(all[i] + ".removed");
        }
    MPI_Bcast(&n_bytes, 1, MPI_UINT64_T, 0, communicator);
    return final_folder;
  }


  std::vector<std::string> CheckpointStore::list() const
  {
    std::string names;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        std::vector<std::pair<std::uint64_t, std::string>> found;
        std::error_code error;
        for (const auto &entry : fs::directory_iterator(path, error))
          {
            std::uint64_t step = 0;
            std::error_code ignored;
            if (entry.is_directory(ignored) &&
                parse_step(entry.path().filename().string(), step))
              found.emplace_back(step, entry.path().string());
          }
        std::sort(found.rbegin(), found.rend());
        for (const auto &[step, name] : found)
          names += name + "\n";
      }
    names = dealii::Utilities::MPI::broadcast(communicator, names);
    std::vector<std::string> result;
    std::istringstream lines(names);
    for (std::string line; std::getline(lines, line);)
      result.push_back(line);
    return result;
  }


  std::string CheckpointStore::newest() const
  {
    const std::vector<std::string> all = list();
    return all.empty() ? "" : all.front();
  }


  unsigned int CheckpointStore::set_later_ones_aside(const std::uint64_t step) const
  {
    unsigned int n = 0;
    for (const std::string &name : list())
      {
        std::uint64_t later = 0;
        if (!parse_step(fs::path(name).filename().string(), later) || later <= step)
          continue;
        ++n;
        call_together(communicator, [&]() {
          if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
            rename_folder(name, free_name(name + ".unused", 0));
        });
      }
    return n;
  }


  std::string CheckpointStore::set_all_aside() const
  {
    if (list().empty())
      return "";
    std::string name;
    call_together(communicator, [&]() {
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        {
          name = free_name(path, 1);
          rename_folder(path, name);
        }
    });
    return dealii::Utilities::MPI::broadcast(communicator, name);
  }
} // namespace mitre::io
