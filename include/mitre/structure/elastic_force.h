#ifndef mitre_structure_elastic_force_h
#define mitre_structure_elastic_force_h

#include <deal.II/base/tensor.h>

#include <vector>

#include <mitre/structure/constitutive_laws/constitutive_law.h>
#include <mitre/structure/node_numbering.h>
#include <mitre/structure/reference_element.h>

namespace mitre::structure
{
  /**
   * What the elastic force needs of the reference configuration, which never changes, by
   * local element i, force quadrature point q and node a of the element.
   */
  template <int dim>
  struct ReferenceCache
  {
    void reinit(const Mesh<dim> &mesh,
                const ElementSet<dim> &elements,
                const ReferenceElement<dim> &reference_element);

    unsigned int nodes_per_element  = 0;
    unsigned int points_per_element = 0;

    /// @f$\partial\phi_a/\partial s_j@f$ [1/cm] at
    /// ((i * points_per_element + q) * nodes_per_element + a) * dim + j.
    std::vector<double> gradients;

    /// Weight times reference Jacobian [cm^dim].
    std::vector<double> JxW;

    std::vector<Fibres<dim>> fibres;

    /**
     * The functions @f$\psi_k@f$ to which the change of volume may be projected in an
     * element: a constant for linear hypercubes and quadratic simplices, linear ones for
     * quadratic hypercubes. volume_modes[q * n_volume_modes + k] at the points, and the
     * inverse of @f$\int\psi_k\psi_l\,ds@f$ [1/cm^dim] at (i * n_volume_modes + k) *
     * n_volume_modes + l. Linear simplices have none: their change of volume is constant.
     */
    unsigned int n_volume_modes = 0;
    std::vector<double> volume_modes;
    std::vector<double> inverse_volume_mass;
  };


  /// A run of local elements with the same law.
  template <int dim>
  struct MaterialRange
  {
    unsigned int begin = 0, end = 0;
    const ConstitutiveLaw<dim> *law = nullptr;

    /// Multiplies energy and stress.
    double time_factor = 1;

    /// Volumetric part of the law whose J shall be projected; null: none.
    const VolumetricPart *projected_part = nullptr;
  };


  /**
   * Add @f$-\int_U P\, \nabla_s\phi_a\, ds@f$ (2.36) [dyn] to the nodes of a run of
   * elements. With a projected volumetric part, the energy U(J) of the law is replaced by
   * @f$U(\tilde J)@f$ with the L2 projection @f$\tilde J@f$ of J to few functions an
   * element, and @f$J U'(J) F^{-T}@f$ in P by @f$J \tilde p F^{-T}@f$ with the projection
   * @f$\tilde p@f$ of @f$U'(\tilde J)@f$. Elements then have no more constraints of
   * volume than they can satisfy. On parallelepipeds that is selective reduced
   * integration (Malkus and Hughes (1978), CMAME 15); on others it passes the patch test,
   * which reduced integration fails.
   *
   * @param positions node positions by local node and component [cm]
   * @param forces the same layout
   *
   * Returns the first local element with @f$\det F \le 0@f$ or NaN, at which it stops, or
   * numbers::invalid_unsigned_int.
   */
  template <int dim>
  unsigned int compute_elastic_force(const ReferenceCache<dim> &cache,
                                     const ElementSet<dim> &elements,
                                     const MaterialRange<dim> &range,
                                     const double t,
                                     const double *positions,
                                     double *forces);


  /**
   * The strain energy [dyn cm^(dim-2)] of those elements of a run whose first node is
   * owned, so that the sum over ranks counts each once.
   */
  template <int dim>
  double compute_elastic_energy(const ReferenceCache<dim> &cache,
                                const ElementSet<dim> &elements,
                                const MaterialRange<dim> &range,
                                const double t,
                                const double *positions);


  /**
   * Kirchhoff pressures @f$J_q \tilde p_q@f$ [dyn/cm^2] of a projected volumetric part at
   * the points of local element @p i, from the J at these. Returns the volumetric energy
   * of the element [dyn cm^(dim-2)]. Both are without the time factor.
   */
  template <int dim>
  double project_volumetric_part(const ReferenceCache<dim> &cache,
                                 const VolumetricPart &part,
                                 const unsigned int i,
                                 const double *J,
                                 double *pressures);


  /// @f$F = \sum_a X_a \otimes \nabla_s\phi_a@f$ at point @p q of local element @p i.
  template <int dim>
  dealii::Tensor<2, dim> compute_deformation_gradient(const ReferenceCache<dim> &cache,
                                                      const ElementSet<dim> &elements,
                                                      const unsigned int i,
                                                      const unsigned int q,
                                                      const double *positions);
} // namespace mitre::structure

#endif
