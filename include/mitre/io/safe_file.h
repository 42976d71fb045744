#ifndef mitre_io_safe_file_h
#define mitre_io_safe_file_h

#include <deal.II/base/mpi.h>

#include <functional>
#include <ostream>
#include <string>

namespace mitre::io
{
  /**
   * Write a file under a temporary name and give it its own one when it is complete, so
   * that whoever reads @p file_name finds the old file or all of the new one. Throws
   * base::UserError, with the file and the system's reason, if that does not succeed; a
   * file of that name is then as it was.
   *
   * @param outlives_power_failure whether the new file is handed to the disk before it
   * takes the place of the old one, so that one of the two is there even if the machine
   * stops
   */
  void write_file(const std::string &file_name,
                  const std::function<void(std::ostream &)> &write,
                  const bool outlives_power_failure = false);


  /// Hand a file, or the names in a folder, to the disk (fsync), so that they outlive a
  /// power failure. Throws base::UserError with the name and the system's reason.
  void synchronise(const std::string &name);


  /// Make a folder and those that it lies in, as far as they do not exist, and hand their
  /// names to the disk. Throws base::UserError, with the folder and the system's reason.
  void make_folder(const std::string &folder);


  /// "Cannot write FILE: No space left on device.", from the value of errno.
  std::string describe_write_error(const std::string &file_name, const int error_number);


  /**
   * Keeps other processes from using a folder in which a run writes: the file "lock" in
   * it is locked as long as the object lives. Where the file system knows no locks, it
   * does nothing.
   */
  class FolderLock
  {
  public:
    /// Throws base::UserError, which names the process that has the folder, if another
    /// has locked it, or if the file cannot be made.
    explicit FolderLock(const std::string &folder);

    FolderLock(const FolderLock &)            = delete;
    FolderLock &operator=(const FolderLock &) = delete;

    ~FolderLock();

  private:
    int descriptor;
  };


  /**
   * Call @p action, and throw base::UserError on all ranks if it does so on any: the
   * first message there is. Collective.
   */
  void call_together(const MPI_Comm communicator, const std::function<void()> &action);
} // namespace mitre::io

#endif
