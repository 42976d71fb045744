#ifndef mitre_fluid_pressure_multigrid_h
#define mitre_fluid_pressure_multigrid_h

#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <memory>
#include <vector>

#include <mitre/grid/cell_halo.h>

namespace mitre::fluid
{
  /**
   * Geometric multigrid for the pressure Poisson operator -div grad on the composite
   * grid, with zero value on open faces and zero normal derivative on all others.
   *
   * All levels keep the leaves of the forest; a level halves the number m of cells along
   * the sides of the patches, n, n/2, .., 1, so that the neighbours of a patch, and with
   * them the treatment of coarse-fine interfaces, are the same on all levels: across an
   * interface the flux is that between the two cells that touch, over 3/2 fine cell
   * widths. With one cell a leaf the problem is small, and solved directly
   * (SparseDirectUMFPACK, on every rank). The smoother is Chebyshev iteration with the
   * inverse diagonal; residuals are averaged, corrections interpolated linearly. All in
   * single precision, as it is only a preconditioner.
   */
  template <int dim>
  class PressureMultigrid
  {
  public:
    using Number      = float;
    using LevelVector = dealii::LinearAlgebra::distributed::Vector<Number>;

    /**
     * @param smoothing_steps Chebyshev degree before and after each coarse correction
     */
    PressureMultigrid(const grid::StaggeredSpace<dim> &space,
                      const unsigned int smoothing_steps);

    /// One V-cycle from zero for -div grad dst = src.
    void vmult(grid::VectorType &dst, const grid::VectorType &src);

    /// True if the pressure is defined up to a constant only.
    bool is_singular() const
    {
      return singular;
    }

    /// Applies the finest level's operator (not quite that of the velocity space at
    /// coarse-fine interfaces).
    void apply(grid::VectorType &dst, const grid::VectorType &src);

    unsigned int n_levels() const
    {
      return levels.size();
    }

    std::size_t memory_consumption() const;

  private:
    struct Level
    {
      unsigned int m;
      std::unique_ptr<grid::CellHalo<dim, Number>> halo;
      LevelVector solution, rhs, update, residual;
      LevelVector inverse_diagonal;
      /// Per owned patch: 1 / h^2 in each direction.
      std::vector<std::array<Number, dim>> inverse_h2;
      /// Per owned patch and side: where its open fractions start, or -1.
      std::vector<int> open_start;
      /// Fraction of the boundary faces of cells that are open.
      std::vector<Number> open_fraction;
    };

    void build_level(Level &level, const unsigned int m, const Level *finer);
    void build_coarse_solver();
    void gather(const Level &level,
                const LevelVector &v,
                const unsigned int p,
                Number *padded) const;
    template <typename Operation>
    void for_each_row(Level &level, LevelVector &x, const Operation &operation);
    void smooth(Level &level, const bool zero_start);
    void cycle(const unsigned int l);
    void solve_coarsest();

    const grid::StaggeredSpace<dim> &space;
    const grid::PatchGrid<dim> &patch_grid;
    const unsigned int n_smoothing_steps;
    bool singular;
    std::vector<std::unique_ptr<Level>> levels;

    dealii::SparsityPattern coarse_sparsity;
    dealii::SparseMatrix<double> coarse_matrix;
    dealii::SparseDirectUMFPACK coarse_inverse;
    dealii::Vector<double> coarse_values, coarse_volumes;
    std::vector<int> coarse_counts, coarse_starts;
  };
} // namespace mitre::fluid

#endif
