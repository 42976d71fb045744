#ifndef mitre_fluid_phase_times_h
#define mitre_fluid_phase_times_h

#include <array>
#include <chrono>

namespace mitre::fluid
{
  /// The parts of a time step that are timed.
  enum class Phase : unsigned char
  {
    advection, ///< div(u u) with its halo
    velocity,  ///< velocity solves of the preconditioner
    pressure,  ///< pressure cycles of the preconditioner
    operators, ///< products with the coupled system, right-hand side, corrections
    krylov     ///< the rest of the coupled solve: orthogonalisation, norms, updates
  };

  constexpr unsigned int n_phases = 5;

  /// Seconds of wall-clock time spent in each phase on this rank since the last reset().
  class PhaseTimes
  {
  public:
    using Clock = std::chrono::steady_clock;

    void reset()
    {
      seconds.fill(0.);
    }

    double operator[](const Phase phase) const
    {
      return seconds[static_cast<unsigned int>(phase)];
    }

    /// Adds the time from construction to destruction to a phase, and takes it from the
    /// phase around it.
    class Scope
    {
    public:
      Scope(PhaseTimes &times, const Phase phase)
        : times(times)
        , outer(times.current)
      {
        times.switch_to(static_cast<int>(phase));
      }

      ~Scope()
      {
        times.switch_to(outer);
      }

      Scope(const Scope &)            = delete;
      Scope &operator=(const Scope &) = delete;

    private:
      PhaseTimes &times;
      const int outer;
    };

  private:
    void switch_to(const int next)
    {
      const Clock::time_point now = Clock::now();
      if (current >= 0)
        seconds[current] += std::chrono::duration<double>(now - since).count();
      since   = now;
      current = next;
    }

    std::array<double, n_phases> seconds{};
    Clock::time_point since;
    int current = -1;
  };
} // namespace mitre::fluid

#endif
