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
    /// Piecewise parabolic edge values, upwinded, monotonised but where there is a smooth
    /// extremum (limiter of Suresh and Huynh, J. Comput. Phys. 136 (1997) 83-99, as used
    /// for such values by Rider, Greenough and Kamm, J. Comput. Phys. 225 (2007) 1827).
    ppm,
    /// Piecewise parabolic, upwinded, monotonised everywhere, which flattens extrema
    /// (Colella and Woodward, J. Comput. Phys. 54 (1984) 174-201).
    monotone_ppm,
    /// Cubic upwind interpolation, limited (third order where smooth; Waterson and
    /// Deconinck, J. Comput. Phys. 224 (2007) 182-207).
    cui,
    /// Mean of the two neighbours; neither upwinded nor bounded.
    centered,
    /// No advection: Stokes flow.
    none
  };

  /// "PPM", "monotone PPM", "CUI", "centered", "none"; base::UserError for any other
  /// name.
  AdvectionScheme advection_scheme(const std::string &name);


  /**
   * div(u u) of the staggered velocity [cm/s^2] in conservative form: each component is
   * advected over the faces of its control volumes by the mean of the velocities next to
   * them.
   *
   * Where levels meet, fluxes match, so that advection neither makes nor loses momentum.
   * Each patch balances the parts of the control volumes that lie in it (half volumes for
   * the faces on its outermost planes), and C^T of grid::StaggeredSpace adds the balances
   * of all copies of a face to its master. Components along an interface take the flux
   * through it from the finer side, where a part of a fine control volume belongs to the
   * coarse control volume that it touches; components normal to it exchange the squares
   * of the fine faces' velocities.
   *
   * The schemes are bounded in space (a forward Euler step makes no new extremum if the
   * sum of the Courant numbers of all directions is at most 1/3, as the value at a face
   * is at most thrice as far from the upwind neighbour as the one in the middle); with
   * Adams-Bashforth steps that is 4/9 of it (Hundsdorfer, Ruuth and Spiteri, SIAM J.
   * Numer. Anal. 41 (2003) 605-623), 0.148.
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

    /// The halo that it reads velocities with: three layers across the sides.
    grid::VelocityHalo<dim> &velocity_halo()
    {
      return halo;
    }

  private:
    template <AdvectionScheme scheme>
    void apply_scheme(grid::VectorType &dst,
                      const grid::VectorType &imported,
                      const bool inhomogeneous);
    void build_matches();
    void shift_fluxes(const unsigned int p,
                      const unsigned int c,
                      const unsigned int d,
                      std::vector<double> &flux) const;
    void match_fluxes(const unsigned int p,
                      const unsigned int c,
                      const unsigned int d,
                      const std::vector<double> &u,
                      std::vector<double> &flux);

    const grid::StaggeredSpace<dim> &space;
    const AdvectionScheme scheme;
    grid::VelocityHalo<dim> halo;

    /// What the flux (or squared velocity) at a place of a fine patch's array gives to
    /// the balance of a coarse face: weight * flux.
    struct Match
    {
      unsigned int flux;
      dealii::types::global_dof_index coarse; ///< entry; its local number once built
      double weight;                          ///< signed area [cm^(dim-1)]
    };
    std::vector<Match> matches;
    /// Per patch, component, direction and end.
    std::vector<unsigned int> match_starts;
    /// Sums of what coarse faces receive from fine patches, and the owned ones that do.
    grid::VectorType received;
    std::vector<unsigned int> receivers;
  };
} // namespace mitre::fluid

#endif
