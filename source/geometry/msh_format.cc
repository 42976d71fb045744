#include <algorithm>
#include <cstdio>
#include <fstream>

#include <mitre/base/exceptions.h>
#include <mitre/geometry/msh_format.h>

namespace mitre::geometry
{
  void write_msh(const TetMesh &mesh, const std::string &file_name)
  {
    std::ofstream out(file_name);
    if (!out)
      throw base::UserError(
        "Cannot write the mesh file '" + file_name +
        "'. Check that 'Output folder' names a folder in which files may "
        "be made.");
    char line[200];

    out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    out << "$PhysicalNames\n" << mesh.materials.size() << '\n';
    for (const auto &[id, name] : mesh.materials)
      out << "3 " << id << " \"" << name << "\"\n";
    out << "$EndPhysicalNames\n";

    out << "$Nodes\n" << mesh.vertices.size() << '\n';
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      {
        const Point3 &x = mesh.vertices[i];
        std::snprintf(
          line, sizeof(line), "%zu %.17g %.17g %.17g\n", i + 1, x[0], x[1], x[2]);
        out << line;
      }
    out << "$EndNodes\n$Elements\n" << mesh.cells.size() << '\n';
    bool has_fibres = false;
    for (std::size_t i = 0; i < mesh.cells.size(); ++i)
      {
        const TetMesh::Cell &cell = mesh.cells[i];
        // Type 4 is the four-node tetrahedron; two tags: physical and elementary entity.
        out << i + 1 << " 4 2 " << cell.material_id << ' ' << cell.material_id;
        for (const unsigned int v : cell.vertices)
          out << ' ' << v + 1;
        out << '\n';
        has_fibres = has_fibres || cell.fibre.norm_square() > 0;
      }
    out << "$EndElements\n";

    if (has_fibres)
      {
        // One string (the name), one real (time), three integers (step, components,
        // size).
        out << "$ElementData\n1\n\"fibre\"\n1\n0\n3\n0\n3\n" << mesh.cells.size() << '\n';
        for (std::size_t i = 0; i < mesh.cells.size(); ++i)
          {
            const Vector3 &f = mesh.cells[i].fibre;
            std::snprintf(
              line, sizeof(line), "%zu %.17g %.17g %.17g\n", i + 1, f[0], f[1], f[2]);
            out << line;
          }
        out << "$EndElementData\n";
      }
    out.flush();
    if (!out)
      throw base::UserError("Writing the mesh file '" + file_name +
                            "' failed; is the disc full?");
  }


  TetMesh read_msh(const std::string &file_name)
  {
    std::ifstream in(file_name);
    if (!in)
      throw base::UserError("Cannot read the mesh file '" + file_name + "'.");
    const auto require = [&](const bool condition, const std::string &what) {
      if (!condition)
        throw base::UserError("Mesh file '" + file_name + "': " + what + ".");
    };

    TetMesh mesh;
    std::string word;
    while (in >> word)
      {
        std::size_t n = 0;
        if (word == "$MeshFormat")
          {
            std::string version;
            in >> version;
            require(version == "2.2", "the format version is not 2.2 but " + version);
          }
        else if (word == "$PhysicalNames")
          {
            in >> n;
            for (std::size_t i = 0; i < n; ++i)
              {
                int dim = 0, id = 0;
                std::string name;
                in >> dim >> id >> name;
                name.erase(std::remove(name.begin(), name.end(), '"'), name.end());
                mesh.materials.emplace_back(id, name);
              }
          }
        else if (word == "$Nodes")
          {
            in >> n;
            mesh.vertices.resize(n);
            for (std::size_t i = 0, index = 0; i < n; ++i)
              {
                in >> index;
                require(in && index == i + 1, "the nodes are not numbered 1, 2, ...");
                in >> mesh.vertices[i][0] >> mesh.vertices[i][1] >> mesh.vertices[i][2];
              }
          }
        else if (word == "$Elements")
          {
            in >> n;
            mesh.cells.resize(n);
            for (std::size_t i = 0; i < n; ++i)
              {
                TetMesh::Cell &cell = mesh.cells[i];
                std::size_t index   = 0;
                int type = 0, n_tags = 0, tag = 0;
                in >> index >> type >> n_tags >> cell.material_id >> tag;
                require(in && index == i + 1 && type == 4 && n_tags == 2,
                        "line " + std::to_string(i + 1) +
                          " of the elements is not a tetrahedron with two tags");
                for (unsigned int &v : cell.vertices)
                  {
                    in >> v;
                    require(in && v >= 1 && v <= mesh.vertices.size(),
                            "element " + std::to_string(i + 1) +
                              " has a vertex that does not exist");
                    --v;
                  }
              }
          }
        else if (word == "$ElementData")
          {
            int n_strings, n_reals, n_integers, step, n_components;
            double time;
            std::string name;
            in >> n_strings >> name >> n_reals >> time >> n_integers >> step >>
              n_components >> n;
            require(in && name == "\"fibre\"" && n_components == 3 &&
                      n == mesh.cells.size(),
                    "the element data are not one 'fibre' vector for each element");
            for (std::size_t i = 0, index = 0; i < n; ++i)
              {
                Vector3 &f = mesh.cells[i].fibre;
                in >> index >> f[0] >> f[1] >> f[2];
                require(bool(in), "the element data end too early");
              }
          }
      }
    require(!mesh.cells.empty(), "there are no elements");
    return mesh;
  }
} // namespace mitre::geometry
