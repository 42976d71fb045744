#ifndef mitre_geometry_fibre_surface_h
#define mitre_geometry_fibre_surface_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>

#include <array>
#include <iosfwd>
#include <string>
#include <vector>

#include <mitre/io/fibre_files.h>

namespace mitre::geometry
{
  /// A surface of quadrilaterals; corners in the order around each.
  struct QuadSurface
  {
    std::vector<dealii::Point<3>> nodes;
    std::vector<std::array<unsigned int, 4>> quads;
  };


  /// A thin sheet of one linear elastic material.
  struct SheetParameters
  {
    /// Young's modulus [dyn/cm^2]
    double modulus = 0;

    /// [cm]
    double thickness = 0;

    /// Whether the small cells have springs along their diagonals.
    bool diagonals = false;

    /// Whether the surface is without bending moments in its shape at rest, or, if not,
    /// where it is flat. Nodes within quadrilaterals lie on straight lines between
    /// corners; a curved surface that is flat at rest begins with all of its bending at
    /// the corners, and twice the energy, until its nodes have moved.
    bool curved_at_rest = true;
  };


  /**
   * Fibres that span a surface as in section 3.2: each quadrilateral has fibres along its
   * sides, which it shares with its neighbours, and along the two lines through its
   * centre from side to side, all of two segments: eight segments for each quadrilateral,
   * if those on its sides count half. Beams join neighbouring segments of a fibre within
   * quadrilaterals and across their sides; they end at the edge of the surface and at
   * nodes inside that do not have four quadrilaterals.
   *
   * A segment of length ds that stands for a strip of width dr (half of the cell on each
   * side) has the stiffness E h dr / ds, a beam, by (3.3), E dr h^3 / (12 ds^3), with the
   * means of its two segments. So a sheet that is stretched or bent along its fibres has
   * the membrane stiffness E h and the bending stiffness E h^3/12 for each unit of width,
   * as with a Poisson ratio of 0. A lattice of these springs alone does not resist shear,
   * and bending along a diagonal only as far as it bends fibres.
   *
   * With diagonals, cells with the sides a and b have springs of
   * @f$\frac{3}{16} E h \frac{a^2 + b^2}{a b}@f$ along both diagonals, and their part of
   * the stiffness of a side of length a is
   * @f$\frac{E h b}{2 a} (\frac{9}{8} - \frac{3}{8} \frac{a^2}{b^2})@f$: the lattice of
   * rectangles then is isotropic for small strains, with the membrane stiffness of E, h
   * and a Poisson ratio of 1/3 in plane stress, the only one that central forces between
   * neighbours can have. Needs a / b < sqrt(3).
   *
   * Throws base::UserError if a quadrilateral is degenerate or too long for diagonals, or
   * if a side belongs to more than two of them.
   */
  structure::FibreNetwork<3> make_fibres(const QuadSurface &surface,
                                         const SheetParameters &parameters);


  /**
   * The quadrilaterals of a gmsh file (ASCII, version 2.2); elements of other kinds are
   * skipped. @p source is the file's name for messages. Throws base::UserError, which
   * names it.
   */
  QuadSurface read_quad_surface(std::istream &in, const std::string &source);


  /// What a parameter file says about a surface of fibres.
  struct FibreSurfaceParameters
  {
    std::string mesh_file, output;
    SheetParameters sheet;

    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm);
  };


  /// Reads the surface, writes the fibre files, and returns a summary.
  std::string prepare_fibre_surface(const FibreSurfaceParameters &parameters);
} // namespace mitre::geometry

#endif
