#ifndef mitre_instruments_part_extent_h
#define mitre_instruments_part_extent_h

#include <mitre/instruments/instrument.h>

namespace mitre::instruments
{
  /**
   * The smallest and the largest coordinate along an axis of the nodes of a part, or of
   * those that belong to elements with some material ids: how far leaflets reach through
   * the plane of their annulus.
   */
  template <int dim>
  class PartExtent : public Instrument<dim>
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm,
                          const std::string &name) override;

    std::vector<std::string> columns() const override;

    std::vector<double> measure(const Observation<dim> &observation) override;

  private:
    std::string name;
    std::string part;
    unsigned int axis = 0;
    std::vector<unsigned int> material_ids;
  };
} // namespace mitre::instruments

#endif
