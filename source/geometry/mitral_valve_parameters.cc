#include <deal.II/base/patterns.h>

#include <cmath>
#include <sstream>
#include <variant>
#include <vector>

#include <mitre/base/exceptions.h>
#include <mitre/geometry/mitral_valve_parameters.h>

namespace mitre::geometry
{
  namespace
  {
    using P = MitralValveParameters;

    struct Entry
    {
      const char *section; // "" is the top level
      const char *name;
      std::variant<double P::*, unsigned int P::*> member;
      double value, lower, upper;
      const char *help;
    };

    // clang-format off
    const std::vector<Entry> &
    entries()
    {
      static const std::vector<Entry> table = {
        {"Annulus", "Plane", &P::annulus_x, 4.0, 0.5, 100.,
         "x of the annular mean plane (cm)."},
        {"Annulus", "Axis y", &P::axis_y, 4.0, 0., 100.,
         "y of the tube axis, which is also the centre of the annulus (cm)."},
        {"Annulus", "Axis z", &P::axis_z, 4.0, 0., 100.,
         "z of the tube axis (cm)."},
        {"Annulus", "Anterior-posterior diameter", &P::annulus_ap_diameter, 2.9, 1., 8.,
         "Width of the annulus in y (cm)."},
        {"Annulus", "Commissural diameter", &P::annulus_comm_diameter, 3.9, 1., 8.,
         "Width of the annulus in z (cm)."},
        {"Annulus", "Saddle ratio", &P::saddle_ratio, 0.17, 0., 0.4,
         "Height of the saddle divided by the commissural diameter (1)."},
        {"Annulus", "Anterior fraction", &P::anterior_fraction, 0.38, 0.2, 0.6,
         "Part of the annulus' length that carries the anterior leaflet (1)."},

        {"Leaflets", "Anterior length", &P::anterior_length, 2.75, 0.3, 6.,
         "Length from the annulus to the free edge in the middle of the anterior leaflet (cm)."},
        {"Leaflets", "Posterior length", &P::posterior_length, 1.85, 0.3, 6.,
         "The same for the posterior leaflet (cm)."},
        {"Leaflets", "Commissural length", &P::commissural_length, 1.1, 0.2, 6.,
         "The same at the commissures (cm)."},
        {"Leaflets", "Anterior fullness", &P::anterior_fullness, 2.6, 0.7, 8.,
         "Exponent p of the length's way from the middle (s = 0) to the commissures (s = 1): "
         "commissural + (middle - commissural) cos^2(pi/2 |s|^p). Larger is fuller (1)."},
        {"Leaflets", "Posterior fullness", &P::posterior_fullness, 5.0, 0.7, 8.,
         "The same for the posterior leaflet (1)."},
        {"Leaflets", "Scallop depth", &P::scallop_depth, 0.05, 0., 0.4,
         "Part of the posterior length that is missing in the two clefts between its three "
         "scallops (1)."},
        {"Leaflets", "Thickness", &P::leaflet_thickness, 0.1, 0.005, 0.5,
         "Thickness of the leaflets (cm)."},
        {"Leaflets", "Element size", &P::leaflet_element_size, 0.2, 0.005, 2.,
         "Edge length to aim at along the leaflets (cm)."},
        {"Leaflets", "Layers", &P::leaflet_layers, 1, 1, 20,
         "Layers of elements through the thickness."},
        {"Leaflets", "Root length", &P::root_length, 0.25, 0., 1.,
         "The leaflets reach this far outward past the annulus, inside the disc; this root has a "
         "material id of its own, by which it can be held (cm)."},

        {"Start shape", "Orifice anterior-posterior width", &P::orifice_ap_width, 1.6, 0.1, 6.,
         "Width in y of the ellipse on which the free edge lies when looked at along x (cm)."},
        {"Start shape", "Orifice commissural width", &P::orifice_comm_width, 3.2, 0.1, 6.,
         "Width of that ellipse in z (cm)."},
        {"Start shape", "Orifice centre", &P::orifice_centre, 0.0, -2., 2.,
         "y of the ellipse's centre relative to the tube axis (cm)."},
        {"Start shape", "Profile angle", &P::profile_angle, 5., 0., 45.,
         "A leaflet's section from annulus to free edge is an arc of a circle; angle between "
         "the arc's end tangents and its chord (degrees). It makes the funnel a bell mouth."},

        {"Closed shape", "Coaptation position", &P::coaptation_position, 0.33, 0.1, 0.9,
         "Distance between the middle of the coaptation line and the posterior annulus, divided "
         "by the anterior-posterior diameter (1)."},
        {"Closed shape", "Coaptation depth", &P::coaptation_depth, 0.4, -1., 2.,
         "Depth of the middle of the coaptation line below the annular mean plane (cm)."},
        {"Closed shape", "Minimum coaptation height", &P::minimum_coaptation_height, 0.3, 0., 2.,
         "Shortest acceptable length of leaflet left for coaptation when the leaflet is "
         "stretched straight from annulus to coaptation line; less is an error (cm)."},

        {"Chordae", "Anterior number", &P::n_anterior_chordae, 6, 2, 40,
         "Number of chordae of the anterior leaflet; even. From 6 on, two of them are struts."},
        {"Chordae", "Posterior number", &P::n_posterior_chordae, 10, 2, 40,
         "Number of chordae of the posterior leaflet; even."},
        {"Chordae", "Strut position", &P::strut_position, 0.8, 0.3, 1.,
         "Where the two anterior strut chordae insert: 0 is the annulus, 1 the free edge (1)."},
        {"Chordae", "Area", &P::chord_area, 0.016, 1e-4, 0.2,
         "Cross section of one chord, a square (cm^2)."},
        {"Chordae", "Slack", &P::chord_slack, 1.0, 0.8, 1.3,
         "Length of a chord divided by the distance between its papillary anchor and its "
         "insertion in the assumed closed valve (1)."},
        {"Chordae", "Papillary depth", &P::papillary_depth, 3.5, 0.5, 10.,
         "Depth of the papillary tips below the annular mean plane (cm)."},
        {"Chordae", "Papillary distance", &P::papillary_distance, 3.9, 0.5, 8.,
         "Distance between the two papillary tips, in z (cm)."},
        {"Chordae", "Papillary offset", &P::papillary_offset, -0.3, -3., 3.,
         "y of the papillary tips relative to the tube axis (cm)."},
        {"Chordae", "Tip radius", &P::tip_radius, 0.3, 0., 1.,
         "The chordae of a papillary tip start from a half circle of this radius, on the side "
         "that faces the valve (cm)."},
        {"Chordae", "Run-in", &P::run_in, 1.0, 0.02, 1.,
         "Chordae run on inside the leaflet, along its meridian towards the annulus: part of the "
         "way from the insertion to 'Root gap' before the annulus. The ribs that they form carry "
         "the load between annulus and free edge, where the leaflets have no fibres (1)."},
        {"Chordae", "Run-in width", &P::run_in_width, 0.25, 0.01, 1.,
         "Width in the plane of the leaflet that a chord takes there at constant area (cm)."},
        {"Chordae", "Root gap", &P::root_gap, 0.25, 0., 2.,
         "Distance from the annulus at which the chordae end, so that the leaflets can turn "
         "about their roots (cm)."},
        {"Chordae", "Anchor length", &P::anchor_length, 0.2, 0., 1.,
         "Length by which a chord is prolonged beyond its papillary anchor, to be held there "
         "(cm)."},
        {"Chordae", "Bow downstream", &P::bow_downstream, 0.3, -5., 5.,
         "A slack chord is bowed away from the tube axis plus this weight times the direction "
         "of the flow (1)."},
        {"Chordae", "Element size", &P::chord_element_size, 0.25, 0.005, 2.,
         "Edge length to aim at along the chordae (cm)."},
        {"Chordae", "Cells across", &P::chord_cells_across, 1, 1, 10,
         "Cells along each side of a chord's square section."},

        {"Disc", "Thickness", &P::disc_thickness, 0.25, 0.01, 2.,
         "Thickness of the housing disc (cm)."},
        {"Disc", "Overlap", &P::disc_overlap, 0.1, 0., 0.5,
         "Length by which the disc reaches inward past the annulus, so that it holds the root "
         "of the leaflets (cm)."},
        {"Disc", "Shift", &P::disc_shift, 0.05, -0.5, 0.5,
         "Distance of the disc's mid surface from the annulus, towards the atrium (cm)."},
        {"Disc", "Element size", &P::disc_element_size, 0.25, 0.005, 2.,
         "Edge length to aim at along the disc (cm)."},
        {"Disc", "Layers", &P::disc_layers, 1, 1, 20,
         "Layers of elements through the thickness."},

        {"Tube", "Inner diameter", &P::tube_inner_diameter, 5.6, 1., 20.,
         "Inner diameter of the tube (cm)."},
        {"Tube", "Wall thickness", &P::tube_thickness, 0.25, 0.01, 2.,
         "Thickness of the tube's wall (cm)."},
        {"Tube", "Length", &P::tube_length, 16., 1., 200.,
         "The tube reaches from x = 0 to this x (cm)."},
        {"Tube", "Element size", &P::tube_element_size, 0.4, 0.01, 4.,
         "Edge length to aim at along the tube (cm)."},
        {"Tube", "Layers", &P::tube_layers, 1, 1, 20,
         "Layers of elements through the wall."}};
      return table;
    }
    // clang-format on

