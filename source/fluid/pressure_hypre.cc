#include <deal.II/base/mpi.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <cmath>

#include <mitre/fluid/pressure_hypre.h>

namespace mitre::fluid
{
  using namespace dealii;
  using grid::Neighbor;
  using grid::VectorType;

  template <int dim>
  PressureHypre<dim>::PressureHypre(const StokesOperators<dim> &operators)
    : operators(operators)
    , singular(
        Utilities::MPI::max(operators.velocity_space().open_faces().empty() ? 0 : 1,
                            operators.velocity_space().grid().communicator()) == 0)
  {
    assemble();
    const IndexSet rows = matrix.locally_owned_range_indices();
    rhs.reinit(rows, operators.velocity_space().grid().communicator());
    solution.reinit(rhs);

    using Data = PETScWrappers::PreconditionBoomerAMG::AdditionalData;
    Data data;
    data.symmetric_operator   = true;
    data.strong_threshold     = (dim == 2 ? 0.25 : 0.5);
    data.relaxation_type_up   = Data::RelaxationType::symmetricSORJacobi;
    data.relaxation_type_down = Data::RelaxationType::symmetricSORJacobi;
    preconditioner.initialize(matrix, data);
  }


  template <int dim>
  void PressureHypre<dim>::assemble()
  {
    const grid::StaggeredSpace<dim> &space = operators.velocity_space();
    const grid::PatchGrid<dim> &patch_grid = space.grid();
    const unsigned int n                   = patch_grid.n_cells_per_side();
    const unsigned int n_owned             = patch_grid.n_owned_patches();
    const unsigned int n_cells             = Utilities::fixed_power<dim>(n);
    const unsigned int n_entries           = space.n_dofs_per_patch();
    const auto &partitioner                = *space.partitioner();

    // the masters of the faces that are not their own
    std::vector<grid::LinearCombination<dim>> followed;
    std::vector<int> follows(static_cast<std::size_t>(n_owned) * n_entries, -1);
    const auto &table = space.coarse_fine_faces();
    for (unsigned int p = 0; p < n_owned; ++p)
      for (unsigned int part = table.begin(p); part < table.end(p); ++part)
        for (unsigned int row = 0; row < table.n_rows(part, 0); ++row)
          {
            grid::LinearCombination<dim> masters;
            table.for_each_entry(
              part, 0, row, [&](const unsigned int entry, const double weight) {
                masters.entries.emplace_back(partitioner.local_to_global(entry), weight);
              });
            follows[space.first_dof(p, 0) + table.destination(part, 0, row)] =
              followed.size();
            followed.push_back(masters);
          }
    for (unsigned int p = 0; p < n_owned; ++p)
      for (unsigned int c = 0; c < dim; ++c)
        if (patch_grid.neighbor(p, 2 * c + 1) == Neighbor::same)
          for (unsigned int i = 0; i < space.n_dofs_per_component(); ++i)
            if (i / space.stride(c, c) % (n + 1) == n)
              {
                typename grid::StaggeredSpace<dim>::Index index;
                unsigned int rest = i;
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    index[d] = patch_grid.patch(p).index[d] * static_cast<int>(n) +
                               rest % space.extent(c, d);
                    rest /= space.extent(c, d);
                  }
                grid::LinearCombination<dim> master;
                const bool found = space.combination(patch_grid.patch(p).level,
                                                     c,
                                                     index,
                                                     grid::BoundaryExtension::reflection,
                                                     false,
                                                     master);
                AssertThrow(found, ExcInternalError());
                follows[space.first_dof(p, c) + i] = followed.size();
                followed.push_back(master);
              }

    // B, one row a cell; columns are velocities
    const auto first_entry = [&](const unsigned int size) {
      return n_owned == 0 ? 0 : patch_grid.patch(0).global_id * size;
    };
    const types::global_dof_index first_row = first_entry(n_cells);
    const types::global_dof_index n_rows    = patch_grid.n_global_patches() * n_cells;
    const types::global_dof_index first_own = first_entry(n_entries);
    IndexSet rows(n_rows);
    rows.add_range(first_row,
                   first_row + static_cast<types::global_dof_index>(n_owned) * n_cells);
    const IndexSet columns = space.owned_entries();

