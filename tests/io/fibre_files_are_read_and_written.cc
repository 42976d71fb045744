// Files of fibres in IBAMR's format: comments, optional columns, what a writer has
// written reads as the same to the last bit; and each mistake ends in an error that names
// the file and the line.

#include <filesystem>
#include <iostream>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/io/fibre_files.h>

using namespace mitre;

namespace
{
  enum class File : unsigned char
  {
    vertex,
    spring,
    beam,
    target
  };


  template <int dim>
  void
  read(const File file, const std::string &text, structure::FibreNetwork<dim> &network)
  {
    std::istringstream in(text);
    switch (file)
      {
        case File::vertex:
          return io::read_vertices(in, "a.vertex", network);
        case File::spring:
          return io::read_springs(in, "a.spring", network);
        case File::beam:
          return io::read_beams(in, "a.beam", network);
        case File::target:
          return io::read_targets(in, "a.target", network);
      }
  }


  template <int dim>
  void print(const structure::FibreNetwork<dim> &network)
  {
    for (const auto &x : network.nodes)
      std::cout << "node " << x << '\n';
    for (const auto &s : network.springs)
      {
        std::cout << "spring " << s.nodes[0] << ' ' << s.nodes[1] << ", " << s.stiffness
                  << ", " << s.rest_length << ", " << s.force_function << " ("
                  << s.parameters.size() << " values) in line " << s.line << '\n';
      }
    for (const auto &b : network.beams)
      std::cout << "beam " << b.nodes[0] << ' ' << b.nodes[1] << ' ' << b.nodes[2] << ", "
                << b.stiffness << ", " << b.curvature << '\n';
    for (const auto &t : network.targets)
      std::cout << "target " << t.node << ", " << t.stiffness << ", " << t.damping
                << '\n';
  }


  template <int dim>
  void check_mistake(const File file, const std::string &text)
  {
    structure::FibreNetwork<dim> network;
    network.nodes.resize(4);
    try
      {
        read(file, text, network);
        std::cout << "no error" << std::endl;
      }
    catch (const base::UserError &error)
      {
        std::cout << error.what() << std::endl;
      }
  }
} // namespace


int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  structure::FibreNetwork<3> network;
  read(
    File::vertex,
    "4 # number of vertices\n0 0 0\n\t1.5 0 1e-3 % second\r\n! nothing\n\n1 1 0\n0 1 0",
    network);
  read(File::spring,
       "4\n0 1 10\n1 2 20.5 0.75 ! rest length\n2 3 30 0 0\n3 0 40 1 2 0.5 7 # values\n",
       network);
  read(File::beam, "2\n0 1 2 5\n1 2 3 6 0.1 -0.2 0.3\n", network);
  read(File::target, "2\n3 1e3\n0 2e3 10\n", network);
  print(network);

  // Numbers that no short text stands for.
  network.nodes[1][0]           = 1. / 3;
  network.springs[1].stiffness  = 0.1 + 0.2;
  network.beams[1].curvature[2] = 2. / 3;
  io::write_fibres(network, "round_trip");
  const structure::FibreNetwork<3> again =
    io::read_fibres<3>("round_trip.vertex", MPI_COMM_WORLD);
  bool same = again.nodes == network.nodes;
  same      = same && again.springs.size() == 4 && again.beams.size() == 2 &&
         again.targets.size() == 2;
  for (unsigned int i = 0; same && i < 4; ++i)
    same = again.springs[i].nodes == network.springs[i].nodes &&
           again.springs[i].stiffness == network.springs[i].stiffness &&
           again.springs[i].rest_length == network.springs[i].rest_length &&
           again.springs[i].force_function == network.springs[i].force_function &&
           again.springs[i].parameters == network.springs[i].parameters;
  for (unsigned int i = 0; same && i < 2; ++i)
    same = again.beams[i].nodes == network.beams[i].nodes &&
           again.beams[i].stiffness == network.beams[i].stiffness &&
           again.beams[i].curvature == network.beams[i].curvature &&
           again.targets[i].node == network.targets[i].node &&
           again.targets[i].stiffness == network.targets[i].stiffness &&
           again.targets[i].damping == network.targets[i].damping;
  std::cout << "written and read: " << (same ? "the same" : "DIFFERENT") << std::endl;

  // Files that a smaller network does not have are taken away.
  network.beams.clear();
  io::write_fibres(network, "round_trip");
  std::cout << "beams of a network without: "
            << (std::filesystem::exists("round_trip.beam") ? "LEFT" : "gone")
            << std::endl;

  check_mistake<2>(File::vertex, "");
  check_mistake<2>(File::vertex, "two\n");
  check_mistake<2>(File::vertex, "-2\n");
  check_mistake<2>(File::vertex, "0\n");
  check_mistake<2>(File::vertex, "2 3\n");
  check_mistake<2>(File::vertex, "2\n0 0\n");
  check_mistake<2>(File::vertex, "2\n0 0\n1 1\n2 2\n");
  check_mistake<2>(File::vertex, "2\n0 0\n1 1 1\n");
  check_mistake<3>(File::vertex, "2\n0 0 0\n1 1\n");
  check_mistake<2>(File::vertex, "1\n0 nan\n");
  check_mistake<2>(File::vertex, "99999999999\n0 0\n");
  check_mistake<2>(File::spring, "1\n0 4 1 1\n");
  check_mistake<2>(File::spring, "1\n0 -1 1 1\n");
  check_mistake<2>(File::spring, "1\n0 1.5 1 1\n");
  check_mistake<2>(File::spring, "1\n2 2 1 1\n");
  check_mistake<2>(File::spring, "2\n0 1 1 1\n\n# comment\n1 2 -1 1\n");
  check_mistake<2>(File::spring, "1\n0 1 1 -0.5\n");
  check_mistake<2>(File::spring, "1\n0 1\n");
  check_mistake<2>(File::spring, "1\n0 1 1 1 -3\n");
  check_mistake<2>(File::spring, "1\n0 1 1 1 0 x\n");
  check_mistake<2>(File::beam, "1\n0 1 0 1\n");
  check_mistake<2>(File::beam, "1\n0 1 7 1\n");
  check_mistake<2>(File::beam, "1\n0 1 2 -1\n");
  check_mistake<2>(File::beam, "1\n0 1 2 1 0.5\n");
  check_mistake<2>(File::beam, "1\n0 1 2 1 0.5 0.5 0.5\n");
  check_mistake<2>(File::target, "1\n4 1\n");
  check_mistake<2>(File::target, "1\n0 -1\n");
  check_mistake<2>(File::target, "1\n0 1 -1\n");
  check_mistake<2>(File::target, "2\n1 1\n1 2\n");
}
