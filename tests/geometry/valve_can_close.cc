// What decides whether the default valve closes. Bounds are anatomical: leaflet area 2
// to 2.5 times the annulus area, orifice of the half open valve 3 to 4 cm^2, 0.3 cm or
// more of leaflet left for coaptation everywhere, papillary tips 2.4 to 4 cm below the
// annulus. Meridians keep their length from the start to the closed shape (1e-3 for
// sampling), the closed leaflets meet along one line (at most one thickness, 0.1 cm,
// apart), and every chord is as long as its closed distance (1e-3). 16 chordae: 10
// posterior, 6 anterior, 2 of them struts, and the two halves of the valve are mirror
// images.

#include <algorithm>
#include <cmath>
#include <iostream>

#include <mitre/geometry/mitral_valve.h>

using namespace mitre::geometry;

namespace
{
  const char *yes(const bool condition)
  {
    return condition ? "yes" : "no";
  }
} // namespace

int
main()
{
  dealii::ParameterHandler prm;
  MitralValveParameters::declare_parameters(prm);
  MitralValveParameters parameters;
  parameters.parse_parameters(prm);
  const LeafletShape shape(parameters);
  const std::vector<Chord> chords = compute_chord_layout(parameters, shape);
  const ValveMeasures m           = compute_measures(parameters, shape, chords);

  std::cout << "area ratio within 2 and 2.5: "
            << yes(m.area_ratio() > 2 && m.area_ratio() < 2.5) << '\n'
            << "orifice within 3 and 4 cm^2: "
            << yes(m.orifice_area > 3 && m.orifice_area < 4) << '\n'
            << "coaptation reserve above 0.3 cm: " << yes(m.least_reserve > 0.3) << '\n'
            << "free edges as long as the coaptation line: "
            << yes(std::min(m.anterior_edge, m.posterior_edge) >
                   0.98 * m.coaptation_length)
            << '\n'
            << "free edge 1 cm off the tube and the papillary tips: "
            << yes(std::min(m.edge_to_tube, m.edge_to_papillary) > 1) << '\n'
            << "papillary depth within 2.4 and 4 cm: "
            << yes(parameters.papillary_depth > 2.4 && parameters.papillary_depth < 4)
            << '\n';

  double length_error = 0, gap = 0;
  for (const Leaflet leaflet : {Leaflet::anterior, Leaflet::posterior})
    for (int i = -20; i <= 20; ++i)
      {
        const double phi = shape.fraction(leaflet, i / 20.);
        double start = 0, closed = 0;
        for (int j = 0; j < 1000; ++j)
          {
            start +=
              shape.start(phi, j / 1000.).distance(shape.start(phi, (j + 1) / 1000.));
            closed +=
              shape.closed(phi, j / 1000.).distance(shape.closed(phi, (j + 1) / 1000.));
          }
        length_error = std::max(
          {length_error, std::abs(start - shape.length(phi)), std::abs(closed - start)});

        const double opposite = shape.fraction(
          leaflet == Leaflet::anterior ? Leaflet::posterior : Leaflet::anterior, i / 20.);
        gap = std::max(gap,
                       shape.closed(phi, shape.span(phi) / shape.length(phi))
                         .distance(shape.closed(
                           opposite, shape.span(opposite) / shape.length(opposite))));
      }
  std::cout << "meridians keep their length: " << yes(length_error < 1e-3) << '\n'
            << "closed leaflets meet: " << yes(gap < 0.1 + 1e-12) << '\n';

  unsigned int n_anterior = 0, n_struts = 0;
  double ratio_error = 0, insertion_error = 0, mirror_error = 0;
  for (const Chord &chord : chords)
    {
      n_anterior += chord.leaflet == Leaflet::anterior;
      n_struts += chord.strut;
      ratio_error = std::max(ratio_error, std::abs(chord.ratio() - 1));

      // Length of the mesh itself between anchor and insertion.
      double length = 0;
      for (unsigned int i = 1; i < chord.sections.size(); ++i)
        length += chord.sections[i].centre.distance(chord.sections[i - 1].centre);
      const double inside =
        chord.v * shape.length(shape.fraction(chord.leaflet, chord.s)) -
        parameters.root_gap;
      insertion_error = std::max(
        insertion_error,
        std::abs(length - inside - parameters.anchor_length - chord.closed_distance));

      double mirrored = 1;
      for (const Chord &other : chords)
        if (other.leaflet == chord.leaflet && std::abs(other.s + chord.s) < 1e-12)
          mirrored = std::abs(other.length - chord.length) +
                     std::abs(other.anchor[2] + chord.anchor[2] - 2 * parameters.axis_z) +
                     std::abs(other.anchor[1] - chord.anchor[1]);
      mirror_error = std::max(mirror_error, mirrored);
    }
  std::cout << "chordae " << chords.size() << ", anterior " << n_anterior << ", struts "
            << n_struts << '\n'
            << "as long as their closed distance: " << yes(ratio_error < 1e-3) << '\n'
            << "and so in the mesh, to 0.1 cm: " << yes(insertion_error < 0.1) << '\n'
            << "both halves alike: " << yes(mirror_error < 1e-6) << '\n';
}