    std::string full_name(const Entry &entry)
    {
      return std::string(entry.section) + "/" + entry.name;
    }

    double get_value(const P &parameters, const Entry &entry)
    {
      return std::visit([&](auto member) { return double(parameters.*member); },
                        entry.member);
    }

    [[noreturn]] void complain(const std::string &parameter,
                               const double found,
                               const std::string &expected)
    {
      std::ostringstream message;
      message << "Parameter '" << parameter << "' is " << found << ", but must be "
              << expected << ".";
      throw base::UserError(message.str());
    }
  } // namespace


  double MitralValveParameters::saddle_height() const
  {
    return annulus_shape == "elliptical" ? 0. : saddle_ratio * annulus_comm_diameter;
  }


  void MitralValveParameters::declare_parameters(dealii::ParameterHandler &prm)
  {
    namespace Patterns = dealii::Patterns;
    prm.declare_entry(
      "Output folder",
      "meshes/mitral_valve",
      Patterns::DirectoryName(),
      "Folder that the meshes and summary.txt are written to, relative to the "
      "current folder; it is made if missing.");
    prm.declare_entry(
      "Write closed shape",
      "false",
      Patterns::Bool(),
      "Write assumed_closed.msh too: the leaflets in the assumed closed shape, "
      "to be looked at. No simulation reads it.");
    prm.enter_subsection("Annulus");
    prm.declare_entry(
      "Shape",
      "saddle",
      Patterns::Selection("saddle|elliptical"),
      "A saddle with its high points (towards the atrium) in the middle of both "
      "leaflets, or a plane ellipse.");
    prm.leave_subsection();
    for (const Entry &entry : entries())
      {
        prm.enter_subsection(entry.section);
        // The ranges are checked in parse_parameters(), which can name the parameter.
        if (std::holds_alternative<double P::*>(entry.member))
          prm.declare_entry(entry.name,
                            Patterns::Tools::to_string(entry.value),
                            Patterns::Double(),
                            entry.help);
        else
          prm.declare_entry(entry.name,
                            std::to_string(static_cast<int>(entry.value)),
                            Patterns::Integer(),
                            entry.help);
        prm.leave_subsection();
      }
  }


