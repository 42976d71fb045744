#ifndef mitre_structure_body_h
#define mitre_structure_body_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <mitre/structure/constraints/constraint.h>
#include <mitre/structure/elastic_force.h>
#include <mitre/structure/fibre_rule.h>
#include <mitre/structure/loads/load.h>
#include <mitre/structure/mass_matrix.h>
#include <mitre/structure/material.h>
#include <mitre/structure/mesh.h>
#include <mitre/structure/node_numbering.h>
#include <mitre/structure/reference_element.h>
#include <mitre/structure/stress_state.h>

namespace mitre::structure
{
  template <int dim>
  struct NamedConstraint
  {
    std::string name;
    std::shared_ptr<Constraint<dim>> constraint;
  };


  template <int dim>
  struct NamedLoad
  {
    std::string name;
    std::shared_ptr<Load<dim>> load;
  };


  /// Declare the list "Constraints" of a part and a subsection for each of them.
  template <int dim>
  void declare_constraints(dealii::ParameterHandler &prm);

  /// Make the constraints of a part. Throws base::UserError, which names @p part.
  template <int dim>
  std::vector<NamedConstraint<dim>> parse_constraints(dealii::ParameterHandler &prm,
                                                      const std::string &part);


  /**
   * What a parameter file says about a part of finite elements, in <code>subsection Part
   * NAME</code>.
   */
  template <int dim>
  struct BodyParameters
  {
    std::string name;
    std::string mesh_file;
    std::vector<Material<dim>> materials;
    std::vector<NamedConstraint<dim>> constraints;
    std::vector<NamedLoad<dim>> loads;
    bool consistent_mass = true;

    /// Whether the part is where its constraints hold it, whatever pulls at it.
    bool rigid            = false;
    double mass_tolerance = 1e-10;

    FibreRule<dim> fibre_rule;

    /// Names of stress_quantities() that the part's output has by element.
    std::vector<std::string> element_fields;

    static void declare_parameters(dealii::ParameterHandler &prm);

    /// @param name of the part. Throws base::UserError, which names it.
    void parse_parameters(dealii::ParameterHandler &prm, const std::string &name);
  };


  /**
   * A deformable part: its nodes in the reference configuration, which elements or
   * segments join them, constraints and loads, and which rank owns which of its nodes.
   * What its elastic forces are, and how nodal forces become the field that is spread to
   * the fluid, is the business of derived classes: FiniteElementBody and FibreBody.
   *
   * Fields on its nodes (positions X [cm], velocities, force densities) are distributed
   * vectors without ghost entries, made by initialize_vector(), with component c of node
   * number i at dim * i + c. Nodes are numbered so that each rank's are contiguous; the
   * numbering changes in distribute(), which carries the vectors along.
   *
   * The force density F times node_weights() is a force: for finite elements F is a
   * density per reference volume [dyn/cm^dim], for fibres a force [dyn] on each node,
   * with weights of 1.
   */
  template <int dim>
  class Body
  {
  public:
    /// The ranks that own points; the same list of points is given on all ranks, and the
    /// same result expected. numbers::invalid_unsigned_int: outside of the box.
    using OwnersOfPoints =
      std::function<std::vector<unsigned int>(const std::vector<dealii::Point<dim>> &)>;

    virtual ~Body() = default;

    Body(const Body &)            = delete;
    Body &operator=(const Body &) = delete;

    const std::string &name() const
    {
      return name_;
    }

    /// Nodes and elements, or, of fibres, segments.
    const Mesh<dim> &mesh() const
    {
      return mesh_;
    }

    const NodeNumbering &numbering() const
    {
      return numbering_;
    }

    MPI_Comm communicator() const
    {
      return numbering_.communicator;
    }

    /// The elements that touch owned nodes.
    const ElementSet<dim> &elements() const
    {
      return elements_;
    }

    /// Whether the nodes are where set_to_held_positions() says. Such a body has no
    /// materials and no elastic forces.
    virtual bool is_rigid() const
    {
      return false;
    }

    const std::vector<NamedConstraint<dim>> &constraints() const
    {
      return constraints_;
    }

    const std::vector<NamedLoad<dim>> &loads() const
    {
      return loads_;
    }

    /// What it consists of: "120 elements, 45 nodes (tube.msh)".
    virtual std::string description() const = 0;

    /// Weight of each owned node in sums over the body: volumes [cm^dim] or 1.
    virtual const std::vector<double> &node_weights() const = 0;

