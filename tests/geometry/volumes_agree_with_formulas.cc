// Volumes of the bodies against formulas. The tube is a prism over a regular n-gon ring:
// n/2 sin(2 pi/n) (R^2 - r^2) L to round-off, and pi (R^2 - r^2) L but for O(1/n^2),
// under 1 %. A rod of straight centreline has area times length to round-off; the
// chordae, whose polygons cut corners, that to 2 %. The leaflets have area times
// thickness to 2 % (the area is integrated over the smooth mid surface). The plane
// annulus is an ellipse: its length against Ramanujan's formula, which is exact to 1e-6
// here.

#include <deal.II/base/numbers.h>

#include <cmath>
#include <iostream>

#include <mitre/geometry/mitral_valve.h>

using namespace mitre::geometry;

namespace
{
  void compare(const char *what,
               const double value,
               const double expected,
               const double tolerance)
  {
    const double error = std::abs(value / expected - 1);
    std::cout << what << ": ";
    if (error < tolerance)
      std::cout << "ok\n";
    else
      std::cout << value << " instead of " << expected << '\n';
  }
} // namespace

int
main()
{
  const double pi = dealii::numbers::PI;
  dealii::ParameterHandler prm;
  MitralValveParameters::declare_parameters(prm);
  prm.enter_subsection("Leaflets");
  prm.set("Element size", "0.1");
  prm.leave_subsection();
  prm.enter_subsection("Chordae");
  prm.set("Element size", "0.05");
  prm.leave_subsection();
  prm.enter_subsection("Annulus");
  prm.set("Shape", "elliptical");
  prm.leave_subsection();
  MitralValveParameters parameters;
  parameters.parse_parameters(prm);

  const double r = 2.8, R = 2.8 + parameters.tube_thickness, L = 16;
  const double n    = std::round(pi * (r + R) / parameters.tube_element_size);
  const double tube = check_mesh(build_tube(parameters)).total_volume();
  compare(
    "tube, polygon", tube, 0.5 * n * std::sin(2 * pi / n) * (R * R - r * r) * L, 1e-12);
  compare("tube, circle", tube, pi * (R * R - r * r) * L, 0.01);

  BlockLayout layout;
  layout.n_cells     = {{3, 2, 2}};
  layout.material_id = [](unsigned int, unsigned int) { return 1; };
  std::vector<RodSection> sections(4);
  for (unsigned int i = 0; i < 4; ++i)
    {
      sections[i].centre = Point3(1 + 0.3 * i, 2 - 0.4 * i, 1.2 * i);
      sections[i].across = Vector3({0, 1, 1});
      sections[i].width  = 0.2;
      sections[i].height = 0.1;
    }
  compare("straight rod",
          check_mesh(build_rod(layout, sections)).total_volume(),
          0.02 * 3.9,
          1e-12);

  const LeafletShape shape(parameters);
  const std::vector<Chord> chords = compute_chord_layout(parameters, shape);
  double length                   = 0;
  for (const Chord &chord : chords)
    for (std::size_t i = 1; i < chord.sections.size(); ++i)
      length += chord.sections[i].centre.distance(chord.sections[i - 1].centre);
  compare("chordae",
          check_mesh(build_chordae(parameters, chords)).total_volume(),
          0.016 * length,
          0.02);

  const ValveMeasures measures = compute_measures(parameters, shape, chords);
  const MeshReport leaflets    = check_mesh(build_leaflets(parameters, shape));
  compare("anterior leaflet", leaflets.volume.at(1), 0.1 * measures.anterior_area, 0.02);
  compare(
    "posterior leaflet", leaflets.volume.at(2), 0.1 * measures.posterior_area, 0.02);

  const double a = 0.5 * parameters.annulus_ap_diameter;
  const double b = 0.5 * parameters.annulus_comm_diameter;
  const double h = (a - b) * (a - b) / ((a + b) * (a + b));
  compare("annulus length",
          measures.annulus_length,
          pi * (a + b) * (1 + 3 * h / (10 + std::sqrt(4 - 3 * h))),
          1e-5);
  compare("annulus area", measures.annulus_area, pi * a * b, 1e-12);
}
