#ifndef mitre_fluid_advection_h
#define mitre_fluid_advection_h

#include <memory>
#include <string>

#include <mitre/grid/velocity_halo.h>

namespace mitre::fluid
{
  /// How the advected velocity is reconstructed between its grid positions.
  enum class AdvectionScheme : unsigned char
  {
    /// Monotonised piecewise parabolic, upwinded (Colella and Woodward, J. Comput. Phys.
    /// 54 (1984) 174-201).
    ppm,
    /// Cubic upwind interpolation, limited (third order where smooth; Waterson and
    /// Deconinck, J. Comput. Phys. 224 (2007) 182-207).
    cui,
    /// Mean of the two neighbours; neither upwinded nor bounded.
    centered,
    /// No advection: Stokes flow.
    none
  };

  /// "PPM", "CUI", "centered", "none"; base::UserError for any other name.
  AdvectionScheme advection_scheme(const std::string &name);


  /**
   * div(u u) of the staggered velocity in conservative form: each component is advected
   * over the faces of its control volumes by the mean of the velocities next to them.
   */
  template <int dim>
  class Advection
  {
  public:
    Advection(const grid::StaggeredSpace<dim> &space, const AdvectionScheme scheme);

    /**
     * dst = div(u u), zero on faces with given velocity. With @p prescribed, tangential
     * velocities at the boundary are those; else zero.
     */
    void
    apply(grid::VectorType &dst,
          const grid::VectorType &u,
          const std::function<double(const grid::BoundaryTerm<dim> &)> &prescribed = {});

  private:
    template <AdvectionScheme scheme>
    void apply_scheme(grid::VectorType &dst,
                      const grid::VectorType &imported,
                      const bool inhomogeneous) const;

    const grid::StaggeredSpace<dim> &space;
    const AdvectionScheme scheme;
    grid::VelocityHalo<dim> halo;
  };
} // namespace mitre::fluid

#endif
