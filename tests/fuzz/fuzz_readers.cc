// Target for libFuzzer (scripts/fuzz): whatever the bytes, the readers of parameter
// files, tables, meshes, fibres and checkpoints must return or throw base::UserError,
// without undefined behaviour and without asking for much more memory than the input is
// long.
//
// The first byte chooses the reader: P parameter file, T time table, M mesh, N nodes of
// fibres, F springs, B beams, H target points, C manifest of a checkpoint, S its state, G
// its leaves. Checksums of checkpoints are put right, for without that no change would
// get past them.

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <unistd.h>
#include <zlib.h>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameter_values.h>
#include <mitre/base/parameters.h>
#include <mitre/base/time_table.h>
#include <mitre/io/checkpoint.h>
#include <mitre/io/fibre_files.h>
#include <mitre/io/mesh_reader.h>

namespace
{
  using namespace mitre;

  const std::string folder = "/dev/shm/mitre_fuzz_" + std::to_string(getpid());


  void write(const std::string &name, const std::string &text)
  {
    std::ofstream file(folder + "/" + name, std::ios::binary);
    file << text;
  }


  /// All kinds of entries that parameter files have.
  void declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Number", "1", dealii::Patterns::Double(0.));
    prm.declare_entry("Text", "", dealii::Patterns::Anything());
    base::declare_choice(prm, "Choice", "a", {"a", "b c"}, "");
    for (const std::string &name : base::declare_names(prm, "Parts", "", ""))
      {
        prm.enter_subsection("Part " + name);
        prm.declare_entry("Mesh file", "", base::InputFile());
        prm.declare_entry("Point", "0, 0", dealii::Patterns::Anything());
        prm.leave_subsection();
      }
  }


  void read_parameters(const std::string &text)
  {
    dealii::ParameterHandler prm;
    base::parse_parameter_text(prm, text, "text", declare);
    base::list_parameter_values(prm);
    for (const std::string &name : base::parse_names(prm.get("Parts")))
      {
        prm.enter_subsection("Part " + name);
        base::parse_point<2>(prm.get("Point"), "Point");
        prm.leave_subsection();
      }
  }


  void read_table(const std::string &text)
  {
    write("table.csv", text);
    for (const auto extension :
         {base::TimeTable::Extension::clamped, base::TimeTable::Extension::periodic})
      {
        const base::TimeTable table(folder + "/table.csv", extension);
        for (unsigned int c = 0; c < table.column_names().size(); ++c)
          for (const double t : {table.start_time(), -1., 0.3, 1e9})
            {
              table.value(c, t);
              table.derivative(c, t);
            }
      }
  }


  void read_mesh(const std::string &text)
  {
    for (const bool three : {true, false})
      try
        {
          std::istringstream in(text);
          if (three)
            io::read_msh<3>(in, "mesh");
          else
            io::read_msh<2>(in, "mesh");
        }
      catch (const base::UserError &)
        {
        }
  }


  template <int dim>
  void read_fibres(const char kind, const std::string &text)
  {
    structure::FibreNetwork<dim> network;
    network.nodes.resize(5);
    std::istringstream in(text);
    if (kind == 'N')
      io::read_vertices(in, "fibres.vertex", network);
    else if (kind == 'F')
      io::read_springs(in, "fibres.spring", network);
    else if (kind == 'B')
      io::read_beams(in, "fibres.beam", network);
    else
      io::read_targets(in, "fibres.target", network);
  }


  std::string hexadecimal(const unsigned long sum)
  {
    char text[16];
    std::snprintf(text, sizeof(text), "%08lx", sum);
    return text;
  }


  unsigned long sum_of(const std::string &text)
  {
    return crc32(0, reinterpret_cast<const Bytef *>(text.data()), text.size());
  }


  void read_checkpoint(const char kind, const std::string &text)
  {
    const std::string leaves(16, '\0');
    const std::string contents[4] = {"",
                                     kind == 'G' ? text : leaves,
                                     kind == 'S' ? text : "numbers 1 a\n12345678\n",
                                     "A = 1\n"};
    const char *const names[4]    = {
         "fields.0.bin", "grid.bin", "state.bin", "parameters.txt"};
    std::string files;
    for (unsigned int i = 0; i < 4; ++i)
      {
        write(names[i], contents[i]);
        files += std::string("file ") + names[i] + " " +
                 std::to_string(contents[i].size()) + " " +
                 hexadecimal(sum_of(contents[i])) + "\n";
      }
    std::string manifest = "Checkpoint\nformat 1\nstep 3\ntime 0.5 s\n"
                           "entries_per_patch 2\npatches_of_rank 1\n";
    if (kind == 'C')
      manifest = text + "\n";
    // A text without files of its own gets these.
    if (kind != 'C' || text.find("file ") == std::string::npos)
      manifest += files;
    write("manifest.txt", manifest + "checksum " + hexadecimal(sum_of(manifest)) + "\n");

    const io::CheckpointReader reader(folder, MPI_COMM_SELF);
    reader.leaf_owners();
    reader.state().get_number("a");
  }
} // namespace


extern "C" int
LLVMFuzzerInitialize(int *, char ***)
{
  int argc = 0;
  MPI_Init(&argc, nullptr);
  std::filesystem::create_directories(folder);
  std::atexit([]() {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    MPI_Finalize();
  });
  return 0;
}


extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *data, const std::size_t size)
{
  if (size == 0)
    return 0;
  const std::string text(reinterpret_cast<const char *>(data) + 1, size - 1);
  try
    {
      switch (data[0])
        {
          case 'P':
            read_parameters(text);
            break;
          case 'T':
            read_table(text);
            break;
          case 'M':
            read_mesh(text);
            break;
          case 'N':
          case 'F':
          case 'B':
          case 'H':
            try
              {
                read_fibres<3>(data[0], text);
              }
            catch (const base::UserError &)
              {
              }
            read_fibres<2>(data[0], text);
            break;
          case 'C':
          case 'S':
          case 'G':
            read_checkpoint(data[0], text);
            break;
          default:
            break;
        }
    }
  catch (const base::UserError &)
    {
    }
  catch (const std::exception &error)
    {
      std::fprintf(stderr, "Not a UserError: %s\n", error.what());
      std::abort();
    }
  return 0;
}
