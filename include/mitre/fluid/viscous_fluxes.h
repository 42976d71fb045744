#ifndef mitre_fluid_viscous_fluxes_h
#define mitre_fluid_viscous_fluxes_h

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include <mitre/grid/staggered_space.h>

namespace mitre::fluid
{
  /**
   * Makes the viscous fluxes of both sides of coarse-fine interfaces the same.
   *
   * A sweep over a patch takes second differences, for which it sees values beyond the
   * interface that are interpolated to its own spacing. Here the rows of the coarse faces
   * that have finer leaves beside them are written anew as balances of fluxes through the
   * sides of their control volumes: a side, or a half of it, takes the sum of the fluxes
   * that the finer leaf beyond sees, and the control volume of a face on an interface
   * consists of a half on the coarser leaf and of halves of those of the finer leaf's
   * faces. With W the control volumes, the sum of W laplace(u) over a periodic box is
   * then zero.
   *
   * What is stored is the difference of these rows and the second differences.
   */
  template <int dim>
  class ViscousFluxes
  {
  public:
    explicit ViscousFluxes(const grid::StaggeredSpace<dim> &space);

    /// Entries of other ranks that the rows read.
    void add_ghosts(std::vector<dealii::types::global_dof_index> &ghosts) const
    {
      rows.collect_ghosts(ghosts);
    }

    /// Uses vectors with this partitioner from now on.
    void localize(const dealii::Utilities::MPI::Partitioner &partitioner)
    {
      rows.localize(partitioner);
    }

    void set_boundary_values(
      const std::function<double(const grid::BoundaryTerm<dim> &)> &prescribed)
    {
      rows.set_boundary_values(prescribed);
    }

    /// Adds b times the difference to @p dst; the ghost values of @p u must be up to
    /// date.
    void add_correction(grid::VectorType &dst,
                        const grid::VectorType &u,
                        const double b,
                        const bool inhomogeneous) const;

  private:
    using Index = std::array<int, dim>;

    /// A row being built, space for one of the values in it, and those of coarser leaves
    /// that rows of the same patch use.
    struct Row
    {
      grid::CombinationSum<dim> sum;
      grid::LinearCombination<dim> value;
      grid::CoarseValues<dim> coarse_values;
    };

    /// Adds factor times the velocity that a leaf of @p level sees at face @p i.
    void add_value(const int level,
                   const unsigned int c,
                   const Index &i,
                   const double factor,
                   Row &row) const;

    /// Adds factor times the flux into the lower (0) or upper (1) half, along c, of the
    /// control volume of face @p i through its side in direction @p d.
    void add_side_flux(const int level,
                       const unsigned int c,
                       const Index &i,
                       const unsigned int half,
                       const unsigned int d,
                       const int sign,
                       const double factor,
                       Row &row) const;

    /// The sum of the fluxes into a half, but that from the other half.
    void add_half_balance(const int level,
                          const unsigned int c,
                          const Index &i,
                          const unsigned int half,
                          const double factor,
                          Row &row) const;

    std::shared_ptr<const grid::PatchRows<dim>>
    build_rows(const unsigned int p, const unsigned int direction) const;

    bool touches_finer(const unsigned int p, const unsigned int c, const Index &i) const;

    /// Whether a face of patch @p p has a row.
    bool is_corrected(const unsigned int p, const unsigned int c, const Index &i) const;

    /// Leaves the row of a face of patch @p p in @p row .value.
    void
    make_row(const unsigned int p, const unsigned int c, const Index &i, Row &row) const;

    const grid::StaggeredSpace<dim> &space;
    const grid::PatchGrid<dim> &patch_grid;
    grid::RowTable<dim> rows;
  };
} // namespace mitre::fluid

#endif
