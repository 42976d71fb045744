#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

#include <mitre/geometry/annulus.h>

namespace mitre::geometry
{
  SampledLength::SampledLength(std::vector<double> parameters_,
                               const std::vector<Point3> &points)
    : parameters(std::move(parameters_))
    , lengths(points.size(), 0.)
  {
    for (std::size_t i = 1; i < points.size(); ++i)
      lengths[i] = lengths[i - 1] + points[i].distance(points[i - 1]);
  }


  double SampledLength::total() const
  {
    return lengths.back();
  }


  double SampledLength::parameter_at(const double fraction) const
  {
    const double length = std::clamp(fraction, 0., 1.) * total();
    const std::size_t i = std::clamp<std::size_t>(
      std::upper_bound(lengths.begin(), lengths.end(), length) - lengths.begin(),
      1,
      lengths.size() - 1);
    const double t = (length - lengths[i - 1]) / (lengths[i] - lengths[i - 1]);
    return (1 - t) * parameters[i - 1] + t * parameters[i];
  }


  Annulus::Annulus(const MitralValveParameters &parameters)
    : centre(parameters.annulus_x, parameters.axis_y, parameters.axis_z)
    , semi_axis_y(0.5 * parameters.annulus_ap_diameter)
    , semi_axis_z(0.5 * parameters.annulus_comm_diameter)
    , saddle_height(parameters.saddle_height())
    , half_anterior_fraction(0.5 * parameters.anterior_fraction)
  {
    const unsigned int n = 4000;
    std::vector<double> angles(n + 1);
    std::vector<Point3> points(n + 1);
    for (unsigned int i = 0; i <= n; ++i)
      {
        angles[i] = 2 * dealii::numbers::PI * i / n;
        points[i] = point(angles[i]);
      }
    arc = SampledLength(angles, points);
  }


  Point3 Annulus::point(const double angle) const
  {
    return {centre[0] - 0.5 * saddle_height * std::cos(2 * angle),
            centre[1] + semi_axis_y * std::cos(angle),
            centre[2] + semi_axis_z * std::sin(angle)};
  }


  Vector3 Annulus::outward_normal(const double angle) const
  {
    Vector3 normal;
    normal[1] = std::cos(angle) / semi_axis_y;
    normal[2] = std::sin(angle) / semi_axis_z;
    return normal / normal.norm();
  }


  double Annulus::angle(const double fraction) const
  {
    const double f     = fraction - half_anterior_fraction;
    const double turns = std::floor(f);
    return 2 * dealii::numbers::PI * turns + arc.parameter_at(f - turns);
  }


  double Annulus::length() const
  {
    return arc.total();
  }


  double Annulus::projected_area() const
  {
    return dealii::numbers::PI * semi_axis_y * semi_axis_z;
  }


  double Annulus::commissure_angle() const
  {
    return angle(2 * half_anterior_fraction);
  }
} // namespace mitre::geometry
