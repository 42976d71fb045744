#ifndef mitre_instruments_part_point_h
#define mitre_instruments_part_point_h

#include <deal.II/base/point.h>

#include <mitre/instruments/instrument.h>

namespace mitre::instruments
{
  /**
   * Displacement and velocity of a material point of a part: of the node that is nearest
   * to a place in the reference configuration, such as the tip of a leaflet.
   */
  template <int dim>
  class PartPoint : public Instrument<dim>
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
    dealii::Point<dim> point;
    double largest_distance = 0;
  };
} // namespace mitre::instruments

#endif
