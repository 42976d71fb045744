#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include <mitre/base/exceptions.h>
#include <mitre/structure/mass_matrix.h>

namespace mitre::structure
{
  template <int dim>
  void MassMatrix<dim>::reinit(const Mesh<dim> &mesh,
                               const ElementSet<dim> &elements,
                               const ReferenceElement<dim> &reference_element)
  {
    const unsigned int n_nodes = mesh.nodes_per_element;
    const unsigned int n_rows  = elements.n_owned_nodes();

    // Step 1: the sparsity pattern.
    std::vector<std::vector<unsigned int>> neighbors(n_rows);
    for (unsigned int i = 0; i < elements.n_elements(); ++i)
      for (unsigned int a = 0; a < n_nodes; ++a)
        {
          const unsigned int row = elements.nodes(i)[a];
          if (row < n_rows)
            neighbors[row].insert(
              neighbors[row].end(), elements.nodes(i), elements.nodes(i) + n_nodes);
        }
    row_starts.assign(1, 0);
    columns.clear();
    for (std::vector<unsigned int> &row : neighbors)
      {
        std::sort(row.begin(), row.end());
        row.erase(std::unique(row.begin(), row.end()), row.end());
        columns.insert(columns.end(), row.begin(), row.end());
        row_starts.push_back(columns.size());
      }

    // Step 2: the entries.
    const ShapeTable<dim> shape(reference_element, reference_element.mass_quadrature());
    std::vector<double> element_matrix(n_nodes * n_nodes);
    entries.assign(columns.size(), 0.);
    for (unsigned int i = 0; i < elements.n_elements(); ++i)
      {
        std::fill(element_matrix.begin(), element_matrix.end(), 0.);
        for (unsigned int q = 0; q < shape.n_points; ++q)
          {
            const double JxW = determinant(shape.jacobian(mesh, elements.element(i), q)) *
                               shape.weights[q];
            for (unsigned int a = 0; a < n_nodes; ++a)
              for (unsigned int b = 0; b < n_nodes; ++b)
                element_matrix[a * n_nodes + b] +=
                  shape.values[q * n_nodes + a] * shape.values[q * n_nodes + b] * JxW;
          }
        for (unsigned int a = 0; a < n_nodes; ++a)
          {
            const unsigned int row = elements.nodes(i)[a];
            if (row >= n_rows)
              continue;
            const auto begin = columns.begin() + row_starts[row],
                       end   = columns.begin() + row_starts[row + 1];
            for (unsigned int b = 0; b < n_nodes; ++b)
              entries[std::lower_bound(begin, end, elements.nodes(i)[b]) -
                      columns.begin()] += element_matrix[a * n_nodes + b];
          }
      }

    // Step 3: diagonal and row sums.
    inverse_diagonal.assign(n_rows, 0.);
    row_sums.assign(n_rows, 0.);
    for (unsigned int row = 0; row < n_rows; ++row)
      for (unsigned int k = row_starts[row]; k < row_starts[row + 1]; ++k)
        {
          row_sums[row] += entries[k];
          if (columns[k] == row)
            inverse_diagonal[row] = 1 / entries[k];
        }

    direction.reinit(elements.partitioner());
    residual.resize(n_rows * dim);
    product.resize(n_rows * dim);
  }


