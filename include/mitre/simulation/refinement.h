#ifndef mitre_simulation_refinement_h
#define mitre_simulation_refinement_h

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/parameter_handler.h>

#include <vector>

namespace mitre::simulation
{
  /**
   * What the user says about the level of the grid: boxes with a level of their own, and
   * how the grid follows the structure.
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

    /// Steps between checks whether the grid has to follow the structure; 0: never.
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
    std::vector<Region> regions;
  };
} // namespace mitre::simulation

#endif
