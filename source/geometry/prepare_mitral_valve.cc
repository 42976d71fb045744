#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <mitre/base/exceptions.h>
#include <mitre/geometry/mitral_valve.h>
#include <mitre/geometry/msh_format.h>

namespace mitre::geometry
{
  namespace
  {
    /** printf() into a string. */
    std::string line(const char *format, ...) __attribute__((format(printf, 1, 2)));

    std::string line(const char *format, ...)
    {
      char text[1000];
      va_list arguments;
      va_start(arguments, format);
      std::vsnprintf(text, sizeof(text), format, arguments);
      va_end(arguments);
      return text;
    }


    const char *name(const Leaflet leaflet)
    {
      return leaflet == Leaflet::anterior ? "anterior" : "posterior";
    }


    void check_that_leaflets_close(const MitralValveParameters &parameters,
                                   const LeafletShape &shape)
    {
      for (const CoaptationSample &sample : compute_coaptation_table(shape, 40))
        if (sample.reserve < parameters.minimum_coaptation_height)
          {
            const bool middle = std::abs(sample.s) < 0.5;
            throw base::UserError(
              line("The %s leaflet cannot close: at %.0f degrees on the annulus it is "
                   "%.2f cm "
                   "long, %.2f cm away from the coaptation line, and has %.2f cm left to "
                   "coapt, but 'Closed shape/Minimum coaptation height' is %.2f cm. ",
                   name(sample.leaflet),
                   sample.angle,
                   sample.length,
                   sample.span,
                   sample.reserve,
                   parameters.minimum_coaptation_height) +
              "Increase 'Leaflets/" +
              (sample.leaflet == Leaflet::anterior
                 ? (middle ? "Anterior length" : "Anterior fullness")
                 : (middle ? "Posterior length" : "Posterior fullness")) +
              "' or move the line by 'Closed shape/Coaptation position'.");
          }
    }


    void check_that_funnel_exists(const MitralValveParameters &parameters,
                                  const LeafletShape &shape)
    {
      for (unsigned int i = 0; i < 360; ++i)
        {
          const double phi    = i / 360.;
          const Point3 edge   = shape.start(phi, 1);
          const Point3 root   = shape.start(phi, 0);
          const double inward = std::hypot(edge[1] - root[1], edge[2] - root[2]);
          const double depth  = edge[0] - root[0];
          // Closer to horizontal than this the funnel could fold at the commissures.
          if (depth < 0.3 * inward)
            throw base::UserError(line(
              "The leaflets are too short for the orifice: at %.0f degrees on the "
              "annulus "
              "the leaflet is %.2f cm long, but has to reach %.2f cm inward. Increase "
              "'Start shape/Orifice anterior-posterior width' (%.2f cm) or 'Start "
              "shape/Orifice commissural width' (%.2f cm).",
              shape.annulus().angle(phi) * 180 / M_PI,
              shape.length(phi),
              inward,
              parameters.orifice_ap_width,
              parameters.orifice_comm_width));
        }
    }


    std::string
    mesh_lines(const std::string &file, const TetMesh &mesh, const MeshReport &report)
    {
      std::string text =
        line("%-14s %8zu nodes %8zu tetrahedra, volume %8.4f cm^3, edges "
             "%.3f to %.3f cm\n",
             file.c_str(),
             report.n_vertices,
             report.total_cells(),
             report.total_volume(),
             report.shortest_edge,
             report.longest_edge);
      for (const auto &[id, material] : mesh.materials)
        text += line("    id %d %-18s %8zu tetrahedra, volume %8.4f cm^3\n",
                     id,
                     material.c_str(),
                     report.n_cells.at(id),
                     report.volume.at(id));
      text += line(
        "    inverted %zu, quality at least %.3f, mean %.3f; surface %s: %zu "
        "triangles, %zu open edges, Euler characteristic %ld, area %.3f cm^2\n",
        report.n_inverted,
        report.min_quality,
        report.mean_quality,
        report.n_bad_surface_edges + report.n_bad_faces == 0 ? "closed" : "NOT CLOSED",
        report.n_surface_faces,
        report.n_bad_surface_edges,
        report.euler_characteristic,
        report.surface_area);
      return text;
    }


    std::string coaptation_lines(const LeafletShape &shape)
    {
      std::string text =
        "Coaptation reserve (cm): leaflet length minus the straight way from "
        "annulus to coaptation line\n"
        "    leaflet         s   angle  length    span reserve\n";
      for (const CoaptationSample &sample : compute_coaptation_table(shape, 10))
        text += line("    %-10s %6.2f %7.1f %7.3f %7.3f %7.3f\n",
                     name(sample.leaflet),
                     sample.s,
                     sample.angle,
                     sample.length,
                     sample.span,
                     sample.reserve);
      return text;
    }


    std::string chord_lines(const MitralValveParameters &parameters,
                            const std::vector<Chord> &chords)
    {
      std::string text =
        "Chordae (cm): distance from anchor to insertion at the start, length of the "
        "chord,\n"
        "distance in the assumed closed valve, length / closed distance\n"
        "     #  leaflet    tip      s     v   start  length  closed   ratio\n";
      std::string warnings;
      for (std::size_t i = 0; i < chords.size(); ++i)
        {
          const Chord &chord = chords[i];
          text += line("    %2zu  %-10s  %cz %6.2f %5.2f %7.3f %7.3f %7.3f %7.4f%s\n",
                       i + 1,
                       name(chord.leaflet),
                       chord.side < 0 ? '-' : '+',
                       chord.s,
                       chord.v,
                       chord.start_distance,
                       chord.length,
                       chord.closed_distance,
                       chord.ratio(),
                       chord.strut ? "  strut" : "");
          if (chord.ratio() > 1.02 * parameters.chord_slack)
            warnings +=
              line("WARNING: chord %zu is longer than asked for: its start distance "
                   "exceeds its closed distance. The leaflet may prolapse there; "
                   "move the papillary tips ('Chordae/Papillary ...').\n",
                   i + 1);
        }
      return text + warnings;
    }


