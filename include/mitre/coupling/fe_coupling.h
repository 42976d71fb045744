#ifndef mitre_coupling_fe_coupling_h
#define mitre_coupling_fe_coupling_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/tensor.h>

#include <memory>
#include <string>
#include <vector>

#include <mitre/coupling/part_points.h>
#include <mitre/coupling/patch_loops.h>
#include <mitre/grid/velocity_halo.h>

namespace mitre::coupling
{
  /**
   * How a part meets the grid, in <code>subsection Part NAME</code>.
   */
  struct CouplingParameters
  {
    /// Quadrature points for each grid spacing along an element's longest edge.
    double point_density = 2;

    std::string kernel = "IB_4";

    PointChoice points = PointChoice::quadrature;

    /// Level of the grid about the part; -1: the finest.
    int level = -1;

    /// Whether the transmission forces of the surface are spread from there, see
    /// structure::SurfaceTractions.
    bool split_forces = false;

    /// @param of_fibres whose points are always their nodes
    static void declare_parameters(dealii::ParameterHandler &prm,
                                   const bool of_fibres = false);

    void parse_parameters(dealii::ParameterHandler &prm, const bool of_fibres = false);
  };


  /// Forces [dyn] at points of their own, which a part's kernel spreads beside its force
  /// density.
  template <int dim>
  struct PointForces
  {
    unsigned int part;
    std::vector<dealii::Point<dim>> points;
    std::vector<dealii::Tensor<1, dim>> forces;
  };


  /**
   * Interaction of bodies with the staggered velocity (2.37)-(2.44): the
   * force density of a body is evaluated at quadrature points and spread to the faces;
   * the velocity is interpolated to the same points and projected onto the body's shape
   * functions. Parts whose points are their nodes (PointChoice::nodes) take the velocity
   * there, and spread the force density times the row sums of the mass matrix from there:
   * cheaper, but only tight where the elements are smaller than the grid's cells. Fibres
   * do so, too, with the forces on their nodes and weights of 1 (2.8)-(2.13). Both
   * directions use the points of the last update_points(), so that they are adjoint,
   * @f$ (S F, u)_{grid} = (F, R u)_{body} @f$.
   *
   * Vectors of parts are those of structure::Body, one for each part, in the order of
   * add_part().
   */
  template <int dim>
  class FECoupling
  {
  public:
    explicit FECoupling(const grid::PatchGrid<dim> &grid);

    /// @p body must outlive this object.
    void add_part(const structure::Body<dim> &body, const CouplingParameters &parameters);

    /// The layers about patches that the kernels of all parts need.
    unsigned int halo_width() const;

    unsigned int n_parts() const
    {
      return parts.size();
    }

    const structure::Body<dim> &body(const unsigned int part) const
    {
      return parts[part].points->body();
    }

    /**
     * To be called when the grid has changed, after the bodies have been distributed
     * anew.
     * @p halo, which must outlive the next call, has its own partitioner, full shape and
     * a width of halo_width() at least.
     */
    void reinit(grid::VelocityHalo<dim> &halo);

    /// The ranks that own the patches at points, the same on all ranks; for
    /// structure::Body::distribute(). Collective.
    std::vector<unsigned int>
    owners_of(const std::vector<dealii::Point<dim>> &points) const;

    /// Find the quadrature points for the node positions @p X of each part. Collective;
    /// errors as in PartPoints::update().
    void update_points(const std::vector<const VectorType *> &X);

    /// The node positions of a part for which its elements have last been looked up, or
    /// null: what find_elements() needs to put a resumed run into the same state.
    const VectorType *lookup_positions(const unsigned int part) const
    {
      return parts[part].points->lookup_positions();
    }

    /// Look up the elements of a part for node positions @p X. Collective.
    void find_elements(const unsigned int part, const VectorType &X)
    {
      parts[part].points->find_elements(X);
    }

    /**
     * Nodal velocities [cm/s] from the grid velocity @p u (2.41): projections onto the
     * shape functions of each body, or, where nodes are the points, the velocities there.
     * On entry @p U holds a first guess, such as the
     * velocities of the last step. Next to boundaries with given velocity, the prescribed
     * values count that the halo knows (grid::VelocityHalo::set_boundary_values()); none
     * stand for walls at rest. Collective.
     */
    void interpolate(const VectorType &u, const std::vector<VectorType *> &U);

    /// The right hand sides @f$\int_U \phi_a\, u^{IB}\, ds@f$ of these projections alone.
    void compute_velocity_moments(const VectorType &u,
                                  const std::vector<VectorType *> &moments);

    /**
     * Grid force density @p f [dyn/cm^dim] (2.40) from nodal force densities @p F
     * [dyn/cm^dim] per reference volume. @p total, if given, receives the forces [dyn] on
     * the faces before the division by control volumes. Collective.
     *
     * @param extra are spread, too, from those points that lie in owned patches
     */
    void spread(const std::vector<const VectorType *> &F,
                VectorType &f,
                VectorType *total                          = nullptr,
                const std::vector<PointForces<dim>> &extra = {});

    /// The distance of a part's points along edges of its elements in grid spacings,
    /// where it is largest (PartPoints::largest_spacing()). Collective.
    double largest_spacing(const unsigned int part) const
    {
      return parts[part].points->largest_spacing();
    }

    /**
     * The velocity @p u at @p points, which are the same on all ranks, interpolated by
     * composite B-splines (CBS32): if u is free of divergence, so is the result, whatever
     * the kernels of the parts. Returns the velocities of those points that lie in owned
     * patches, with their numbers.
     * Collective.
     */
    std::vector<std::pair<std::size_t, dealii::Tensor<1, dim>>>
    velocities_at(const VectorType &u,
                  const std::vector<dealii::Point<dim>> &points) const;

    /// Number of quadrature points in owned patch @p p.
    std::size_t n_points(const unsigned int p) const;

    /// Number of quadrature points on this rank.
    std::size_t n_points() const;

  private:
    /// Adds the i-th force of @p set to the padded patch, which is that of patch @p p.
    void
    spread_one(const PointForces<dim> &set, const std::size_t i, const unsigned int p);

    struct Part
    {
      CouplingParameters parameters;
      std::unique_ptr<PartPoints<dim>> points;
      VectorType ghosted;
    };

    const grid::PatchGrid<dim> &grid;
    grid::VelocityHalo<dim> *halo = nullptr;
    std::vector<Part> parts;
    std::unique_ptr<PaddedPatch<dim>> padded;
  };
} // namespace mitre::coupling

#endif
