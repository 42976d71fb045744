// The table passes through its values; the interpolant is exact for a straight line
// (slopes of a line are the line's), has no overshoot (stays within the values of each
// interval), has a continuous derivative also across the seam of a period, and converts
// units. A cubic interpolant with second-order slopes of a smooth function that is
// monotone between the extrema converges: for sin the error must fall by about 4 a
// halving near the extrema, where the limiter sets the slope to 0 if they are points of
// the table.

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>

#include <mitre/base/time_table.h>

using namespace mitre::base;

double
error_of_sine(const unsigned int n)
{
  {
    std::ofstream file("sine.csv");
    file.precision(16);
    file << "time [s],value [1]\n";
    for (unsigned int i = 0; i <= n; ++i)
      file << double(i) / n << ','
           << (i == n ? 0. : std::sin(2. * dealii::numbers::PI * i / n)) << '\n';
  }
  const TimeTable table("sine.csv", TimeTable::Extension::periodic);
  double error = 0.;
  for (unsigned int i = 0; i < 1000; ++i)
    error = std::max(error,
                     std::abs(table.value(0, i / 1000.) -
                              std::sin(2. * dealii::numbers::PI * i / 1000.)));
  return error;
}

int
main()
{
  {
    std::ofstream file("pressures.csv");
    file << "# drive\n"
            "time [ms],ventricle [mmHg],atrium [mmHg],line [cm]\n"
            "\n"
            "100, 10, 5, 1\r\n"
            "200, 10, 7, 2\n"
            "300, 150, 6, 3\n"
            "500, 10, 5, 5\n";
  }

  const TimeTable clamped("pressures.csv", TimeTable::Extension::clamped);
  for (const std::string &name : clamped.column_names())
    std::cout << name << ' ';
  std::cout << clamped.start_time() << ' ' << clamped.end_time() << std::endl;

  const unsigned int ventricle = clamped.column("ventricle");
  const unsigned int line      = clamped.column("line");
  for (const double t : {0., 0.1, 0.2, 0.3, 0.5, 9.})
    std::cout << clamped.value(ventricle, t) / 1333.22 << ' ';
  std::cout << std::endl;
  // between points whose neighbours continue the line: from 0.2 to 0.3
  std::cout << clamped.value(line, 0.225) << ' ' << clamped.derivative(line, 0.25)
            << std::endl;

  // no overshoot: flat where the table is flat, at most the peak beside it
  double largest = 0., deviation = 0.;
  for (unsigned int i = 0; i <= 400; ++i)
    {
      const double t     = 0.1 + 0.001 * i;
      const double value = clamped.value(ventricle, t) / 1333.22;
      largest            = std::max(largest, value);
      if (t <= 0.2)
        deviation = std::max(deviation, std::abs(value - 10.));
    }
  std::cout << (largest <= 150. + 1e-12 ? "no overshoot" : "overshoot") << ' '
            << (deviation < 1e-12 ? "flat" : "not flat") << std::endl;

  // the derivative agrees with differences and is continuous, across the seam, too
  {
    std::ofstream file("periodic.csv");
    file << "time [s],value [1]\n0,0\n0.25,1\n0.4,3\n0.7,-2\n1,0\n";
  }
  const TimeTable periodic("periodic.csv", TimeTable::Extension::periodic);
  double difference = 0., jump = 0.;
  for (unsigned int i = 0; i < 300; ++i)
    {
      const double t = -1. + 0.01 * i, h = 1e-6;
      difference = std::max(
        difference,
        std::abs((periodic.value(0, t + h) - periodic.value(0, t - h)) / (2. * h) -
                 periodic.derivative(0, t)));
      jump = std::max(
        jump,
        std::abs(periodic.derivative(0, t + 1e-9) - periodic.derivative(0, t - 1e-9)));
    }
  std::cout << (difference < 1e-3 ? "derivative ok" : "derivative wrong") << ' '
            << (jump < 1e-5 ? "continuous" : "jumps") << ' '
            << (std::abs(periodic.derivative(0, 0.)) > 1. ? "steep" : "level")
            << " at the seam" << std::endl;
  std::cout << periodic.value(0, 2.4) << ' ' << periodic.value(0, -0.6) << std::endl;

  const double ratio = error_of_sine(32) / error_of_sine(64);
  std::cout << (ratio > 3.5 && error_of_sine(64) < 2e-3 ? "converges"
                                                        : "does not converge")
            << std::endl;
}
