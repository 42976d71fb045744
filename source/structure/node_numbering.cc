#include <deal.II/base/index_set.h>

#include <algorithm>

#include <mitre/structure/node_numbering.h>

namespace mitre::structure
{
  NodeNumbering::NodeNumbering(const std::vector<unsigned int> &owners,
                               const MPI_Comm communicator)
    : communicator(communicator)
    , number_of(owners.size())
    , node_of(owners.size())
    , first(dealii::Utilities::MPI::n_mpi_processes(communicator) + 1, 0)
  {
    for (const unsigned int owner : owners)
      ++first[owner + 1];
    for (unsigned int r = 1; r < first.size(); ++r)
      first[r] += first[r - 1];

    std::vector<unsigned int> next(first.begin(), first.end() - 1);
    for (unsigned int i = 0; i < owners.size(); ++i)
      {
        number_of[i]          = next[owners[i]]++;
        node_of[number_of[i]] = i;
      }
  }


  template <int dim>
  ElementSet<dim>::ElementSet(const Mesh<dim> &mesh,
                              const NodeNumbering &numbering,
                              std::vector<unsigned int> elements,
                              const std::vector<unsigned int> &other_nodes)
    : nodes_per_element(mesh.nodes_per_element)
    , elements_(std::move(elements))
  {
    const unsigned int begin = numbering.begin_owned(), end = numbering.end_owned();
    owned_nodes = end - begin;

    // Step 1: numbers of the ghost nodes.
    for (const unsigned int node : other_nodes)
      {
        const unsigned int number = numbering.number_of[node];
        if (number < begin || number >= end)
          ghosts.push_back(number);
      }
    element_nodes.resize(elements_.size() * nodes_per_element);
    for (unsigned int i = 0; i < elements_.size(); ++i)
      for (unsigned int a = 0; a < nodes_per_element; ++a)
        {
          const unsigned int number =
            numbering.number_of[mesh.elements[elements_[i] * nodes_per_element + a]];
          element_nodes[i * nodes_per_element + a] = number;
          if (number < begin || number >= end)
            ghosts.push_back(number);
        }
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());

    // Step 2: local numbers.
    for (unsigned int &node : element_nodes)
      if (node >= begin && node < end)
        node -= begin;
      else
        node = owned_nodes +
               (std::lower_bound(ghosts.begin(), ghosts.end(), node) - ghosts.begin());

    file_nodes.reserve(owned_nodes + ghosts.size());
    for (unsigned int number = begin; number < end; ++number)
      file_nodes.push_back(numbering.node_of[number]);
    for (const unsigned int number : ghosts)
      file_nodes.push_back(numbering.node_of[number]);

    // Step 3: which vector entries to exchange with whom.
    const dealii::types::global_dof_index n_entries =
      static_cast<dealii::types::global_dof_index>(numbering.n_nodes()) * dim;
    dealii::IndexSet owned_entries(n_entries), ghost_entries(n_entries);
    owned_entries.add_range(static_cast<dealii::types::global_dof_index>(begin) * dim,
                            static_cast<dealii::types::global_dof_index>(end) * dim);
    for (const unsigned int number : ghosts)
      ghost_entries.add_range(static_cast<dealii::types::global_dof_index>(number) * dim,
                              static_cast<dealii::types::global_dof_index>(number + 1) *
                                dim);
    owned_entries.compress();
    ghost_entries.compress();
    partitioner_ = std::make_shared<const dealii::Utilities::MPI::Partitioner>(
      owned_entries, ghost_entries, numbering.communicator);
  }


  template <int dim>
  unsigned int ElementSet<dim>::local_node(const NodeNumbering &numbering,
                                           const unsigned int node) const
  {
    const unsigned int number = numbering.number_of[node];
    const unsigned int begin  = numbering.begin_owned();
    if (number >= begin && number < numbering.end_owned())
      return number - begin;
    const auto ghost = std::lower_bound(ghosts.begin(), ghosts.end(), number);
    Assert(ghost != ghosts.end() && *ghost == number, dealii::ExcInternalError());
    return owned_nodes + (ghost - ghosts.begin());
  }


  template <int dim>
  std::vector<unsigned int> find_elements_of_owned_nodes(const Mesh<dim> &mesh,
                                                         const NodeNumbering &numbering)
  {
    const unsigned int begin = numbering.begin_owned(), end = numbering.end_owned();

    std::vector<unsigned int> elements;
    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      for (unsigned int a = 0; a < mesh.nodes_per_element; ++a)
        {
          const unsigned int number =
            numbering.number_of[mesh.elements[e * mesh.nodes_per_element + a]];
          if (number >= begin && number < end)
            {
              elements.push_back(e);
              break;
            }
        }
    std::stable_sort(
      elements.begin(), elements.end(), [&](const unsigned int a, const unsigned int b) {
        return mesh.material_ids[a] < mesh.material_ids[b];
      });
    return elements;
  }


  template class ElementSet<2>;
  template class ElementSet<3>;
  template std::vector<unsigned int> find_elements_of_owned_nodes(const Mesh<2> &,
                                                                  const NodeNumbering &);
  template std::vector<unsigned int> find_elements_of_owned_nodes(const Mesh<3> &,
                                                                  const NodeNumbering &);
} // namespace mitre::structure
