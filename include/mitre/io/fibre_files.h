#ifndef mitre_io_fibre_files_h
#define mitre_io_fibre_files_h

#include <deal.II/base/mpi.h>

#include <istream>
#include <map>
#include <string>

#include <mitre/structure/fibre_network.h>

namespace mitre::io
{
  /**
   * Read fibres from files in the format of IBAMR (class IBStandardInitializer): the
   * nodes from @p vertex_file, NAME.vertex, and springs, beams and target points from
   * NAME.spring, NAME.beam and NAME.target, if these are there.
   *
   * Each file has the number of its entries in its first line, then one entry a line;
   * nodes are numbered from 0. What follows !, # or % in a line is a comment, and lines
   * without anything else are skipped (IBAMR has none).
   * | file    | an entry |
   * |---------|----------|
   * | .vertex | x y, in 3D x y z [cm] |
   * | .spring | i j kappa [l_0 [force function [values for the law ..]]], see
   * structure::Spring | | .beam   | i j k kappa [c_x c_y, in 3D c_z], see
   * structure::Beam; j is in the middle | | .target | i kappa [eta], see
   * structure::TargetPoint |
   *
   * Stiffnesses are those of the discrete forces: they are not divided by the distance of
   * nodes.
   *
   * The first rank reads and sends to the others. Collective. Throws base::UserError on
   * all ranks, which names file and line, for anything else than this: another number of
   * entries than announced, columns too few or too many, a node that is not there or is
   * named twice in an entry, negative stiffness, damping or length, a second target point
   * on a node; a file that is there but cannot be read.
   */
  template <int dim>
  structure::FibreNetwork<dim> read_fibres(const std::string &vertex_file,
                                           const MPI_Comm communicator);


  /// The files of springs, beams and target points that belong to a vertex file and are
  /// there, by their ending: ".spring" and so on. A link to nowhere is there, too.
  std::map<std::string, std::string> files_beside(const std::string &vertex_file);


  /// The single files; @p source is the file's name for messages. Springs, beams and
  /// target points are added to a @p network that has its nodes.
  template <int dim>
  void read_vertices(std::istream &in,
                     const std::string &source,
                     structure::FibreNetwork<dim> &network);
  template <int dim>
  void read_springs(std::istream &in,
                    const std::string &source,
                    structure::FibreNetwork<dim> &network);
  template <int dim>
  void read_beams(std::istream &in,
                  const std::string &source,
                  structure::FibreNetwork<dim> &network);
  template <int dim>
  void read_targets(std::istream &in,
                    const std::string &source,
                    structure::FibreNetwork<dim> &network);


  /**
   * Write the files that read_fibres() reads, with all digits: NAME.vertex, and those of
   * the others that have entries; files that would have none are removed. @p name is the
   * path without an ending. Throws base::UserError, which names the file.
   */
  template <int dim>
  void write_fibres(const structure::FibreNetwork<dim> &network, const std::string &name);
} // namespace mitre::io

#endif
