#ifndef mitre_instruments_instruments_h
#define mitre_instruments_instruments_h

#include <memory>
#include <string>
#include <vector>

#include <mitre/instruments/instrument.h>

namespace mitre::instruments
{
  /**
   * The instruments of a run: a list of names, each with a type and the parameters of
   * that type.
   */
  template <int dim>
  class Instruments
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);
    void parse_parameters(dealii::ParameterHandler &prm);

    /// The columns of all instruments, in the order of the list.
    std::vector<std::string> columns() const;

    /// Their values. Collective.
    std::vector<double> measure(const Observation<dim> &observation);

    /// The state of each, for checkpoints.
    std::vector<std::vector<double>> state() const;

    /// Go on from what state() returned; the list must be the same.
    void set_state(const std::vector<std::vector<double>> &state);

  private:
    std::vector<std::unique_ptr<Instrument<dim>>> instruments;
  };
} // namespace mitre::instruments

#endif
