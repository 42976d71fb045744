#ifndef mitre_instruments_chordal_tension_h
#define mitre_instruments_chordal_tension_h

#include <mitre/instruments/instrument.h>
#include <mitre/structure/fibre_body.h>

namespace mitre::instruments
{
  /**
   * Tension of the chordae of a part of fibres [dyn]: of those of its springs that have
   * given force functions. Springs that have nodes in common belong to one chord.
   *
   * Columns: the largest tension of all these springs, their mean weighted by the length
   * at rest (if they have one), and, if it is said how many chordae there are, the
   * largest tension in each, in the order in which the spring file names them first.
   */
  template <int dim>
  class ChordalTension : public Instrument<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name) override;

    std::vector<std::string> columns() const override;

    std::vector<double> measure(const Observation<dim> &observation) override;

  private:
    void find_chordae(const structure::FibreNetwork<dim> &network);

    std::string name;
    std::string part;
    std::vector<int> force_functions;
    unsigned int n_chordae = 0;

    /// Springs by chord.
    std::vector<std::vector<unsigned int>> chordae;
  };
} // namespace mitre::instruments

#endif
