#ifndef mitre_coupling_patch_loops_h
#define mitre_coupling_patch_loops_h

#include <array>
#include <string>

#include <mitre/coupling/part_points.h>

namespace mitre::coupling
{
  /**
   * Arrays of the velocity components on a patch and the layers about it, as
   * grid::VelocityHalo fills them, with room for reads of whole vectors at the end.
   */
  template <int dim>
  struct PaddedPatch
  {
    PaddedPatch(const std::array<std::array<unsigned int, dim>, dim> &extents,
                const unsigned int width);

    std::array<std::array<unsigned int, dim>, dim> extents;
    unsigned int width;
    std::array<std::vector<double>, dim> values;

    /// Cells of the patch along an edge.
    unsigned int n_cells() const
    {
      return extents[0][0] - 1 - 2 * width;
    }
  };


  /// Where patch p is: corner, reciprocal spacings, and the box's length in spacings in
  /// periodic directions (0 in others).
  template <int dim>
  struct PatchFrame
  {
    PatchFrame(const grid::PatchGrid<dim> &grid, const unsigned int p);

    std::array<double, dim> lower;
    std::array<double, dim> inverse_h;
    std::array<double, dim> period;
  };


  /**
   * For all points q of a part in patch @p p, add
   * @f$\phi_a(q)\, w_q \sum_i u_i\, \delta(x_i - X_q)@f$ to the nodes of their elements.
   *
   * @param moments by local node and component
   */
  template <int dim>
  void interpolate_patch(PartPoints<dim> &points,
                         const std::string &kernel,
                         const PatchFrame<dim> &frame,
                         const unsigned int p,
                         const PaddedPatch<dim> &velocity,
                         double *moments);


  /**
   * For all points q of a part in patch @p p, add the force
   * @f$w_q \sum_a \phi_a(q) F_a@f$ [dyn], distributed by the kernel, to the faces.
   *
   * @param densities nodal force densities by local node and component
   */
  template <int dim>
  void spread_patch(PartPoints<dim> &points,
                    const std::string &kernel,
                    const PatchFrame<dim> &frame,
                    const unsigned int p,
                    const double *densities,
                    PaddedPatch<dim> &force);
} // namespace mitre::coupling

#endif
