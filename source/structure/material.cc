#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <limits>
#include <utility>

#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/base/parameters.h>
#include <mitre/structure/constitutive_laws/volumetric_part.h>
#include <mitre/structure/library.h>
#include <mitre/structure/material.h>

namespace mitre::structure
{
  StiffnessFactor::StiffnessFactor()
    : TimeFunction(base::TimeExpression("1", "Time factor"))
  {
  }


  StiffnessFactor::StiffnessFactor(base::TimeExpression expression)
    : TimeFunction(std::move(expression))
  {
  }


  void StiffnessFactor::declare_parameters(dealii::ParameterHandler &prm)
  {
    TimeFunction::declare_parameters(prm,
                                     "Time factor",
                                     "1",
                                     "Expression of the time t [s] that multiplies the "
                                     "stress.",
                                     "with the unit [1]");
  }


  void StiffnessFactor::parse_parameters(dealii::ParameterHandler &prm,
                                         const std::string &what)
  {
    TimeFunction::parse_parameters(prm, "Time factor", "1", what, "number");
  }


  template <int dim>
  void Material<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    StiffnessFactor::declare_parameters(prm);
    prm.declare_entry("Stabilisation Poisson ratio",
                      "0.4",
                      dealii::Patterns::Double(-1, 0.4999999),
                      "nu by which a law whose \"Bulk modulus\" is 0 gets one after all, "
                      "kappa = 2 G (1 + nu) / (3 (1 - 2 nu)) with its shear modulus "
                      "G, so that the tissue keeps its volume; -1: none.");
    prm.declare_entry(
      "Volumetric integration",
      "reduced",
      dealii::Patterns::Selection("reduced|full"),
      "'reduced': the volumetric energy sees the change of volume projected "
      "to few functions an element, so that elements do not lock; the "
      "same for linear triangles and tetrahedra.");
    const std::string law =
      base::declare_choice(prm,
                           "Law",
                           constitutive_laws<dim>().names().front(),
                           constitutive_laws<dim>().names(),
                           "Constitutive law; its constants are in the subsection of "
                           "that name.\n" +
                             constitutive_laws<dim>().help());
    prm.enter_subsection(law);
    constitutive_laws<dim>().declare_parameters(law, prm);
    prm.leave_subsection();
  }


  template <int dim>
  void Material<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                       const std::string &what)
  {
    time_factor.parse_parameters(prm, what);

    const std::string law_name = prm.get("Law");
    AssertThrow(
      constitutive_laws<dim>().contains(law_name),
      base::UserError(what + ": there is no constitutive law '" + law_name + "'. " +
                      base::suggest_name(law_name, constitutive_laws<dim>().names())));
    law = constitutive_laws<dim>().create(law_name);
    prm.enter_subsection(law_name);
    law->parse_parameters(prm);
    prm.leave_subsection();

    project_volume                   = prm.get("Volumetric integration") == "reduced";
    const double poisson_ratio       = prm.get_double("Stabilisation Poisson ratio");
    VolumetricPart *const volumetric = law->volumetric_part();
    if (volumetric != nullptr && volumetric->bulk_modulus == 0 && poisson_ratio > -1)
      volumetric->bulk_modulus =
        bulk_modulus_of(compute_shear_modulus(*law), poisson_ratio);
  }


  template <int dim>
  double compute_shear_modulus(const ConstitutiveLaw<dim> &law)
  {
    Fibres<dim> fibres;
    for (unsigned int f = 0; f < law.n_fibre_families(); ++f)
      fibres[f][f] = 1;
    constexpr double step = 1e-5;

    double smallest = std::numeric_limits<double>::max();
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < i; ++j)
        {
          // Of the Kirchhoff stress, in which a reference stress that is a pressure does
          // not count.
          double difference = 0;
          for (const double gamma : {-step, step})
            {
              dealii::Tensor<2, dim> F = dealii::unit_symmetric_tensor<dim>();
              F[i][j] = F[j][i] = 0.5 * gamma;
              const dealii::Tensor<2, dim> tau =
                law.first_piola_kirchhoff_stress(F, fibres, 0.) * transpose(F);
              difference += gamma > 0 ? tau[i][j] : -tau[i][j];
            }
          smallest = std::min(smallest, difference / (2 * step));
        }
    return smallest;
  }


  double bulk_modulus_of(const double shear_modulus, const double poisson_ratio)
  {
    return 2 * shear_modulus * (1 + poisson_ratio) / (3 * (1 - 2 * poisson_ratio));
  }


  template struct Material<2>;
  template struct Material<3>;
  template double compute_shear_modulus(const ConstitutiveLaw<2> &);
  template double compute_shear_modulus(const ConstitutiveLaw<3> &);
} // namespace mitre::structure
