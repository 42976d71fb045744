#include <cmath>

#include <mitre/base/exceptions.h>
#include <mitre/base/units.h>
#include <mitre/fluid/navier_stokes.h>
#include <mitre/instruments/gorlin_area.h>

namespace mitre::instruments
{
  double compute_gorlin_area(const double flow,
                             const double pressure_difference,
                             const double contraction_coefficient)
  {
    return flow / (contraction_coefficient * 44.5 * std::sqrt(pressure_difference));
  }


  template <int dim>
  void GorlinArea<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    StationPair<dim>::declare_parameters(prm);
    prm.declare_entry("Flow position",
                      "0",
                      dealii::Patterns::Double(),
                      "Coordinate of the disc through which the flow is measured [cm].");
    prm.declare_entry(
      "Flow radius",
      "0",
      dealii::Patterns::Double(0),
      "Its radius [cm], about the same centre; 0: the whole cross-section "
      "of the box.");
    prm.declare_entry("Contraction coefficient",
                      "0.7",
                      dealii::Patterns::Double(1e-3, 1),
                      "C_c in A = Q / (C_c 44.5 sqrt(dp)), with A in cm^2, Q in mL/s and "
                      "dp in mmHg.");
    prm.declare_entry("Smallest difference",
                      "0.5",
                      dealii::Patterns::Double(0),
                      "The area is 0 where the difference of pressure is less [mmHg].");
  }


  template <int dim>
  void GorlinArea<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                         const std::string &instrument)
  {
    name = instrument;
    AssertThrow(dim == 3,
                base::UserError("Instrument " + name +
                                ": Gorlin's formula is for three dimensions."));
    stations.parse_parameters(prm, name);
    flow_disc          = stations.upstream;
    flow_disc.position = prm.get_double("Flow position");
    flow_disc.radius   = prm.get_double("Flow radius");
    AssertThrow(
      flow_disc.radius == 0 || stations.upstream.radius > 0,
      base::UserError("Instrument " + name +
                      ": with a \"Flow radius\", a \"Radius\" and \"Centre\" of "
                      "the stations are needed, too."));
    contraction_coefficient = prm.get_double("Contraction coefficient");
    smallest_difference     = prm.get_double("Smallest difference");
  }


  template <int dim>
  std::vector<std::string> GorlinArea<dim>::columns() const
  {
    return {name + " [cm^2]"};
  }


  template <int dim>
  std::vector<double> GorlinArea<dim>::measure(const Observation<dim> &observation)
  {
    const fluid::NavierStokes<dim> &fluid = *observation.fluid;
    const double flow = compute_flow(flow_disc, fluid.space(), fluid.velocity(), name);
    const double difference =
      stations.compute_difference(fluid.space().grid(), fluid.pressure(), name) /
      base::mmHg;
    return {flow > 0 && difference > 0 && difference >= smallest_difference
              ? compute_gorlin_area(flow, difference, contraction_coefficient)
              : 0.};
  }


  template class GorlinArea<2>;
  template class GorlinArea<3>;
} // namespace mitre::instruments
