#include <mitre/base/units.h>
#include <mitre/fluid/navier_stokes.h>
#include <mitre/instruments/pressure_difference.h>
#include <mitre/instruments/pressure_station.h>

namespace mitre::instruments
{
  template <int dim>
  void StationPair<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    MeasuringDisc<dim>::declare_cross_section(prm);
    prm.declare_entry("Upstream position",
                      "0",
                      dealii::Patterns::Double(),
                      "Coordinate of the first disc along the axis [cm].");
    prm.declare_entry(
      "Downstream position",
      "0",
      dealii::Patterns::Double(),
      "Coordinate of the second disc [cm], whose pressure is subtracted.");
  }


  template <int dim>
  void StationPair<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                          const std::string &instrument)
  {
    upstream.parse_cross_section(prm, instrument);
    downstream          = upstream;
    upstream.position   = prm.get_double("Upstream position");
    downstream.position = prm.get_double("Downstream position");
  }


  template <int dim>
  double StationPair<dim>::compute_difference(const grid::PatchGrid<dim> &patch_grid,
                                              const grid::VectorType &p,
                                              const std::string &instrument) const
  {
    return compute_mean_pressure(upstream, patch_grid, p, instrument) -
           compute_mean_pressure(downstream, patch_grid, p, instrument);
  }


  template <int dim>
  void PressureDifference<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    StationPair<dim>::declare_parameters(prm);
  }


  template <int dim>
  void PressureDifference<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                                 const std::string &instrument)
  {
    name = instrument;
    stations.parse_parameters(prm, name);
  }


  template <int dim>
  std::vector<std::string> PressureDifference<dim>::columns() const
  {
    return {name + " [mmHg]"};
  }


  template <int dim>
  std::vector<double>
  PressureDifference<dim>::measure(const Observation<dim> &observation)
  {
    const fluid::NavierStokes<dim> &fluid = *observation.fluid;
    return {stations.compute_difference(fluid.space().grid(), fluid.pressure(), name) /
            base::mmHg};
  }


  template struct StationPair<2>;
  template struct StationPair<3>;
  template class PressureDifference<2>;
  template class PressureDifference<3>;
} // namespace mitre::instruments
