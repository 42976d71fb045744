#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <limits>
#include <sstream>
#include <unistd.h>
#include <utility>

#include <mitre/base/progress.h>

namespace mitre::base
{
  namespace
  {
    constexpr double seconds_between_bars  = 0.2;
    constexpr double seconds_between_lines = 10.;
    constexpr double pace_memory           = 120.; // s

    bool is_terminal(const std::ostream &out)
    {
      return (&out == &std::cout && isatty(STDOUT_FILENO)) ||
             (&out == &std::cerr && isatty(STDERR_FILENO));
    }


    double wall_clock()
    {
      return std::chrono::duration<double>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
    }
  } // namespace


  Progress::Progress(std::ostream &out,
                     const double begin,
                     const double end,
                     const std::string &unit,
                     const Style style,
                     std::function<double()> clock)
    : out_(out)
    , begin_(begin)
    , end_(end)
    , unit_(unit)
    , bar_(style == Style::bar || (style == Style::automatic && is_terminal(out)))
    , clock_(clock ? std::move(clock) : wall_clock)
    , value_(begin)
    , start_clock_(clock_())
    , last_clock_(start_clock_)
    , last_written_(-std::numeric_limits<double>::infinity())
    , pace_(std::numeric_limits<double>::quiet_NaN())
    , width_written_(0)
    , finished_(false)
  {
  }


  void Progress::update(const double value, const std::string &note)
  {
    const double now = clock_();
    if (value > value_ && now > last_clock_)
      {
        const double pace = (now - last_clock_) / (value - value_);
        // Weigh by time, so that the mean does not depend on how often it is updated;
        // from the beginning until the memory is full it is the plain mean.
        const double memory = std::min(pace_memory, now - start_clock_);
        const double weight = std::min(1., (now - last_clock_) / memory);
        // The mean of the pace over the quantity's advance is the inverse of the mean of
        // its speed over time.
        pace_ =
          std::isfinite(pace_) ? 1. / ((1. - weight) / pace_ + weight / pace) : pace;
        last_clock_ = now;
        value_      = value;
      }
    else if (value > value_)
      value_ = value;

    if (now - last_written_ >= (bar_ ? seconds_between_bars : seconds_between_lines))
      {
        write(note);
        last_written_ = now;
      }
  }


  void Progress::finish(const std::string &note)
  {
    if (finished_)
      return;
    finished_ = true;
    write(note);
    if (bar_)
      out_ << std::endl;
    width_written_ = 0;
  }


  void Progress::interrupt()
  {
    if (width_written_ > 0)
      {
        out_ << '\r' << std::string(width_written_, ' ') << '\r' << std::flush;
        width_written_ = 0;
        last_written_  = -std::numeric_limits<double>::infinity();
      }
  }


  double Progress::seconds_left() const
  {
    if (value_ >= end_)
      return 0.;
    return std::isfinite(pace_) ? pace_ * (end_ - value_)
                                : std::numeric_limits<double>::infinity();
  }


  void Progress::write(const std::string &note)
  {
    const double fraction =
      end_ > begin_ ? std::clamp((value_ - begin_) / (end_ - begin_), 0., 1.) : 1.;

    std::ostringstream text;
    if (bar_)
      {
        constexpr unsigned int width = 30;
        const unsigned int full      = static_cast<unsigned int>(fraction * width);
        text << '[' << std::string(full, '#') << std::string(width - full, '.') << "] ";
      }
    text << std::fixed << std::setprecision(1) << std::setw(5) << 100. * fraction
         << " %  " << std::defaultfloat << std::setprecision(5) << value_ << " of "
         << end_ << ' ' << unit_ << ", ";
    if (finished_)
      text << format_duration(clock_() - start_clock_) << " taken";
    else
      text << format_duration(seconds_left()) << " left";
    if (!note.empty())
      text << ", " << note;

    const std::string line = text.str();
    if (bar_)
      {
        out_ << '\r' << line;
        if (line.size() < width_written_)
          out_ << std::string(width_written_ - line.size(), ' ');
        out_ << std::flush;
        width_written_ = line.size();
      }
    else
      out_ << line << std::endl;
  }


  std::string format_duration(const double seconds)
  {
    if (!std::isfinite(seconds))
      return "?";
    const auto total = static_cast<long long>(std::llround(std::max(0., seconds)));
    char text[64];
    if (total < 60)
      std::snprintf(text, sizeof(text), "%lld s", total);
    else if (total < 3600)
      std::snprintf(text, sizeof(text), "%lld min %02lld s", total / 60, total % 60);
    else if (total < 86400)
      std::snprintf(
        text, sizeof(text), "%lld h %02lld min", total / 3600, total % 3600 / 60);
    else
      std::snprintf(
        text, sizeof(text), "%lld d %lld h", total / 86400, total % 86400 / 3600);
    return text;
  }
} // namespace mitre::base
