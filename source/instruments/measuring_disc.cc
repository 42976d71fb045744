#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/instruments/measuring_disc.h>
#include <mitre/structure/mesh.h>

namespace mitre::instruments
{
  template <int dim>
  void MeasuringDisc<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    declare_cross_section(prm);
    prm.declare_entry("Position",
                      "0",
                      dealii::Patterns::Double(),
                      "Coordinate of the disc along the axis [cm].");
  }


  template <int dim>
  void MeasuringDisc<dim>::declare_cross_section(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Axis",
                      "x",
                      dealii::Patterns::Selection("x|y|z"),
                      "The disc lies across this axis.");
    prm.declare_entry("Radius",
                      "0",
                      dealii::Patterns::Double(0),
                      "Radius of the disc [cm]; 0: the whole cross-section of the box.");
    prm.declare_entry("Centre",
                      "",
                      dealii::Patterns::List(dealii::Patterns::Double(), 0, 3),
                      "The other coordinates of the disc's centre, for the axis y those "
                      "in x and z [cm]. Needed if the radius is not 0.");
  }


  template <int dim>
  void MeasuringDisc<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                            const std::string &instrument)
  {
    parse_cross_section(prm, instrument);
    position = prm.get_double("Position");
  }


  template <int dim>
  void MeasuringDisc<dim>::parse_cross_section(dealii::ParameterHandler &prm,
                                               const std::string &instrument)
  {
    axis   = parse_axis<dim>(prm.get("Axis"), instrument);
    radius = prm.get_double("Radius");
    if (radius == 0)
      return;

    const std::vector<double> others =
      base::parse_numbers(prm.get("Centre"), "Instrument " + instrument + ", Centre");
    AssertThrow(
      others.size() == dim - 1,
      base::UserError("Instrument " + instrument + ": Centre has " +
                      std::to_string(others.size()) + " number(s), expected are the " +
                      std::to_string(dim - 1) + " coordinate(s) across the axis " +
                      prm.get("Axis") + "."));
    unsigned int i = 0;
    for (unsigned int d = 0; d < dim; ++d)
      if (d != axis)
        centre[d] = others[i++];
  }


  template <int dim>
  bool MeasuringDisc<dim>::contains(const dealii::Point<dim> &x) const
  {
    if (radius == 0)
      return true;
    double square = 0;
    for (unsigned int d = 0; d < dim; ++d)
      if (d != axis)
        square += (x[d] - centre[d]) * (x[d] - centre[d]);
    return square <= radius * radius;
  }


  template <int dim>
  bool MeasuringDisc<dim>::may_touch(const grid::Patch<dim> &patch,
                                     const unsigned int n) const
  {
    bool near = true;
    if (radius > 0)
      for (unsigned int d = 0; d < dim; ++d)
        if (d != axis)
          near = near && centre[d] + radius >= patch.lower[d] &&
                 centre[d] - radius <= patch.lower[d] + n * patch.h[d];
    return near;
  }


  template <int dim>
  void MeasuringDisc<dim>::check_inside(const dealii::BoundingBox<dim> &box,
                                        const std::string &instrument) const
  {
    const double lower = box.lower_bound(axis), upper = box.upper_bound(axis);
    if (lower <= position && position <= upper)
      return;
    std::ostringstream text;
    text << "Instrument " << instrument << ": its position " << position
         << " cm is outside of the box, which reaches from " << lower << " to " << upper
         << " cm along the axis "
         << "xyz"[axis] << ".";
    throw base::UserError(text.str());
  }


  template <int dim>
  unsigned int parse_axis(const std::string &axis, const std::string &instrument)
  {
    const unsigned int number = axis == "x" ? 0 : axis == "y" ? 1 : 2;
    AssertThrow(number < dim,
                base::UserError("Instrument " + instrument + ": a run in " +
                                std::to_string(dim) + " dimensions has no axis " + axis +
                                "."));
    return number;
  }


  template <int dim>
  std::string MeasuringDisc<dim>::describe() const
  {
    std::ostringstream text;
    text << "the disc of radius " << radius << " cm around "
         << structure::to_string(centre) << " cm";
    return text.str();
  }


  template struct MeasuringDisc<2>;
  template struct MeasuringDisc<3>;
  template unsigned int parse_axis<2>(const std::string &, const std::string &);
  template unsigned int parse_axis<3>(const std::string &, const std::string &);
} // namespace mitre::instruments
