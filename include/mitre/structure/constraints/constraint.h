#ifndef mitre_structure_constraints_constraint_h
#define mitre_structure_constraints_constraint_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <string>

#include <mitre/structure/node_numbering.h>
#include <mitre/structure/regions.h>

namespace mitre::structure
{
  using VectorType = dealii::LinearAlgebra::distributed::Vector<double>;


  /**
   * A force that keeps nodes of a body near where they shall be. Unlike a Load it knows
   * where that is, so that a run can tell how far it gives way.
   *
   * The force is a density at the nodes, or a sum of nodal forces, which is projected
   * together with the elastic one.
   */
  template <int dim>
  class Constraint
  {
  public:
    virtual ~Constraint() = default;

    /// @param what names the constraint in messages: "Part tube, constraint hold"
    virtual void parse_parameters(dealii::ParameterHandler &prm,
                                  const std::string &what) = 0;

    /// Find out what does not depend on ranks; called once, before reinit().
    virtual void initialize(const Mesh<dim> &)
    {
    }

    /// Find the owned nodes on which the constraint acts; called again when the nodes
    /// have been distributed anew.
    virtual void reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements) = 0;

    /// How many owned nodes it acts on.
    virtual unsigned int n_nodes() const = 0;

    /**
     * Add to the nodal force density @p F per reference volume [dyn/cm^dim] at node
     * positions @p X [cm] and velocities @p U [cm/s] at time @p t [s].
     */
    virtual void add_force_density(const VectorType &X,
                                   const VectorType &U,
                                   const double t,
                                   VectorType &F) const = 0;

    /// Whether it acts on nodes alone, so that a body needs no elements for it.
    virtual bool acts_on_points() const
    {
      return false;
    }

    /// Whether add_forces() has something to add.
    virtual bool has_nodal_forces() const
    {
      return false;
    }

    /// Add to the nodal forces [dyn] by local node and component. Those of nodes that are
    /// not owned are of no use.
    virtual void add_forces(const NodalState &, double *) const
    {
    }

    /**
     * Put the components of owned nodes in @p X that the constraint holds where they
     * shall be at time @p t [s].
     */
    virtual void set_targets(const double t, VectorType &X) const = 0;

    /// The largest distance of an owned node from where it shall be [cm].
    virtual double largest_displacement(const VectorType &X, const double t) const = 0;
  };
} // namespace mitre::structure

#endif
