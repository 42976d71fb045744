#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/geometry/mitral_valve.h>
#include <mitre/geometry/msh_format.h>
#include <mitre/geometry/prosthesis.h>
#include <mitre/io/fibre_files.h>
#include <mitre/io/safe_file.h>

namespace mitre::geometry
{
  namespace
  {
    using dealii::numbers::PI;
    using P = ProsthesisParameters;

    struct Entry
    {
      const char *name;
      double P::*member;
      double value, lower, upper;
      const char *help;
    };

    // clang-format off
    const std::vector<Entry> &
    entries()
    {
      static const std::vector<Entry> table = {
        {"Annulus plane", &P::annulus_x, 4., 0.5, 100., "x of the plane of the annulus and of the disc [cm]."},
        {"Axis y", &P::axis_y, 4., 0., 100., "y of the tube's axis [cm]."},
        {"Axis z", &P::axis_z, 4., 0., 100., "z of the tube's axis [cm]."},
        {"Annulus width", &P::width, 3.1, 1., 8., "Width of the D-shaped annulus in z, from commissure to commissure [cm]."},
        {"Anterior depth", &P::anterior_depth, 0.6, 0.1, 4., "How far the D reaches from the commissures towards +y [cm]."},
        {"Posterior depth", &P::posterior_depth, 1.6, 0.1, 4., "How far the D reaches from the commissures towards -y [cm]."},
        {"Post height", &P::post_height, 0.75, 0., 3., "How far the bound edge of the leaflets rises from the annulus at the commissures, downstream [cm]."},
        {"Post width", &P::post_width, 50., 5., 85., "Half of the angle about the tube's axis over which it rises [degrees]."},
        {"Anterior length", &P::anterior_length, 1.7, 0.2, 6., "From the bound to the free edge in the middle of the anterior leaflet [cm]."},
        {"Posterior length", &P::posterior_length, 2.3, 0.2, 6., "The same for the posterior leaflet [cm]."},
        {"Commissural length", &P::commissural_length, 0.5, 0.05, 6., "The same at the commissures [cm]."},
        {"Anterior angle", &P::anterior_angle, 12., -30., 80., "By how much the anterior leaflet leans inward from the direction of the flow [degrees]."},
        {"Posterior angle", &P::posterior_angle, 22., -30., 80., "The same for the posterior leaflet [degrees]."},
        {"Coaptation position", &P::coaptation_y, -0.2, -4., 4., "y from the commissures at which the leaflets are assumed to meet in the middle [cm]."},
        {"Coaptation depth", &P::coaptation_x, 1., 0., 4., "x from the annulus at which they are assumed to meet in the middle [cm]."},
        {"Minimum coaptation height", &P::minimum_coaptation_height, 0.1, 0., 2., "What must be left of a meridian behind the line where leaflets meet [cm]."},
        {"Chord area", &P::chord_area, 4e-3, 1e-6, 1., "Cross-section of a chord [cm^2]."},
        {"Chord modulus", &P::chord_modulus, 3e8, 0., 1e12, "Young's modulus of the chordae [dyn/cm^2]."},
        {"Chord slack", &P::chord_slack, 0., -0.5, 1., "By what part chordae are longer than they need to be in the closed valve."},
        {"Attachment depth", &P::attachment_x, 3.6, 0.5, 10., "x of the attachment points of the chordae from the annulus [cm]."},
        {"Attachment position", &P::attachment_y, -0.3, -4., 4., "y of the attachment points from the axis [cm]."},
        {"Attachment distance", &P::attachment_distance, 2.4, 0., 8., "Distance of the two attachment points in z [cm]."},
        {"Leaflet spacing", &P::leaflet_spacing, 0.1, 1e-3, 1., "Length of the fibre segments of the leaflets [cm]; half of the grid's spacing or less."},
        {"Chord spacing", &P::chord_spacing, 0.1, 1e-3, 1., "The same for the chordae between leaflets and attachment points [cm]."},
        {"Rigid spacing", &P::rigid_spacing, 0.1, 1e-3, 1., "Distance of the nodes of the disc [cm]; half of the grid's spacing or less."},
        {"Tube element size", &P::tube_element_size, 0.2, 1e-3, 10., "Of the tube [cm]."},
        {"Target stiffness", &P::target_stiffness, 1e5, 0., 1e12, "Of the target points [dyn/cm]."},
        {"Target damping", &P::target_damping, 0., 0., 1e12, "Of the target points [dyn s/cm]."},
        {"Attachment stiffness", &P::attachment_stiffness, 1e6, 0., 1e12, "Of the target points at the ends of the chordae [dyn/cm]."},
        {"Tube inner diameter", &P::tube_inner_diameter, 5.6, 1., 100., "[cm]"},
        {"Tube thickness", &P::tube_thickness, 0.25, 0.01, 10., "[cm]"},
        {"Tube length", &P::tube_length, 16., 1., 1000., "[cm]"}};
      return table;
    }
    // clang-format on