    /**
     * Give each node to the rank that @p owners_of names for its position in @p X and
     * rebuild all that depends on it. @p X and @p others, vectors of this body, keep
     * their values at each node. Collective. Throws base::UserError, which names part and
     * node, if a node is outside of the box.
     */
    void distribute(const OwnersOfPoints &owners_of,
                    VectorType &X,
                    const std::vector<VectorType *> &others = {});

    /// Make @p v a vector of this body with all entries 0.
    void initialize_vector(VectorType &v) const;

    /// The reference positions as a vector of this body.
    void set_to_reference_positions(VectorType &X) const;

    /// Where the constraints of a rigid body hold its nodes at time @p t [s].
    void set_to_held_positions(const double t, VectorType &X) const;

    /**
     * All entries of a vector of this body on every rank, by node of the mesh and
     * component. Collective; costs one reduction of all nodes.
     */
    std::vector<double> to_mesh_order(const VectorType &v) const;

    /// The inverse of to_mesh_order().
    void from_mesh_order(const std::vector<double> &values, VectorType &v) const;

    /// The rank that owns each node of the mesh.
    std::vector<unsigned int> node_owners() const;

    /// Projected part of the last compute_force_density(), with which the next one starts
    /// its iteration: a part of the state of a run.
    const VectorType &elastic_force_density() const
    {
      return elastic_density;
    }

    /// To start the next iteration from @p density.
    void set_elastic_force_density(const VectorType &density)
    {
      elastic_density = density;
    }

    /// What the elastic force is the sum of, for messages: "material chordae", "springs".
    virtual std::vector<std::string> elastic_force_names() const = 0;

    /// The same of the external forces: "constraint annulus", "load drag".
    std::vector<std::string> external_force_names() const;

    /**
     * Nodal elastic forces [dyn]. Collective.
     *
     * @param which take only the one with this number in elastic_force_names()
     */
    virtual void compute_elastic_force(
      const VectorType &X,
      const double t,
      VectorType &G,
      const unsigned int which = dealii::numbers::invalid_unsigned_int) const = 0;

    /**
     * Nodal forces of loads, and of constraints as far as these are forces rather than
     * densities [dyn]. Collective.
     *
     * @param which take only the one with this number in external_force_names()
     */
    void compute_external_forces(
      const VectorType &X,
      const VectorType &U,
      const double t,
      VectorType &G,
      const unsigned int which = dealii::numbers::invalid_unsigned_int) const;

    /// The sum of the forces of all constraints and loads [dyn]. Collective.
    dealii::Tensor<1, dim> compute_total_external_force(const VectorType &X,
                                                        const VectorType &U,
                                                        const double t) const;

    /**
     * Nodal values of the force density: nodal forces, elastic and external, divided by
     * the mass matrix (2.36) or, of fibres, as they are, plus the densities of
     * constraints. The projected part of the previous call serves as start of the
     * iteration.
     */
    void compute_force_density(const VectorType &X,
                               const VectorType &U,
                               const double t,
                               VectorType &F);

    /**
     * The field @p x whose moments with the shape functions are @p b, from a first guess
     * in @p x: solves with the mass matrix, or, of fibres, copies. Returns the number of
     * iterations.
     */
    virtual unsigned int project(VectorType &x, const VectorType &b) const = 0;

    /// The sum of a force density times node_weights() [dyn]. Collective.
    dealii::Tensor<1, dim> compute_total(const VectorType &F) const;

    /// Elastic energy [erg; erg/cm in 2D]. Collective.
    virtual double compute_elastic_energy(const VectorType &X, const double t) const = 0;

    /// For each constraint, the largest distance of a node from its target [cm].
    /// Collective.
    std::vector<double> compute_constraint_displacements(const VectorType &X,
                                                         const double t) const;

  protected:
    Body(const std::string &name,
         Mesh<dim> mesh,
         std::vector<NamedConstraint<dim>> constraints,
         std::vector<NamedLoad<dim>> loads,
         const MPI_Comm communicator);

    /// Deals the nodes out in equal parts; for the end of a constructor. Throws
    /// base::UserError if a constraint or load has nothing to act on.
    void deal_out_nodes();

    /// The elements of which this rank owns a node, and the ghost nodes that it needs.
    virtual ElementSet<dim> find_elements() const;

    /// Make anew what depends on numbering() and elements().
    virtual void reinit() = 0;

    /// Copy of @p X in which ghost nodes are known too.
    const double *import_positions(const VectorType &X) const;

    mutable std::vector<double> local_forces;

