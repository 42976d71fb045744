#ifndef mitre_instruments_measuring_disc_h
#define mitre_instruments_measuring_disc_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>

#include <string>

#include <mitre/grid/patch_grid.h>

namespace mitre::instruments
{
  /**
   * A disc across one of the axes (in two dimensions a line), or the whole cross-section
   * of the box.
   */
  template <int dim>
  struct MeasuringDisc
  {
    unsigned int axis = 0;

    /// Coordinate along the axis [cm].
    double position = 0;

    /// [cm]; its coordinate along the axis has no meaning.
    dealii::Point<dim> centre;

    /// [cm]; 0: the whole cross-section.
    double radius = 0;

    /// All of them, or all but the position.
    static void declare_parameters(dealii::ParameterHandler &prm);
    static void declare_cross_section(dealii::ParameterHandler &prm);

    /// @param instrument for messages
    void parse_parameters(dealii::ParameterHandler &prm, const std::string &instrument);
    void parse_cross_section(dealii::ParameterHandler &prm,
                             const std::string &instrument);

    /// Whether @p x lies in the cylinder over the disc.
    bool contains(const dealii::Point<dim> &x) const;

    /// Whether the cross-section of @p patch, of n cells a side, comes near the disc.
    bool may_touch(const grid::Patch<dim> &patch, const unsigned int n) const;

    /// base::UserError unless the disc's position is within @p box.
    void check_inside(const dealii::BoundingBox<dim> &box,
                      const std::string &instrument) const;

    /// "the disc of radius 2 cm around (4, 4, 4) cm"
    std::string describe() const;
  };


  /// The axis "x", "y" or "z" as a number; base::UserError if there is none in dim
  /// dimensions.
  template <int dim>
  unsigned int parse_axis(const std::string &axis, const std::string &instrument);
} // namespace mitre::instruments

#endif
