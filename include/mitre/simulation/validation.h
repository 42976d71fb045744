#ifndef mitre_simulation_validation_h
#define mitre_simulation_validation_h

#include <map>
#include <ostream>
#include <string>
#include <vector>

#include <mitre/coupling/fe_coupling.h>
#include <mitre/fluid/boundary_conditions/interface.h>
#include <mitre/fluid/navier_stokes.h>
#include <mitre/structure/body.h>

namespace mitre::simulation
{
  /**
   * What a look at a run before its first step has found: errors, with which it cannot
   * go well, and warnings about what is seldom meant. Each is a whole message. The same
   * on all ranks.
   */
  struct Findings
  {
    std::vector<std::string> errors, warnings;
  };


  /// A part of a run, as the checks see it.
  template <int dim>
  struct PartView
  {
    const structure::Body<dim> &body;
    const coupling::CouplingParameters &coupling;

    /// Node positions [cm].
    const structure::VectorType &X;
  };


  /// The longest time step with which some explicit part of the scheme is stable.
  struct StepLimit
  {
    /// Which forces: "springs of the constraints", and of what they were computed.
    std::string cause;

    /// [s]; infinity if there are no such forces.
    double time_step;

    /// Which parameters to change, for a message.
    std::string remedy;
  };


  /**
   * Shape of an element: for simplices the mean ratio, 12 (3 V)^(2/3) / sum of squared
   * edges in 3D and 4 sqrt(3) A / sum of squared edges in 2D, for hypercubes the
   * least Jacobian at a vertex over the product of the lengths of the edges that meet
   * there. 1 for regular simplices and boxes, 0 for flat elements. (Liu and Joe, BIT 34
   * (1994) 268; Knupp, SIAM J. Sci. Comput. 23 (2001) 193.)
   */
  template <int dim>
  double element_quality(const structure::Mesh<dim> &mesh, const unsigned int e);


  /**
   * Sizes, element quality, size of the elements in grid cells and distance to the walls
   * of a part; warns of bad elements, of elements much finer or coarser than the cells,
   * of kernels that reach a wall which the part does not touch, and of sizes that look
   * like another unit of length.
   */
  template <int dim>
  void check_part(const PartView<dim> &part,
                  const grid::PatchGrid<dim> &grid,
                  Findings &findings,
                  std::ostream &out);

  /// Warns of nodes under whose kernel the grid has more than one level. Collective.
  template <int dim>
  void check_levels(const PartView<dim> &part,
                    const grid::PatchGrid<dim> &grid,
                    Findings &findings);

  /**
   * Area of the box's faces where each boundary condition holds [cm^(dim-1)], and range
   * of its pressures or largest velocity from @p start to @p end [s]; warns of conditions
   * that hold nowhere and of pressures and speeds that look like another unit.
   * Collective. Returns the difference between the largest and the smallest pressure
   * [dyn/cm^2].
   */
  template <int dim>
  double check_boundaries(const fluid::BoundaryConditions<dim> &conditions,
                          const grid::PatchGrid<dim> &grid,
                          const double start,
                          const double end,
                          Findings &findings,
                          std::ostream &out);

  /// Warns of a density or viscosity that looks like another unit.
  void check_fluid(const fluid::FluidParameters &parameters, Findings &findings);

  /**
   * Warns of tables that are not repeated and do not cover the time from @p start to @p
   * end [s].
   *
   * @param parameters by path, as from base::list_parameter_values(): a table is a
   * parameter "... file" or "... table" beside one "... extension".
   */
  void check_tables(const std::map<std::string, std::string> &parameters,
                    const double start,
                    const double end,
                    Findings &findings);

  /**
   * Longest stable steps for the forces of the constraints: those that follow positions
   * and those that follow velocities.
   *
   * With A the map from positions to minus the acceleration of the nodes (force density,
   * spread, divided by the density of the fluid, interpolated), the midpoint rule is
   * stable for dt <= 2/sqrt(mu), mu the largest eigenvalue of A; with B the same map from
   * velocities, and forces taken at the beginning of the step, for dt <= 2/mu. Both are
   * found by power iteration. The projection to divergence-free velocities is left out:
   * it is orthogonal and can only make mu smaller, so that thin plates bear longer steps.
   *
   * @p coupling must have points. Collective.
   */
  template <int dim>
  std::vector<StepLimit>
  constraint_step_limits(const std::vector<PartView<dim>> &parts,
                         coupling::FECoupling<dim> &coupling,
                         const fluid::StokesOperators<dim> &operators,
                         const double density);

  /// Adds an error or a warning for each limit that @p time_step [s] exceeds.
  void check_step_limits(const std::vector<StepLimit> &limits,
                         const double time_step,
                         Findings &findings,
                         std::ostream &out);

  /// Throws base::UserError unless files can be made in @p folder, or in the nearest of
  /// its parents that is there.
  void check_output_folder(const std::string &folder);
} // namespace mitre::simulation

#endif