  private:
    void setup(const std::vector<unsigned int> &owners);

    /// Whether there is a load, or a constraint that gives nodal forces.
    bool has_external_forces() const;

    const std::string name_;
    const Mesh<dim> mesh_;
    const std::vector<NamedConstraint<dim>> constraints_;
    const std::vector<NamedLoad<dim>> loads_;
    NodeNumbering numbering_;
    ElementSet<dim> elements_;

    mutable VectorType ghosted_positions, ghosted_velocities;
    VectorType elastic_force, external_force, elastic_density;
  };


  /**
   * A deformable body that a finite element mesh describes, with its materials.
   */
  template <int dim>
  class FiniteElementBody : public Body<dim>
  {
  public:
    /**
     * The nodes are dealt out in equal parts until distribute() is called. Throws
     * base::UserError if a material id of the mesh has no material or two, a material
     * has no elements, an element is inverted, a law lacks its fibres, a rigid body has
     * materials or nodes that nothing holds, a constraint or load has nothing to act on,
     * or quadratic simplices shall have a lumped mass matrix.
     */
    FiniteElementBody(BodyParameters<dim> parameters,
                      Mesh<dim> mesh,
                      const MPI_Comm communicator);

    bool is_rigid() const override
    {
      return parameters.rigid;
    }

    const ReferenceElement<dim> &reference_element() const
    {
      return reference_element_;
    }

    const MassMatrix<dim> &mass_matrix() const
    {
      return mass_matrix_;
    }

    const std::vector<Material<dim>> &materials() const
    {
      return parameters.materials;
    }

    const std::vector<std::string> &element_fields() const
    {
      return parameters.element_fields;
    }

    std::string description() const override;

    /// Row sums of the mass matrix [cm^dim].
    const std::vector<double> &node_weights() const override
    {
      return mass_matrix_.lumped();
    }

    /// The materials.
    std::vector<std::string> elastic_force_names() const override;

    /**
     * Nodal elastic forces @f$G_a = -\int_U P\,\nabla_s\phi_a\,ds@f$ [dyn]. Collective.
     * Throws base::UserError on all ranks if an element is inverted; it names part,
     * element, centroid and time.
     *
     * @param material take only the elements of the material with this index
     */
    void compute_elastic_force(
      const VectorType &X,
      const double t,
      VectorType &G,
      const unsigned int material = dealii::numbers::invalid_unsigned_int) const override;

    /**
     * Solve M x = b, with the consistent or lumped mass matrix as the parameters say;
     * @p x holds a first guess. Returns the number of iterations.
     */
    unsigned int project(VectorType &x, const VectorType &b) const override;

    /**
     * Call @p function with each quadrature point of the elastic force, in the order of
     * the elements, on one rank only. Collective, as positions are exchanged first.
     *
     * Where the change of volume is projected, the volumetric stress is that of the
     * projection.
     *
     * @param function takes the index of the material, the number of the element in the
     * mesh, weight times reference Jacobian [cm^dim] and the state
     */
    void
    for_each_point(const VectorType &X,
                   const double t,
                   const std::function<void(const unsigned int,
                                            const unsigned int,
                                            const double,
                                            const StressState<dim> &)> &function) const;

    /**
     * The values of quantities by element of the mesh and component, on all ranks. They
     * are those of the means over the reference volume of the element, see
     * StressState::add(). Collective.
     */
    std::vector<std::vector<double>>
    compute_element_fields(const std::vector<std::string> &names,
                           const VectorType &X,
                           const double t) const;

    /// Strain energy [erg; erg/cm in 2D]. Collective.
    double compute_elastic_energy(const VectorType &X, const double t) const override;

    /// Volume of the deformed elements over that of the reference elements: smallest and
    /// largest. Collective.
    std::pair<double, double> compute_volume_ratios(const VectorType &X) const;

  private:
    using Body<dim>::import_positions;
    using Body<dim>::local_forces;

    void check_materials() const;

    void check_rigid() const;

    void reinit() override;

    std::vector<MaterialRange<dim>> material_ranges(
      const double t,
      const unsigned int material = dealii::numbers::invalid_unsigned_int) const;

    BodyParameters<dim> parameters;
    const ReferenceElement<dim> reference_element_;
    ReferenceCache<dim> cache;
    MassMatrix<dim> mass_matrix_;

    /// Runs of local elements and the index of their material.
    struct Range
    {
      unsigned int begin, end, material;
    };
    std::vector<Range> ranges;
  };
} // namespace mitre::structure

#endif
