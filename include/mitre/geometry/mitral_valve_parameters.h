#ifndef mitre_geometry_mitral_valve_parameters_h
#define mitre_geometry_mitral_valve_parameters_h

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace mitre::geometry
{
  /**
   * Sizes of the parametric mitral valve, its housing disc and its tube.
   * Lengths are in cm, areas in cm^2, angles in degrees.
   *
   * The tube axis is the line (x, @p axis_y, @p axis_z); blood flows from the atrium
   * (small x) to the ventricle (large x). The anterior leaflet hangs on the +y side; the
   * commissures lie on the -z and +z sides. "Depth" is the distance from the annular mean
   * plane in direction +x, that is, into the ventricle.
   *
   * Default values, admissible ranges and help texts stand in one table in the source
   * file.
   */
  struct MitralValveParameters
  {
    std::string output_folder;
    bool write_closed_shape = false;

    std::string annulus_shape;
    double annulus_x             = 0;
    double annulus_ap_diameter   = 0;
    double annulus_comm_diameter = 0;
    double saddle_ratio          = 0;
    double anterior_fraction     = 0;
    double axis_y                = 0;
    double axis_z                = 0;

    double anterior_length      = 0;
    double posterior_length     = 0;
    double commissural_length   = 0;
    double anterior_fullness    = 0;
    double posterior_fullness   = 0;
    double scallop_depth        = 0;
    double leaflet_thickness    = 0;
    double leaflet_element_size = 0;
    unsigned int leaflet_layers = 0;
    double root_length          = 0;

    double orifice_ap_width   = 0;
    double orifice_comm_width = 0;
    double orifice_centre     = 0;
    double profile_angle      = 0;

    double coaptation_position       = 0;
    double coaptation_depth          = 0;
    double minimum_coaptation_height = 0;

    unsigned int n_anterior_chordae  = 0;
    unsigned int n_posterior_chordae = 0;
    double strut_position            = 0;
    double chord_area                = 0;
    double chord_slack               = 0;
    double papillary_depth           = 0;
    double papillary_distance        = 0;
    double papillary_offset          = 0;
    double tip_radius                = 0;
    double run_in                    = 0;
    double run_in_width              = 0;
    double root_gap                  = 0;
    double anchor_length             = 0;
    double bow_downstream            = 0;
    double chord_element_size        = 0;
    unsigned int chord_cells_across  = 0;

    double disc_thickness    = 0;
    double disc_overlap      = 0;
    double disc_shift        = 0;
    double disc_element_size = 0;
    unsigned int disc_layers = 0;

    double tube_inner_diameter = 0;
    double tube_thickness      = 0;
    double tube_length         = 0;
    double tube_element_size   = 0;
    unsigned int tube_layers   = 0;

    /** Saddle height (cm): ratio times commissural diameter, zero for the elliptical
     * annulus. */
    double saddle_height() const;

    /** Declare all entries in the current subsection of @p prm. */
    static void declare_parameters(dealii::ParameterHandler &prm);

    /**
     * Read all entries and call check(). Throws base::UserError that names the parameter,
     * its value and what is expected.
     */
    void parse_parameters(dealii::ParameterHandler &prm);

    /** Conditions between several parameters; throws base::UserError. */
    void check() const;
  };
} // namespace mitre::geometry

#endif
