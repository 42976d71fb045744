#ifndef mitre_structure_stable_time_step_h
#define mitre_structure_stable_time_step_h

#include <functional>
#include <string>

#include <mitre/structure/body.h>

namespace mitre::structure
{
  /// What bounds the time step of a part.
  struct StableTimeStep
  {
    /// [s]; infinite if nothing moves the part.
    double time_step;

    /// Highest frequency of the part in the fluid [1/s], and the highest rate at which
    /// its damping takes velocity away [1/s].
    double frequency;
    double damping_rate;

    std::string part;

    /// What contributes most to the mode of the highest frequency (or, if damping bounds
    /// the step, of the fastest damping): "material chordae", "constraint annulus", "load
    /// drag".
    std::string limited_by;
  };


  /// Maps a force density of a body, as Body::compute_force_density() gives it, to the
  /// accelerations of its nodes times the density of the fluid. Linear.
  using Mobility =
    std::function<void(const VectorType &force_density, VectorType &acceleration)>;


  /**
   * The longest time step that the explicit coupling of a part can take, from the largest
   * eigenvalue of @f$M^{-1}K@f$ at the positions @p X, with K the derivative of all nodal
   * forces, by power iteration (from below, usually within 2 per cent). The tissue moves
   * with as much fluid as it displaces, thus with
   * @f[ \omega^2 = \lambda_{max}(M^{-1}K)/\rho, \quad
   *     \Delta t = \left(\sqrt{c^2 + 4\omega^2} - c\right)/\omega^2 @f]
   * where c is the largest rate of damping over @f$\rho@f$: the bound of central
   * differences with lagging damping.
   *
   * With @p mobility the fluid moves it instead: the force density spread to the grid,
   * made divergence-free and interpolated. That allows steps several times as long, as
   * changes of volume and motions that the grid does not resolve move nothing. Fibres
   * have no mass of their own and need it.
   *
   * An estimate: materials and fibres stiffen as they are stretched, and slack fibres
   * count half, so that a part that will be loaded may need shorter steps. Viscosity
   * changes little, as Crank-Nicolson leaves this bound where it is. Collective.
   *
   * @param density of the fluid [g/cm^3]
   * @param mobility needed for fibres; if there is none, the body moves with the fluid
   * that it displaces
   */
  template <int dim>
  StableTimeStep estimate_stable_time_step(const Body<dim> &body,
                                           const VectorType &X,
                                           const double t,
                                           const double density,
                                           const Mobility &mobility = {});
} // namespace mitre::structure

#endif
