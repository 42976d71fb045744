#ifndef mitre_geometry_collapsible_channel_h
#define mitre_geometry_collapsible_channel_h

#include <deal.II/base/parameter_handler.h>

#include <string>

#include <mitre/io/fibre_files.h>

namespace mitre::geometry
{
  /**
   * The upper wall of a plane channel (section 3.3): rigid, elastic, rigid. Lengths in
   * cm; forces and stiffnesses are those of a layer of 1 cm.
   */
  struct CollapsibleChannelParameters
  {
    double width             = 1;
    double upstream_length   = 5;
    double elastic_length    = 5;
    double downstream_length = 30;

    /// Of the elastic part in plane strain, E / (1 - nu^2) [dyn/cm^2].
    double modulus   = 6e6;
    double thickness = 0.01;

    /// Distance of nodes.
    double spacing = 1. / 64;

    /// Of the target points of the rigid parts, for each cm of wall [dyn/cm^2 and
    /// dyn s/cm^2].
    double wall_stiffness = 0;
    double wall_damping   = 0;

    std::string output;

    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm);
  };


  /**
   * Nodes at the height of the channel's width, from half a spacing on. Springs with
   * EA/ds and beams with EI/ds^3 in the elastic part, I = h^3/12, whose ends are clamped:
   * each end lies midway between two nodes that are held. The spacing is rounded so that
   * it divides the elastic length, and the rigid parts end at most one spacing early.
   * Throws base::UserError if the elastic part has fewer than 4 nodes.
   */
  structure::FibreNetwork<2>
  make_collapsible_wall(const CollapsibleChannelParameters &parameters);

  /// Writes the fibre files and returns a summary.
  std::string prepare_collapsible_channel(const CollapsibleChannelParameters &parameters);
} // namespace mitre::geometry

#endif
