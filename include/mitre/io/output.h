#ifndef mitre_io_output_h
#define mitre_io_output_h

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <mitre/grid/staggered_space.h>
#include <mitre/grid/types.h>
#include <mitre/structure/body.h>

namespace mitre::io
{
  /**
   * Writes the fields of a run for ParaView: in FOLDER/output, each frame of the fluid is
   * a file fluid_00012.pvtu that names one piece a rank, fluid_00012.0.vtu and so on, and
   * each frame of a part one file PART_00012.vtu. The collections fluid.pvd and PART.pvd
   * list the frames and their times.
   *
   * Data are binary, compressed with zlib. Every file gets its name only when it is
   * complete, and a collection is written after what it lists: a run that is killed at
   * any moment leaves collections that can be read.
   *
   * All functions are collective, and throw base::UserError on all ranks, which names the
   * file and the system's reason, if a file cannot be written.
   */
  template <int dim>
  class OutputWriter
  {
  public:
    /// Velocity component that is prescribed at a point of the boundary [cm/s].
    using PrescribedVelocity = std::function<double(const grid::BoundaryTerm<dim> &)>;

    /// @param folder of the run; it and FOLDER/output are made if they do not exist
    OutputWriter(const std::string &folder, const MPI_Comm communicator);

    /**
     * A frame of the fluid, with values in the corners of all cells: the fields velocity
     * [cm/s], the mean of the adjacent faces, "pressure [mmHg]", the mean of the adjacent
     * cells, and the refinement level of the patch.
     *
     * @param u velocity [cm/s] as a vector of @p space, consistent
     * @param p pressure [dyn/cm^2] by cell
     * @param prescribed gives the tangential velocity on walls; by default it is zero
     */
    void write_fluid(const grid::StaggeredSpace<dim> &space,
                     const grid::VectorType &u,
                     const grid::VectorType &p,
                     const double time,
                     const PrescribedVelocity &prescribed = {});

    /**
     * A frame of a part at its deformed place, with the fields displacement [cm] and
     * velocity [cm/s] of the nodes, and J (deformed over reference volume), material id
     * and those fields of stress and strain of the elements that the part names.
     *
     * Rank 0 writes all of it. Throws base::UserError if the part's name is not fit for a
     * file.
     *
     * @param X,U positions [cm] and velocities [cm/s] of the nodes
     */
    void write_part(const structure::Body<dim> &body,
                    const structure::VectorType &X,
                    const structure::VectorType &U,
                    const double time);

    /// Times and file names of the frames of each series.
    using Frames = std::map<std::string, std::vector<std::pair<double, std::string>>>;

    /// The frames that have been written, for checkpoints.
    const Frames &written_frames() const
    {
      return frames;
    }

    /// Go on after @p written: the collections list these frames and no others, and the
    /// next ones take the numbers after them. Collective.
    void continue_after(const Frames &written);

    /// Hand the files that this rank has written since the last call to the disk.
    /// Collective.
    void synchronise();

  private:
    /// "fluid_00012", the name of the next frame of a series.
    std::string next_frame(const std::string &series) const;

    /// Rank 0 writes the collection of a series.
    void write_collection(const std::string &series) const;

    /// Rank 0 adds a frame to a collection.
    void
    add_frame(const std::string &series, const double time, const std::string &file_name);

    const MPI_Comm communicator;
    const unsigned int rank;
    const std::string folder;

    Frames frames;
    mutable std::set<std::string> unsynchronised;
  };
} // namespace mitre::io

#endif
