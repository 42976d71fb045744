#include <map>
#include <utility>

#include <mitre/structure/fibre_network.h>

namespace mitre::structure
{
  template <int dim>
  Mesh<dim> make_segment_mesh(const FibreNetwork<dim> &network)
  {
    Mesh<dim> mesh;
    mesh.source            = network.source;
    mesh.shape             = ElementShape::segment;
    mesh.nodes_per_element = 2;
    mesh.nodes             = network.nodes;

    std::map<std::pair<unsigned int, unsigned int>, unsigned int> known;
    std::vector<bool> has_neighbour(network.nodes.size(), false);
    const auto add =
      [&](const unsigned int a, const unsigned int b, const unsigned int id) {
        if (!known.emplace(std::minmax(a, b), id).second)
          return;
        mesh.elements.insert(mesh.elements.end(), {a, b});
        mesh.material_ids.push_back(id);
        has_neighbour[a] = has_neighbour[b] = true;
      };
    for (const Spring &spring : network.springs)
      add(spring.nodes[0], spring.nodes[1], spring.force_function);
    for (const Beam<dim> &beam : network.beams)
      {
        add(beam.nodes[0], beam.nodes[1], 0);
        add(beam.nodes[1], beam.nodes[2], 0);
      }
    for (unsigned int i = 0; i < network.nodes.size(); ++i)
      if (!has_neighbour[i])
        add(i, i, 0);
    return mesh;
  }


  template Mesh<2> make_segment_mesh(const FibreNetwork<2> &);
  template Mesh<3> make_segment_mesh(const FibreNetwork<3> &);
} // namespace mitre::structure
