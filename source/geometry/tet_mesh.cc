#include <deal.II/base/exceptions.h>

#include <cmath>

#include <mitre/geometry/tet_mesh.h>

namespace mitre::geometry
{
  void TetMesh::append(const TetMesh &other)
  {
    const unsigned int shift = vertices.size();
    vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    for (Cell cell : other.cells)
      {
        for (unsigned int &v : cell.vertices)
          v += shift;
        cells.push_back(cell);
      }
  }


  TetMesh build_block(
    const BlockLayout &layout,
    const std::function<Point3(unsigned int, unsigned int, unsigned int)> &point)
  {
    const auto &n              = layout.n_cells;
    const unsigned int nodes_i = layout.periodic ? n[0] : n[0] + 1;
    const auto node            = [&](unsigned int i, unsigned int j, unsigned int k) {
      return ((i % nodes_i) * (n[1] + 1) + j) * (n[2] + 1) + k;
    };

    TetMesh mesh;
    mesh.vertices.reserve(nodes_i * (n[1] + 1) * (n[2] + 1));
    for (unsigned int i = 0; i < nodes_i; ++i)
      for (unsigned int j = 0; j <= n[1]; ++j)
        for (unsigned int k = 0; k <= n[2]; ++k)
          mesh.vertices.push_back(point(i, j, k));

    // Orders in which the indices are raised, the even permutations first.
    const unsigned int orders[6][3] = {
      {0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};

    double volume = 0;
    mesh.cells.reserve(6 * n[0] * n[1] * n[2]);
    for (unsigned int i = 0; i < n[0]; ++i)
      for (unsigned int j = 0; j < n[1]; ++j)
        for (unsigned int k = 0; k < n[2]; ++k)
          {
            Vector3 fibre;
            if (layout.fibre_direction >= 0)
              {
                const unsigned int d = layout.fibre_direction, d1 = (d + 1) % 3,
                                   d2 = (d + 2) % 3;
                for (unsigned int edge = 0; edge < 4; ++edge)
                  {
                    std::array<unsigned int, 3> a{{i, j, k}};
                    a[d1] += edge & 1;
                    a[d2] += edge >> 1;
                    std::array<unsigned int, 3> b = a;
                    ++b[d];
                    fibre += mesh.vertices[node(b[0], b[1], b[2])] -
                             mesh.vertices[node(a[0], a[1], a[2])];
                  }
                fibre /= fibre.norm();
              }
            for (unsigned int o = 0; o < 6; ++o)
              {
                std::array<unsigned int, 3> at{{i, j, k}};
                TetMesh::Cell cell;
                cell.vertices[0] = node(i, j, k);
                for (unsigned int step = 0; step < 3; ++step)
                  {
                    ++at[orders[o][step]];
                    cell.vertices[step + 1] = node(at[0], at[1], at[2]);
                  }
                if (o >= 3)
                  std::swap(cell.vertices[2], cell.vertices[3]);
                cell.material_id = layout.material_id(i, j);
                cell.fibre       = fibre;
                mesh.cells.push_back(cell);
                const Point3 &x = mesh.vertices[cell.vertices[0]];
                volume += dealii::cross_product_3d(mesh.vertices[cell.vertices[1]] - x,
                                                   mesh.vertices[cell.vertices[2]] - x) *
                          (mesh.vertices[cell.vertices[3]] - x);
              }
          }
    if (volume < 0)
      for (TetMesh::Cell &cell : mesh.cells)
        std::swap(cell.vertices[2], cell.vertices[3]);
    return mesh;
  }


  TetMesh build_shell(const BlockLayout &layout,
                      const std::vector<double> &u,
                      const std::vector<double> &v,
                      const double thickness,
                      const std::function<Point3(double, double)> &surface)
  {
    Assert(u.size() == layout.n_cells[0] + 1,
           dealii::ExcDimensionMismatch(u.size(), layout.n_cells[0] + 1));
    Assert(v.size() == layout.n_cells[1] + 1,
           dealii::ExcDimensionMismatch(v.size(), layout.n_cells[1] + 1));
    const double eps = 1e-4;
    return build_block(layout, [&](unsigned int i, unsigned int j, unsigned int k) {
      const double v0   = std::max(v.front(), v[j] - eps);
      const double v1   = std::min(v.back(), v[j] + eps);
      const bool open_u = !layout.periodic;
      const double u0   = open_u ? std::max(0., u[i] - eps) : u[i] - eps;
      const double u1   = open_u ? std::min(1., u[i] + eps) : u[i] + eps;
      Vector3 normal    = dealii::cross_product_3d(surface(u1, v[j]) - surface(u0, v[j]),
                                                surface(u[i], v1) - surface(u[i], v0));
      normal /= normal.norm();
      return surface(u[i], v[j]) +
             (double(k) / layout.n_cells[2] - 0.5) * thickness * normal;
    });
  }


  TetMesh build_rod(const BlockLayout &layout, const std::vector<RodSection> &sections)
  {
    const unsigned int n = sections.size();
    Assert(n == layout.n_cells[0] + 1,
           dealii::ExcDimensionMismatch(n, layout.n_cells[0] + 1));
    const auto unit = [](const Vector3 &v) { return v / v.norm(); };

    std::vector<Vector3> first(n), second(n);
    for (unsigned int i = 0; i < n; ++i)
      {
        Vector3 tangent;
        if (i > 0)
          tangent += unit(sections[i].centre - sections[i - 1].centre);
        if (i + 1 < n)
          tangent += unit(sections[i + 1].centre - sections[i].centre);
        tangent               = unit(tangent);
        const Vector3 &across = sections[i].across;
        first[i]              = unit(across - (across * tangent) * tangent);
        second[i]             = dealii::cross_product_3d(tangent, first[i]);
      }
    return build_block(layout, [&](unsigned int i, unsigned int j, unsigned int k) {
      return sections[i].centre +
             sections[i].width * (double(j) / layout.n_cells[1] - 0.5) * first[i] +
             sections[i].height * (double(k) / layout.n_cells[2] - 0.5) * second[i];
    });
  }
} // namespace mitre::geometry
