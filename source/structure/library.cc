#include <mitre/structure/constitutive_laws/guccione.h>
#include <mitre/structure/constitutive_laws/holzapfel_gasser_ogden.h>
#include <mitre/structure/constitutive_laws/holzapfel_ogden.h>
#include <mitre/structure/constitutive_laws/may_newman_yin.h>
#include <mitre/structure/constitutive_laws/mooney_rivlin.h>
#include <mitre/structure/constitutive_laws/neo_hookean.h>
#include <mitre/structure/constitutive_laws/st_venant_kirchhoff.h>
#include <mitre/structure/constitutive_laws/toe_linear_collagen.h>
#include <mitre/structure/constitutive_laws/transversely_isotropic.h>
#include <mitre/structure/constraints/tether.h>
#include <mitre/structure/library.h>
#include <mitre/structure/loads/body_force.h>
#include <mitre/structure/loads/damping.h>
#include <mitre/structure/loads/pressure.h>
#include <mitre/structure/loads/traction.h>
#include <mitre/structure/spring_laws/exponential.h>
#include <mitre/structure/spring_laws/linear.h>
#include <mitre/structure/spring_laws/toe_linear.h>

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
      laws.template add<MooneyRivlin<dim>>("Mooney-Rivlin",
                                           "W = C1 (I1 - 3) + C2 (I2 - 3)");
      laws.template add<StVenantKirchhoff<dim>>("St Venant-Kirchhoff",
                                                "W = (lambda/2) (tr E)^2 + mu E:E");
      laws.template add<HolzapfelGasserOgden<dim>>(
        "Holzapfel-Gasser-Ogden",
        "W = (mu/2) (I1 - 3) + k1 / (2 k2) (exp(k2 E^2) - 1) for each of two families of "
        "dispersed fibres, E = kappa (I1 - 3) + (1 - 3 kappa) (I4 - 1)");
      laws.template add<HolzapfelOgden<dim>>(
        "Holzapfel-Ogden",
        "orthotropic myocardium, exponentials of I1, of the stretch along fibres and "
        "sheets, and of the shear between them");
      laws.template add<MayNewmanYin<dim>>(
        "May-Newman-Yin",
        "mitral leaflets, W = c0 (exp(c1 (I1 - 3)^2 + c2 (sqrt(I4) - 1)^4) - 1)");
      laws.template add<Guccione<dim>>(
        "Guccione", "transversely isotropic myocardium, W = (C/2) (exp(Q) - 1)");
      laws.template add<ToeLinearCollagen<dim>>(
        "toe-linear collagen",
        "chordae: W = C1 (I1 - 3) and fibres with an exponential toe, linear beyond a "
        "transition stretch");
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
        "tether",
        "springs and dampers between nodes and where they shall be, which may move");
      return constraints;
    }();
    return registry;
  }


  template <int dim>
  const base::PluginRegistry<Load<dim>> &loads()
  {
    static const auto registry = [] {
      base::PluginRegistry<Load<dim>> loads("load");
      loads.template add<Pressure<dim>>(
        "pressure", "on the surface, which it may follow as the body deforms");
      loads.template add<Traction<dim>>(
        "traction", "a force per reference area on the surface, in a given direction");
      loads.template add<BodyForce<dim>>("body force",
                                         "a force per reference volume, such as weight");
      loads.template add<Damping<dim>>("damping",
                                       "a drag that is proportional to the velocity");
      return loads;
    }();
    return registry;
  }


  const base::PluginRegistry<SpringLaw> &spring_laws()
  {
    static const auto registry = [] {
      base::PluginRegistry<SpringLaw> laws("spring law");
      laws.add<LinearSpring>("linear", "T = kappa (l - l_0)");
      laws.add<ExponentialSpring>("exponential",
                                  "T = kappa l_0 / b (exp(b (l/l_0 - 1)) - 1)");
      laws.add<ToeLinearSpring>("toe-linear",
                                "collagen: quadratic in the strain up to a transition "
                                "strain, linear beyond, none in compression");
      return laws;
    }();
    return registry;
  }


  template const base::PluginRegistry<ConstitutiveLaw<2>> &constitutive_laws<2>();
  template const base::PluginRegistry<ConstitutiveLaw<3>> &constitutive_laws<3>();
  template const base::PluginRegistry<Constraint<2>> &constraints<2>();
  template const base::PluginRegistry<Constraint<3>> &constraints<3>();
  template const base::PluginRegistry<Load<2>> &loads<2>();
  template const base::PluginRegistry<Load<3>> &loads<3>();
} // namespace mitre::structure
