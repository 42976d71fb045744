#include <algorithm>
#include <array>
#include <limits>

#include <mitre/structure/boundary_faces.h>

namespace mitre::structure
{
  namespace
  {
    constexpr unsigned int unused = std::numeric_limits<unsigned int>::max();

    /// The corners of a face, sorted and filled up, by which its two sides are alike.
    using Key = std::array<unsigned int, 4>;

    struct Side
    {
      Key corners;
      unsigned int element, face;
    };
  } // namespace


  template <int dim>
  const std::vector<std::vector<unsigned int>> &face_corners(const ElementShape shape)
  {
    static const std::vector<std::vector<unsigned int>> simplex =
      dim == 2 ? std::vector<std::vector<unsigned int>>{{0, 1}, {1, 2}, {2, 0}}
               : std::vector<std::vector<unsigned int>>{
                   {0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
    static const std::vector<std::vector<unsigned int>> hypercube =
      dim == 2 ? std::vector<std::vector<unsigned int>>{{0, 2}, {1, 3}, {0, 1}, {2, 3}}
               : std::vector<std::vector<unsigned int>>{{0, 2, 4, 6},
                                                        {1, 3, 5, 7},
                                                        {0, 1, 4, 5},
                                                        {2, 3, 6, 7},
                                                        {0, 1, 2, 3},
                                                        {4, 5, 6, 7}};
    return shape == ElementShape::simplex ? simplex : hypercube;
  }


  template <int dim>
  std::vector<BoundaryFace> find_boundary_faces(const Mesh<dim> &mesh)
  {
    const auto &corners = face_corners<dim>(mesh.shape);

    // Step 1: the two sides of an inner face come together when they are sorted.
    std::vector<Side> sides;
    sides.reserve(mesh.n_elements() * corners.size());
    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      for (unsigned int f = 0; f < corners.size(); ++f)
        {
          Side side{{{unused, unused, unused, unused}}, e, f};
          for (unsigned int k = 0; k < corners[f].size(); ++k)
            side.corners[k] = mesh.elements[e * mesh.nodes_per_element + corners[f][k]];
          std::sort(side.corners.begin(), side.corners.end());
          sides.push_back(side);
        }
    std::sort(sides.begin(), sides.end(), [](const Side &a, const Side &b) {
      return a.corners < b.corners;
    });

    std::vector<Side> outer;
    for (std::size_t i = 0; i < sides.size(); ++i)
      if ((i == 0 || sides[i].corners != sides[i - 1].corners) &&
          (i + 1 == sides.size() || sides[i].corners != sides[i + 1].corners))
        outer.push_back(sides[i]);

    // Step 2: the ids of the file.
    std::vector<unsigned int> ids(outer.size(), BoundaryFace::no_id);
    const unsigned int n_corners = corners[0].size();
    for (unsigned int i = 0; i < mesh.boundary_ids.size(); ++i)
      {
        Key key{{unused, unused, unused, unused}};
        std::copy(mesh.boundary_elements.begin() + i * n_corners,
                  mesh.boundary_elements.begin() + (i + 1) * n_corners,
                  key.begin());
        std::sort(key.begin(), key.end());
        const auto found = std::lower_bound(
          outer.begin(), outer.end(), key, [](const Side &a, const Key &b) {
            return a.corners < b;
          });
        if (found != outer.end() && found->corners == key)
          ids[found - outer.begin()] = mesh.boundary_ids[i];
      }

    // Step 3: in the order of the elements.
    std::vector<BoundaryFace> faces;
    for (unsigned int i = 0; i < outer.size(); ++i)
      faces.push_back({outer[i].element, outer[i].face, ids[i]});
    std::sort(
      faces.begin(), faces.end(), [](const BoundaryFace &a, const BoundaryFace &b) {
        return std::make_pair(a.element, a.face) < std::make_pair(b.element, b.face);
      });
    return faces;
  }


  template <int dim>
  dealii::Point<dim> centroid(const Mesh<dim> &mesh, const BoundaryFace &face)
  {
    const std::vector<unsigned int> &corners = face_corners<dim>(mesh.shape)[face.face];
    dealii::Point<dim> sum;
    for (const unsigned int corner : corners)
      sum += mesh.nodes[mesh.elements[face.element * mesh.nodes_per_element + corner]];
    return sum / static_cast<double>(corners.size());
  }


  template const std::vector<std::vector<unsigned int>> &
  face_corners<2>(const ElementShape);
  template const std::vector<std::vector<unsigned int>> &
  face_corners<3>(const ElementShape);
  template std::vector<BoundaryFace> find_boundary_faces(const Mesh<2> &);
  template std::vector<BoundaryFace> find_boundary_faces(const Mesh<3> &);
  template dealii::Point<2> centroid(const Mesh<2> &, const BoundaryFace &);
  template dealii::Point<3> centroid(const Mesh<3> &, const BoundaryFace &);
} // namespace mitre::structure
