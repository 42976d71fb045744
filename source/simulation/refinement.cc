#include <algorithm>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/simulation/refinement.h>

namespace mitre::simulation
{
  using namespace dealii;

  template <int dim>
  void Refinement<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.declare_entry(
      "Structure buffer",
      "2",
      Patterns::Double(0., 64.),
      "Cells that have a part's level beyond the reach of its kernels. The "
      "grid is rebuilt when a part may have moved by half of it.");
    prm.declare_entry(
      "Check interval",
      "10",
      Patterns::Integer(0),
      "Time steps between checks whether the grid has to follow the parts and "
      "the vorticity; 0: it never changes.");
    prm.declare_entry(
      "Vorticity change",
      "0",
      Patterns::Double(0.),
      "If not 0: patches where vorticity times cell width, the change of the velocity "
      "across a cell, is larger than this [cm/s] are refined by a level at each check, "
      "and those where it is less than a third of this are coarsened.");
    prm.declare_entry("Vorticity level",
                      "12",
                      Patterns::Integer(0, 12),
                      "Finest level that the vorticity may ask for.");
    const auto names =
      base::declare_names(prm,
                          "Refinement boxes",
                          "",
                          "Names of boxes with a level of their own; each "
                          "has a subsection \"Box NAME\".");
    for (const std::string &name : names)
      {
        prm.enter_subsection("Box " + name);
        prm.declare_entry("Lower corner",
                          dim == 2 ? "0, 0" : "0, 0, 0",
                          Patterns::List(Patterns::Double(), dim, dim),
                          "Corner with the smallest coordinates [cm].");
        prm.declare_entry("Upper corner",
                          dim == 2 ? "0, 0" : "0, 0, 0",
                          Patterns::List(Patterns::Double(), dim, dim),
                          "Corner with the largest coordinates [cm].");
        prm.declare_entry("Level",
                          "0",
                          Patterns::Integer(0, 12),
                          "Level that patches which meet the box have at least.");
        prm.leave_subsection();
      }
  }


  template <int dim>
  void Refinement<dim>::parse_parameters(ParameterHandler &prm)
  {
    buffer_cells           = prm.get_double("Structure buffer");
    check_interval         = prm.get_integer("Check interval");
    largest_change         = prm.get_double("Vorticity change");
    finest_vorticity_level = prm.get_integer("Vorticity level");
    regions.clear();
    for (const std::string &name : base::parse_names(prm.get("Refinement boxes")))
      {
        prm.enter_subsection("Box " + name);
        const std::string what = "Grid / Refinement / Box " + name;
        const Point<dim> lower =
          base::parse_point<dim>(prm.get("Lower corner"), what + " / Lower corner");
        const Point<dim> upper =
          base::parse_point<dim>(prm.get("Upper corner"), what + " / Upper corner");
        for (unsigned int d = 0; d < dim; ++d)
          AssertThrow(lower[d] < upper[d],
                      base::UserError(what + ": \"Upper corner\" is " +
                                      prm.get("Upper corner") +
                                      ", but must be above \"Lower corner\", which is " +
                                      prm.get("Lower corner") + ", in each direction."));
        Region region;
        region.box   = BoundingBox<dim>(std::make_pair(lower, upper));
        region.level = prm.get_integer("Level");
        regions.push_back(region);
        prm.leave_subsection();
      }
  }


  template <int dim>
  int Refinement<dim>::wanted_level(const BoundingBox<dim> &leaf) const
  {
    int wanted                 = 0;
    const auto &[lower, upper] = leaf.get_boundary_points();
    for (const Region &region : regions)
      {
        const auto &[a, b] = region.box.get_boundary_points();
        bool meets         = true;
        for (unsigned int d = 0; d < dim; ++d)
          meets = meets && lower[d] < b[d] && upper[d] > a[d];
        if (meets)
          wanted = std::max(wanted, region.level);
      }
    return wanted;
  }


  template class Refinement<2>;
  template class Refinement<3>;
} // namespace mitre::simulation
