#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sys/file.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <mitre/base/exceptions.h>
#include <mitre/io/safe_file.h>

namespace mitre::io
{
  namespace fs = std::filesystem;

  namespace
  {
    std::string folder_of(const std::string &name)
    {
      const std::string parent = fs::path(name).parent_path().string();
      return parent.empty() ? "." : parent;
    }
  } // namespace


  void write_file(const std::string &file_name,
                  const std::function<void(std::ostream &)> &write,
                  const bool outlives_power_failure)
  {
    const std::string temporary = file_name + ".tmp";
    errno                       = 0;
    std::ofstream file(temporary, std::ios::binary);
    try
      {
        if (file)
          write(file);
      }
    catch (const dealii::StandardExceptions::ExcIO &)
      {
        file.setstate(std::ios::badbit);
      }
    file.flush();
    int error_number = file ? 0 : errno;
    // Some file systems say only now that there was no room.
    file.close();
    if (error_number == 0 && !file)
      error_number = errno;
    const bool good = file.good();

    std::error_code error;
    try
      {
        if (good && outlives_power_failure)
          synchronise(temporary);
      }
    catch (const base::UserError &)
      {
        fs::remove(temporary, error);
        throw;
      }
    if (good)
      {
        fs::rename(temporary, file_name, error);
        error_number = error.value();
      }
    if (!good || error)
      {
        fs::remove(temporary, error);
        throw base::UserError(describe_write_error(file_name, error_number));
      }
    if (outlives_power_failure)
      synchronise(folder_of(file_name));
  }


  void synchronise(const std::string &name)
  {
    const int descriptor = ::open(name.c_str(), O_RDONLY | O_CLOEXEC);
    const bool good      = descriptor >= 0 && ::fsync(descriptor) == 0;
    const int error      = errno;
    if (descriptor >= 0)
      ::close(descriptor);
    // Some file systems cannot do so with folders.
    if (!good && error != EINVAL)
      throw base::UserError(describe_write_error(name, error));
  }


  void make_folder(const std::string &folder)
  {
    // The folders that will hold a new name.
    std::error_code error;
    std::vector<std::string> changed;
    fs::path missing = fs::path(folder).lexically_normal();
    if (!missing.has_filename())
      missing = missing.parent_path();
    for (; !missing.empty() && !fs::exists(missing, error);
         missing = missing.parent_path())
      changed.push_back(folder_of(missing.string()));

    fs::create_directories(folder, error);
    if (error || !fs::is_directory(folder))
      throw base::UserError("Cannot make the folder " + folder + ": " +
                            (error ? error.message() : "there is a file of that name") +
                            ".");
    for (const std::string &name : changed)
      try
        {
          synchronise(name);
        }
      catch (const base::UserError &)
        {
          // A folder of others, which may be written to but not read.
        }
  }


  FolderLock::FolderLock(const std::string &folder)
  {
    const std::string name = folder + "/lock";
    descriptor             = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0)
      throw base::UserError(describe_write_error(name, errno));
    bool locked = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    // Ranks of a run that has just been killed may take a while to end.
    for (unsigned int i = 0; i < 30 && !locked && errno == EWOULDBLOCK; ++i)
      {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        locked = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
      }
    if (!locked)
      {
        if (errno != EWOULDBLOCK)
          return;
        std::array<char, 256> text;
        const ssize_t size = ::read(descriptor, text.data(), text.size());
        ::close(descriptor);
        std::string owner(text.data(), std::max<ssize_t>(size, 0));
        owner = owner.substr(0, owner.find('\n'));
        throw base::UserError("Another run is writing to the folder " + folder +
                              (owner.empty() ? "" : ": " + owner) +
                              ". Wait for its end, end it, or choose another "
                              "\"Output folder\".");
      }

    // Only for the message, so that a full disk is no error.
    std::array<char, 256> host = {};
    ::gethostname(host.data(), host.size() - 1);
    const std::string owner =
      "process " + std::to_string(::getpid()) + " on " + host.data() + "\n";
    if (::ftruncate(descriptor, 0) == 0 &&
        ::write(descriptor, owner.data(), owner.size()) < 0)
      errno = 0;
  }


  FolderLock::~FolderLock()
  {
    ::close(descriptor);
  }


  std::string describe_write_error(const std::string &file_name, const int error_number)
  {
    return "Cannot write " + file_name + ": " +
           (error_number == 0 ? "the system gives no reason"
                              : std::strerror(error_number)) +
           ".";
  }


  void call_together(const MPI_Comm communicator, const std::function<void()> &action)
  {
    std::string message;
    try
      {
        action();
      }
    catch (const base::UserError &error)
      {
        message = error.what();
      }
    if (dealii::Utilities::MPI::logical_or(!message.empty(), communicator))
      for (const std::string &text :
           dealii::Utilities::MPI::all_gather(communicator, message))
        AssertThrow(text.empty(), base::UserError(text));
  }
} // namespace mitre::io
