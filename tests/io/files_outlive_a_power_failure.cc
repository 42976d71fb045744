// What a power failure leaves of a run is what has been handed to the disk (fsync): data
// of files, and names in folders. The system's functions are replaced here by ones that
// write down what is asked of them, or refuse it.
//
// - A checkpoint gets its name when all that it consists of is on the disk, and older
//   ones are removed when that name is. So are the names of all folders above it.
// - The frames and the table that it continues are on the disk before, with their names.
// - A table that is continued is replaced by one that is on the disk.
// - Refused fsync or fclose: a message, no remains, and the earlier checkpoint stays.
// - A folder in which one run writes is refused to a second one.

#include <cerrno>
#include <cstdio>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <mitre/base/exceptions.h>
#include <mitre/io/checkpoint.h>
#include <mitre/io/output.h>
#include <mitre/io/safe_file.h>
#include <mitre/io/statistics_file.h>

#include "io_tests.h"
#include "vtu_file.h"

namespace fs = std::filesystem;

namespace
{
  std::vector<std::string> complaints;
  std::string refused; // the end of a name

  // What the disk has: sizes of files and names in folders at their last fsync.
  std::map<std::string, std::uintmax_t> sizes;
  std::map<std::string, std::set<std::string>> names;

  std::string absolute(const std::string &name)
  {
    return fs::absolute(name).lexically_normal().string();
  }

  std::string name_of(const int descriptor)
  {
    std::error_code ignored;
    return fs::read_symlink("/proc/self/fd/" + std::to_string(descriptor), ignored)
      .string();
  }

  bool ends_with(const std::string &name, const std::string &ending)
  {
    return name.size() >= ending.size() &&
           name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
  }

  bool is_refused(const std::string &name)
  {
    return !refused.empty() && ends_with(name, refused);
  }

  std::set<std::string> entries(const std::string &folder)
  {
    std::set<std::string> result;
    for (const auto &entry : fs::directory_iterator(folder))
      result.insert(entry.path().filename().string());
    return result;
  }

  /// A file, or a folder and all that is in it.
  void must_be_on_disk(const std::string &name, const std::string &when)
  {
    if (fs::is_directory(name))
      {
        if (names[name] != entries(name))
          complaints.push_back("the names in " + name + " are not on the disk " + when);
        for (const std::string &entry : entries(name))
          must_be_on_disk(name + "/" + entry, when);
      }
    else if (sizes.count(name) == 0 || sizes[name] != fs::file_size(name))
      complaints.push_back(name + " is not on the disk " + when);
  }

  /// What has been synchronised under one name is known by another one.
  template <typename T>
  void move_entries(std::map<std::string, T> &map,
                    const std::string &from,
                    const std::string &to)
  {
    std::map<std::string, T> moved;
    for (const auto &[name, value] : map)
      if (name == from || name.rfind(from + "/", 0) == 0)
        moved[to + name.substr(from.size())] = value;
      else if (name != to && name.rfind(to + "/", 0) != 0)
        moved[name] = value;
    map.swap(moved);
  }
} // namespace


extern "C" int
fsync(int descriptor)
{
  const std::string name = name_of(descriptor);
  if (is_refused(name))
    {
      errno = EIO;
      return -1;
    }
  if (fs::is_directory(name))
    names[name] = entries(name);
  else
    sizes[name] = fs::file_size(name);
  return syscall(SYS_fsync, descriptor);
}


extern "C" int
fclose(FILE *file)
{
  using Function             = int (*)(FILE *);
  static const auto original = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "fclose"));
  const bool refuse          = !refused.empty() && is_refused(name_of(fileno(file)));
  const int status           = original(file);
  if (!refuse)
    return status;
  errno = EDQUOT;
  return EOF;
}


extern "C" int
rename(const char *from, const char *to)
{
  const std::string a = absolute(from), b = absolute(to);
  if (ends_with(a, "0.tmp") || ends_with(a, "statistics.csv.tmp"))
    must_be_on_disk(a, "when it gets its name");
  if (ends_with(b, ".removed"))
    must_be_on_disk(fs::path(b).parent_path().string(), "when an older one is removed");
  const int status = syscall(SYS_rename, from, to);
  if (status == 0)
    {
      move_entries(sizes, a, b);
      move_entries(names, a, b);
    }
  return status;
}


