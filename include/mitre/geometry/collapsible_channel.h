#ifndef mitre_geometry_collapsible_channel_h
#define mitre_geometry_collapsible_channel_h

#include <deal.II/base/parameter_handler.h>

#include <ostream>
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

    /// Distance of nodes in the elastic part, and in the rigid ones.
    double spacing       = 1. / 64;
    double rigid_spacing = 1. / 32;

    /// The elastic part: springs and beams, or a mesh.
    bool finite_elements = false;

    /// How far the elastic part goes on, held, into the rigid ones.
    double clamped_length = 0.25;

    /// File with the place (x, y) of the elastic part at the start by material coordinate
    /// s; empty: straight. Springs have the length at rest of the straight wall.
    std::string start_shape;

    /// Of the target points, for each cm of wall [dyn/cm^2 and dyn s/cm^2].
    double wall_stiffness = 0;
    double wall_damping   = 0;

    /// Of a drag on the elastic part, for each cm of wall [dyn s/cm^2].
    double elastic_damping = 0;

    std::string output;

    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm);
  };


  /**
   * The elastic part and its clamped ends: nodes at the height of the channel's width.
   * Springs with EA/ds and beams with EI/ds^3, I = h^3/12; each end of the elastic part
   * lies midway between two nodes that are held. The outermost nodes that have a spring,
   * on which the tension of the wall pulls, are held by target points as stiff as a
   * spring, so that they give way by no more than a spring is stretched. The spacing is
   * rounded so that it divides the elastic length, the clamped length up to a multiple of
   * it. Throws base::UserError if the elastic part has fewer than 4 nodes, or if a start
   * shape does not begin and end where it does.
   */
  structure::FibreNetwork<2>
  make_elastic_wall(const CollapsibleChannelParameters &parameters);

  /// The rigid parts up to where the clamped ends begin: target points.
  structure::FibreNetwork<2>
  make_rigid_wall(const CollapsibleChannelParameters &parameters);

  /**
   * The elastic part and its clamped ends as a mesh in gmsh's format (ASCII, 2.2): one
   * layer of quadrilaterals of nine nodes about the height of the channel's width, two
   * spacings long, with corners at the ends of the elastic part. Material id 1.
   */
  void write_beam_mesh(const CollapsibleChannelParameters &parameters, std::ostream &out);

  /// Writes the fibre files, and the mesh if there is one, and returns a summary.
  std::string prepare_collapsible_channel(const CollapsibleChannelParameters &parameters);
} // namespace mitre::geometry

#endif
