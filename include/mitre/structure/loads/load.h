#ifndef mitre_structure_loads_load_h
#define mitre_structure_loads_load_h

#include <deal.II/base/parameter_handler.h>

#include <string>

#include <mitre/structure/mesh.h>
#include <mitre/structure/node_numbering.h>
#include <mitre/structure/regions.h>

namespace mitre::structure
{
  /**
   * A force that acts on a body from outside, whose nodal forces follow from the weak
   * form and are projected together with the elastic ones. Unlike a Constraint it does
   * not know where the body shall be.
   */
  template <int dim>
  class Load
  {
  public:
    virtual ~Load() = default;

    /// @param what names the load in messages: "Part leaflets, load pressure"
    virtual void parse_parameters(dealii::ParameterHandler &prm,
                                  const std::string &what) = 0;

    /// Find the elements or faces on which the load acts; called once, before reinit().
    virtual void initialize(const Mesh<dim> &mesh) = 0;

    /// Keep those that touch owned nodes; called again when the nodes have been
    /// distributed anew.
    virtual void reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements) = 0;

    /// On how many elements or faces it acts on this rank.
    virtual unsigned int n_elements() const = 0;

    /// Add to the nodal forces [dyn] by local node and component. Those of nodes that are
    /// not owned are of no use.
    virtual void add_forces(const NodalState &state, double *forces) const = 0;
  };
} // namespace mitre::structure

#endif