  void MitralValveParameters::parse_parameters(dealii::ParameterHandler &prm)
  {
    output_folder      = prm.get("Output folder");
    write_closed_shape = prm.get_bool("Write closed shape");
    prm.enter_subsection("Annulus");
    annulus_shape = prm.get("Shape");
    prm.leave_subsection();
    for (const Entry &entry : entries())
      {
        prm.enter_subsection(entry.section);
        const double value = prm.get_double(entry.name);
        prm.leave_subsection();
        if (!(value >= entry.lower && value <= entry.upper))
          {
            std::ostringstream range;
            range << "between " << entry.lower << " and " << entry.upper;
            complain(full_name(entry), value, range.str());
          }
        if (const auto *member = std::get_if<double P::*>(&entry.member))
          this->*(*member) = value;
        else
          this->*std::get<unsigned int P::*>(entry.member) =
            static_cast<unsigned int>(value);
      }
    check();
  }


  void MitralValveParameters::check() const
  {
    const auto require =
      [&](const bool condition, auto member, const std::string &expected) {
        if (condition)
          return;
        for (const Entry &entry : entries())
          if (const auto *candidate = std::get_if<decltype(member)>(&entry.member))
            if (*candidate == member)
              complain(full_name(entry), get_value(*this, entry), expected);
      };
    const auto cm = [](const double value) {
      std::ostringstream text;
      text << value << " cm";
      return text.str();
    };

    if (output_folder.empty())
      throw base::UserError(
        "Parameter 'Output folder' is empty, but must name a folder.");
    const double radius = 0.5 * tube_inner_diameter;
    require(annulus_comm_diameter + 0.4 < tube_inner_diameter,
            &P::annulus_comm_diameter,
            "at least 0.4 cm smaller than 'Tube/Inner diameter' (" +
              cm(tube_inner_diameter) + ")");
    require(annulus_ap_diameter + 0.4 < tube_inner_diameter,
            &P::annulus_ap_diameter,
            "at least 0.4 cm smaller than 'Tube/Inner diameter' (" +
              cm(tube_inner_diameter) + ")");
    require(annulus_x > 0.5 * (saddle_height() + disc_thickness) &&
              annulus_x < tube_length,
            &P::annulus_x,
            "inside the tube, which reaches from x = 0 to 'Tube/Length' (" +
              cm(tube_length) + "), with room for the disc");
    require(orifice_ap_width + 2 * std::abs(orifice_centre) < annulus_ap_diameter,
            &P::orifice_ap_width,
            "such that the orifice lies inside the annulus ('Annulus/Anterior-posterior "
            "diameter' is " +
              cm(annulus_ap_diameter) + ", 'Start shape/Orifice centre' " +
              cm(orifice_centre) + ")");
    require(orifice_comm_width < annulus_comm_diameter,
            &P::orifice_comm_width,
            "smaller than 'Annulus/Commissural diameter' (" + cm(annulus_comm_diameter) +
              ")");
    require(n_anterior_chordae % 2 == 0,
            &P::n_anterior_chordae,
            "even: half of the chordae go to each papillary tip");
    require(n_posterior_chordae % 2 == 0,
            &P::n_posterior_chordae,
            "even: half of the chordae go to each papillary tip");
    require(
      std::hypot(0.5 * papillary_distance, papillary_offset) + tip_radius < radius,
      &P::papillary_distance,
      "such that the papillary tips ('Chordae/Tip radius' included) lie inside the tube "
      "of radius " +
        cm(radius));
    require(annulus_x + papillary_depth + anchor_length < tube_length,
            &P::papillary_depth,
            "such that the papillary tips lie inside the tube");
    require(
      root_gap < 0.8 * strut_position * commissural_length,
      &P::root_gap,
      "smaller than 0.8 'Chordae/Strut position' times 'Leaflets/Commissural length' (" +
        cm(commissural_length) + ")");
    require(radius + tube_thickness <= axis_y && radius + tube_thickness <= axis_z,
            &P::tube_thickness,
            "such that the tube stays at positive y and z ('Annulus/Axis y' is " +
              cm(axis_y) + ", 'Annulus/Axis z' " + cm(axis_z) + ")");
  }
} // namespace mitre::geometry
