#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

#include <mitre/geometry/chord_layout.h>

namespace mitre::geometry
{
  namespace
  {
    constexpr double spacing =
      0.01; // of the points that a centreline is computed with (cm)
    constexpr double rounding = 0.06; // standard deviation of the filter (cm)
    constexpr double widening = 0.4;  // way on which a chord becomes flat (cm)

    double polyline_length(const std::vector<Point3> &points,
                           const std::size_t begin,
                           const std::size_t end)
    {
      double length = 0;
      for (std::size_t i = begin; i < end; ++i)
        length += points[i].distance(points[i + 1]);
      return length;
    }


    std::vector<Point3> resample(const std::vector<Point3> &points,
                                 const unsigned int n_intervals)
    {
      std::vector<double> index(points.size());
      for (std::size_t i = 0; i < index.size(); ++i)
        index[i] = i;
      const SampledLength arc(index, points);
      std::vector<Point3> result(n_intervals + 1);
      for (unsigned int i = 0; i <= n_intervals; ++i)
        {
          const double p      = arc.parameter_at(double(i) / n_intervals);
          const std::size_t j = std::min<std::size_t>(p, points.size() - 2);
          result[i]           = points[j] + (p - j) * (points[j + 1] - points[j]);
        }
      return result;
    }


    /** Centreline with an arc of half angle @p half_angle, and the places of its two
     * ends. */
    struct Path
    {
      std::vector<Point3> points;
      std::size_t anchor, insertion;
    };

    Path make_path(const Chord &chord,
                   const MitralValveParameters &parameters,
                   const LeafletShape &shape,
                   const double half_angle)
    {
      const Vector3 along = (chord.insertion - chord.anchor) / chord.start_distance;
      const Vector3 begin =
        std::cos(half_angle) * along + std::sin(half_angle) * chord.bow;

      Path path;
      const unsigned int n_anchor =
        static_cast<unsigned int>(std::ceil(parameters.anchor_length / spacing));
      for (unsigned int i = n_anchor; i > 0; --i)
        path.points.push_back(chord.anchor -
                              (i * parameters.anchor_length / n_anchor) * begin);
      path.anchor = path.points.size();

      const double half_chord = 0.5 * chord.start_distance;
      const double length     = chord.start_distance *
                            (half_angle > 1e-8 ? half_angle / std::sin(half_angle) : 1.);
      const unsigned int n_arc = static_cast<unsigned int>(std::ceil(length / spacing));
      for (unsigned int i = 0; i <= n_arc; ++i)
        {
          const double t = -1 + 2. * i / n_arc;
          double x = half_chord * t, y = 0;
          if (half_angle > 1e-8)
            {
              const double radius = half_chord / std::sin(half_angle);
              x                   = radius * std::sin(half_angle * t);
              y = radius * (std::cos(half_angle * t) - std::cos(half_angle));
            }
          path.points.push_back(chord.anchor + (half_chord + x) * along + y * chord.bow);
        }
      path.insertion = path.points.size() - 1;

      const double phi = shape.fraction(chord.leaflet, chord.s);
      const double run_in =
        parameters.run_in * (chord.v * shape.length(phi) - parameters.root_gap);
      const unsigned int n_run_in =
        static_cast<unsigned int>(std::ceil(run_in / spacing));
      for (unsigned int i = 1; i <= n_run_in; ++i)
        path.points.push_back(
          shape.start(phi, chord.v - i * run_in / (n_run_in * shape.length(phi))));

      // One sweep of the filter (1, 2, 1)/4 has the variance spacing^2 / 2.
      const unsigned int n_sweeps =
        static_cast<unsigned int>(2 * std::pow(rounding / spacing, 2));
      std::vector<Point3> old;
      for (unsigned int sweep = 0; sweep < n_sweeps; ++sweep)
        {
          old = path.points;
          for (std::size_t i = 1; i + 1 < old.size(); ++i)
            for (unsigned int d = 0; d < 3; ++d)
              path.points[i][d] =
                0.25 * old[i - 1][d] + 0.5 * old[i][d] + 0.25 * old[i + 1][d];
        }
      return path;
    }


    void set_sections(Chord &chord,
                      const MitralValveParameters &parameters,
                      const LeafletShape &shape,
                      const Path &path)
    {
      const double before = polyline_length(path.points, 0, path.insertion);
      const double total  = polyline_length(path.points, 0, path.points.size() - 1);
      const unsigned int n =
        std::max(2, static_cast<int>(std::lround(total / parameters.chord_element_size)));
      const std::vector<Point3> centres = resample(path.points, n);

      const double phi  = shape.fraction(chord.leaflet, chord.s);
      const double side = std::sqrt(parameters.chord_area);
      chord.sections.resize(n + 1);
      chord.insertion_section = n;
      // From the end inside the leaflet, where the leaflet says how the section lies, to
      // the anchor, on the way to which it turns as little as possible.
      for (unsigned int i = n + 1; i-- > 0;)
        {
          RodSection &section = chord.sections[i];
          const double inside = total * i / n - before;
          const double v      = chord.v - std::max(0., inside) / shape.length(phi);
          const double t      = std::clamp(inside / widening, 0., 1.);
          section.centre      = centres[i];
          section.width  = side + t * t * (3 - 2 * t) * (parameters.run_in_width - side);
          section.height = parameters.chord_area / section.width;
          if (inside >= 0 || i == n)
            {
              const double eps = 1e-4;
              section.across   = shape.start(phi + eps, v) - shape.start(phi - eps, v);
              chord.insertion_section = i;
            }
          else
            section.across = chord.sections[i + 1].across;
          const Vector3 tangent =
            centres[std::min(i + 1, n)] - centres[i > 0 ? i - 1 : 0];
          section.across -= (section.across * tangent) / tangent.norm_square() * tangent;
          section.across /= section.across.norm();
        }
    }


