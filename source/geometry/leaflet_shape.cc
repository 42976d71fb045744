#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

#include <mitre/geometry/leaflet_shape.h>

namespace mitre::geometry
{
  namespace
  {
    /** Parabola through middle (w = 0) and end (w = 1), mirrored in z for w < 0. */
    Point3 point_on_line(const Point3 &middle, const Point3 &end, const double w)
    {
      const double q = w * w;
      return {(1 - q) * middle[0] + q * end[0],
              (1 - q) * middle[1] + q * end[1],
              middle[2] + w * (end[2] - middle[2])};
    }
  } // namespace


  LeafletShape::LeafletShape(const MitralValveParameters &parameters_)
    : parameters(parameters_)
    , ring(parameters)
    , line_middle(parameters.annulus_x + parameters.coaptation_depth,
                  parameters.axis_y + (parameters.coaptation_position - 0.5) *
                                        parameters.annulus_ap_diameter,
                  parameters.axis_z)
    , line_end(ring.point(ring.commissure_angle()))
  {
    const unsigned int n = 2000;
    std::vector<double> w(n + 1);
    std::vector<Point3> points(n + 1);
    for (unsigned int i = 0; i <= n; ++i)
      {
        w[i]      = -1 + 2. * i / n;
        points[i] = point_on_line(line_middle, line_end, w[i]);
      }
    line = SampledLength(w, points);
  }


  const Annulus &LeafletShape::annulus() const
  {
    return ring;
  }


  double LeafletShape::fraction(const Leaflet leaflet, const double s) const
  {
    const double f = parameters.anterior_fraction;
    return leaflet == Leaflet::anterior ? 0.5 * (1 + s) * f : f + 0.5 * (1 - s) * (1 - f);
  }


  std::pair<Leaflet, double> LeafletShape::position(const double phi) const
  {
    const double f = parameters.anterior_fraction;
    const double p = phi - std::floor(phi);
    if (p <= f)
      return {Leaflet::anterior, 2 * p / f - 1};
    return {Leaflet::posterior, 1 - 2 * (p - f) / (1 - f)};
  }


  double LeafletShape::length(const double phi) const
  {
    const auto [leaflet, s] = position(phi);
    const bool anterior     = leaflet == Leaflet::anterior;
    const double middle =
      anterior ? parameters.anterior_length : parameters.posterior_length;
    const double fullness =
      anterior ? parameters.anterior_fullness : parameters.posterior_fullness;
    const double c =
      std::cos(0.5 * dealii::numbers::PI * std::pow(std::abs(s), fullness));
    double length =
      parameters.commissural_length + (middle - parameters.commissural_length) * c * c;
    if (!anterior)
      {
        const double t = (std::abs(s) - 0.36) / 0.1;
        length *= 1 - parameters.scallop_depth * std::exp(-t * t);
      }
    return length;
  }


  Point3 LeafletShape::start(const double phi, const double v) const
  {
    const double angle = ring.angle(phi);
    const Point3 root  = ring.point(angle);
    const double dy    = parameters.axis_y + parameters.orifice_centre +
                      0.5 * parameters.orifice_ap_width * std::cos(angle) - root[1];
    const double dz =
      parameters.axis_z + 0.5 * parameters.orifice_comm_width * std::sin(angle) - root[2];
    const double inward = std::hypot(dy, dz);
    const double l      = length(phi);
    const double bend =
      std::max(1e-6, parameters.profile_angle * dealii::numbers::PI / 180.);

    // The arc of length l and end tangents at +-bend has the chord l sin(bend)/bend; the
    // chord leans such that it covers the horizontal distance to the orifice's ellipse.
    const double chord = l * std::sin(bend) / bend;
    const double lean  = std::acos(std::min(1., inward / chord));
    const double begin = lean - bend, now = begin + 2 * bend * v;
    const double scale = l / (2 * bend);
    const double r     = scale * (std::sin(now) - std::sin(begin));
    const double depth = scale * (std::cos(begin) - std::cos(now));
    return {root[0] + depth, root[1] + r * dy / inward, root[2] + r * dz / inward};
  }


  Point3 LeafletShape::coaptation_point(const Leaflet leaflet, const double s) const
  {
    const double w = line.parameter_at(0.5 * (1 + s));
    Point3 p       = point_on_line(line_middle, line_end, w);
    // Normal of the line in the (y,z) plane, towards the anterior leaflet.
    const double ty    = 2 * w * (line_end[1] - line_middle[1]),
                 tz    = line_end[2] - line_middle[2];
    const double shift = (leaflet == Leaflet::anterior ? 0.5 : -0.5) *
                         parameters.leaflet_thickness * (1 - std::pow(w, 4)) /
                         std::hypot(ty, tz);
    p[1] += shift * tz;
    p[2] -= shift * ty;
    return p;
  }


  Point3 LeafletShape::closed(const double phi, const double v) const
  {
    const auto [leaflet, s] = position(phi);
    const Point3 root       = ring.point(ring.angle(phi));
    const Point3 knee       = coaptation_point(leaflet, s);
    const double reach      = root.distance(knee);
    const double l          = v * length(phi);
    if (l < reach)
      return root + (l / reach) * (knee - root);
    return knee + Point3(l - reach, 0, 0);
  }


  Point3 LeafletShape::root(const double phi, const double distance) const
  {
    const double angle = ring.angle(phi);
    return ring.point(angle) + distance * ring.outward_normal(angle);
  }


  double LeafletShape::span(const double phi) const
  {
    const auto [leaflet, s] = position(phi);
    return ring.point(ring.angle(phi)).distance(coaptation_point(leaflet, s));
  }


  double LeafletShape::coaptation_length() const
  {
    return line.total();
  }
} // namespace mitre::geometry
