#ifndef mitre_structure_fibre_body_h
#define mitre_structure_fibre_body_h

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <mitre/structure/body.h>
#include <mitre/structure/fibre_network.h>
#include <mitre/structure/spring_laws/spring_law.h>
#include <mitre/structure/vector_expression.h>

namespace mitre::structure
{
  /// A law, and which springs follow it.
  struct NamedSpringLaw
  {
    std::string name;

    /// The index in the column for force functions of the springs' file.
    unsigned int force_function = 0;

    /// Whether springs that are shorter than at rest push.
    bool carries_compression = true;

    std::shared_ptr<SpringLaw> law;
  };


  /**
   * What a parameter file says about a part of fibres, in <code>subsection Part
   * NAME</code>.
   */
  template <int dim>
  struct FibreParameters
  {
    std::string name;
    std::string vertex_file;

    /// None: all springs are linear.
    std::vector<NamedSpringLaw> spring_laws;
    std::vector<NamedConstraint<dim>> constraints;
    VectorExpression<dim> target_displacement;

    static void declare_parameters(dealii::ParameterHandler &prm);

    /// @param name of the part. Throws base::UserError, which names it.
    void parse_parameters(dealii::ParameterHandler &prm, const std::string &name);
  };


  /**
   * A part of fibres, as in the classical immersed boundary method (2.3)-(2.13): forces
   * on nodes [dyn], of springs between two, of beams of three, and of target points, that
   * are spread from the nodes and move with the velocity there. Force "densities" are
   * these forces, and all node weights are 1.
   *
   * Forces on a node are summed in the order of the network, so that they do not depend
   * on the number of ranks.
   */
  template <int dim>
  class FibreBody : public Body<dim>
  {
  public:
    /**
     * The nodes are dealt out in equal parts until distribute() is called. Throws
     * base::UserError if there is no law for the force function of a spring, a spring has
     * more values than its law takes or lacks a rest length that its law needs, a
     * constraint does not act on points, or there is nothing that has a force.
     */
    FibreBody(FibreParameters<dim> parameters,
              FibreNetwork<dim> network,
              const MPI_Comm communicator);

    const FibreNetwork<dim> &network() const
    {
      return network_;
    }

    std::string description() const override;

    const std::vector<double> &node_weights() const override
    {
      return weights;
    }

    /// "springs", "beams"
    std::vector<std::string> elastic_force_names() const override;

    /// The forces are minus the derivative of compute_elastic_energy() by the positions.
    /// A spring whose ends are in one place has no direction, and no force.
    void compute_elastic_force(
      const VectorType &X,
      const double t,
      VectorType &G,
      const unsigned int which = dealii::numbers::invalid_unsigned_int) const override;

    unsigned int project(VectorType &x, const VectorType &b) const override;

    /// Of springs and beams.
    double compute_elastic_energy(const VectorType &X, const double t) const override;

    /// The tension of each spring of network() [dyn], on all ranks. @p X as below.
    std::vector<double> compute_spring_tensions(const std::vector<double> &X) const;

    /// Sum of the tensions of the springs along each segment of mesh() [dyn], on all
    /// ranks. @p X are positions by node of the mesh and component.
    std::vector<double> compute_tensions(const std::vector<double> &X) const;

  private:
    using Body<dim>::import_positions;
    using Body<dim>::local_forces;

    /// Whether the rank owns one of the nodes.
    template <std::size_t n>
    bool owns_any(const std::array<unsigned int, n> &nodes) const;

    ElementSet<dim> find_elements() const override;

    void reinit() override;

    void check_springs() const;

    const NamedSpringLaw &law_of(const Spring &spring) const;

    double tension(const Spring &spring, const double length) const;

    FibreParameters<dim> parameters;
    const FibreNetwork<dim> network_;
    std::vector<double> weights;

    /// Numbers of the springs and beams that touch owned nodes, and local numbers of
    /// their nodes.
    std::vector<unsigned int> springs, beams;
    std::vector<std::array<unsigned int, 2>> spring_nodes;
    std::vector<std::array<unsigned int, 3>> beam_nodes;
  };
} // namespace mitre::structure

#endif
