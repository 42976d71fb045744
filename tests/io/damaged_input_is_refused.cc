// Meshes and checkpoints with numbers that no memory could hold, or that only seem right
// after an overflow, are refused with a message like any other damaged file. The
// checksums of the checkpoints are right.

#include <deal.II/base/mpi.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <vector>
#include <zlib.h>

#include <mitre/base/exceptions.h>
#include <mitre/io/checkpoint.h>
#include <mitre/io/mesh_reader.h>

using namespace mitre;

namespace
{
  unsigned long sum_of(const std::string &text)
  {
    return crc32(0, reinterpret_cast<const Bytef *>(text.data()), text.size());
  }


  std::string hexadecimal(const unsigned long sum)
  {
    char text[16];
    std::snprintf(text, sizeof(text), "%08lx", sum);
    return text;
  }


  template <typename Action>
  void report(const std::string &what, const Action &action)
  {
    std::cout << what << ": ";
    try
      {
        action();
        std::cout << "read" << std::endl;
      }
    catch (const base::UserError &error)
      {
        std::cout << error.what() << std::endl;
      }
    catch (const std::exception &error)
      {
        std::cout << "not a message for users: " << error.what() << std::endl;
      }
  }


  void mesh(const std::string &what, const std::string &sections)
  {
    report(what, [&]() {
      std::istringstream in("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + sections);
      io::read_msh<3>(in, "damaged.msh");
    });
  }


  void checkpoint(const std::string &what,
                  const std::string &patches,
                  const std::string &state,
                  const std::string &sum_of_state = "")
  {
    std::filesystem::create_directories("damaged");
    std::vector<std::pair<std::string, std::string>> contents = {
      {"fields.0.bin", ""},
      {"grid.bin", std::string(16, '\0')},
      {"state.bin", state},
      {"parameters.txt", "A = 1\n"}};
    if (patches.find("patches") != patches.rfind("patches"))
      contents.emplace_back("fields.1.bin", "");
    std::string manifest = "Checkpoint\nformat 1\nstep 3\ntime 0.5 s\n" + patches;
    for (const auto &[name, text] : contents)
      {
        std::ofstream("damaged/" + name, std::ios::binary) << text;
        manifest +=
          "file " + name + " " + std::to_string(text.size()) + " " +
          (name == "state.bin" && !sum_of_state.empty() ? sum_of_state
                                                        : hexadecimal(sum_of(text))) +
          "\n";
      }
    std::ofstream("damaged/manifest.txt")
      << manifest << "checksum " << hexadecimal(sum_of(manifest)) << "\n";
    report(what, [&]() {
      const io::CheckpointReader reader("damaged", MPI_COMM_SELF);
      std::cout << reader.leaf_owners().size() << " leaf, "
                << reader.state().get_number("a") << ", ";
    });
  }
} // namespace


int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  mesh("too many nodes in a block",
       "$Nodes\n1 1 1 1\n3 1 0 9000000000000000000\n1\n0 0 0\n$EndNodes\n");
  mesh("too many integers",
       "$ElementData\n1\n\"fibre\"\n1\n0\n9000000000000000000\n0\n3\n$EndElementData\n");
  mesh("an id beyond all numbers",
       "$Entities\n0 0 0 1\n1 0 0 0 1 1 1 1 1e30 0\n$EndEntities\n");
  mesh("bytes that are 0", std::string("$Nodes\n\0\n", 9));

  const std::string one = "patches_of_rank 1\n";
  const std::string number("numbers 1 a\n\0\0\0\0\0\0\xf0?\n", 21);
  checkpoint("a sound checkpoint", one, number);
  checkpoint("no numbers", one, "numbers 0 a\n\n");
  checkpoint("more numbers than memory", one, "numbers 2305843009213693952 a\n\n");
  checkpoint("more text than memory", one, "text 18446744073709551615 a\n\n");
  checkpoint("more patches than leaves",
             "patches_of_rank 18446744073709551615\npatches_of_rank 2\n",
             number);
  checkpoint("a checksum that is no number", one, number, "xyz");
  checkpoint("more digits than a number has", one, number, "fffffffffffffffffff");
}