    const auto for_each_row = [&](const auto &operation) {
      for (unsigned int p = 0; p < n_owned; ++p)
        for (unsigned int cell = 0; cell < n_cells; ++cell)
          {
            grid::LinearCombination<dim> row;
            for (unsigned int side = 0; side < 2 * dim; ++side)
              {
                const unsigned int c = side / 2;
                std::size_t entry    = space.first_dof(p, c);
                unsigned int rest    = cell;
                double area          = (side % 2 == 1 ? 1. : -1.);
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    entry += (rest % n + (d == c ? side % 2 : 0)) * space.stride(c, d);
                    rest /= n;
                    if (d != c)
                      area *= patch_grid.patch(p).h[d];
                  }
                if (follows[entry] < 0)
                  row.entries.emplace_back(first_own + entry, area);
                else
                  row.add(followed[follows[entry]], area);
              }
            row.merge();
            operation(first_row + static_cast<types::global_dof_index>(p) * n_cells +
                        cell,
                      row.entries);
          }
    };
    DynamicSparsityPattern pattern(n_rows, columns.size(), rows);
    for_each_row([&](const types::global_dof_index row, const auto &entries) {
      for (const auto &entry : entries)
        pattern.add(row, entry.first);
    });
    PETScWrappers::MPI::SparseMatrix B;
    B.reinit(rows, columns, pattern, patch_grid.communicator());
    for_each_row([&](const types::global_dof_index row, const auto &entries) {
      for (const auto &entry : entries)
        B.set(row, entry.first, entry.second);
    });
    B.compress(VectorOperation::insert);

    // B W^-1 B^T from B W^-1/2
    PETScWrappers::MPI::Vector root(columns, patch_grid.communicator());
    for (unsigned int i = 0; i < space.inverse_volumes().locally_owned_size(); ++i)
      root(first_own + i) = std::sqrt(space.inverse_volumes().local_element(i));
    root.compress(VectorOperation::insert);
    PetscErrorCode error = MatDiagonalScale(B.petsc_matrix(), nullptr, root);
    AssertThrow(error == 0, LACExceptions::ExcPETScError(error));
    Mat transpose;
    error = MatTranspose(B.petsc_matrix(), MAT_INITIAL_MATRIX, &transpose);
    AssertThrow(error == 0, LACExceptions::ExcPETScError(error));
    error = MatDestroy(&matrix.petsc_matrix());
    AssertThrow(error == 0, LACExceptions::ExcPETScError(error));
    error = MatMatMult(B.petsc_matrix(),
                       transpose,
                       MAT_INITIAL_MATRIX,
                       PETSC_DEFAULT,
                       &matrix.petsc_matrix());
    AssertThrow(error == 0, LACExceptions::ExcPETScError(error));
    error = MatDestroy(&transpose);
    AssertThrow(error == 0, LACExceptions::ExcPETScError(error));
    if (singular)
      {
        if (rows.is_element(0))
          matrix.add(0, 0, matrix.diag_element(0));
        matrix.compress(VectorOperation::add);
      }

    cell_volumes.assign(n_owned, 1.);
    for (unsigned int p = 0; p < n_owned; ++p)
      for (const double h : patch_grid.patch(p).h)
        cell_volumes[p] *= h;
  }


  template <int dim>
  void PressureHypre<dim>::vmult(VectorType &dst, const VectorType &src)
  {
    const double mean          = singular ? operators.mean_pressure(src) : 0.;
    const unsigned int n_cells = operators.pressure_halo().n_cells_per_patch();
    PetscScalar *values;
    PetscErrorCode error = VecGetArray(rhs, &values);
    AssertThrow(error == 0, LACExceptions::ExcPETScError(error));
    for (std::size_t i = 0; i < src.locally_owned_size(); ++i)
      values[i] = cell_volumes[i / n_cells] * (src.local_element(i) - mean);
    error = VecRestoreArray(rhs, &values);
    AssertThrow(error == 0, LACExceptions::ExcPETScError(error));

    preconditioner.vmult(solution, rhs);

    const PetscScalar *result;
    error = VecGetArrayRead(solution, &result);
    AssertThrow(error == 0, LACExceptions::ExcPETScError(error));
    for (std::size_t i = 0; i < dst.locally_owned_size(); ++i)
      dst.local_element(i) = result[i];
    error = VecRestoreArrayRead(solution, &result);
    AssertThrow(error == 0, LACExceptions::ExcPETScError(error));
    if (singular)
      dst.add(-operators.mean_pressure(dst));
  }


  template class PressureHypre<2>;
  template class PressureHypre<3>;
} // namespace mitre::fluid
