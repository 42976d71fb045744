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
  };


  /// A run of local elements with the same law.
  template <int dim>
  struct MaterialRange
  {
    unsigned int begin = 0, end = 0;
    const ConstitutiveLaw<dim> *law = nullptr;

    /// Multiplies energy and stress.
    double time_factor = 1;
  };


  /**
   * Add @f$-\int_U P\, \nabla_s\phi_a\, ds@f$ (2.36) [dyn] to the nodes of a run of
   * elements.
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


  /// @f$F = \sum_a X_a \otimes \nabla_s\phi_a@f$ at point @p q of local element @p i.
  template <int dim>
  dealii::Tensor<2, dim> compute_deformation_gradient(const ReferenceCache<dim> &cache,
                                                      const ElementSet<dim> &elements,
                                                      const unsigned int i,
                                                      const unsigned int q,
                                                      const double *positions);
} // namespace mitre::structure

#endif
