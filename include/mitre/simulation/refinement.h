#ifndef mitre_simulation_refinement_h
#define mitre_simulation_refinement_h

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/parameter_handler.h>

#include <vector>

namespace mitre::simulation
{
  /**
   * What the user says about the level of the grid: boxes with a level of their own, and
   * how the grid follows the structure and the vorticity.
   */
  template <int dim>
  class Refinement
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);
    void parse_parameters(dealii::ParameterHandler &prm);

    /// The level that the user's boxes ask for in a leaf.
    int wanted_level(const dealii::BoundingBox<dim> &leaf) const;

    /// Cells between a structure's kernels and a coarser level.
    double buffer() const
    {
      return buffer_cells;
    }

    /// Change of the velocity across a cell [cm/s] beyond which vorticity refines the
    /// grid; 0: it does not.
    double vorticity_change() const
    {
      return largest_change;
    }

    /// Finest level that the vorticity may ask for.
    int vorticity_level() const
    {
      return finest_vorticity_level;
    }

    /// Steps between checks whether the grid has to follow structure and flow; 0: never.
    unsigned int interval() const
    {
      return check_interval;
    }

  private:
    struct Region
    {
      dealii::BoundingBox<dim> box;
      int level;
    };
    double buffer_cells         = 2.;
    unsigned int check_interval = 10;
    double largest_change       = 0.;
    int finest_vorticity_level  = 12;
    std::vector<Region> regions;
  };
} // namespace mitre::simulation

#endif