  // Bound by loads of entries and nodal values from the second cache; all components of a
  // node are one vector. In three dimensions its load takes a number of the next node
  // along, so that the last node of a row, which may be the last one of all, is apart.
  template <int dim>
  void MassMatrix<dim>::multiply(const double *src, double *dst) const
  {
    using Two                 = double __attribute__((vector_size(16)));
    using Four                = double __attribute__((vector_size(32)));
    using Components          = std::conditional_t<dim == 3, Four, Two>;
    const unsigned int n_rows = inverse_diagonal.size();
    for (unsigned int row = 0; row < n_rows; ++row)
      {
        const unsigned int last = row_starts[row + 1] - 1;
        Components value{}, sum[2] = {};
        std::memcpy(&value, src + columns[last] * dim, dim * sizeof(double));
        sum[0]         = entries[last] * value;
        unsigned int k = row_starts[row];
        for (; k + 2 <= last; k += 2)
          for (unsigned int i = 0; i < 2; ++i)
            {
              std::memcpy(&value, src + columns[k + i] * dim, sizeof(Components));
              sum[i] += entries[k + i] * value;
            }
        if (k < last)
          {
            std::memcpy(&value, src + columns[k] * dim, sizeof(Components));
            sum[1] += entries[k] * value;
          }
        sum[0] += sum[1];
        for (unsigned int c = 0; c < dim; ++c)
          dst[row * dim + c] = sum[0][c];
      }
  }


  template <int dim>
  void MassMatrix<dim>::vmult(VectorType &dst, const VectorType &src) const
  {
    std::copy(src.begin(), src.end(), direction.begin());
    direction.update_ghost_values();
    multiply(direction.begin(), dst.begin());
    direction.zero_out_ghost_values();
  }


  namespace
  {
    /**
     * Corrections for residuals in single precision by conjugate gradients with a
     * symmetric Gauss-Seidel sweep over the rows of this rank as preconditioner, in the
     * form of Eisenstat (SIAM J. Sci. Stat. Comput. 2 (1981) 1-4), one pass over the
     * matrix an iteration: with D^-1/2 M D^-1/2 = L + 1 + U + E, where E has the columns
     * of other ranks' nodes, for the operator (1 + L)^-1 (L + 1 + U + E) (1 + U)^-1.
     *
     * Copying the matrix takes as long as one iteration or two, of more than ten that
     * a solve without a first guess takes.
     */
    template <int dim>
    class CorrectionSolver
    {
    public:
      /// @param ghosted_vector has the ghosts that rows reach, for imports
      void reinit(const std::vector<unsigned int> &rows,
                  const std::vector<unsigned int> &column_numbers,
                  const std::vector<double> &double_entries,
                  const std::vector<double> &inverse_diagonal,
                  VectorType &ghosted_vector)
      {
        row_starts = rows.data();
        columns    = column_numbers.data();
        ghosted    = &ghosted_vector;
        n_rows     = inverse_diagonal.size();
        const unsigned int n_nodes =
          n_rows + ghosted->get_partitioner()->n_ghost_indices() / dim;
        entries.resize(double_entries.size());
        diagonal_at.resize(n_rows);
        first_ghost.resize(n_rows);
        scale.resize(n_nodes);
        for (std::vector<FourFloats> *v :
             {&defect, &correction, &direction, &solved, &swept})
          v->assign(n_nodes, FourFloats{});

        for (unsigned int row = 0; row < n_rows; ++row)
          ghosted->local_element(row * dim) = std::sqrt(inverse_diagonal[row]);
        ghosted->update_ghost_values();
        for (unsigned int node = 0; node < scale.size(); ++node)
          scale[node] = ghosted->begin()[node * dim];
        ghosted->zero_out_ghost_values();

        for (unsigned int row = 0; row < n_rows; ++row)
          {
            const unsigned int *begin = columns + row_starts[row],
                               *end   = columns + row_starts[row + 1];
            diagonal_at[row]          = std::lower_bound(begin, end, row) - columns;
            first_ghost[row]          = std::lower_bound(begin, end, n_rows) - columns;
            for (unsigned int k = row_starts[row]; k < row_starts[row + 1]; ++k)
              entries[k] = double_entries[k] * scale[row] * scale[columns[k]];
          }
      }

