#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <mitre/base/exceptions.h>
#include <mitre/geometry/mitral_valve.h>

namespace mitre::geometry
{
  namespace
  {
    constexpr double pi = dealii::numbers::PI;

    unsigned int count(const double length, const double size, const unsigned int least)
    {
      return std::max(least, static_cast<unsigned int>(std::lround(length / size)));
    }


    /** Length of the part of the line v = const in the start shape that belongs to a
     * leaflet. */
    double line_length(const LeafletShape &shape, const Leaflet leaflet, const double v)
    {
      const unsigned int n = 400;
      double length        = 0;
      Point3 last;
      for (unsigned int i = 0; i <= n; ++i)
        {
          const Point3 x = shape.start(shape.fraction(leaflet, -1 + 2. * i / n), v);
          if (i > 0)
            length += x.distance(last);
          last = x;
        }
      return length;
    }


    double leaflet_area(const LeafletShape &shape, const Leaflet leaflet)
    {
      const unsigned int n = 400, m = 200;
      double area = 0;
      std::vector<Point3> last(m + 1), now(m + 1);
      for (unsigned int i = 0; i <= n; ++i)
        {
          const double phi = shape.fraction(leaflet, -1 + 2. * i / n);
          for (unsigned int j = 0; j <= m; ++j)
            now[j] = shape.start(phi, double(j) / m);
          if (i > 0)
            for (unsigned int j = 0; j < m; ++j)
              area +=
                0.5 * dealii::cross_product_3d(now[j + 1] - last[j], now[j] - last[j + 1])
                        .norm();
          last.swap(now);
        }
      return area;
    }
  } // namespace


  TetMesh build_leaflets(const MitralValveParameters &parameters,
                         const LeafletShape &shape,
                         const bool closed)
  {
    const double size = parameters.leaflet_element_size;
    const unsigned int n_anterior =
      count(line_length(shape, Leaflet::anterior, 0.5), size, 4);
    const unsigned int n_posterior =
      count(line_length(shape, Leaflet::posterior, 0.5), size, 4);

    std::vector<double> phi;
    double mean_length = 0;
    for (unsigned int i = 0; i < n_anterior; ++i)
      phi.push_back(shape.fraction(Leaflet::anterior, -1 + 2. * i / n_anterior));
    for (unsigned int i = 0; i <= n_posterior; ++i)
      phi.push_back(shape.fraction(Leaflet::posterior, 1 - 2. * i / n_posterior));
    for (std::size_t i = 0; i + 1 < phi.size(); ++i)
      mean_length += shape.length(phi[i]) / (phi.size() - 1);

    // v is -1 at the outer end of the root, 0 at the annulus, 1 at the free edge.
    const unsigned int n_root =
      parameters.root_length > 0 ? count(parameters.root_length, size, 1) : 0;
    const unsigned int n_free = count(mean_length, size, 2);
    std::vector<double> v;
    for (unsigned int j = 0; j < n_root; ++j)
      v.push_back(-1 + double(j) / n_root);
    for (unsigned int j = 0; j <= n_free; ++j)
      v.push_back(double(j) / n_free);

    BlockLayout layout;
    layout.n_cells = {
      {n_anterior + n_posterior, n_root + n_free, parameters.leaflet_layers}};
    layout.periodic        = true;
    layout.fibre_direction = 0;
    layout.material_id     = [&](const unsigned int i, const unsigned int j) {
      return j < n_root       ? leaflet_root
                 : i < n_anterior ? anterior_leaflet
                                  : posterior_leaflet;
    };
    TetMesh mesh = build_shell(
      layout, phi, v, parameters.leaflet_thickness, [&](const double p, const double at) {
        return at < 0   ? shape.root(p, -at * parameters.root_length)
               : closed ? shape.closed(p, at)
                        : shape.start(p, at);
      });
    mesh.materials = {{anterior_leaflet, "anterior"}, {posterior_leaflet, "posterior"}};
    if (n_root > 0)
      mesh.materials.emplace_back(leaflet_root, "root");
    return mesh;
  }


