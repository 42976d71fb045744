#ifndef mitre_instruments_orifice_area_h
#define mitre_instruments_orifice_area_h

#include <array>

#include <mitre/instruments/instrument.h>

namespace mitre::instruments
{
  /**
   * The open area of a valve as it is seen along an axis, from the inlet or the outlet:
   * the area of what some parts together enclose but do not cover, projected along the
   * axis [cm^2]. In 2D the parts cover intervals of a line, and the gaps between these
   * add up [cm].
   *
   * A part of finite elements covers what its boundary covers; of fibres, the cells of
   * the network, which are closed paths of three or four segments: single strands as
   * chordae hide nothing.
   *
   * In 3D the projection is drawn on square pixels. One is covered if a triangle has its
   * centre, closed if an edge passes through it. What cannot be reached from the rim of
   * the picture through pixels that are neither is enclosed, and open where it is not
   * covered; a pixel that is only closed counts by how many of its neighbours are
   * enclosed rather than outside. Edges of surfaces are so drawn to the nearest pixel,
   * without bias: the error is far below the length of the rim times the pixel.
   */
  template <int dim>
  class OrificeArea : public Instrument<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name) override;

    std::vector<std::string> columns() const override;

    std::vector<double> measure(const Observation<dim> &observation) override;

  private:
    std::string name;
    std::vector<std::string> parts;
    unsigned int axis = 0;
    double pixel      = 0;

    /// By part, pieces of its surface: triangles (in 2D segments) between nodes.
    std::vector<std::vector<std::array<unsigned int, dim>>> surfaces;
  };


  /// The surface of a part as triangles (in 2D segments) between its nodes.
  template <int dim>
  std::vector<std::array<unsigned int, dim>>
  find_surface(const structure::Mesh<dim> &mesh);


  /**
   * Enclosed area that triangles do not cover, each the coordinates of its corners in the
   * plane, by pixels of a given width.
   */
  double compute_open_area(const std::vector<std::array<dealii::Point<2>, 3>> &triangles,
                           const double pixel,
                           const std::string &instrument);

  /// The gaps between intervals on a line.
  double compute_open_length(std::vector<std::array<double, 2>> intervals);
} // namespace mitre::instruments

#endif