    std::string measure_lines(const MitralValveParameters &parameters,
                              const ValveMeasures &m)
    {
      std::string text;
      text += line("Annulus: length %.2f cm, projected area %.2f cm^2, saddle height / "
                   "commissural width %.3f\n",
                   m.annulus_length,
                   m.annulus_area,
                   parameters.saddle_height() / parameters.annulus_comm_diameter);
      text +=
        line("Leaflets: anterior %.2f cm^2, posterior %.2f cm^2, together %.2f times the "
             "annulus area\n",
             m.anterior_area,
             m.posterior_area,
             m.area_ratio());
      text +=
        line("Free edges: anterior %.2f cm, posterior %.2f cm, coaptation line %.2f cm\n",
             m.anterior_edge,
             m.posterior_edge,
             m.coaptation_length);
      text +=
        line("Orifice: %.2f cm^2 projected, free edges at least %.2f cm apart in the "
             "middle\n",
             m.orifice_area,
             m.edge_to_edge);
      text +=
        line("Least distances (cm): free edge to tube %.2f, to papillary tip %.2f, chord "
             "to leaflet (0.5 cm off its insertion) %.2f\n",
             m.edge_to_tube,
             m.edge_to_papillary,
             m.chord_to_leaflet);
      text += line("Coaptation reserve: at least %.2f cm\n", m.least_reserve);
      for (const int side : {-1, 1})
        {
          const Point3 tip = papillary_tip(parameters, side);
          text +=
            line("Papillary tip %cz: (%.3f, %.3f, %.3f); chordae start on a half circle "
                 "of radius %.2f cm around it\n",
                 side < 0 ? '-' : '+',
                 tip[0],
                 tip[1],
                 tip[2],
                 parameters.tip_radius);
        }
      text += line(
        "Region that holds them there: (x-%g)^2 + (y-%g)^2 + (abs(z-%g)-%g)^2 < %g^2\n",
        papillary_tip(parameters, 1)[0],
        papillary_tip(parameters, 1)[1],
        parameters.axis_z,
        0.5 * parameters.papillary_distance,
        parameters.tip_radius + 0.15);
      if (m.area_ratio() < 2 || m.area_ratio() > 2.5)
        text +=
          "WARNING: the leaflets' area should be 2 to 2.5 times the annulus' area.\n";
      if (m.orifice_area < 3 || m.orifice_area > 4)
        text += "WARNING: a half open valve has an orifice of 3 to 4 cm^2.\n";
      if (std::min(m.anterior_edge, m.posterior_edge) < 0.95 * m.coaptation_length)
        text +=
          "WARNING: a free edge is shorter than the coaptation line and must stretch.\n";
      return text;
    }
  } // namespace


  std::string prepare_mitral_valve(const MitralValveParameters &parameters)
  {
    const LeafletShape shape(parameters);
    check_that_funnel_exists(parameters, shape);
    check_that_leaflets_close(parameters, shape);
    const std::vector<Chord> chords = compute_chord_layout(parameters, shape);

    std::error_code error;
    std::filesystem::create_directories(parameters.output_folder, error);
    if (error)
      throw base::UserError("Cannot make the folder '" + parameters.output_folder +
                            "' that 'Output folder' names: " + error.message() + ".");
    const std::string folder = parameters.output_folder + "/";

    std::vector<std::pair<std::string, TetMesh>> bodies;
    bodies.emplace_back("leaflets.msh", build_leaflets(parameters, shape));
    bodies.emplace_back("chordae.msh", build_chordae(parameters, chords));
    bodies.emplace_back("disc.msh", build_disc(parameters, shape.annulus()));
    bodies.emplace_back("tube.msh", build_tube(parameters));

    std::string summary = "Mitral valve in '" + parameters.output_folder + "'\n\n";
    std::string problems;
    std::size_t total = 0, without_tube = 0;
    for (auto &[file, mesh] : bodies)
      {
        write_msh(mesh, folder + file);
        mesh                    = read_msh(folder + file);
        const MeshReport report = check_mesh(mesh);
        summary += mesh_lines(file, mesh, report);
        total += report.total_cells();
        if (file != "tube.msh")
          without_tube += report.total_cells();
        if (!report.sound())
          problems += " " + folder + file;
        const bool fibres = file == "leaflets.msh" || file == "chordae.msh";
        if (fibres && (report.n_without_fibre > 0 || report.fibre_length_error > 1e-12))
          problems += " " + folder + file + " (fibres)";
      }
    if (parameters.write_closed_shape)
      write_msh(build_leaflets(parameters, shape, true), folder + "assumed_closed.msh");

    summary +=
      line("Together %zu tetrahedra, %zu without the tube\n\n", total, without_tube);
    summary +=
      measure_lines(parameters, compute_measures(parameters, shape, chords)) + "\n";
    summary += coaptation_lines(shape) + "\n";
    summary += chord_lines(parameters, chords);

    std::ofstream out(folder + "summary.txt");
    out << summary;
    out.flush();
    if (!out)
      throw base::UserError("Cannot write '" + folder + "summary.txt'.");
    if (!problems.empty())
      throw base::UserError("These meshes are not sound (inverted or flat elements, or a "
                            "surface that is not closed; see " +
                            folder + "summary.txt):" + problems +
                            ". Choose smaller element sizes or a smoother shape.");
    return summary;
  }
} // namespace mitre::geometry
