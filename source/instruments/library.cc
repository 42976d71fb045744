#include <mitre/instruments/chordal_tension.h>
#include <mitre/instruments/energy.h>
#include <mitre/instruments/flow_meter.h>
#include <mitre/instruments/gorlin_area.h>
#include <mitre/instruments/instrument.h>
#include <mitre/instruments/leak.h>
#include <mitre/instruments/orifice_area.h>
#include <mitre/instruments/part_extent.h>
#include <mitre/instruments/part_force.h>
#include <mitre/instruments/part_point.h>
#include <mitre/instruments/part_volume.h>
#include <mitre/instruments/pressure_difference.h>
#include <mitre/instruments/pressure_point.h>
#include <mitre/instruments/pressure_station.h>
#include <mitre/instruments/stress_and_strain.h>

namespace mitre::instruments
{
  template <int dim>
  const base::PluginRegistry<Instrument<dim>> &instrument_registry()
  {
    static const auto registry = [] {
      base::PluginRegistry<Instrument<dim>> instruments("instrument");
      instruments.template add<FlowMeter<dim>>(
        "flow meter", "volume flow through a disc, and the volumes that have passed");
      instruments.template add<PressureStation<dim>>("pressure station",
                                                     "mean pressure over a disc");
      instruments.template add<PressureDifference<dim>>(
        "pressure difference", "difference of the mean pressures over two discs");
      instruments.template add<PressurePoint<dim>>(
        "pressure point", "pressure at a point, or on the surface of a part");
      instruments.template add<PartForce<dim>>(
        "part force", "force of the fluid on a part that is held: drag and lift");
      instruments.template add<PartExtent<dim>>(
        "part extent", "smallest and largest coordinate of a part along an axis");
      instruments.template add<PartPoint<dim>>(
        "part point", "displacement and velocity of a material point of a part");
      instruments.template add<PartVolume<dim>>(
        "part volume",
        "deformed over reference volume of a part, smallest and largest J");
      instruments.template add<StressAndStrain<dim>>(
        "stress and strain",
        "smallest, mean and largest stress, strain and stretch of fibres, and "
        "percentiles, "
        "by material");
      instruments.template add<Leak<dim>>(
        "leak", "flow of the fluid through a part that should be tight");
      instruments.template add<OrificeArea<dim>>(
        "orifice area", "open area that parts enclose, seen along an axis");
      instruments.template add<GorlinArea<dim>>(
        "Gorlin area", "effective area of an orifice, from flow and pressure difference");
      instruments.template add<ChordalTension<dim>>(
        "chordal tension", "tension of the chordae of a part of fibres");
      instruments.template add<Energy<dim>>(
        "energy", "kinetic energy of the fluid and strain energy of the parts");
      return instruments;
    }();
    return registry;
  }


  template const base::PluginRegistry<Instrument<2>> &instrument_registry();
  template const base::PluginRegistry<Instrument<3>> &instrument_registry();
} // namespace mitre::instruments
