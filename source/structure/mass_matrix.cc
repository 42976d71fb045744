#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstring>
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


  template <int dim>
  unsigned int
  MassMatrix<dim>::solve(VectorType &x, const VectorType &b, const double tolerance) const
  {
    const unsigned int n_rows = inverse_diagonal.size();
    const MPI_Comm comm       = b.get_mpi_communicator();

    double *const r       = residual.data();
    double *const p       = direction.begin();
    double *const q       = product.data();
    double *const u       = x.begin();
    const double *const f = b.begin();

    const auto multiply_direction = [&]() {
      direction.update_ghost_values();
      multiply(p, q);
      direction.zero_out_ghost_values();
    };

    // Step 1: the residual of the first guess, and the norm that it is measured against.
    std::copy(x.begin(), x.end(), p);
    multiply_direction();
    double squares[2] = {0, 0};
    for (unsigned int row = 0; row < n_rows; ++row)
      for (unsigned int i = row * dim; i < (row + 1) * dim; ++i)
        {
          r[i] = f[i] - q[i];
          squares[0] += inverse_diagonal[row] * r[i] * r[i];
          squares[1] += inverse_diagonal[row] * f[i] * f[i];
        }
    dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(squares, 2),
                                comm,
                                dealii::ArrayView<double>(squares, 2));
    double rz = squares[0];
    if (!std::isfinite(rz))
      throw base::UserError(
        "forces or velocities at its nodes are infinite or undefined. "
        "The time step is probably too large for its stiffness.");
    const double target = tolerance * tolerance * squares[1];
    if (squares[1] == 0)
      {
        x = 0;
        return 0;
      }
    if (rz <= target)
      return 0;

    // Step 2: the first direction.
    for (unsigned int row = 0; row < n_rows; ++row)
      for (unsigned int i = row * dim; i < (row + 1) * dim; ++i)
        p[i] = inverse_diagonal[row] * r[i];

    for (unsigned int iteration = 1; iteration <= 1000; ++iteration)
      {
        // Step 3: the best point along the direction.
        multiply_direction();
        double pq = 0;
        for (unsigned int i = 0; i < n_rows * dim; ++i)
          pq += p[i] * q[i];
        const double alpha = rz / dealii::Utilities::MPI::sum(pq, comm);

        double rz_new = 0;
        for (unsigned int row = 0; row < n_rows; ++row)
          for (unsigned int i = row * dim; i < (row + 1) * dim; ++i)
            {
              u[i] += alpha * p[i];
              r[i] -= alpha * q[i];
              rz_new += inverse_diagonal[row] * r[i] * r[i];
            }
        rz_new = dealii::Utilities::MPI::sum(rz_new, comm);
        if (rz_new <= target)
          return iteration;

        // Step 4: the next direction.
        const double beta = rz_new / rz;
        for (unsigned int row = 0; row < n_rows; ++row)
          for (unsigned int i = row * dim; i < (row + 1) * dim; ++i)
            p[i] = inverse_diagonal[row] * r[i] + beta * p[i];
        rz = rz_new;
      }
    throw base::UserError("the mass matrix solve has not converged in 1000 iterations. A "
                          "larger \"Mass solver tolerance\" or a mesh with better "
                          "elements may help.");
  }


  template class MassMatrix<2>;
  template class MassMatrix<3>;
} // namespace mitre::structure
