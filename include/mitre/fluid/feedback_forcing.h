#ifndef mitre_fluid_feedback_forcing_h
#define mitre_fluid_feedback_forcing_h

#include <vector>

#include <mitre/fluid/boundary_conditions/interface.h>

namespace mitre::fluid
{
  /**
   * Feedback forcing, (3.4) of the thesis: a body force [dyn/cm^3]
   *
   *   f = k (u_b - u),  k = s rho / dt * (1 + cos(pi z / w)) / 2
   *
   * at a distance z < w from the parts of the boundary whose condition asks for it. Next
   * to given velocities (walls too) u_b is that of the nearest point of the boundary, and
   * the force acts on all components; next to open boundaries it acts on the tangential
   * components, with u_b = 0, and, where the condition has backflow damping, on a normal
   * velocity that points into the domain. The width w is a number of cells of the grid
   * where the force acts, and s is FeedbackParameters::strength (0.5 in the thesis,
   * without the ramp). Where several conditions act on a component, the strongest force
   * counts.
   *
   * u is the velocity at the beginning of a time step, so that a step takes the fraction
   * s (1 + cos) / 2 of the difference away: at most all of it, as s is at most 1.
   */
  template <int dim>
  class FeedbackForcing
  {
  public:
    /// Finds the faces that the force acts on. @p conditions are needed as long as this
    /// is.
    FeedbackForcing(const grid::StaggeredSpace<dim> &space,
                    const BoundaryConditions<dim> &conditions);

    /// True if a condition asks for a force (on all ranks the same).
    bool active() const
    {
      return is_active;
    }

    /**
     * @p force = k (u_b - u) with k = @p rho_over_dt [g/(cm^3 s)] times the strengths and
     * ramps, and u_b at @p time; consistent. Collective.
     */
    void compute_force(grid::VectorType &force,
                       const grid::VectorType &u,
                       const double time,
                       const double rho_over_dt) const;

  private:
    struct Face
    {
      std::size_t dof;
      double weight;          ///< strength times ramp
      double inward;          ///< +-1: damp flow in this direction only; 0: any flow
      unsigned int component; ///< of the velocity
      unsigned int condition;
      dealii::Point<dim> x; ///< nearest point of the boundary
    };

    const grid::StaggeredSpace<dim> &space;
    const BoundaryConditions<dim> &conditions;
    bool is_active = false;
    std::vector<Face> faces; ///< those of one entry follow each other, strongest first
  };
} // namespace mitre::fluid

#endif
