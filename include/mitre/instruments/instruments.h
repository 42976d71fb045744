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

  private:
    std::vector<std::unique_ptr<Instrument<dim>>> instruments;
  };
} // namespace mitre::instruments

#endif
