#ifndef mitre_instruments_instrument_h
#define mitre_instruments_instrument_h

#include <deal.II/base/exceptions.h>
#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

#include <mitre/base/plugin_registry.h>
#include <mitre/instruments/observation.h>

namespace mitre::instruments
{
  /**
   * Something that turns the state of a run into a few numbers a step, which become
   * columns of statistics.csv.
   */
  template <int dim>
  class Instrument
  {
  public:
    virtual ~Instrument() = default;

    /// Reads the parameters of the subsection that has been entered; @p name is that of
    /// the instrument, with which its columns begin.
    virtual void parse_parameters(dealii::ParameterHandler &prm,
                                  const std::string &name) = 0;

    /// Names with units of what measure() returns: "flow [mL/s]".
    virtual std::vector<std::string> columns() const = 0;

    /**
     * The values now, the same on all ranks. Called in the order of time, for
     * instruments may accumulate. Collective. Throws base::UserError on all ranks if what
     * the instrument shall look at does not exist.
     */
    virtual std::vector<double> measure(const Observation<dim> &observation) = 0;

    /// What later measurements depend on, for checkpoints; the same on all ranks.
    virtual std::vector<double> state() const
    {
      return {};
    }

    /// Goes on from what state() returned.
    virtual void set_state(const std::vector<double> &state)
    {
      AssertDimension(state.size(), 0);
      (void)state;
    }
  };


  /// The instruments by the names that parameter files use for their types.
  template <int dim>
  const base::PluginRegistry<Instrument<dim>> &instrument_registry();
} // namespace mitre::instruments

#endif
