// Faults put into a sound mesh, and wrong parameters. Turning one cell round makes one
// inverted cell. Cell 7 of the 48 in 2x2x2 cubes has one face on the surface: given
// twice, its three inner faces belong to three cells, and its outer one is taken for an
// inner one, so that the surface has a hole with three edges. Two cubes that share
// nothing but an edge have four surface triangles at that edge. Each wrong parameter is
// named in the error.

#include <fstream>
#include <iostream>

#include <mitre/base/exceptions.h>
#include <mitre/geometry/mitral_valve.h>
#include <mitre/geometry/msh_format.h>

using namespace mitre::geometry;

namespace
{
  TetMesh cubes(const unsigned int n, const double shift_y = 0, const double shift_z = 0)
  {
    BlockLayout layout;
    layout.n_cells     = {{n, n, n}};
    layout.material_id = [](unsigned int, unsigned int) { return 1; };
    return build_block(layout, [&](unsigned int i, unsigned int j, unsigned int k) {
      return Point3(double(i) / n, shift_y + double(j) / n, shift_z + double(k) / n);
    });
  }

  void report(const char *what, const TetMesh &mesh)
  {
    const MeshReport r = check_mesh(mesh);
    std::cout << what << ": inverted " << r.n_inverted << ", bad faces " << r.n_bad_faces
              << ", bad surface edges " << r.n_bad_surface_edges << ", sound "
              << (r.sound() ? "yes" : "no") << '\n';
  }

  void try_parameter(const char *section, const char *name, const char *value)
  {
    dealii::ParameterHandler prm;
    MitralValveParameters::declare_parameters(prm);
    prm.set("Output folder", "geometry_mistakes_are_found.meshes");
    if (*section)
      prm.enter_subsection(section);
    prm.set(name, value);
    if (*section)
      prm.leave_subsection();
    try
      {
        MitralValveParameters parameters;
        parameters.parse_parameters(prm);
        prepare_mitral_valve(parameters);
        std::cout << section << '/' << name << " = " << value << " was accepted\n";
      }
    catch (const mitre::base::UserError &error)
      {
        const std::string message = error.what();
        std::cout << (message.find(name) != std::string::npos ? "named: " : "not named: ")
                  << section << '/' << name << '\n';
      }
  }
} // namespace

int
main()
{
  TetMesh mesh = cubes(2);
  report("sound", mesh);
  std::swap(mesh.cells[7].vertices[0], mesh.cells[7].vertices[1]);
  report("one cell turned", mesh);
  mesh = cubes(2);
  mesh.cells.push_back(mesh.cells[7]);
  report("one cell twice", mesh);

  // Two cubes that touch along the edge y = z = 1: join the nodes of that edge.
  mesh = cubes(1);
  mesh.append(cubes(1, 1, 1));
  for (TetMesh::Cell &cell : mesh.cells)
    for (unsigned int &v : cell.vertices)
      for (unsigned int other = 0; other < v; ++other)
        if (mesh.vertices[v].distance(mesh.vertices[other]) < 1e-12)
          {
            v = other;
            break;
          }
  report("cubes that share an edge", mesh);

  try_parameter("Leaflets", "Thickness", "-0.1");
  try_parameter("Leaflets", "Anterior length", "2.1");
  try_parameter("Annulus", "Commissural diameter", "5.5");
  try_parameter("Start shape", "Orifice commissural width", "0.8");
  try_parameter("Chordae", "Anterior number", "5");
  try_parameter("Chordae", "Papillary distance", "6");
  try_parameter("Tube", "Wall thickness", "1.5");
  // A file stands where the folder should be.
  std::ofstream("geometry_mistakes_are_found.file") << "x";
  try_parameter("", "Output folder", "geometry_mistakes_are_found.file/meshes");

  std::ofstream("broken.msh") << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  try
    {
      read_msh("broken.msh");
      std::cout << "broken.msh was accepted\n";
    }
  catch (const mitre::base::UserError &error)
    {
      std::cout << error.what() << '\n';
    }
}
