#ifndef mitre_fluid_stokes_operators_h
#define mitre_fluid_stokes_operators_h

#include <memory>
#include <vector>

#include <mitre/fluid/viscous_fluxes.h>
#include <mitre/grid/cell_halo.h>
#include <mitre/grid/staggered_space.h>
#include <mitre/grid/velocity_halo.h>

namespace mitre::fluid
{
  /**
   * Staggered difference operators on the composite grid: vector Laplacian, pressure
   * gradient and divergence, all in the form of values per volume.
   *
   * With V the cell volumes and W the faces' control volumes, W grad = - C^T D^T V where
   * D is the divergence of all faces and C gives the copied faces from their masters (see
   * grid::StaggeredSpace), so that div grad is symmetric and the pressure does no work on
   * a divergence-free velocity, also across levels. Open boundary faces are half a cell
   * from the pressure next to them.
   *
   * Results are zero on faces with given velocity, and consistent.
   */
  template <int dim>
  class StokesOperators
  {
  public:
    /**
     * Builds the one-layer halos and finalizes @p space, whose vectors can be made after
     * this.
     */
    explicit StokesOperators(grid::StaggeredSpace<dim> &space);

    void initialize_velocity(grid::VectorType &u) const
    {
      space.initialize_vector(u);
    }

    void initialize_pressure(grid::VectorType &p) const
    {
      cell_halo.initialize_vector(p);
    }

    /// dst = a u + b laplace(u); prescribed boundary values enter if @p inhomogeneous.
    void apply_helmholtz(grid::VectorType &dst,
                         grid::VectorType &u,
                         const double a,
                         const double b,
                         const bool inhomogeneous) const;

    /// dst = (add ? dst : 0) + factor grad p, with zero pressure on open faces.
    void apply_gradient(grid::VectorType &dst,
                        grid::VectorType &p,
                        const bool add,
                        const double factor = 1.) const;

    /// dst = factor div u; @p u must be consistent.
    void apply_divergence(grid::VectorType &dst,
                          const grid::VectorType &u,
                          const double factor = 1.) const;

    /**
     * The product of a time step, momentum = a u + b laplace(u) + grad p and
     * mass = factor div u with homogeneous boundary values, in one sweep over the
     * patches.
     */
    void apply_stokes(grid::VectorType &momentum,
                      grid::VectorType &mass,
                      grid::VectorType &u,
                      grid::VectorType &p,
                      const double a,
                      const double b,
                      const double factor) const;

    /**
     * Makes the divergence of the 2^dim cells of each block of cells that may be one
     * coarser cell the same, by the smallest change of the velocities inside of the
     * blocks: div u = 0 in cells that are refined is inherited by the finer ones.
     */
    void equalize_divergence_in_blocks(grid::VectorType &u) const;

    /// Largest |div u| over all cells [1/s].
    double max_divergence(const grid::VectorType &u) const;

    /// Largest velocity component times dt / h over all faces.
    double max_courant_number(const grid::VectorType &u, const double dt) const;

    /// Mean of @p p over the box.
    double mean_pressure(const grid::VectorType &p) const;

    /// Sets the prescribed tangential velocities for inhomogeneous products.
    void set_boundary_values(
      const std::function<double(const grid::BoundaryTerm<dim> &)> &prescribed)
    {
      velocity_halo.set_boundary_values(prescribed);
      viscous_fluxes.set_boundary_values(prescribed);
    }

    const grid::StaggeredSpace<dim> &velocity_space() const
    {
      return space;
    }

    /// The halo of one layer of apply_helmholtz().
    const grid::VelocityHalo<dim> &helmholtz_halo() const
    {
      return velocity_halo;
    }

    const grid::CellHalo<dim> &pressure_halo() const
    {
      return cell_halo;
    }

  private:
    /// The parts of the operators on owned patch @p p; @p padded is room for a halo.
    void helmholtz_on_patch(grid::VectorType &dst,
                            const grid::VectorType &u,
                            const unsigned int p,
                            const double a,
                            const double b,
                            const bool inhomogeneous,
                            std::vector<double> &padded) const;
    void gradient_on_patch(grid::VectorType &dst,
                           const grid::VectorType &pressure,
                           const unsigned int p,
                           const bool add,
                           const double factor,
                           std::vector<double> &padded) const;
    void divergence_on_patch(grid::VectorType &dst,
                             const grid::VectorType &u,
                             const unsigned int p,
                             const double factor) const;

    /// Adds factor grad p on coarse-fine interfaces.
    void add_interface_gradient(grid::VectorType &dst,
                                const grid::VectorType &pressure,
                                const double factor) const;

    void finish(grid::VectorType &dst) const;

    grid::StaggeredSpace<dim> &space;
    const grid::PatchGrid<dim> &patch_grid;
    const unsigned int n;
    grid::VelocityHalo<dim> velocity_halo;
    ViscousFluxes<dim> viscous_fluxes;
    grid::CellHalo<dim> cell_halo;
    mutable grid::VectorType interface_forces;

    /// Faces on coarse-fine interfaces, of both sides: the cell of the same patch that
    /// touches them, and the signed area that its pressure acts on.
    struct InterfaceFace
    {
      std::size_t dof;
      unsigned int cell;
      double area;
    };
    std::vector<InterfaceFace> interface_faces;
    void set_interface_forces(const grid::VectorType &pressure) const;
    /// Masters that forces on interfaces reach, and copies that hand them on.
    std::vector<std::size_t> interface_masters;
    std::vector<std::pair<std::size_t, std::size_t>> interface_copies;
  };
} // namespace mitre::fluid

#endif
