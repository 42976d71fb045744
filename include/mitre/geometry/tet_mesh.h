#ifndef mitre_geometry_tet_mesh_h
#define mitre_geometry_tet_mesh_h

#include <deal.II/base/point.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace mitre::geometry
{
  using Point3  = dealii::Point<3>;
  using Vector3 = dealii::Tensor<1, 3>;

  /**
   * A body of tetrahedra. Vertices of a tetrahedron are ordered such that
   * (v1 - v0) x (v2 - v0) . (v3 - v0) is positive, as gmsh and deal.II have it.
   */
  struct TetMesh
  {
    struct Cell
    {
      std::array<unsigned int, 4> vertices;
      int material_id;
      Vector3 fibre; // unit vector, or zero where there are no fibres
    };

    std::vector<Point3> vertices;
    std::vector<Cell> cells;
    /** Pairs of a material id that may occur and its name. */
    std::vector<std::pair<int, std::string>> materials;

    /** Add the cells of another mesh; nodes are not merged. */
    void append(const TetMesh &other);
  };

  /** Size and meaning of a block of hexahedra with indices (i, j, k), see build_block().
   */
  struct BlockLayout
  {
    std::array<unsigned int, 3> n_cells;
    /** The block closes on itself in its first direction: node n_cells[0] is node 0. */
    bool periodic = false;
    /** Direction of the fibres, 0, 1 or 2, or -1 for none. */
    int fibre_direction = -1;
    /** Material id of the hexahedra with the first two indices i and j. */
    std::function<int(unsigned int i, unsigned int j)> material_id;
  };

  /**
   * Nodes @p point(i, j, k), with 0 <= i <= n_cells[0] and so on, joined to hexahedra,
   * each of which is cut into the six tetrahedra of Kuhn's subdivision (one for each
   * order in which the three indices can be raised by one). As all hexahedra are cut
   * alike, neighbours fit, also across the seam of a periodic block. The fibre direction
   * of a cell is the mean of its hexahedron's four edges in that direction.
   *
   * If the block is left handed, all cells are turned round; a single cell of negative
   * volume stays one.
   */
  TetMesh build_block(
    const BlockLayout &layout,
    const std::function<Point3(unsigned int, unsigned int, unsigned int)> &point);

  /**
   * Shell around the mid surface @p surface(u, v): node (i, j, k) lies at surface(u_i,
   * v_j) + (k/n_k - 1/2) thickness n, with the unit normal n = d/du x d/dv from central
   * differences. @p u and @p v hold the n_cells[0] + 1 and n_cells[1] + 1 values u_i and
   * v_j, both ascending.
   */
  TetMesh build_shell(const BlockLayout &layout,
                      const std::vector<double> &u,
                      const std::vector<double> &v,
                      double thickness,
                      const std::function<Point3(double, double)> &surface);

  /** Rectangular section of a rod. */
  struct RodSection
  {
    Point3 centre;
    Vector3 across; // direction of the width; its part along the rod is ignored
    double width = 0, height = 0;
  };

  /**
   * Rod through the given sections, which are the n_cells[0] + 1 layers of nodes; a
   * section is normal to the mean direction of the two pieces of centreline that meet
   * there.
   */
  TetMesh build_rod(const BlockLayout &layout, const std::vector<RodSection> &sections);
} // namespace mitre::geometry

#endif
