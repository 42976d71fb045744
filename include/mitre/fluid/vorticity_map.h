#ifndef mitre_fluid_vorticity_map_h
#define mitre_fluid_vorticity_map_h

#include <map>

#include <mitre/grid/staggered_space.h>

namespace mitre::fluid
{
  /**
   * The refinement levels that the vorticity of a flow asks for.
   *
   * The measure of a patch is the largest vorticity times the smallest cell width: the
   * change of the velocity across a cell [cm/s] that shear makes. Where it is larger than
   * a given one, the patch shall be finer by a level, and where it is smaller than a
   * third, coarser: refinement halves the measure, so that levels do not flip.
   */
  template <int dim>
  class VorticityMap
  {
  public:
    /**
     * @param u consistent velocity [cm/s]
     * @param change change of the velocity across a cell [cm/s]
     * @param maximum_level finest level that the vorticity may ask for
     * Collective.
     */
    VorticityMap(const grid::StaggeredSpace<dim> &space,
                 const grid::VectorType &u,
                 const double change,
                 const int maximum_level);

    /**
     * The level for a leaf, whose box is that of a patch of the grid as it was, of one
     * of its children, or of its parent.
     */
    int wanted_level(const dealii::BoundingBox<dim> &leaf) const;

  private:
    using Index = std::array<int, dim>;

    Index index_of(const dealii::Point<dim> &x, const int level) const;

    const dealii::BoundingBox<dim> box;
    std::array<int, dim> base_patches;

    /// Per level: the level that is wanted in a patch or in some part of it.
    std::vector<std::map<Index, int>> wanted;
  };


  /// Largest absolute value of the vorticity [1/s] at the inner vertices (edges in 3D) of
  /// owned patch @p p.
  template <int dim>
  double compute_largest_vorticity(const grid::StaggeredSpace<dim> &space,
                                   const grid::VectorType &u,
                                   const unsigned int p);
} // namespace mitre::fluid

#endif
