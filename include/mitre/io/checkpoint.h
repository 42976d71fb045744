#ifndef mitre_io_checkpoint_h
#define mitre_io_checkpoint_h

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <mitre/grid/patch_grid.h>
#include <mitre/grid/types.h>

namespace mitre::io
{
  /**
   * What a checkpoint holds beside the fields of the grid: arrays of numbers and texts by
   * name. Rank 0's are written, and all ranks read the same.
   */
  struct CheckpointState
  {
    std::map<std::string, std::vector<double>> numbers;
    std::map<std::string, std::string> texts;

    /// The array or text @p name; throws base::UserError if there is none, or if an
    /// array does not have @p size entries (0: any number).
    const std::vector<double> &get(const std::string &name,
                                   const std::size_t size = 0) const;
    double get_number(const std::string &name) const;
    const std::string &get_text(const std::string &name) const;
  };


  /// A field on the patches of the grid: a vector whose owned entries are those of the
  /// owned patches, one after the other, the same number for each.
  struct CheckpointField
  {
    grid::VectorType *values;
    unsigned int entries_per_patch;
  };


  /**
   * A checkpoint on disk that has been opened: a folder with
   *
   *   manifest.txt   version of the format, step, time, number of ranks, and size and
   *                  CRC-32 of every other file and of itself
   *   parameters.txt the values of all parameters, one a line: "Time / End time = 1"
   *   state.bin      CheckpointState
   *   grid.bin       the leaves of the forest: level and position, rank by rank
   *   fields.R.bin   the fields of the patches that rank R had
   *
   * It can be read on any number of ranks. Numbers are binary, little-endian doubles and
   * 32-bit integers.
   */
  class CheckpointReader
  {
  public:
    /**
     * Opens the checkpoint in @p folder and checks all of its files against the manifest.
     * Collective. Throws base::UserError on all ranks, which names the file and what is
     * wrong with it.
     */
    CheckpointReader(const std::string &folder, const MPI_Comm communicator);

    const std::string &folder() const
    {
      return path;
    }

    std::uint64_t step() const
    {
      return step_number;
    }

    /// [s]
    double time() const
    {
      return time_;
    }

    /// Number of ranks that wrote it.
    unsigned int n_ranks() const
    {
      return owner_counts.size();
    }

    const CheckpointState &state() const
    {
      return state_;
    }

    /// Values of all parameters of the run that wrote it, by path.
    const std::map<std::string, std::string> &parameters() const
    {
      return parameters_;
    }

    const std::vector<grid::Leaf> &leaves() const
    {
      return leaves_;
    }

    /// The rank that had each leaf.
    std::vector<unsigned int> leaf_owners() const;

    /**
     * Reads the fields for the leaves that this rank owns now, in the order in which they
     * were written. Collective. Throws base::UserError on all ranks.
     */
    void read_fields(const std::vector<grid::Leaf> &owned_leaves,
                     const std::vector<CheckpointField> &fields) const;

  private:
    void read_manifest();
    void check_files() const;

    struct File
    {
      std::string name;
      std::uint64_t size;
      std::uint32_t sum;
    };

    const std::string path;
    const MPI_Comm communicator;
    std::uint64_t step_number = 0;
    double time_              = 0.;
    std::vector<File> files;
    CheckpointState state_;
    std::map<std::string, std::string> parameters_;
    std::vector<grid::Leaf> leaves_;
    std::vector<std::uint64_t> owner_counts;
    unsigned int entries_per_patch = 0;
  };


  /**
   * The checkpoints of a run, in the folders RUN/checkpoints/00000120 and so on, by the
   * number of the step. All functions are collective and throw base::UserError on all
   * ranks.
   */
  class CheckpointStore
  {
  public:
    /// @param n_kept how many checkpoints stay when a new one has been written
    CheckpointStore(const std::string &run_folder,
                    const unsigned int n_kept,
                    const MPI_Comm communicator);

    /**
     * Writes a checkpoint: into a folder of another name, which gets its own when all
     * files have been written, read again and handed to the disk, so that it is complete
     * or not there. Then older ones than the last are removed. If it does not succeed,
     * nothing of it remains, and the earlier ones are as they were. Returns its folder.
     *
     * @param fields must be finite; their owned entries are written
     * @param remove_older false: the older ones stay, as the new one may be of no use
     */
    std::string write(const std::uint64_t step,
                      const double time,
                      const CheckpointState &state,
                      const std::map<std::string, std::string> &parameters,
                      const std::vector<grid::Leaf> &owned_leaves,
                      const std::vector<CheckpointField> &fields,
                      const bool remove_older = true) const;

    /// The checkpoints that are there, the newest first, complete or not.
    std::vector<std::string> list() const;

    /// The newest checkpoint's folder, or nothing.
    std::string newest() const;

    /// Before a run goes on from @p step: later checkpoints get the ending ".unused".
    /// Returns their number.
    unsigned int set_later_ones_aside(const std::uint64_t step) const;

    /// Before a run begins anew: RUN/checkpoints becomes RUN/checkpoints.1 (.2, ...) if
    /// there are any. Returns the new name, or nothing.
    std::string set_all_aside() const;

    /// RUN/checkpoints
    const std::string &folder() const
    {
      return path;
    }

    /// Bytes of the last checkpoint.
    std::uint64_t last_size() const
    {
      return n_bytes;
    }

  private:
    const std::string path;
    const unsigned int n_kept;
    const MPI_Comm communicator;
    mutable std::uint64_t n_bytes = 0;
  };
} // namespace mitre::io

#endif
