#ifndef mitre_structure_library_h
#define mitre_structure_library_h

#include <mitre/base/plugin_registry.h>
#include <mitre/structure/constitutive_laws/constitutive_law.h>
#include <mitre/structure/constraints/constraint.h>
#include <mitre/structure/loads/load.h>
#include <mitre/structure/spring_laws/spring_law.h>

namespace mitre::structure
{
  /// The constitutive laws by the names that parameter files use.
  template <int dim>
  const base::PluginRegistry<ConstitutiveLaw<dim>> &constitutive_laws();


  /// The constraints by the names that parameter files use.
  template <int dim>
  const base::PluginRegistry<Constraint<dim>> &constraints();


  /// The loads by the names that parameter files use.
  template <int dim>
  const base::PluginRegistry<Load<dim>> &loads();


  /// The laws of the springs of fibre parts by the names that parameter files use.
  const base::PluginRegistry<SpringLaw> &spring_laws();
} // namespace mitre::structure

#endif
