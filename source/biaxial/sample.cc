#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/biaxial/sample.h>

namespace mitre::biaxial
{
  namespace
  {
    std::string
    describe(const double stretch_1, const double stretch_2, const double shear)
    {
      std::ostringstream text;
      text << "stretches " << stretch_1 << " and " << stretch_2;
      if (shear != 0)
        text << " and shear " << shear;
      return text.str();
    }
  } // namespace


  double find_free_stretch(const std::function<double(const double)> &stress,
                           const double start,
                           const std::string &what)
  {
    const auto of_logarithm = [&](const double x) { return stress(std::exp(x)); };
    const double middle     = std::log(start);
    const double at_start   = of_logarithm(middle);
    if (at_start == 0)
      return start;

    // A stiff sheet shortens through its thickness when it is pulled, so that the root is
    // on the side where the stress falls; a soft one may have it on the other side.
    double below = middle, above = middle;
    double f_below = at_start, f_above = at_start;
    for (double step = 0.01; step < std::log(5.) / 2; step *= 1.5)
      for (const double side : {-1., 1.})
        {
          double &inner        = side < 0 ? below : above;
          double &f_inner      = side < 0 ? f_below : f_above;
          const double outer   = inner + side * step;
          const double f_outer = of_logarithm(outer);
          const bool bracketed = std::isfinite(f_outer) && f_outer * f_inner <= 0;
          const double a = std::min(inner, outer), b = std::max(inner, outer);
          const double f_a = side < 0 ? f_outer : f_inner;
          const double f_b = side < 0 ? f_inner : f_outer;
          if (bracketed)
            {
              if (f_outer == 0)
                return std::exp(outer);
              boost::uintmax_t n_iterations = 200;
              const auto [left, right]      = boost::math::tools::toms748_solve(
                of_logarithm,
                a,
                b,
                f_a,
                f_b,
                boost::math::tools::eps_tolerance<double>(50),
                n_iterations);
              return std::exp(0.5 * (left + right));
            }
          if (std::isfinite(f_outer))
            {
              inner   = outer;
              f_inner = f_outer;
            }
        }
    throw base::UserError("There is no stretch between " + std::to_string(start / 5) +
                          " and " + std::to_string(start * 5) + " at which " + what);
  }


  Sample::Sample(const structure::ConstitutiveLaw<3> &law,
                 const structure::Fibres<3> &fibres,
                 const Volume volume,
                 const double stiffness_factor,
                 const double t)
    : law(law)
    , fibres(fibres)
    , volume(volume)
    , stiffness_factor(stiffness_factor)
    , t(t)
  {
  }


  State Sample::evaluate(const double stretch_1,
                         const double stretch_2,
                         const double shear,
                         const double stretch_3) const
  {
    State state;
    state.F[0][0] = stretch_1;
    state.F[1][1] = stretch_2;
    state.F[0][1] = shear;
    state.F[2][2] = stretch_3;

    state.first_piola_stress =
      stiffness_factor * law.first_piola_kirchhoff_stress(state.F, fibres, t);
    if (volume == Volume::incompressible)
      {
        // P33 of p F^-T is p / F33.
        const double pressure = state.first_piola_stress[2][2] * stretch_3;
        state.first_piola_stress -= pressure * transpose(invert(state.F));
      }
    state.cauchy_stress =
      state.first_piola_stress * transpose(state.F) / determinant(state.F);
    return state;
  }


  State
  Sample::deform(const double stretch_1, const double stretch_2, const double shear) const
  {
    const double isochoric = 1 / (stretch_1 * stretch_2);
    const double stretch_3 =
      volume == Volume::incompressible
        ? isochoric
        : find_free_stretch(
            [&](const double stretch) {
              return evaluate(stretch_1, stretch_2, shear, stretch).cauchy_stress[2][2];
            },
            isochoric,
            "the stress through the thickness vanishes with " +
              describe(stretch_1, stretch_2, shear) + ".");

    const State state = evaluate(stretch_1, stretch_2, shear, stretch_3);
    AssertThrow(std::isfinite(state.cauchy_stress.norm()),
                base::UserError("The stress is not finite with " +
                                describe(stretch_1, stretch_2, shear) +
                                "; expected a smaller range of stretches."));
    return state;
  }


  State Sample::stretch_uniaxially(const unsigned int direction,
                                   const double stretch) const
  {
    Assert(direction == 1 || direction == 2, dealii::ExcInternalError());
    const bool first = direction == 1;
    const auto state = [&](const double lateral) {
      return first ? deform(stretch, lateral, 0) : deform(lateral, stretch, 0);
    };
    std::ostringstream text;
    text << "the lateral stress vanishes with the uniaxial stretch " << stretch << ".";
    return state(find_free_stretch(
      [&](const double lateral) {
        const unsigned int other = first ? 1 : 0;
        try
          {
            return state(lateral).cauchy_stress[other][other];
          }
        catch (const base::UserError &)
          {
            return std::numeric_limits<double>::quiet_NaN();
          }
      },
      1 / std::sqrt(stretch),
      text.str()));
  }
} // namespace mitre::biaxial
