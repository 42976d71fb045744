#include <mitre/structure/constitutive_laws/neo_hookean.h>
#include <mitre/structure/constitutive_laws/transversely_isotropic.h>
#include <mitre/structure/constraints/tether.h>
#include <mitre/structure/library.h>

namespace mitre::structure
{
  template <int dim>
  const base::PluginRegistry<ConstitutiveLaw<dim>> &constitutive_laws()
  {
    static const auto registry = [] {
      base::PluginRegistry<ConstitutiveLaw<dim>> laws("constitutive law");
      laws.template add<NeoHookean<dim>>("neo-Hookean", "W = C1 (I1 - 3)");
      laws.template add<TransverselyIsotropic<dim>>(
        "transversely isotropic",
        "W = C1 (I1 - 3) + a_f / (2 b_f) (exp(b_f (I_f - 1)^2) - 1), "
        "the second term only in stretched fibres");
      return laws;
    }();
    return registry;
  }


  template <int dim>
  const base::PluginRegistry<Constraint<dim>> &constraints()
  {
    static const auto registry = [] {
      base::PluginRegistry<Constraint<dim>> constraints("constraint");
      constraints.template add<Tether<dim>>(
        "tether", "springs and dampers between nodes and their reference positions");
      return constraints;
    }();
    return registry;
  }


  template const base::PluginRegistry<ConstitutiveLaw<2>> &constitutive_laws<2>();
  template const base::PluginRegistry<ConstitutiveLaw<3>> &constitutive_laws<3>();
  template const base::PluginRegistry<Constraint<2>> &constraints<2>();
  template const base::PluginRegistry<Constraint<3>> &constraints<3>();
} // namespace mitre::structure