      /**
       * Add to @p x what makes the residual @p r, whose norm with 1/D is @p size, smaller
       * by @p reduction, in the norm of (1 + L)^-1 D^-1/2 r, or what 100 iterations do.
       * Returns their number.
       */
      unsigned int
      correct(double *x, const double *r, const double size, const double reduction)
      {
        // Step 1: the residual, made 1 and transformed.
        for (unsigned int row = 0; row < n_rows; ++row)
          for (unsigned int c = 0; c < dim; ++c)
            defect[row][c] = scale[row] / size * r[row * dim + c];
        sweep_down([&](const unsigned int row) { return defect[row]; });
        FourDoubles squares{};
        for (unsigned int row = 0; row < n_rows; ++row)
          {
            defect[row] = direction[row] = swept[row];
            correction[row]              = FourFloats{};
            squares += product(defect[row], defect[row]);
          }
        double rr              = sum_over_ranks(squares);
        const double target    = reduction * reduction * rr;
        unsigned int iteration = 0;
        do
          {
            // Step 2: (1 + U)^-1 times the direction.
            sweep_up();
            import_solved();

            // Step 3: the operator times the direction, and the best step along it.
            sweep_down([&](const unsigned int row) {
              return direction[row] - solved[row] +
                     sum_of_products(first_ghost[row], row_starts[row + 1], solved);
            });
            FourDoubles products{};
            for (unsigned int row = 0; row < n_rows; ++row)
              products += product(direction[row], solved[row] + swept[row]);
            const double alpha = rr / sum_over_ranks(products);

            // Step 4: along it, and the next direction.
            squares = FourDoubles{};
            for (unsigned int row = 0; row < n_rows; ++row)
              {
                correction[row] += static_cast<float>(alpha) * solved[row];
                defect[row] -= static_cast<float>(alpha) * (solved[row] + swept[row]);
                squares += product(defect[row], defect[row]);
              }
            const double rr_new = sum_over_ranks(squares);
            for (unsigned int row = 0; row < n_rows; ++row)
              direction[row] =
                defect[row] + static_cast<float>(rr_new / rr) * direction[row];
            rr = rr_new;
            ++iteration;
        } while (rr > target && iteration < 100);
        for (unsigned int row = 0; row < n_rows; ++row)
          for (unsigned int c = 0; c < dim; ++c)
            x[row * dim + c] += size * scale[row] * correction[row][c];
        return iteration;
      }

    private:
      /// The components at a node, and zeros.
      using FourFloats  = float __attribute__((vector_size(16)));
      using FourDoubles = double __attribute__((vector_size(32)));

      static FourDoubles product(const FourFloats a, const FourFloats b)
      {
        return __builtin_convertvector(a, FourDoubles) *
               __builtin_convertvector(b, FourDoubles);
      }

      double sum_over_ranks(const FourDoubles v) const
      {
        return dealii::Utilities::MPI::sum((v[0] + v[1]) + (v[2] + v[3]),
                                           ghosted->get_mpi_communicator());
      }

      /// sum over begin <= k < end of entries[k] v[columns[k]]
      FourFloats sum_of_products(unsigned int begin,
                                 const unsigned int end,
                                 const std::vector<FourFloats> &v) const
      {
        FourFloats sum[2] = {};
        for (; begin + 2 <= end; begin += 2)
          {
            sum[0] += entries[begin] * v[columns[begin]];
            sum[1] += entries[begin + 1] * v[columns[begin + 1]];
          }
        if (begin < end)
          sum[0] += entries[begin] * v[columns[begin]];
        return sum[0] + sum[1];
      }

      // Sweeps are bound by loads of the matrix. They take the row before, which most
      // rows need, from a register and last, as rows would wait for each other's stores.

      /// swept = (1 + L)^-1 v, where v(row) is asked for when its turn has come.
      template <typename Function>
      void sweep_down(const Function &v)
      {
        FourFloats before{};
        for (unsigned int row = 0; row < n_rows; ++row)
          {
            const unsigned int begin = row_starts[row];
            unsigned int end         = diagonal_at[row];
            const bool follows       = begin < end && columns[end - 1] == row - 1;
            end -= follows;
            FourFloats value = v(row) - sum_of_products(begin, end, swept);
            if (follows)
              value -= entries[end] * before;
            swept[row] = before = value;
          }
      }

