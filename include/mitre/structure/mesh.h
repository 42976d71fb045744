#ifndef mitre_structure_mesh_h
#define mitre_structure_mesh_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <string>
#include <vector>

namespace mitre::structure
{
  /// The shapes that elements may have; a mesh has elements of one shape only. Segments
  /// are no finite elements: they say which nodes of a fibre part are neighbours.
  enum class ElementShape : unsigned char
  {
    simplex,
    hypercube,
    segment ///< between two nodes, or a node by itself twice: of fibres
  };


  /// Largest number of fibre families that an element can have.
  constexpr unsigned int max_fibre_families = 2;


  /// Fibre directions in the reference configuration, unit vectors (zero: no such
  /// family).
  template <int dim>
  using Fibres = std::array<dealii::Tensor<1, dim>, max_fibre_families>;


  /**
   * A finite element mesh in the reference configuration as plain arrays, the same on
   * every rank. Nodes and elements are numbered from 0 in the order of the file.
   */
  template <int dim>
  struct Mesh
  {
    /// Where the mesh comes from, for messages.
    std::string source;

    ElementShape shape  = ElementShape::simplex;
    unsigned int degree = 1;

    /// Node positions [cm].
    std::vector<dealii::Point<dim>> nodes;

    unsigned int nodes_per_element = dim + 1;

    /// Nodes of element e at e * nodes_per_element, in the order in which deal.II numbers
    /// the vertices of a cell (hypercubes: lexicographic, x fastest).
    std::vector<unsigned int> elements;

    std::vector<unsigned int> material_ids;

    /// Elements of one dimension less that the file gives a physical id, by their corners
    /// (in any order; dim of simplices, 2^(dim-1) of hypercubes), and these ids.
    std::vector<unsigned int> boundary_elements;
    std::vector<unsigned int> boundary_ids;

    /// Directions by family and element; a family without directions is empty.
    std::array<std::vector<dealii::Tensor<1, dim>>, max_fibre_families> fibres;

    /// Number of each element in the file, for messages (empty: the same as here).
    std::vector<unsigned long> element_tags;

    unsigned int n_elements() const
    {
      return material_ids.size();
    }

    unsigned int n_fibre_families() const;

    /// Mean of the nodes of element @p e at @p positions (by default the reference ones).
    dealii::Point<dim> centroid(const unsigned int e) const;

    /// "element 17 of meshes/tube.msh"
    std::string describe_element(const unsigned int e) const;
  };


  /**
   * Throws base::UserError unless every element of @p mesh has a positive Jacobian at all
   * its nodes; the message names file, element, position and volume. A volume below 1e-10
   * of that of a cube with the element's longest edge counts as zero.
   */
  template <int dim>
  void check_orientation(const Mesh<dim> &mesh);


  /// "(1.5, 2, 0)" for messages.
  template <int dim>
  std::string to_string(const dealii::Point<dim> &x);
} // namespace mitre::structure

#endif