using namespace io_tests;

void
report(const std::string &what)
{
  std::cout << what << ": "
            << (complaints.empty() ? "in order" : "FAILED: " + complaints[0])
            << std::endl;
  complaints.clear();
}

template <typename Action>
void
refuse(const std::string &name, const Action &action)
{
  refused = name;
  std::string message;
  try
    {
      action();
      message = "FAILED: no error";
    }
  catch (const base::UserError &error)
    {
      message = error.what();
    }
  refused.clear();
  std::cout << "refused " << name << ": " << message << std::endl;
}

std::string
names_in(const std::string &folder)
{
  std::string text;
  for (const std::string &name : entries(folder))
    text += (text.empty() ? "" : " ") + name;
  return text;
}


int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  fs::remove_all("new");

  Case<2> flow;
  std::vector<grid::Leaf> leaves                = flow.patch_grid.owned_leaves();
  const std::vector<io::CheckpointField> fields = {
    {&flow.u, flow.space->n_dofs_per_patch()}};
  io::CheckpointState state;
  state.numbers["a"] = {1., 2.};

  // A run in a folder below one that is not there yet.
  const std::string run = "new/run";
  const auto checkpoint = [&](const io::CheckpointStore &store, const unsigned int step) {
    return store.write(step, step, state, {{"A", "1"}}, leaves, fields);
  };
  {
    io::OutputWriter<2> output(run, MPI_COMM_WORLD);
    io::StatisticsFile statistics(
      run + "/statistics.csv", {"time [s]", "flow [mL/s]"}, MPI_COMM_WORLD);
    output.write_fluid(*flow.space, flow.u, flow.p, 0.);
    statistics.write({0., 1.});
    statistics.flush();
    io::synchronise(run + "/statistics.csv");
    output.synchronise();
    must_be_on_disk(absolute(run + "/output"), "before the checkpoint");
    must_be_on_disk(absolute(run + "/statistics.csv"), "before the checkpoint");
    report("frames and table");

    const io::CheckpointStore store(run, 1, MPI_COMM_WORLD);
    checkpoint(store, 10);
    must_be_on_disk(absolute("new"), "after the checkpoint");
    if (names[fs::current_path().string()].count("new") == 0)
      complaints.push_back("the name of new is not on the disk");
    report("first checkpoint");
    checkpoint(store, 20);
    report("second checkpoint");
    std::cout << names_in(run + "/checkpoints") << std::endl;

    for (const std::string name : {"fields.0.bin", "manifest.txt", "00000030.tmp"})
      refuse(name, [&]() { checkpoint(store, 30); });
    std::cout << names_in(run + "/checkpoints") << std::endl;
    const auto frames = names_in(run + "/output");
    refuse("fluid_00001.0.vtu.tmp",
           [&]() { output.write_fluid(*flow.space, flow.u, flow.p, 1.); });
    std::cout << (names_in(run + "/output") == frames ? "no remains" : "FAILED: remains")
              << std::endl;
  }

  const auto go_on = [&]() {
    io::StatisticsFile(
      run + "/statistics.csv", {"time [s]", "flow [mL/s]"}, MPI_COMM_WORLD, 0.);
  };
  go_on();
  report("table that is continued");
  refuse("statistics.csv.tmp", go_on);
  std::cout << vtu::read_text(run + "/statistics.csv") << names_in(run) << std::endl;

  // Two runs in one folder; the second is another process.
  {
    const io::FolderLock lock(run);
    std::cout.flush();
    if (const pid_t child = fork(); child == 0)
      {
        std::string message = "FAILED: no error";
        try
          {
            const io::FolderLock second(run);
          }
        catch (const base::UserError &error)
          {
            message = error.what();
          }
        const auto process = message.find("process "), on = message.find(" on ");
        std::cout << message.substr(0, process)
                  << (message.substr(process, on - process) ==
                          "process " + std::to_string(getppid())
                        ? "the first process"
                        : "FAILED: another process")
                  << message.substr(message.find(". Wait")) << std::endl;
        _exit(0);
      }
    else
      waitpid(child, nullptr, 0);
  }
  const io::FolderLock lock(run);
  std::cout << "afterwards: locked" << std::endl;
}
