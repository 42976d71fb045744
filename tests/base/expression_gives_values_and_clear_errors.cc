// Values at (1, 2) or (1, 2, 3) and t = 4 are worked out by hand; conditions are 0 or 1;
// what cannot be read, or is not finite, is an error that names the parameter, the text
// and the variables there are.

#include <iostream>

#include <mitre/base/exceptions.h>
#include <mitre/base/expression.h>

using namespace mitre::base;

template <typename Function>
void
show_error(const Function &function)
{
  try
    {
      function();
      std::cout << "no error" << std::endl;
    }
  catch (const UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
}

int
main()
{
  const dealii::Point<2> p(1., 2.);
  const dealii::Point<3> q(1., 2., 3.);

  std::cout << Expression<2>("x + 10*y + 100*t", "a").value(p, 4.) << ' '
            << Expression<3>("x + 10*y + 100*z + 1000*t", "a").value(q, 4.) << ' '
            << Expression<3>("8*mmHg*sin(pi/6)", "a").value(q) << ' '
            << Expression<3>("if(t > 3, 5, 6)", "a").value(q, 4.) << ' '
            << Expression<3>("t < 0.2 ? 1 : 2", "a").value(q, 0.1) << ' '
            << Expression<3>().value(q) << std::endl;

  const Expression<3> region("x < 4 && (y-2)^2 + (z-3)^2 < 0.25", "a");
  std::cout << region.holds(q) << region.holds(dealii::Point<3>(5., 2., 3.))
            << region.holds(dealii::Point<3>(1., 2.6, 3.)) << std::endl;

  const TimeExpression factor("if(t >= 0.2 && t < 0.55, 1, 0.06)", "a");
  std::cout << factor.value(0.) << ' ' << factor.value(0.3) << ' ' << factor.text()
            << std::endl;

  show_error([] { Expression<2>("x + z", "Part tube, Region"); });
  show_error([] { Expression<3>("x + ", "Part tube, Region"); });
  show_error([] { Expression<3>(" ", "Part tube, Region"); });
  show_error([] { Expression<3>("x; y", "Part tube, Region"); });
  show_error([] { TimeExpression("x", "Time factor"); });
  show_error([&] { Expression<3>("1/(x-1)", "Velocity").value(q, 4.); });
  show_error([] { TimeExpression("1/t", "Time factor").value(0.); });
}
