#ifndef mitre_structure_node_numbering_h
#define mitre_structure_node_numbering_h

#include <deal.II/base/array_view.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <memory>
#include <vector>

#include <mitre/structure/mesh.h>

namespace mitre::structure
{
  /**
   * A numbering of the nodes of a mesh in which each rank's nodes are contiguous, in the
   * order of the file among each other. All ranks know all of it.
   */
  struct NodeNumbering
  {
    NodeNumbering() = default;

    /// @param owners the rank that owns each node of the file
    NodeNumbering(const std::vector<unsigned int> &owners, const MPI_Comm communicator);

    MPI_Comm communicator = MPI_COMM_SELF;

    /// Number of node i of the file, and its inverse.
    std::vector<unsigned int> number_of;
    std::vector<unsigned int> node_of;

    /// The nodes first[r] <= number < first[r + 1] belong to rank r.
    std::vector<unsigned int> first;

    unsigned int n_nodes() const
    {
      return number_of.size();
    }

    unsigned int begin_owned() const
    {
      return first[dealii::Utilities::MPI::this_mpi_process(communicator)];
    }

    unsigned int end_owned() const
    {
      return first[dealii::Utilities::MPI::this_mpi_process(communicator) + 1];
    }
  };


  /**
   * Some elements of a mesh and all nodes that this rank needs to work on them: its own
   * ones, numbered from 0, followed by those of other ranks that the elements touch, in
   * the order of their numbers. Component c of local node i is the local entry dim * i +
   * c of a distributed vector with partitioner().
   */
  template <int dim>
  class ElementSet
  {
  public:
    ElementSet() = default;

    /// @param elements in the order in which loops shall visit them
    /// @param other_nodes further nodes of the mesh that this rank needs
    ElementSet(const Mesh<dim> &mesh,
               const NodeNumbering &numbering,
               std::vector<unsigned int> elements,
               const std::vector<unsigned int> &other_nodes = {});

    unsigned int n_elements() const
    {
      return elements_.size();
    }

    /// The number in the mesh of local element @p i.
    unsigned int element(const unsigned int i) const
    {
      return elements_[i];
    }

    /// Local numbers of the nodes of local element @p i.
    const unsigned int *nodes(const unsigned int i) const
    {
      return element_nodes.data() + i * nodes_per_element;
    }

    unsigned int n_owned_nodes() const
    {
      return owned_nodes;
    }

    /// Own nodes and ghosts.
    unsigned int n_nodes() const
    {
      return file_nodes.size();
    }

    /// The number in the mesh of local node @p i.
    unsigned int file_node(const unsigned int i) const
    {
      return file_nodes[i];
    }

    /// The local number of @p node of the mesh, which must be one of this rank's.
    unsigned int local_node(const NodeNumbering &numbering,
                            const unsigned int node) const;

    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &partitioner() const
    {
      return partitioner_;
    }

  private:
    unsigned int nodes_per_element = 0;
    unsigned int owned_nodes       = 0;
    std::vector<unsigned int> elements_;
    std::vector<unsigned int> element_nodes;
    std::vector<unsigned int> file_nodes;

    /// Numbers of the ghosts, in ascending order.
    std::vector<unsigned int> ghosts;

    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner_;
  };


  /// The elements of which this rank owns a node, those of one material id together, in
  /// the order of the file among each other.
  template <int dim>
  std::vector<unsigned int> find_elements_of_owned_nodes(const Mesh<dim> &mesh,
                                                         const NodeNumbering &numbering);
} // namespace mitre::structure

#endif