    void lay_centreline(Chord &chord,
                        const MitralValveParameters &parameters,
                        const LeafletShape &shape)
    {
      const double wanted = parameters.chord_slack * chord.closed_distance;
      const auto length   = [](const Path &path) {
        return polyline_length(path.points, path.anchor, path.insertion);
      };

      double lower = 0, upper = 0.9 * dealii::numbers::PI;
      Path path = make_path(chord, parameters, shape, lower);
      if (length(path) < wanted)
        for (unsigned int i = 0; i < 40; ++i)
          {
            const double middle = 0.5 * (lower + upper);
            path                = make_path(chord, parameters, shape, middle);
            (length(path) < wanted ? lower : upper) = middle;
          }
      chord.length = length(path);
      set_sections(chord, parameters, shape, path);
    }
  } // namespace


  double Chord::ratio() const
  {
    return length / closed_distance;
  }


  Point3 papillary_tip(const MitralValveParameters &parameters, const int side)
  {
    return {parameters.annulus_x + parameters.papillary_depth,
            parameters.axis_y + parameters.papillary_offset,
            parameters.axis_z + 0.5 * side * parameters.papillary_distance};
  }


  std::vector<Chord> compute_chord_layout(const MitralValveParameters &parameters,
                                          const LeafletShape &shape)
  {
    std::vector<Chord> chords;
    for (const Leaflet leaflet : {Leaflet::anterior, Leaflet::posterior})
      for (const int side : {-1, 1})
        {
          const bool anterior = leaflet == Leaflet::anterior;
          const unsigned int n =
            (anterior ? parameters.n_anterior_chordae : parameters.n_posterior_chordae) /
            2;
          for (unsigned int i = 0; i < n; ++i)
            {
              Chord chord;
              chord.leaflet          = leaflet;
              chord.side             = side;
              chord.s                = side * (i + 0.5) / n;
              chord.strut            = anterior && n >= 3 && i == n / 2;
              chord.v                = chord.strut ? parameters.strut_position : 1.;
              const double phi       = shape.fraction(leaflet, chord.s);
              chord.insertion        = shape.start(phi, chord.v);
              chord.closed_insertion = shape.closed(phi, chord.v);
              chords.push_back(chord);
            }
        }

    // Anchors on the half circle around each tip that faces the tube axis, in the order
    // in which the insertions are seen from the tip, so that chordae do not cross there.
    const Point3 axis(parameters.annulus_x, parameters.axis_y, parameters.axis_z);
    for (const int side : {-1, 1})
      {
        const Point3 tip = papillary_tip(parameters, side);
        Vector3 facing({0, axis[1] - tip[1], axis[2] - tip[2]});
        facing /= facing.norm();
        const Vector3 across({0, -facing[2], facing[1]});

        std::vector<std::pair<double, Chord *>> order;
        for (Chord &chord : chords)
          if (chord.side == side)
            {
              const Vector3 to = (chord.insertion - tip) + (chord.closed_insertion - tip);
              order.emplace_back(std::atan2(to * across, to * facing), &chord);
            }
        std::sort(order.begin(), order.end());
        for (std::size_t k = 0; k < order.size(); ++k)
          {
            const double beta =
              dealii::numbers::PI *
              (order.size() > 1 ? double(k) / (order.size() - 1) - 0.5 : 0.);
            order[k].second->anchor =
              tip +
              parameters.tip_radius * (std::cos(beta) * facing + std::sin(beta) * across);
          }
      }

    for (Chord &chord : chords)
      {
        chord.start_distance  = chord.anchor.distance(chord.insertion);
        chord.closed_distance = chord.anchor.distance(chord.closed_insertion);
        const Vector3 along   = (chord.insertion - chord.anchor) / chord.start_distance;
        Vector3 outward       = 0.5 * (chord.insertion + chord.anchor) - axis;
        outward[0]            = 0;
        outward /= outward.norm();
        outward[0] = parameters.bow_downstream;
        chord.bow  = outward - (outward * along) * along;
        chord.bow /= chord.bow.norm();
        lay_centreline(chord, parameters, shape);
      }
    return chords;
  }
} // namespace mitre::geometry