  TetMesh build_chordae(const MitralValveParameters &parameters,
                        const std::vector<Chord> &chords)
  {
    TetMesh mesh;
    mesh.materials = {{anterior_chordae, "anterior_chordae"},
                      {posterior_chordae, "posterior_chordae"},
                      {chordal_rib, "ribs"}};
    for (const Chord &chord : chords)
      {
        BlockLayout layout;
        layout.n_cells         = {{static_cast<unsigned int>(chord.sections.size() - 1),
                                   parameters.chord_cells_across,
                                   parameters.chord_cells_across}};
        layout.fibre_direction = 0;
        layout.material_id     = [&](const unsigned int i, unsigned int) {
          return i >= chord.insertion_section         ? chordal_rib
                     : chord.leaflet == Leaflet::anterior ? anterior_chordae
                                                          : posterior_chordae;
        };
        mesh.append(build_rod(layout, chord.sections));
      }
    return mesh;
  }


  TetMesh build_disc(const MitralValveParameters &parameters, const Annulus &annulus)
  {
    const double outer =
      0.5 * (parameters.tube_inner_diameter + parameters.tube_thickness);
    const auto surface = [&](const double u, const double v) {
      const double angle   = 2 * pi * u;
      const Point3 ring    = annulus.point(angle);
      const Vector3 normal = annulus.outward_normal(angle);
      const double y0      = ring[1] - parameters.disc_overlap * normal[1];
      const double z0      = ring[2] - parameters.disc_overlap * normal[2];
      const double y1      = parameters.axis_y + outer * std::cos(angle);
      const double z1      = parameters.axis_z + outer * std::sin(angle);
      const double w       = v * v * (3 - 2 * v);
      return Point3((1 - w) * ring[0] + w * parameters.annulus_x - parameters.disc_shift,
                    (1 - v) * y0 + v * y1,
                    (1 - v) * z0 + v * z1);
    };

    const double mean_radius = 0.5 * (annulus.length() / (2 * pi) + outer);
    const double width = outer - annulus.length() / (2 * pi) + parameters.disc_overlap;
    BlockLayout layout;
    layout.n_cells     = {{count(2 * pi * mean_radius, parameters.disc_element_size, 8),
                           count(width, parameters.disc_element_size, 2),
                           parameters.disc_layers}};
    layout.periodic    = true;
    layout.material_id = [](unsigned int, unsigned int) { return housing_disc; };
    std::vector<double> u(layout.n_cells[0] + 1), v(layout.n_cells[1] + 1);
    for (std::size_t i = 0; i < u.size(); ++i)
      u[i] = double(i) / layout.n_cells[0];
    for (std::size_t j = 0; j < v.size(); ++j)
      v[j] = double(j) / layout.n_cells[1];
    TetMesh mesh   = build_shell(layout, u, v, parameters.disc_thickness, surface);
    mesh.materials = {{housing_disc, "disc"}};
    return mesh;
  }


  TetMesh build_tube(const MitralValveParameters &parameters)
  {
    const double inner = 0.5 * parameters.tube_inner_diameter;
    BlockLayout layout;
    layout.n_cells     = {{count(2 * pi * (inner + 0.5 * parameters.tube_thickness),
                             parameters.tube_element_size,
                             8),
                           count(parameters.tube_length, parameters.tube_element_size, 1),
                           parameters.tube_layers}};
    layout.periodic    = true;
    layout.material_id = [](unsigned int, unsigned int) { return tube_wall; };
    TetMesh mesh =
      build_block(layout, [&](unsigned int i, unsigned int j, unsigned int k) {
        const double angle = 2 * pi * i / layout.n_cells[0];
        const double r     = inner + parameters.tube_thickness * k / layout.n_cells[2];
        return Point3(parameters.tube_length * j / layout.n_cells[1],
                      parameters.axis_y + r * std::cos(angle),
                      parameters.axis_z + r * std::sin(angle));
      });
    mesh.materials = {{tube_wall, "tube"}};
    return mesh;
  }


