// The default valve (the one for a grid of 0.25 cm) as a simulation gets it: written, and
// read back by deal.II's own reader. No element is inverted, every surface is closed
// (each of its edges belongs to two of its triangles), and its Euler characteristic is
// that of a ring (0) or of 16 separate chordae (16 * 2 = 32). deal.II must see the same
// number of cells, volume and materials; fibres are unit vectors in leaflets and chordae,
// and run around the tube's axis in the leaflets.

#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/tria.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <set>

#include <mitre/geometry/mitral_valve.h>
#include <mitre/geometry/msh_format.h>

using namespace mitre::geometry;

int
main()
{
  dealii::ParameterHandler prm;
  MitralValveParameters::declare_parameters(prm);
  prm.set("Output folder", "valve_meshes_are_sound.meshes");
  MitralValveParameters parameters;
  parameters.parse_parameters(prm);
  prepare_mitral_valve(parameters);

  for (const std::string name : {"leaflets", "chordae", "disc", "tube"})
    {
      const std::string file  = parameters.output_folder + "/" + name + ".msh";
      const TetMesh mesh      = read_msh(file);
      const MeshReport report = check_mesh(mesh);

      dealii::Triangulation<3> triangulation;
      dealii::GridIn<3> grid_in(triangulation);
      std::ifstream in(file);
      grid_in.read_msh(in);
      double volume = 0;
      std::set<int> ids;
      bool same_order = true;
      std::size_t i   = 0;
      for (const auto &cell : triangulation.active_cell_iterators())
        {
          volume += cell->measure();
          ids.insert(cell->material_id());
          same_order =
            same_order && int(cell->material_id()) == mesh.cells[i++].material_id;
        }

      std::cout << name << ": inverted " << report.n_inverted << ", bad faces "
                << report.n_bad_faces << ", open edges " << report.n_bad_surface_edges
                << ", unused nodes " << report.n_unused_vertices
                << ", Euler characteristic " << report.euler_characteristic << '\n'
                << "  quality above 0.1: " << (report.min_quality > 0.1 ? "yes" : "no")
                << "; deal.II reads all cells: "
                << (triangulation.n_active_cells() == report.total_cells() ? "yes" : "no")
                << ", in order: " << (same_order ? "yes" : "no") << ", volume: "
                << (std::abs(volume / report.total_volume() - 1) < 1e-10 ? "same"
                                                                         : "differs")
                << ", materials:";
      for (const int id : ids)
        std::cout << ' ' << id;
      std::cout << '\n';

      if (name == "leaflets")
        {
          const Annulus annulus(parameters);
          unsigned int n = 0;
          double least   = 1;
          for (const TetMesh::Cell &cell : mesh.cells)
            for (const unsigned int v : cell.vertices)
              {
                const Point3 &x = mesh.vertices[v];
                const double a = std::atan2((x[2] - 4) / parameters.annulus_comm_diameter,
                                            (x[1] - 4) / parameters.annulus_ap_diameter);
                if (x.distance(annulus.point(a)) > 0.06)
                  continue;
                Vector3 tangent = annulus.point(a + 1e-4) - annulus.point(a - 1e-4);
                tangent /= tangent.norm();
                least = std::min(least, std::abs(cell.fibre * tangent));
                ++n;
              }
          std::cout << "  fibres at the root follow the annulus: "
                    << (n > 100 && least > 0.95 ? "yes" : "no") << '\n';
        }
      if (name == "leaflets" || name == "chordae")
        std::cout << "  cells without fibre " << report.n_without_fibre
                  << ", unit length: "
                  << (report.fibre_length_error < 1e-12 ? "yes" : "no") << '\n';
    }
}
