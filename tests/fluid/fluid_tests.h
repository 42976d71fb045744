#ifndef mitre_tests_fluid_tests_h
#define mitre_tests_fluid_tests_h

#include <mitre/fluid/boundary_conditions/wall.h>
#include <mitre/fluid/navier_stokes.h>

#include "../grid/grid_tests.h"

namespace fluid_tests
{
  using namespace dealii;
  using namespace mitre;

  /// A condition of velocity or pressure from a function of place, component and time.
  template <int dim>
  class Given : public fluid::BoundaryCondition<dim>
  {
  public:
    using Function =
      std::function<double(const Point<dim> &, const unsigned int, const double)>;

    Given(const grid::BoundaryKind kind, const Function &function)
      : boundary_kind(kind)
      , function(function)
    {
    }

    void parse_parameters(ParameterHandler &, const std::string &) override
    {
    }

    grid::BoundaryKind kind() const override
    {
      return boundary_kind;
    }

    double
    velocity(const Point<dim> &x, const unsigned int c, const double t) const override
    {
      return boundary_kind == grid::BoundaryKind::velocity ? function(x, c, t) : 0.;
    }

    bool velocity_is_zero() const override
    {
      return boundary_kind != grid::BoundaryKind::velocity;
    }

    double pressure(const Point<dim> &x, const double t) const override
    {
      return function(x, dim, t);
    }

  private:
    const grid::BoundaryKind boundary_kind;
    const Function function;
  };

  template <int dim>
  std::shared_ptr<const fluid::BoundaryCondition<dim>>
  given_velocity(const typename Given<dim>::Function &function)
  {
    return std::make_shared<Given<dim>>(grid::BoundaryKind::velocity, function);
  }

  template <int dim>
  std::shared_ptr<const fluid::BoundaryCondition<dim>>
  given_pressure(const typename Given<dim>::Function &function)
  {
    return std::make_shared<Given<dim>>(grid::BoundaryKind::traction, function);
  }

  template <int dim>
  std::shared_ptr<const fluid::BoundaryCondition<dim>> wall()
  {
    return std::make_shared<fluid::WallCondition<dim>>();
  }

  template <int dim>
  std::shared_ptr<const fluid::BoundaryCondition<dim>> slip()
  {
    return std::make_shared<fluid::SlipCondition<dim>>();
  }

  /// Largest difference of the velocity from a function of place and component, over all
  /// faces of all ranks.
  template <int dim, typename Exact>
  double velocity_error(const fluid::NavierStokes<dim> &flow, const Exact &exact)
  {
    double largest = 0.;
    grid_tests::for_each_face(
      flow.space(),
      [&](const std::size_t entry,
          const unsigned int,
          const unsigned int c,
          const Point<dim> &x) {
        largest =
          std::max(largest, std::abs(flow.velocity().local_element(entry) - exact(x, c)));
      });
    return Utilities::MPI::max(largest, flow.space().grid().communicator());
  }

  /// The same for the pressure.
  template <int dim, typename Exact>
  double pressure_error(const fluid::NavierStokes<dim> &flow, const Exact &exact)
  {
    double largest = 0.;
    grid_tests::for_each_cell(
      flow.space().grid(),
      [&](
        const std::size_t entry, const unsigned int, const Point<dim> &x, const double) {
        largest =
          std::max(largest, std::abs(flow.pressure().local_element(entry) - exact(x)));
      });
    return Utilities::MPI::max(largest, flow.space().grid().communicator());
  }
} // namespace fluid_tests

#endif
