#ifndef mitre_instruments_observation_h
#define mitre_instruments_observation_h

#include <string>
#include <vector>

#include <mitre/structure/body.h>

namespace mitre::fluid
{
  template <int dim>
  class NavierStokes;
  template <int dim>
  class BoundaryConditions;
} // namespace mitre::fluid

namespace mitre::coupling
{
  template <int dim>
  class FECoupling;
}

namespace mitre::instruments
{
  /// A part, the positions X [cm] and the velocities U [cm/s] of its nodes.
  template <int dim>
  struct ObservedPart
  {
    const structure::Body<dim> *body;
    const structure::VectorType *X;
    const structure::VectorType *U;

    /// The positions at which forces act if these are not X, as in rigid bodies.
    const structure::VectorType *pulled = nullptr;
  };


  /// What instruments see of a run at a time.
  template <int dim>
  struct Observation
  {
    /// [s]
    double time = 0;

    /// The step that led here [s]; 0 at the start.
    double dt = 0;

    const fluid::NavierStokes<dim> *fluid = nullptr;

    std::vector<ObservedPart<dim>> parts;

    /// How the parts meet the fluid; null if there are none.
    const coupling::FECoupling<dim> *coupling = nullptr;

    const fluid::BoundaryConditions<dim> *boundary_conditions = nullptr;

    /// The part @p name; base::UserError, which names @p instrument, if there is none.
    const ObservedPart<dim> &find_part(const std::string &name,
                                       const std::string &instrument) const;

    /// The body of the part @p name; base::UserError, which names @p instrument, if it is
    /// not of finite elements.
    const structure::FiniteElementBody<dim> &
    find_finite_elements(const std::string &name, const std::string &instrument) const;
  };
} // namespace mitre::instruments

#endif
