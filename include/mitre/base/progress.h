#ifndef mitre_base_progress_h
#define mitre_base_progress_h

#include <functional>
#include <ostream>
#include <string>

namespace mitre::base
{
  /**
   * Shows how far a computation is and how long it will still take: a bar that is drawn
   * over and over on a terminal, plain lines now and then in a file.
   *
   * The time left follows from the pace of the last minutes (an exponential mean with
   * time constant 120 s), so that it adapts when the steps become dearer.
   */
  class Progress
  {
  public:
    enum class Style
    {
      /** bar if the stream is std::cout or std::cerr on a terminal, else lines */
      automatic,
      bar,
      lines
    };

    /**
     * @param out where to; only one rank should have a Progress
     * @param begin,end values of the quantity that advances, say the time of a run
     * @param unit its unit
     * @param clock seconds since any moment, increasing; wall time by default
     */
    Progress(std::ostream &out,
             const double begin,
             const double end,
             const std::string &unit,
             const Style style             = Style::automatic,
             std::function<double()> clock = {});

    /**
     * Say that the quantity has reached @p value. Draws at most five times a second on a
     * terminal and writes at most one line in ten seconds elsewhere.
     *
     * @param note a few words more, say "flow 312 mL/s"
     */
    void update(const double value, const std::string &note = "");

    /** Say so in any case and end the line. Nothing more if it has been said before. */
    void finish(const std::string &note = "");

    /**
     * Leave the line of the bar, so that other output does not run into it; the next
     * update() draws it anew.
     */
    void interrupt();

    /** Seconds to go by the present pace; infinite before there is one. */
    double seconds_left() const;

  private:
    void write(const std::string &note);

    std::ostream &out_;
    double begin_;
    double end_;
    std::string unit_;
    bool bar_;
    std::function<double()> clock_;
    double value_;
    double start_clock_;
    double last_clock_;
    double last_written_;
    double pace_; // seconds per unit of the quantity
    std::size_t width_written_;
    bool finished_;
  };

  /** "45 s", "3 min 05 s", "2 h 07 min", "3 d 4 h"; "?" if @p seconds is not finite. */
  std::string format_duration(const double seconds);
} // namespace mitre::base

#endif
