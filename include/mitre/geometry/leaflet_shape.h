#ifndef mitre_geometry_leaflet_shape_h
#define mitre_geometry_leaflet_shape_h

#include <mitre/geometry/annulus.h>

namespace mitre::geometry
{
  enum class Leaflet
  {
    anterior,
    posterior
  };

  /**
   * Mid surface of the skirt that both leaflets form, in two shapes: the start shape, a
   * half open funnel, and the shape that it is assumed to take when it is shut.
   *
   * A material point has the coordinates (phi, v): phi in [0, 1) is the fraction of the
   * annulus' length from the -z commissure (anterior leaflet first, see
   * Annulus::angle()), and v in [0, 1] the fraction of the leaflet's length from annulus
   * to free edge. Inside one leaflet, s in [-1, 1] counts from its -z to its +z
   * commissure.
   */
  class LeafletShape
  {
  public:
    explicit LeafletShape(const MitralValveParameters &parameters);

    const Annulus &annulus() const;

    /** Coordinate phi of the meridian @p s of a leaflet. */
    double fraction(Leaflet leaflet, double s) const;

    /** Length from annulus to free edge (cm). */
    double length(double phi) const;

    /**
     * Start shape: each meridian is an arc of a circle of length length(phi) in the plane
     * parallel to x that runs from its annulus point to the point with the same angle on
     * the orifice's ellipse.
     */
    Point3 start(double phi, double v) const;

    /**
     * Assumed closed shape: each meridian runs straight from the annulus to the
     * coaptation line, and what is left of its length hangs down along x. Lengths along
     * meridians are kept. The coaptation line joins the commissures; its projection along
     * x is a parabola; meridians of both leaflets are spread over it evenly.
     */
    Point3 closed(double phi, double v) const;

    /** Point at @p distance (cm) outward from the annulus, on the straight continuation
     * of the leaflet's root. */
    Point3 root(double phi, double distance) const;

    /** Straight distance from the annulus to the coaptation line (cm). */
    double span(double phi) const;

    /** Length of the coaptation line (cm). */
    double coaptation_length() const;

  private:
    /** Leaflet and s that belong to phi. */
    std::pair<Leaflet, double> position(double phi) const;

    /** Point of the coaptation line, moved by half a leaflet's thickness to the leaflet's
     * side. */
    Point3 coaptation_point(Leaflet leaflet, double s) const;

    MitralValveParameters parameters;
    Annulus ring;
    Point3 line_middle, line_end;
    SampledLength line;
  };
} // namespace mitre::geometry

#endif
