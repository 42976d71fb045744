#ifndef mitre_geometry_prosthesis_h
#define mitre_geometry_prosthesis_h

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

#include <mitre/geometry/annulus.h>
#include <mitre/geometry/fibre_surface.h>

namespace mitre::geometry
{
  /**
   * A chorded mitral valve prosthesis of polyurethane (section 3.4), its housing disc and
   * its tube. Lengths in cm, areas in cm^2, moduli in dyn/cm^2. Axes are those of
   * MitralValveParameters: blood flows in the direction x, the anterior leaflet lies on
   * the +y side, the commissures on the -z and +z sides.
   */
  struct ProsthesisParameters
  {
    std::string output_folder;

    double annulus_x = 0, axis_y = 0, axis_z = 0;

    /// The D: its width, and how far it reaches from the commissures to each side.
    double width = 0, anterior_depth = 0, posterior_depth = 0;

    double post_height = 0, post_width = 0;

    SheetParameters sheet;
    double anterior_length = 0, posterior_length = 0, commissural_length = 0;
    double anterior_angle = 0, posterior_angle = 0;
    double coaptation_y = 0, coaptation_x = 0, minimum_coaptation_height = 0;

    unsigned int n_anterior_chordae = 0, n_posterior_chordae = 0;
    double chord_area = 0, chord_modulus = 0, chord_slack = 0;

    /// Whether leaflets and chordae have beams.
    bool leaflet_bending = true, chordal_bending = true;
    double attachment_x = 0, attachment_y = 0, attachment_distance = 0;

    double leaflet_spacing = 0, chord_spacing = 0, rigid_spacing = 0;
    double target_stiffness = 0, target_damping = 0, attachment_stiffness = 0;

    double tube_inner_diameter = 0, tube_thickness = 0, tube_length = 0;
    double tube_element_size = 0;

    static void declare_parameters(dealii::ParameterHandler &prm);

    /// Throws base::UserError for values that do not fit together.
    void parse_parameters(dealii::ParameterHandler &prm);
  };


  /**
   * The leaflets of the prosthesis as one skirt, over an angle a about the tube's axis:
   * 0 in the middle of the anterior leaflet, 90 and -90 degrees at the commissures.
   *
   * The annulus is a D: for cos(a) < 0 half an ellipse, else flattened,
   * @f[ y = d (1 - (1 - \cos a)^{p/d}),\quad z = \tfrac12 w \sin a, @f]
   * with the anterior depth d and the posterior depth p, so that both halves meet without
   * a corner. The bound edge of the leaflets follows it and rises, in the direction of
   * the flow, by the height of the posts at the commissures.
   */
  class ProsthesisShape
  {
  public:
    explicit ProsthesisShape(const ProsthesisParameters &parameters);

    /// The D in the plane of the annulus.
    Point3 annulus(const double angle) const;

    /// The edge at which the leaflets are held.
    Point3 bound_edge(const double angle) const;

    /// From bound to free edge.
    double length(const double angle) const;

    /// Point of the leaflet at @p v, from 0 on the bound to 1 on the free edge: meridians
    /// are straight, and lean inward from the flow's direction.
    Point3 point(const double angle, const double v) const;

    /// Where a meridian meets the other leaflet in the closed valve: a parabola from post
    /// to post.
    Point3 coaptation_point(const double angle) const;

    /// The free edge in the closed valve: what is left of a meridian behind the
    /// coaptation line hangs down in the direction of the flow.
    Point3 closed_free_edge(const double angle) const;

    /// Angles at fractions i / n of the length of the D.
    std::vector<double> angles(const unsigned int n) const;

    /// Length of the D [cm], and the area within [cm^2].
    double annulus_length() const;
    double annulus_area() const;

    /// Area within the free edge at the start, projected along x [cm^2].
    double orifice_area() const;

  private:
    ProsthesisParameters parameters;
    SampledLength arc;
  };


  /// A chord along a meridian of a leaflet and on to an attachment point.
  struct ProsthesisChord
  {
    /// Of its meridian, and 1 or -1 for the attachment point at +z or -z.
    double angle = 0;
    int side     = 1;

    /// From the free edge to the attachment point: at the start, in the closed valve, and
    /// at rest [cm].
    double start_length = 0, closed_length = 0, rest_length = 0;
  };


  /// The fibres of a prosthesis: leaflets with chordae, and the housing disc with posts.
  struct Prosthesis
  {
    structure::FibreNetwork<3> valve, disc;
    std::vector<ProsthesisChord> chordae;

    /// How many of the valve's springs and beams belong to the leaflets; those of chordae
    /// come after them, and springs have the force function 1.
    unsigned int n_leaflet_springs = 0, n_leaflet_beams = 0;
  };


  /**
   * Leaflets of make_fibres(), at rest as they are made. Chordae (EA/ds, and EI/ds^3 of a
   * round section) share the nodes of a meridian of the leaflets from the bound to the
   * free edge; behind it they are straight, with a rest length that is at least that in
   * the closed valve times (1 + slack). Nodes of the bound edge and the attachment points
   * are target points, as is every node of the disc.
   *
   * Throws base::UserError if a leaflet is too short to close.
   */
  Prosthesis make_prosthesis(const ProsthesisParameters &parameters);


  /// Writes valve.*, disc.* (fibre files) and tube.msh, and returns a summary.
  std::string prepare_prosthesis(const ProsthesisParameters &parameters);
} // namespace mitre::geometry

#endif
