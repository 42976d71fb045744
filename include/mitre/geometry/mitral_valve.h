#ifndef mitre_geometry_mitral_valve_h
#define mitre_geometry_mitral_valve_h

#include <mitre/geometry/chord_layout.h>
#include <mitre/geometry/mesh_check.h>

namespace mitre::geometry
{
  /** Material ids of the bodies. */
  enum MaterialId : int
  {
    anterior_leaflet  = 1,
    posterior_leaflet = 2,
    anterior_chordae  = 3,
    posterior_chordae = 4,
    housing_disc      = 5,
    tube_wall         = 6,
    leaflet_root      = 7,
    chordal_rib       = 8
  };

  /** The skirt of both leaflets in the start shape, or in the assumed closed shape (to be
   *  looked at: its two sides touch). */
  TetMesh build_leaflets(const MitralValveParameters &parameters,
                         const LeafletShape &shape,
                         bool closed = false);

  TetMesh build_chordae(const MitralValveParameters &parameters,
                        const std::vector<Chord> &chords);

  /**
   * Ring from the annulus, past which it reaches inward by the overlap, to the middle of
   * the tube's wall, where it is plane.
   */
  TetMesh build_disc(const MitralValveParameters &parameters, const Annulus &annulus);

  TetMesh build_tube(const MitralValveParameters &parameters);

  /** One meridian of a leaflet in the closed valve; lengths in cm. */
  struct CoaptationSample
  {
    Leaflet leaflet;
    double s;       // -1 .. 1 from commissure to commissure
    double angle;   // on the annulus (degrees; 0 is the middle of the anterior leaflet)
    double length;  // of the leaflet
    double span;    // from the annulus straight to the coaptation line
    double reserve; // length - span: what is left for coaptation
  };

  std::vector<CoaptationSample> compute_coaptation_table(const LeafletShape &shape,
                                                         unsigned int n_samples);

  /** Numbers by which a valve is judged; cm, cm^2. */
  struct ValveMeasures
  {
    double annulus_length, annulus_area;
    double anterior_area, posterior_area; // of the mid surfaces in the start shape
    double orifice_area;                  // projected, inside the leaflets' inner faces
    double anterior_edge, posterior_edge; // length of the free edges in the start shape
    double coaptation_length;             // length of the coaptation line
    double least_reserve;                 // of the coaptation table
    double edge_to_tube;      // least distance of the free edge from the tube's wall
    double edge_to_papillary; // ... from a papillary tip
    double edge_to_edge; // least width of the orifice between anterior and posterior edge
                         // over the middle half of the leaflets
    double chord_to_leaflet; // least distance of a chord (more than 0.5 cm before its
                             // insertion) from the leaflets' mid surface

    /** Leaflet area / annulus area. */
    double area_ratio() const;
  };

  ValveMeasures compute_measures(const MitralValveParameters &parameters,
                                 const LeafletShape &shape,
                                 const std::vector<Chord> &chords);

  /**
   * Build all bodies, write them to the output folder, read the files back, check them,
   * and return the text that summary.txt gets. Throws base::UserError if the leaflets
   * cannot close, if a mesh is not sound, or if a file cannot be written.
   */
  std::string prepare_mitral_valve(const MitralValveParameters &parameters);
} // namespace mitre::geometry

#endif
