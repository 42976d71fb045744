#ifndef mitre_fluid_pressure_hypre_h
#define mitre_fluid_pressure_hypre_h

#include <deal.II/lac/petsc_precondition.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/petsc_vector.h>

#include <vector>

#include <mitre/fluid/stokes_operators.h>

namespace mitre::fluid
{
  /**
   * Algebraic multigrid (hypre's BoomerAMG, through PETSc) for the pressure Poisson
   * operator -div grad of StokesOperators, as a check of PressureMultigrid.
   *
   * The operator is assembled as it is applied, coarse-fine interfaces included: with the
   * notation of StokesOperators, V (-div grad) = B W^-1 B^T with B = V D C. Row i of B
   * has the signed areas of the faces of cell i, on the masters that these faces follow
   * from; W^-1 is zero for faces with given velocity. Where no boundary is open, the
   * pressure is fixed in the first cell and then shifted to have mean zero.
   */
  template <int dim>
  class PressureHypre
  {
  public:
    explicit PressureHypre(const StokesOperators<dim> &operators);

    /// One V-cycle from zero for -div grad dst = src.
    void vmult(grid::VectorType &dst, const grid::VectorType &src);

    /// V (-div grad) [cm^(dim-2)].
    const dealii::PETScWrappers::MPI::SparseMatrix &assembled_matrix() const
    {
      return matrix;
    }

  private:
    void assemble();

    const StokesOperators<dim> &operators;
    bool singular;
    std::vector<double> cell_volumes; // one a patch [cm^dim]
    dealii::PETScWrappers::MPI::SparseMatrix matrix;
    dealii::PETScWrappers::MPI::Vector rhs, solution;
    dealii::PETScWrappers::PreconditionBoomerAMG preconditioner;
  };
} // namespace mitre::fluid

#endif
