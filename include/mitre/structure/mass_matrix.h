#ifndef mitre_structure_mass_matrix_h
#define mitre_structure_mass_matrix_h

#include <deal.II/lac/la_parallel_vector.h>

#include <vector>

#include <mitre/structure/node_numbering.h>
#include <mitre/structure/reference_element.h>

namespace mitre::structure
{
  using VectorType = dealii::LinearAlgebra::distributed::Vector<double>;


  /**
   * The matrix @f$M_{ab} = \int_U \phi_a \phi_b\, ds@f$ [cm^dim] of a mesh (without a
   * density), for the projections (2.36) of the thesis. It acts on each component of a
   * nodal vector field alike. Vectors need no ghost entries.
   */
  template <int dim>
  class MassMatrix
  {
  public:
    /**
     * @param elements all elements that touch owned nodes
     */
    void reinit(const Mesh<dim> &mesh,
                const ElementSet<dim> &elements,
                const ReferenceElement<dim> &reference_element);

    /// dst = M src
    void vmult(VectorType &dst, const VectorType &src) const;

    /**
     * Solve M x = b by conjugate gradients with Gauss-Seidel sweeps as preconditioner,
     * all components at once, starting from @p x, until the residual in the norm of the
     * inverse diagonal is below @p tolerance times that of b (or at round-off). Returns
     * the number of iterations; throws base::UserError after 1000.
     */
    unsigned int solve(VectorType &x, const VectorType &b, const double tolerance) const;

    /// Row sums @f$\int_U \phi_a\, ds@f$ of the owned nodes [cm^dim].
    const std::vector<double> &lumped() const
    {
      return row_sums;
    }

  private:
    void multiply(const double *src, double *dst) const;

    std::vector<unsigned int> row_starts;
    std::vector<unsigned int> columns;
    std::vector<double> entries;
    std::vector<double> inverse_diagonal;
    std::vector<double> row_sums;

    /// Work space with the ghosts that rows of owned nodes reach.
    mutable VectorType direction;
    mutable std::vector<double> residual, product;
  };
} // namespace mitre::structure

#endif
