#ifndef mitre_geometry_chord_layout_h
#define mitre_geometry_chord_layout_h

#include <array>
#include <vector>

#include <mitre/geometry/leaflet_shape.h>
#include <mitre/geometry/tet_mesh.h>

namespace mitre::geometry
{
  /** One chord: where it runs, and its lengths in cm. */
  struct Chord
  {
    Leaflet leaflet = Leaflet::anterior;
    int side        = 1; // -1 or +1: sign of z of its papillary tip
    double s = 0, v = 0; // material coordinates of its insertion, see LeafletShape
    bool strut = false;  // inserts inside the leaflet, not at its free edge

    Point3 anchor, insertion, closed_insertion;
    double start_distance  = 0; // anchor to insertion in the start shape
    double closed_distance = 0; // anchor to insertion in the assumed closed shape
    double length          = 0; // along the centreline from anchor to insertion

    /** From the held end behind the anchor to the end inside the leaflet, evenly spaced.
     */
    std::vector<RodSection> sections;
    /** First section inside the leaflet. */
    unsigned int insertion_section = 0;
    /** Direction away from the tube axis into which it is bowed. */
    Vector3 bow;

    /** length / closed_distance: below 1 the chord holds the valve open, far above 1 the
     *  leaflet prolapses. */
    double ratio() const;
  };

  /** Papillary tip on the side -1 or +1 of z. */
  Point3 papillary_tip(const MitralValveParameters &parameters, int side);

  /**
   * Spread the chordae evenly over the free edges (the middle anterior ones of each side
   * are struts) and lay each along an arc of a circle whose length is slack times the
   * distance between anchor and closed insertion. Where that is less than the start
   * distance the chord is straight, and its ratio larger than the slack asked for.
   *
   * Inside the leaflet a chord follows the meridian towards the annulus; its section
   * turns from a square to a flat rectangle of the same area in the plane of the leaflet.
   *
   * Corners are rounded by a binomial filter (standard deviation 0.06 cm); the arc is
   * chosen such that the length is right after rounding.
   */
  std::vector<Chord> compute_chord_layout(const MitralValveParameters &parameters,
                                          const LeafletShape &shape);
} // namespace mitre::geometry

#endif