      /// solved = (1 + U)^-1 direction
      void sweep_up()
      {
        FourFloats before{};
        for (unsigned int row = n_rows; row-- > 0;)
          {
            unsigned int begin     = diagonal_at[row] + 1;
            const unsigned int end = first_ghost[row];
            const bool follows     = begin < end && columns[begin] == row + 1;
            begin += follows;
            FourFloats value = direction[row] - sum_of_products(begin, end, solved);
            if (follows)
              value -= entries[begin - 1] * before;
            solved[row] = before = value;
          }
      }

      /// The values of solved at other ranks' nodes.
      void import_solved()
      {
        if (dealii::Utilities::MPI::n_mpi_processes(ghosted->get_mpi_communicator()) == 1)
          return;
        for (unsigned int row = 0; row < n_rows; ++row)
          for (unsigned int c = 0; c < dim; ++c)
            ghosted->local_element(row * dim + c) = solved[row][c];
        ghosted->update_ghost_values();
        for (unsigned int node = n_rows; node < solved.size(); ++node)
          for (unsigned int c = 0; c < dim; ++c)
            solved[node][c] = ghosted->begin()[node * dim + c];
        ghosted->zero_out_ghost_values();
      }

      const unsigned int *row_starts, *columns;
      unsigned int n_rows;
      VectorType *ghosted;
      std::vector<float> entries;
      std::vector<unsigned int> diagonal_at, first_ghost;
      std::vector<double> scale;
      std::vector<FourFloats> defect, correction, direction, solved, swept;
    };
  } // namespace


  template <int dim>
  unsigned int
  MassMatrix<dim>::solve(VectorType &x, const VectorType &b, const double tolerance) const
  {
    const unsigned int n_rows = inverse_diagonal.size();
    double *const r           = residual.data();
    const double *const f     = b.begin();
    unsigned int n_iterations = 0;
    double last_square        = std::numeric_limits<double>::max();
    while (n_iterations <= 1000)
      {
        // Step 1: the residual, and what it is measured against.
        std::copy(x.begin(), x.end(), direction.begin());
        direction.update_ghost_values();
        multiply(direction.begin(), product.data());
        direction.zero_out_ghost_values();
        double squares[2] = {0, 0};
        for (unsigned int row = 0; row < n_rows; ++row)
          for (unsigned int i = row * dim; i < (row + 1) * dim; ++i)
            {
              r[i] = f[i] - product[i];
              squares[0] += inverse_diagonal[row] * r[i] * r[i];
              squares[1] += inverse_diagonal[row] * f[i] * f[i];
            }
        dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(squares, 2),
                                    b.get_mpi_communicator(),
                                    dealii::ArrayView<double>(squares, 2));
        if (!std::isfinite(squares[0]))
          throw base::UserError(
            "forces or velocities at its nodes are infinite or undefined. "
            "The time step is probably too large for its stiffness.");
        if (squares[1] == 0)
          {
            x = 0;
            return 0;
          }
        // Round-off keeps residuals above about 1e-15.
        const double target = tolerance * tolerance * squares[1];
        if (squares[0] <= target ||
            (squares[0] <= 1e-26 * squares[1] && squares[0] > 0.25 * last_square))
          return n_iterations;
        last_square = squares[0];

        // Step 2: a correction. Its norm differs from this one by a factor near 1.
        // Its memory is used again, as getting it takes as long as several iterations.
        static thread_local CorrectionSolver<dim> solver;
        if (n_iterations == 0)
          solver.reinit(row_starts, columns, entries, inverse_diagonal, direction);
        n_iterations +=
          solver.correct(x.begin(),
                         r,
                         std::sqrt(squares[0]),
                         std::max(2e-6, 0.4 * std::sqrt(target / squares[0])));
      }
    throw base::UserError("the mass matrix solve has not converged in 1000 iterations. A "
                          "larger \"Mass solver tolerance\" or a mesh with better "
                          "elements may help.");
  }


  template class MassMatrix<2>;
  template class MassMatrix<3>;
} // namespace mitre::structure
