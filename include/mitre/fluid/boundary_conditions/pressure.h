#ifndef mitre_fluid_boundary_conditions_pressure_h
#define mitre_fluid_boundary_conditions_pressure_h

#include <mitre/base/expression.h>
#include <mitre/base/time_table.h>
#include <mitre/fluid/boundary_conditions/interface.h>

namespace mitre::fluid
{
  /// A pressure [dyn/cm^2] that a parameter file gives: an expression of place and time,
  /// plus a column of a table over time.
  template <int dim>
  class GivenPressure
  {
  public:
    /// Declares "Pressure" and the table's parameters.
    static void declare_parameters(dealii::ParameterHandler &prm);

    /// @p section is that of the parameters, @p owner what they belong to, for messages.
    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &section,
                          const std::string &owner);

    double value(const dealii::Point<dim> &x, const double t) const;

  private:
    base::Expression<dim> expression;
    std::shared_ptr<base::TimeTable> table;
    unsigned int column = 0;
  };


  /**
   * An open boundary with a given pressure: normal traction -p and zero tangential
   * velocity. (On such a boundary the normal viscous stress vanishes, because the
   * divergence and the tangential derivatives of the tangential velocity do.) The
   * pressure is an expression of place and time, or a column of a table over time, and a
   * shift that the run may change between steps.
   *
   * Backflow stabilisation lowers the pressure by beta rho/2 u_n^2 where the normal
   * velocity u_n points into the domain. For beta = 1 the kinetic energy that comes in
   * with the fluid is then matched by the work of the boundary, so that it cannot grow
   * without a difference of the given pressures: Bruneau and Fabrie, Int. J. Numer.
   * Meth. Fluids 19 (1994) 693; Esmaily Moghadam et al., Comput. Mech. 48 (2011) 277.
   */
  template <int dim>
  class PressureCondition : public BoundaryCondition<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);
    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name) override;

    grid::BoundaryKind kind() const override
    {
      return grid::BoundaryKind::traction;
    }

    double pressure(const dealii::Point<dim> &x, const double t) const override;

    double backflow_stabilisation() const override
    {
      return beta;
    }

    FeedbackParameters feedback() const override
    {
      return feedback_parameters;
    }

    /// Added to the pressure everywhere [dyn/cm^2]. It is not of the condition that the
    /// parameters describe, but of the run that adjusts it, which only reads conditions.
    void set_shift(const double pressure) const
    {
      *shift = pressure;
    }

  private:
    GivenPressure<dim> given;
    std::shared_ptr<double> shift = std::make_shared<double>(0.);
    double beta                   = 0.;
    FeedbackParameters feedback_parameters;
  };
} // namespace mitre::fluid

#endif
