#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include <mitre/base/exceptions.h>
#include <mitre/io/safe_file.h>

namespace mitre::io
{
  namespace fs = std::filesystem;

  void write_file(const std::string &file_name,
                  const std::function<void(std::ostream &)> &write)
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
    const bool good  = file.good();
    file.close();

    std::error_code error;
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
    std::error_code error;
    fs::create_directories(folder, error);
    if (error || !fs::is_directory(folder))
      throw base::UserError("Cannot make the folder " + folder + ": " +
                            (error ? error.message() : "there is a file of that name") +
                            ".");
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
