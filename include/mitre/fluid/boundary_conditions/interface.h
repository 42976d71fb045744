#ifndef mitre_fluid_boundary_conditions_interface_h
#define mitre_fluid_boundary_conditions_interface_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <memory>
#include <string>
#include <vector>

#include <mitre/base/plugin_registry.h>
#include <mitre/grid/staggered_space.h>

namespace mitre::fluid
{
  /**
   * The body force next to a boundary that FeedbackForcing applies.
   */
  struct FeedbackParameters
  {
    /// k dt / rho of the force k (u_b - u); 0.5 in the thesis.
    double strength = 0.;
    /// The same for the normal velocity of fluid that comes in through an open boundary.
    double backflow_damping = 0.;
    /// Number of cells over which the force falls to zero.
    double width = 4.;

    /// Declares "Feedback strength" and "Feedback width".
    static void declare_parameters(dealii::ParameterHandler &prm);
    void parse_parameters(dealii::ParameterHandler &prm);

    bool active() const
    {
      return strength > 0. || backflow_damping > 0.;
    }
  };


  /**
   * What holds on a region of the box's faces. Positions in cm, times in s.
   */
  template <int dim>
  class BoundaryCondition
  {
  public:
    virtual ~BoundaryCondition() = default;

    /// Reads the parameters of the subsection that has been entered; @p name is the
    /// condition's name in messages.
    virtual void parse_parameters(dealii::ParameterHandler &prm,
                                  const std::string &name) = 0;

    virtual grid::BoundaryKind kind() const = 0;

    /// Component @p c of the prescribed velocity [cm/s].
    virtual double
    velocity(const dealii::Point<dim> &, const unsigned int, const double) const
    {
      return 0.;
    }

    /// True if velocity() is zero everywhere, always.
    virtual bool velocity_is_zero() const
    {
      return true;
    }

    /// The prescribed pressure (minus the normal traction) [dyn/cm^2].
    virtual double pressure(const dealii::Point<dim> &, const double) const
    {
      return 0.;
    }

    /// beta of the pressure -beta rho/2 u_n^2 that is added where the fluid flows in
    /// through an open boundary (see PressureCondition).
    virtual double backflow_stabilisation() const
    {
      return 0.;
    }

    /// The body force that holds the fluid next to the boundary to the condition.
    virtual FeedbackParameters feedback() const
    {
      return {};
    }
  };


  /// All kinds of boundary conditions by name.
  template <int dim>
  const base::PluginRegistry<BoundaryCondition<dim>> &boundary_condition_registry();


  /**
   * The boundary conditions of a run: a list of names, each with faces, a region of
   * these faces, and a type. Where several match, the first in the list holds.
   */
  template <int dim>
  class BoundaryConditions
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);
    void parse_parameters(dealii::ParameterHandler &prm);

    /// Adds a condition that holds on all of the given sides (for tests and programs).
    void add(const std::string &name,
             const std::vector<unsigned int> &sides,
             std::shared_ptr<const BoundaryCondition<dim>> condition);

    /// The condition at a point; base::UserError that names face and place if none is.
    grid::BoundaryInfo info(const unsigned int side, const dealii::Point<dim> &x) const;

    grid::BoundaryKinds<dim> kinds() const
    {
      return [this](const unsigned int side, const dealii::Point<dim> &x) {
        return info(side, x);
      };
    }

    const BoundaryCondition<dim> &condition(const unsigned int number) const
    {
      return *entries[number].condition;
    }

    const std::string &name(const unsigned int number) const
    {
      return entries[number].name;
    }

    unsigned int size() const
    {
      return entries.size();
    }

    /// True if no condition prescribes a velocity other than zero.
    bool all_velocities_zero() const;

  private:
    struct Entry
    {
      std::string name;
      std::array<bool, 2 * dim> sides;
      std::function<bool(const dealii::Point<dim> &)> region;
      std::shared_ptr<const BoundaryCondition<dim>> condition;
    };
    std::vector<Entry> entries;
  };
} // namespace mitre::fluid

#endif