    double degrees(const double angle)
    {
      return angle * 180. / PI;
    }


    /// Area of the projection along x within a closed curve [cm^2].
    template <typename Curve>
    double projected_area(const Curve &curve)
    {
      constexpr unsigned int n = 2000;
      double sum               = 0;
      for (unsigned int i = 0; i < n; ++i)
        {
          const Point3 a = curve(2 * PI * i / n), b = curve(2 * PI * (i + 1) / n);
          sum += 0.5 * (a[1] * b[2] - a[2] * b[1]);
        }
      return std::abs(sum);
    }


    void add_target(structure::FibreNetwork<3> &network,
                    const unsigned int node,
                    const double stiffness,
                    const double damping)
    {
      structure::TargetPoint target;
      target.node      = node;
      target.stiffness = stiffness;
      target.damping   = damping;
      network.targets.push_back(target);
    }
  } // namespace


  void ProsthesisParameters::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Output folder",
                      "meshes/prosthesis",
                      dealii::Patterns::Anything(),
                      "Where valve.vertex, disc.vertex, the other fibre files and "
                      "tube.msh are written.");
    for (const Entry &entry : entries())
      {
        std::ostringstream value;
        value << entry.value;
        prm.declare_entry(entry.name,
                          value.str(),
                          dealii::Patterns::Double(entry.lower, entry.upper),
                          entry.help);
      }
    prm.declare_entry("Young's modulus",
                      "5.4e7",
                      dealii::Patterns::Double(0),
                      "E of the leaflets [dyn/cm^2].");
    prm.declare_entry(
      "Thickness", "0.0125", dealii::Patterns::Double(0), "h of the leaflets [cm].");
    prm.declare_entry("Diagonals",
                      "false",
                      dealii::Patterns::Bool(),
                      "Whether leaflets have springs along diagonals, too, so that they "
                      "resist shear; elements must then be about square.");
    prm.declare_entry("Leaflet bending",
                      "true",
                      dealii::Patterns::Bool(),
                      "Whether leaflets resist bending; false: they have no beams.");
    prm.declare_entry(
      "Chordal bending", "true", dealii::Patterns::Bool(), "The same for the chordae.");
    prm.declare_entry("Anterior chordae",
                      "6",
                      dealii::Patterns::Integer(0, 100),
                      "Number of chordae of the anterior leaflet, half of them to each "
                      "side.");
    prm.declare_entry("Posterior chordae",
                      "8",
                      dealii::Patterns::Integer(0, 100),
                      "The same for the posterior leaflet.");
  }


  void ProsthesisParameters::parse_parameters(dealii::ParameterHandler &prm)
  {
    output_folder   = prm.get("Output folder");
    leaflet_bending = prm.get_bool("Leaflet bending");
    chordal_bending = prm.get_bool("Chordal bending");
    for (const Entry &entry : entries())
      this->*entry.member = prm.get_double(entry.name);
    sheet.modulus       = prm.get_double("Young's modulus");
    sheet.thickness     = prm.get_double("Thickness");
    sheet.diagonals     = prm.get_bool("Diagonals");
    n_anterior_chordae  = prm.get_integer("Anterior chordae");
    n_posterior_chordae = prm.get_integer("Posterior chordae");

    const double radius = 0.5 * tube_inner_diameter;
    AssertThrow(std::max(0.5 * width, std::max(anterior_depth, posterior_depth)) <
                  radius - rigid_spacing,
                base::UserError("Prosthesis: the annulus, of the half width " +
                                std::to_string(0.5 * width) + " cm and the depths " +
                                std::to_string(anterior_depth) + " and " +
                                std::to_string(posterior_depth) +
                                " cm, does not fit into the tube, whose radius is " +
                                std::to_string(radius) + " cm."));
    for (const unsigned int n : {n_anterior_chordae, n_posterior_chordae})
      AssertThrow(n % 2 == 0,
                  base::UserError("Prosthesis: a leaflet has " + std::to_string(n) +
                                  " chordae; expected an even number, half of which go "
                                  "to each attachment point."));
  }


  ProsthesisShape::ProsthesisShape(const ProsthesisParameters &parameters)
    : parameters(parameters)
  {
    constexpr unsigned int n = 4000;
    std::vector<double> angles;
    std::vector<Point3> points;
    for (unsigned int i = 0; i <= n; ++i)
      {
        angles.push_back(2 * PI * i / n);
        points.push_back(annulus(angles.back()));
      }
    arc = SampledLength(angles, points);
  }


  Point3 ProsthesisShape::annulus(const double angle) const
  {
    const double c = std::cos(angle), d = parameters.anterior_depth,
                 p = parameters.posterior_depth;
    const double y = c > 0 ? d * (1 - std::pow(1 - c, p / d)) : p * c;
    return Point3(parameters.annulus_x,
                  parameters.axis_y + y,
                  parameters.axis_z + 0.5 * parameters.width * std::sin(angle));
  }


  Point3 ProsthesisShape::bound_edge(const double angle) const
  {
    Point3 x = annulus(angle);
    // from the nearer commissure, where cos(angle) = 0
    const double away = degrees(std::abs(std::asin(std::cos(angle))));
    if (away < parameters.post_width)
      x[0] += parameters.post_height *
              std::pow(std::cos(0.5 * PI * away / parameters.post_width), 2);
    return x;
  }


  double ProsthesisShape::length(const double angle) const
  {
    const double c = std::cos(angle);
    const double middle =
      c > 0 ? parameters.anterior_length : parameters.posterior_length;
    // flat in the middle, and without a corner at the commissures
    const double t = std::pow(std::sin(0.5 * PI * std::abs(c)), 2);
    return parameters.commissural_length + (middle - parameters.commissural_length) * t;
  }


  Point3 ProsthesisShape::point(const double angle, const double v) const
  {
    const double c = std::cos(angle);
    const double t = c * c;
    const double lean =
      (c > 0 ? parameters.anterior_angle : parameters.posterior_angle) * t * PI / 180;
    const Point3 root = bound_edge(angle);
    // inward across the D: towards the line between the commissures, less so near them
    Vector3 inward;
    inward[1] = -(c > 0 ? 1. : -1.);
    Point3 x  = root;
    x[0] += v * length(angle) * std::cos(lean);
    x += v * length(angle) * std::sin(lean) * inward;
    return x;
  }


  Point3 ProsthesisShape::coaptation_point(const double angle) const
  {
    // by the sine, which is 1 at the commissures, on both leaflets
    const double s = std::sin(angle), tip = parameters.annulus_x + parameters.post_height;
    const double middle = parameters.annulus_x + parameters.coaptation_x;
    return Point3(middle + (tip - middle) * s * s,
                  parameters.axis_y + parameters.coaptation_y * (1 - s * s),
                  parameters.axis_z + 0.5 * parameters.width * s);
  }


  Point3 ProsthesisShape::closed_free_edge(const double angle) const
  {
    Point3 x = coaptation_point(angle);
    x[0] += length(angle) - bound_edge(angle).distance(x);
    return x;
  }


  std::vector<double> ProsthesisShape::angles(const unsigned int n) const
  {
    std::vector<double> result;
    for (unsigned int i = 0; i < n; ++i)
      result.push_back(arc.parameter_at(double(i) / n));
    return result;
  }


  double ProsthesisShape::annulus_length() const
  {
    return arc.total();
  }


  double ProsthesisShape::annulus_area() const
  {
    return projected_area([&](const double angle) { return annulus(angle); });
  }


  double ProsthesisShape::orifice_area() const
  {
    return projected_area([&](const double angle) { return point(angle, 1); });
  }


  namespace
  {
    void check_that_leaflets_close(const ProsthesisParameters &parameters,
                                   const ProsthesisShape &shape)
    {
      for (int i = 0; i < 72; ++i)
        {
          const double angle = 2 * PI * i / 72;
          const double span =
            shape.bound_edge(angle).distance(shape.coaptation_point(angle));
          if (shape.length(angle) - span < parameters.minimum_coaptation_height)
            {
              char text[400];
              std::snprintf(
                text,
                sizeof(text),
                "Prosthesis: the %s leaflet cannot close: at %.0f degrees it is "
                "%.2f cm long, %.2f cm away from where it should meet the other "
                "one, and has less than the \"Minimum coaptation height\" of %.2f "
                "cm left. Increase its length, or \"Commissural length\".",
                std::cos(angle) > 0 ? "anterior" : "posterior",
                degrees(angle),
                shape.length(angle),
                span,
                parameters.minimum_coaptation_height);
              throw base::UserError(text);
            }
        }
    }


    /// Adds a fibre through @p nodes, which are there, with all that a chord has.
    void add_chord_segments(structure::FibreNetwork<3> &network,
                            const std::vector<unsigned int> &nodes,
                            const std::vector<double> &rest_lengths,
                            const ProsthesisParameters &parameters)
    {
      const double EA = parameters.chord_modulus * parameters.chord_area;
      const double EI = EA * parameters.chord_area / (4 * PI);
      for (unsigned int i = 0; i + 1 < nodes.size(); ++i)
        {
          structure::Spring spring;
          spring.nodes          = {{nodes[i], nodes[i + 1]}};
          spring.rest_length    = rest_lengths[i];
          spring.stiffness      = EA / rest_lengths[i];
          spring.force_function = 1;
          network.springs.push_back(spring);
        }
      for (unsigned int i = 0; parameters.chordal_bending && i + 2 < nodes.size(); ++i)
        {
          const double ds = 0.5 * (rest_lengths[i] + rest_lengths[i + 1]);
          structure::Beam<3> beam;
          beam.nodes     = {{nodes[i], nodes[i + 1], nodes[i + 2]}};
          beam.stiffness = EI / (ds * ds * ds);
          beam.curvature = (network.nodes[nodes[i]] - network.nodes[nodes[i + 1]]) +
                           (network.nodes[nodes[i + 2]] - network.nodes[nodes[i + 1]]);
          network.beams.push_back(beam);
        }
    }


    /// The disc between the annulus and the middle of the tube's wall, and the posts.
    structure::FibreNetwork<3> make_disc(const ProsthesisParameters &parameters,
                                         const ProsthesisShape &shape)
    {
      structure::FibreNetwork<3> network;
      network.source = network.spring_source = "housing disc";
      const double radius =
        0.5 * (parameters.tube_inner_diameter + parameters.tube_thickness);
      const double ds = parameters.rigid_spacing;

      // Nodes at most ds apart along a closed curve, but for those that have a neighbour.
      const auto add_ring = [&](const std::function<Point3(double)> &curve) {
        constexpr unsigned int n_samples = 2000;
        std::vector<double> angles;
        std::vector<Point3> points;
        for (unsigned int i = 0; i <= n_samples; ++i)
          {
            angles.push_back(2 * PI * i / n_samples);
            points.push_back(curve(angles.back()));
          }
        const SampledLength length(angles, points);
        const unsigned int n = std::ceil(length.total() / ds);
        for (unsigned int i = 0; i < n; ++i)
          {
            const Point3 x = curve(length.parameter_at(double(i) / n));
            if (std::any_of(network.nodes.begin(),
                            network.nodes.end(),
                            [&](const Point3 &y) { return x.distance(y) < 0.4 * ds; }))
              continue;
            add_target(network,
                       network.nodes.size(),
                       parameters.target_stiffness,
                       parameters.target_damping);
            network.nodes.push_back(x);
          }
      };

      // From the bound edge down the posts to the annulus, then outward in the plane.
      // Where there is no post, or the plate is narrow, rings run together.
      const unsigned int n_wall = std::ceil(parameters.post_height / ds);
      for (unsigned int j = 0; j <= n_wall; ++j)
        add_ring([&, part = n_wall > 0 ? double(j) / n_wall : 1.](const double angle) {
          const Point3 top = shape.bound_edge(angle);
          return Point3(top + part * (shape.annulus(angle) - top));
        });
      const unsigned int n_plate = std::ceil(
        (radius - std::min(parameters.anterior_depth, parameters.posterior_depth)) / ds);
      for (unsigned int j = 1; j <= n_plate; ++j)
        add_ring([&, part = double(j) / n_plate](const double angle) {
          const Point3 foot = shape.annulus(angle);
          const double polar =
            std::atan2(foot[2] - parameters.axis_z, foot[1] - parameters.axis_y);
          const Point3 rim(parameters.annulus_x,
                           parameters.axis_y + radius * std::cos(polar),
                           parameters.axis_z + radius * std::sin(polar));
          return Point3(foot + part * (rim - foot));
        });
      return network;
    }
  } // namespace


  Prosthesis make_prosthesis(const ProsthesisParameters &parameters)
  {
    const ProsthesisShape shape(parameters);
    check_that_leaflets_close(parameters, shape);

    // Step 1: the leaflets as quadrilaterals of two segments a side. As many columns as
    // let each leaflet's chordae lie on one.
    const double ds         = 2 * parameters.leaflet_spacing;
    const unsigned int n    = 4 * std::ceil(shape.annulus_length() / (4 * ds));
    const unsigned int rows = std::max<unsigned int>(
      2,
      std::ceil(std::max(parameters.anterior_length, parameters.posterior_length) / ds));
    const std::vector<double> angles = shape.angles(n);
    QuadSurface surface;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j <= rows; ++j)
        surface.nodes.push_back(shape.point(angles[i], double(j) / rows));
    const auto corner = [&](const unsigned int i, const unsigned int j) {
      return (i % n) * (rows + 1) + j;
    };
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < rows; ++j)
        surface.quads.push_back(
          {{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)}});

    Prosthesis result;
    result.valve                      = make_fibres(surface, parameters.sheet);
    structure::FibreNetwork<3> &valve = result.valve;
    valve.source = valve.spring_source = "leaflets and chordae";
    result.n_leaflet_springs           = valve.springs.size();

    // Nodes between corners, as make_fibres() has made them.
    std::map<std::pair<unsigned int, unsigned int>, unsigned int> middle_of;
    const unsigned int n_corners = surface.nodes.size();
    for (const structure::Beam<3> &beam : valve.beams)
      if (beam.nodes[0] < n_corners && beam.nodes[2] < n_corners)
        middle_of[std::minmax(beam.nodes[0], beam.nodes[2])] = beam.nodes[1];

    if (!parameters.leaflet_bending)
      valve.beams.clear();
    result.n_leaflet_beams = valve.beams.size();

    // Step 2: the bound edge is held.
    for (unsigned int i = 0; i < n; ++i)
      {
        add_target(
          valve, corner(i, 0), parameters.target_stiffness, parameters.target_damping);
        const std::pair<unsigned int, unsigned int> side =
          std::minmax(corner(i, 0), corner(i + 1, 0));
        add_target(valve,
                   middle_of.at(side),
                   parameters.target_stiffness,
                   parameters.target_damping);
      }

    // Step 3: chordae, spread evenly over each leaflet, whose ends lie at 90 degrees.
    const auto add_chord = [&](const double angle) {
      ProsthesisChord chord;
      unsigned int column = 0;
      double least        = 1e10;
      for (unsigned int i = 0; i < n; ++i)
        {
          const double away = std::abs(std::remainder(angles[i] - angle, 2 * PI));
          if (away < least)
            {
              least  = away;
              column = i;
            }
        }
      chord.angle = angles[column];
      chord.side  = std::sin(angle) > 0 ? 1 : -1;
      const Point3 end(parameters.annulus_x + parameters.attachment_x,
                       parameters.axis_y + parameters.attachment_y,
                       parameters.axis_z +
                         0.5 * chord.side * parameters.attachment_distance);
      const Point3 edge   = shape.point(chord.angle, 1);
      chord.start_length  = edge.distance(end);
      chord.closed_length = shape.closed_free_edge(chord.angle).distance(end);
      chord.rest_length =
        std::max(chord.start_length, (1 + parameters.chord_slack) * chord.closed_length);

      std::vector<unsigned int> nodes;
      std::vector<double> rest_lengths;
      for (unsigned int j = 0; j <= rows; ++j)
        {
          if (j > 0)
            {
              const std::pair<unsigned int, unsigned int> side =
                std::minmax(corner(column, j - 1), corner(column, j));
              nodes.push_back(middle_of.at(side));
            }
          nodes.push_back(corner(column, j));
        }
      for (unsigned int i = 0; i + 1 < nodes.size(); ++i)
        rest_lengths.push_back(valve.nodes[nodes[i]].distance(valve.nodes[nodes[i + 1]]));
      const unsigned int n_free =
        std::ceil(chord.start_length / parameters.chord_spacing);
      for (unsigned int i = 1; i <= n_free; ++i)
        {
          nodes.push_back(valve.nodes.size());
          valve.nodes.push_back(edge + double(i) / n_free * (end - edge));
          rest_lengths.push_back(chord.rest_length / n_free);
        }
      add_chord_segments(valve, nodes, rest_lengths, parameters);
      add_target(
        valve, nodes.back(), parameters.attachment_stiffness, parameters.target_damping);
      result.chordae.push_back(chord);
    };
    for (unsigned int k = 0; k < parameters.n_anterior_chordae; ++k)
      add_chord((-0.5 + (k + 0.5) / parameters.n_anterior_chordae) * PI);
    for (unsigned int k = 0; k < parameters.n_posterior_chordae; ++k)
      add_chord((0.5 + (k + 0.5) / parameters.n_posterior_chordae) * PI);

    result.disc = make_disc(parameters, shape);
    return result;
  }


  std::string prepare_prosthesis(const ProsthesisParameters &parameters)
  {
    const ProsthesisShape shape(parameters);
    const Prosthesis prosthesis = make_prosthesis(parameters);
    const std::string &folder   = parameters.output_folder;
    io::make_folder(folder);
    io::write_fibres(prosthesis.valve, folder + "/valve");
    io::write_fibres(prosthesis.disc, folder + "/disc");

    dealii::ParameterHandler prm;
    MitralValveParameters::declare_parameters(prm);
    MitralValveParameters tube;
    tube.parse_parameters(prm);
    tube.axis_y              = parameters.axis_y;
    tube.axis_z              = parameters.axis_z;
    tube.tube_inner_diameter = parameters.tube_inner_diameter;
    tube.tube_thickness      = parameters.tube_thickness;
    tube.tube_length         = parameters.tube_length;
    tube.tube_element_size   = parameters.tube_element_size;
    tube.tube_layers         = 1;
    write_msh(build_tube(tube), folder + "/tube.msh");

    std::ostringstream text;
    text.precision(4);
    text << "Prosthesis in " << folder << "\n  annulus: " << shape.annulus_length()
         << " cm around, " << shape.annulus_area() << " cm^2; free edges enclose "
         << shape.orifice_area()
         << " cm^2 at the start\n  leaflets: " << prosthesis.n_leaflet_springs
         << " segments, " << prosthesis.n_leaflet_beams << " beams; chordae: "
         << prosthesis.valve.springs.size() - prosthesis.n_leaflet_springs
         << " segments, " << prosthesis.valve.beams.size() - prosthesis.n_leaflet_beams
         << " beams; disc: " << prosthesis.disc.nodes.size()
         << " nodes\n  chordae from the free edge to their attachment points [cm]:\n"
         << "    angle   start  closed  at rest\n";
    for (const ProsthesisChord &chord : prosthesis.chordae)
      {
        char line[100];
        std::snprintf(line,
                      sizeof(line),
                      "    %5.0f %7.2f %7.2f %8.2f\n",
                      degrees(std::remainder(chord.angle, 2 * PI)),
                      chord.start_length,
                      chord.closed_length,
                      chord.rest_length);
        text << line;
      }
    return text.str();
  }
} // namespace mitre::geometry
