#ifndef mitre_geometry_annulus_h
#define mitre_geometry_annulus_h

#include <deal.II/base/point.h>

#include <vector>

#include <mitre/geometry/mitral_valve_parameters.h>

namespace mitre::geometry
{
  using Point3  = dealii::Point<3>;
  using Vector3 = dealii::Tensor<1, 3>;

  /** A curve given by samples, to be walked through by its length. */
  class SampledLength
  {
  public:
    SampledLength() = default;

    /** @p parameters increase; @p points are the curve's points there. */
    SampledLength(std::vector<double> parameters, const std::vector<Point3> &points);

    /** Total length (cm). */
    double total() const;

    /** Parameter at which a fraction in [0, 1] of the length is behind us. */
    double parameter_at(double fraction) const;

  private:
    std::vector<double> parameters, lengths;
  };

  /**
   * The annulus: with the angle a from the middle of the anterior leaflet,
   *
   *   x = x_0 - H/2 cos(2 a),  y = y_0 + A/2 cos(a),  z = z_0 + C/2 sin(a),
   *
   * where H is the saddle height, A the anterior-posterior and C the commissural
   * diameter. High points (towards the atrium) lie in the middle of the leaflets, low
   * points on the commissural diameter.
   */
  class Annulus
  {
  public:
    explicit Annulus(const MitralValveParameters &parameters);

    Point3 point(double angle) const;

    /** Unit normal of the projection along x, which points outward. */
    Vector3 outward_normal(double angle) const;

    /**
     * Angle at a fraction of the annulus' length, counted from the commissure on the -z
     * side through the anterior leaflet, then the posterior one. Not limited to [0, 1].
     */
    double angle(double fraction) const;

    /** Length of the curve (cm). */
    double length() const;

    /** Area enclosed by its projection along x (cm^2). */
    double projected_area() const;

    /** Angle of the commissure on the +z side; the other one has the negative angle. */
    double commissure_angle() const;

  private:
    Point3 centre;
    double semi_axis_y, semi_axis_z, saddle_height, half_anterior_fraction;
    SampledLength arc;
  };
} // namespace mitre::geometry

#endif
