#ifndef mitre_tests_instrument_tests_h
#define mitre_tests_instrument_tests_h

// A flow whose velocity is given, on a grid with a refined region.

#include <deal.II/base/mpi.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <memory>
#include <string>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/fluid/navier_stokes.h>
#include <mitre/instruments/instruments.h>

namespace instrument_tests
{
  using namespace mitre;
  using dealii::Point;

  /// Velocity component at a place and time.
  template <int dim>
  using Velocity = std::function<double(const Point<dim> &, unsigned int, double)>;

  /// u = (1 + a x + b y, ...), free of divergence, times a factor.
  template <int dim>
  double linear_velocity(const Point<dim> &x, const unsigned int c)
  {
    if (c == 0)
      return 3. + (dim - 1.) * x[0] + 0.5 * x[1];
    if (c == 1)
      return 1. - x[0] - x[1];
    return 2. + x[1] - x[dim - 1];
  }

  template <int dim>
  class GivenVelocity : public fluid::BoundaryCondition<dim>
  {
  public:
    explicit GivenVelocity(const Velocity<dim> &function)
      : function(function)
    {
    }

    void parse_parameters(dealii::ParameterHandler &, const std::string &) override
    {
    }

    grid::BoundaryKind kind() const override
    {
      return grid::BoundaryKind::velocity;
    }

    double
    velocity(const Point<dim> &x, const unsigned int c, const double t) const override
    {
      return function(x, c, t);
    }

    bool velocity_is_zero() const override
    {
      return false;
    }

  private:
    Velocity<dim> function;
  };

  /// The box (0,2) x (0,1)^(dim-1) of cells of width 1/16, with cells of width 1/32 where
  /// 1/2 < x < 3/2 and y < 1/2.
  template <int dim>
  struct Case
  {
    explicit Case(const Velocity<dim> &velocity)
      : patch_grid(MPI_COMM_WORLD, parameters())
    {
      patch_grid.adapt([](const dealii::BoundingBox<dim> &box) {
        return std::abs(box.center()[0] - 1.) < 0.5 && box.center()[1] < 0.5 ? 2 : 1;
      });
      std::vector<unsigned int> all;
      for (unsigned int side = 0; side < 2 * dim; ++side)
        all.push_back(side);
      conditions.add("all", all, std::make_shared<GivenVelocity<dim>>(velocity));
      fluid::FluidParameters fluid_parameters;
      fluid_parameters.density = 1.5;
      fluid                    = std::make_unique<fluid::NavierStokes<dim>>(
        patch_grid, conditions, fluid_parameters);
    }

    static grid::PatchGridParameters<dim> parameters()
    {
      grid::PatchGridParameters<dim> p;
      for (unsigned int d = 0; d < dim; ++d)
        {
          p.lower[d]        = 0.;
          p.upper[d]        = d == 0 ? 2. : 1.;
          p.base_patches[d] = d == 0 ? 2 : 1;
          p.periodic[d]     = false;
        }
      p.cells_per_side = 8;
      p.minimum_level  = 1;
      p.maximum_level  = 2;
      return p;
    }

    grid::PatchGrid<dim> patch_grid;
    fluid::BoundaryConditions<dim> conditions;
    std::unique_ptr<fluid::NavierStokes<dim>> fluid;
  };

  template <int dim>
  void parse(instruments::Instruments<dim> &instruments, const std::string &text)
  {
    dealii::ParameterHandler prm;
    base::parse_parameter_text(
      prm, text, "test.prm", instruments::Instruments<dim>::declare_parameters);
    instruments.parse_parameters(prm);
  }

  inline bool prints()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  /// "what: ok" if two numbers agree to a tolerance.
  inline void check(const std::string &what,
                    const double found,
                    const double expected,
                    const double tolerance)
  {
    if (!prints())
      return;
    std::cout << what << ' ' << expected;
    if (std::abs(found - expected) <= tolerance)
      std::cout << ": ok" << std::endl;
    else
      std::cout << ": FAILED, found " << found << ", off by " << found - expected
                << std::endl;
  }

  /// Prints the message of the UserError that an action must throw.
  inline void expect_error(const std::function<void()> &action)
  {
    std::string message = "FAILED: no error";
    try
      {
        action();
      }
    catch (const base::UserError &error)
      {
        message = error.what();
      }
    if (prints())
      std::cout << message << std::endl;
  }
} // namespace instrument_tests

#endif
