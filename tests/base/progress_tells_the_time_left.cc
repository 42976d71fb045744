// At an even pace of 10 s a step of 0.01 s, 0.1 of 0.7 s take 100 s and leave 600 s = 10
// min. When each step then takes 20 s for much longer than the memory of 120 s, the time
// left must follow: 0.1 s still to go at 2000 s a second of the run are 200 s. Lines come
// no more often than every 10 s; a bar is redrawn over itself.

#include <cmath>
#include <iostream>
#include <sstream>

#include <mitre/base/progress.h>

using namespace mitre::base;

int
main()
{
  double now = 0.;

  std::ostringstream lines;
  Progress progress(lines, 0., 0.7, "s", Progress::Style::lines, [&] { return now; });
  std::cout << format_duration(progress.seconds_left()) << std::endl;
  for (unsigned int i = 1; i <= 10; ++i)
    {
      now += 10.;
      progress.update(0.01 * i, "flow 300 mL/s");
    }
  std::cout << progress.seconds_left() << std::endl;
  for (unsigned int i = 11; i <= 60; ++i)
    {
      now += 20.;
      progress.update(0.01 * i);
    }
  std::cout << (std::abs(progress.seconds_left() - 200.) < 1. ? "follows" : "lags")
            << std::endl;

  const std::string text = lines.str();
  std::cout << text.substr(0, text.find('\n', text.find("0.02 of"))) << std::endl;

  std::ostringstream often;
  now = 0.;
  Progress many(often, 0., 1., "s", Progress::Style::lines, [&] { return now; });
  for (unsigned int i = 1; i <= 100; ++i)
    {
      now += 0.25;
      many.update(0.01 * i);
    }
  many.finish("done");
  many.finish("done");
  std::cout << often.str();

  std::ostringstream bar;
  now = 0.;
  Progress drawn(bar, 0., 1., "s", Progress::Style::bar, [&] { return now; });
  now = 1.;
  drawn.update(0.5);
  now = 2.;
  drawn.update(1.);
  drawn.finish();
  std::string shown = bar.str();
  for (char &c : shown)
    if (c == '\r')
      c = '\n';
  std::cout << shown;

  for (const double seconds : {0., 59.4, 60., 3599., 3600., 90000.})
    std::cout << format_duration(seconds) << std::endl;
}
