#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <mitre/geometry/mesh_check.h>

namespace mitre::geometry
{
  std::size_t MeshReport::total_cells() const
  {
    std::size_t sum = 0;
    for (const auto &[id, n] : n_cells)
      sum += n;
    return sum;
  }


  double MeshReport::total_volume() const
  {
    double sum = 0;
    for (const auto &[id, v] : volume)
      sum += v;
    return sum;
  }


  bool MeshReport::sound() const
  {
    return n_inverted == 0 && n_bad_faces == 0 && n_bad_surface_edges == 0 &&
           n_unused_vertices == 0 && min_quality > 1e-3;
  }


  MeshReport check_mesh(const TetMesh &mesh)
  {
    MeshReport report;
    report.n_vertices    = mesh.vertices.size();
    report.min_quality   = std::numeric_limits<double>::max();
    report.shortest_edge = std::numeric_limits<double>::max();

    using Face = std::array<unsigned int, 3>;
    std::vector<Face> faces;
    std::vector<bool> used(mesh.vertices.size(), false);
    faces.reserve(4 * mesh.cells.size());
    for (const TetMesh::Cell &cell : mesh.cells)
      {
        std::array<Point3, 4> x;
        for (unsigned int v = 0; v < 4; ++v)
          {
            x[v]                   = mesh.vertices[cell.vertices[v]];
            used[cell.vertices[v]] = true;
          }
        const double volume =
          dealii::cross_product_3d(x[1] - x[0], x[2] - x[0]) * (x[3] - x[0]) / 6;
        ++report.n_cells[cell.material_id];
        report.volume[cell.material_id] += volume;
        if (!(volume > 0))
          ++report.n_inverted;

        double squares = 0;
        for (unsigned int a = 0; a < 4; ++a)
          for (unsigned int b = a + 1; b < 4; ++b)
            {
              const double length  = x[a].distance(x[b]);
              report.shortest_edge = std::min(report.shortest_edge, length);
              report.longest_edge  = std::max(report.longest_edge, length);
              squares += length * length;
            }
        const double quality = 12 * std::pow(3 * std::max(0., volume), 2. / 3) / squares;
        report.min_quality   = std::min(report.min_quality, quality);
        report.mean_quality += quality / mesh.cells.size();

        if (cell.fibre.norm_square() == 0)
          ++report.n_without_fibre;
        else
          report.fibre_length_error =
            std::max(report.fibre_length_error, std::abs(cell.fibre.norm() - 1));

        for (unsigned int opposite = 0; opposite < 4; ++opposite)
          {
            Face face{};
            for (unsigned int v = 0, f = 0; v < 4; ++v)
              if (v != opposite)
                face[f++] = cell.vertices[v];
            std::sort(face.begin(), face.end());
            faces.push_back(face);
          }
      }
    report.n_unused_vertices = std::count(used.begin(), used.end(), false);

    std::sort(faces.begin(), faces.end());
    std::vector<std::array<unsigned int, 2>> edges;
    std::set<unsigned int> surface_vertices;
    for (std::size_t i = 0; i < faces.size();)
      {
        std::size_t next = i + 1;
        while (next < faces.size() && faces[next] == faces[i])
          ++next;
        if (next - i > 2)
          ++report.n_bad_faces;
        else if (next - i == 1)
          {
            const Face &f = faces[i];
            ++report.n_surface_faces;
            report.surface_area +=
              0.5 * dealii::cross_product_3d(mesh.vertices[f[1]] - mesh.vertices[f[0]],
                                             mesh.vertices[f[2]] - mesh.vertices[f[0]])
                      .norm();
            surface_vertices.insert(f.begin(), f.end());
            edges.push_back({{f[0], f[1]}});
            edges.push_back({{f[0], f[2]}});
            edges.push_back({{f[1], f[2]}});
          }
        i = next;
      }
    std::sort(edges.begin(), edges.end());
    long n_edges = 0;
    for (std::size_t i = 0; i < edges.size(); ++n_edges)
      {
        std::size_t next = i + 1;
        while (next < edges.size() && edges[next] == edges[i])
          ++next;
        if (next - i != 2)
          ++report.n_bad_surface_edges;
        i = next;
      }
    report.euler_characteristic =
      long(surface_vertices.size()) - n_edges + long(report.n_surface_faces);
    return report;
  }
} // namespace mitre::geometry
