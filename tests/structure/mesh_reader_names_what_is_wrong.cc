// Each mistake in a mesh file ends in an error that names the file and the line or
// element.

#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/io/mesh_reader.h>

#include "structure_tests.h"

using namespace mitre;

template <int dim>
void
check(const std::string &text)
{
  try
    {
      std::istringstream in(text);
      io::read_msh<dim>(in, "a.msh");
      std::cout << "no error" << std::endl;
    }
  catch (const base::UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  const std::string format = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const std::string nodes  = "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n"
                             "$EndNodes\n";
  const auto elements      = [&](const std::string &list) {
    return format + nodes + "$Elements\n" + list + "$EndElements\n";
  };

  check<3>("hello");
  check<3>("$Nodes\n");
  check<3>("$MeshFormat\n2.2 1 8\n");
  check<3>("$MeshFormat\n3.0 0 8\n$EndMeshFormat\n");
  check<3>(format + "$Nodes\n2\n1 0 0 0\n2 1 zero 0\n$EndNodes\n");
  check<3>(format + "$Nodes\n2\n1 0 0 0\n1 1 0 0\n$EndNodes\n");
  check<3>(format + nodes);
  check<3>(elements("1\n1 4 2 1 1 1 2 3 9\n"));
  check<3>(elements("2\n1 4 2 1 1 1 2 3 4\n"));
  check<3>(elements("1\n7 4 2 1 1 1 3 2 4\n"));
  check<3>(elements("1\n1 4 2 1 1 1 2 3 3\n"));
  check<3>(elements("1\n1 2 2 1 1 1 2 3\n"));
  check<2>(elements("1\n1 4 2 1 1 1 2 3 4\n"));
  check<2>(elements("1\n1 2 2 1 1 1 2 4\n"));
  check<2>(elements("2\n1 2 2 1 1 1 2 3\n2 3 2 1 1 1 2 5 3\n"));
  check<2>(elements("1\n1 9 2 1 1 1 2 3 1 2 3\n"));
  check<3>(elements("1\n1 4 2 1 1 1 2 3 4\n") +
           "$ElementData\n1\n\"fibre\"\n1\n0.0\n3\n0\n3\n1\n2 1 0 0\n$EndElementData\n");
  check<3>(elements("1\n1 4 2 1 1 1 2 3 4\n") +
           "$ElementData\n1\n\"fibre\"\n1\n0.0\n3\n0\n1\n1\n1 1\n$EndElementData\n");
  try
    {
      io::read_mesh<3>("no such file.msh", MPI_COMM_WORLD);
    }
  catch (const base::UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
}