  std::vector<CoaptationSample> compute_coaptation_table(const LeafletShape &shape,
                                                         const unsigned int n_samples)
  {
    std::vector<CoaptationSample> table;
    for (const Leaflet leaflet : {Leaflet::anterior, Leaflet::posterior})
      for (unsigned int i = 0; i <= n_samples; ++i)
        {
          CoaptationSample sample;
          sample.leaflet   = leaflet;
          sample.s         = -1 + 2. * i / n_samples;
          const double phi = shape.fraction(leaflet, sample.s);
          sample.angle     = shape.annulus().angle(phi) * 180 / pi;
          sample.length    = shape.length(phi);
          sample.span      = shape.span(phi);
          sample.reserve   = sample.length - sample.span;
          table.push_back(sample);
        }
    return table;
  }


  double ValveMeasures::area_ratio() const
  {
    return (anterior_area + posterior_area) / annulus_area;
  }


  ValveMeasures compute_measures(const MitralValveParameters &parameters,
                                 const LeafletShape &shape,
                                 const std::vector<Chord> &chords)
  {
    ValveMeasures m{};
    m.annulus_length    = shape.annulus().length();
    m.annulus_area      = shape.annulus().projected_area();
    m.anterior_area     = leaflet_area(shape, Leaflet::anterior);
    m.posterior_area    = leaflet_area(shape, Leaflet::posterior);
    m.anterior_edge     = line_length(shape, Leaflet::anterior, 1);
    m.posterior_edge    = line_length(shape, Leaflet::posterior, 1);
    m.coaptation_length = shape.coaptation_length();

    m.least_reserve = std::numeric_limits<double>::max();
    for (const CoaptationSample &sample : compute_coaptation_table(shape, 40))
      m.least_reserve = std::min(m.least_reserve, sample.reserve);

    // The free edge as a polygon in the (y,z) plane; the leaflets take half a thickness
    // of it.
    const unsigned int n = 720;
    std::vector<Point3> edge(n);
    double circumference = 0;
    m.edge_to_tube = m.edge_to_papillary = std::numeric_limits<double>::max();
    for (unsigned int i = 0; i < n; ++i)
      edge[i] = shape.start(double(i) / n, 1);
    for (unsigned int i = 0; i < n; ++i)
      {
        const Point3 &a = edge[i], &b = edge[(i + 1) % n];
        const double ay = a[1] - parameters.axis_y, az = a[2] - parameters.axis_z;
        const double by = b[1] - parameters.axis_y, bz = b[2] - parameters.axis_z;
        m.orifice_area += 0.5 * (ay * bz - az * by);
        circumference += std::hypot(by - ay, bz - az);
        m.edge_to_tube = std::min(
          m.edge_to_tube, 0.5 * parameters.tube_inner_diameter - std::hypot(ay, az));
        for (const int side : {-1, 1})
          m.edge_to_papillary =
            std::min(m.edge_to_papillary, a.distance(papillary_tip(parameters, side)));
      }
    m.orifice_area =
      std::abs(m.orifice_area) - 0.5 * parameters.leaflet_thickness * circumference;

    m.edge_to_edge = std::numeric_limits<double>::max();
    for (int i = -50; i <= 50; ++i)
      for (int j = -50; j <= 50; ++j)
        m.edge_to_edge = std::min(
          m.edge_to_edge,
          shape.start(shape.fraction(Leaflet::anterior, 0.01 * i), 1)
            .distance(shape.start(shape.fraction(Leaflet::posterior, 0.01 * j), 1)));

    m.chord_to_leaflet = std::numeric_limits<double>::max();
    std::vector<Point3> skirt;
    for (unsigned int i = 0; i < 180; ++i)
      for (unsigned int j = 0; j <= 40; ++j)
        skirt.push_back(shape.start(i / 180., j / 40.));
    for (const Chord &chord : chords)
      for (unsigned int i = 0; i < chord.insertion_section; ++i)
        if (chord.sections[i].centre.distance(chord.insertion) > 0.5)
          for (const Point3 &y : skirt)
            m.chord_to_leaflet =
              std::min(m.chord_to_leaflet, chord.sections[i].centre.distance(y));
    return m;
  }
} // namespace mitre::geometry
