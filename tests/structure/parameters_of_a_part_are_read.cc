// A part as a parameter file describes it: materials with their laws, ids and time
// factors, constraints, mass matrix. A law that does not exist is an error that names the
// known ones. The stress of the leaflet's law at a fibre stretch of 1.1 is that of the
// constants in the file, 2 C1 (1.1 - 1/1.1) + 2 a_f 0.21 exp(b_f 0.0441) 1.1 = 1527.6
// with C1 = 100, a_f = 200, b_f = 60.

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>

#include "structure_tests.h"

using namespace structure_tests;

BodyParameters<3>
read(const std::string &text)
{
  dealii::ParameterHandler prm;
  const auto declare = [](dealii::ParameterHandler &prm) {
    prm.enter_subsection("Part leaflets");
    BodyParameters<3>::declare_parameters(prm);
    prm.leave_subsection();
  };
  mitre::base::parse_parameter_text(prm, text, "a.prm", declare);

  BodyParameters<3> parameters;
  prm.enter_subsection("Part leaflets");
  parameters.parse_parameters(prm, "leaflets");
  prm.leave_subsection();
  return parameters;
}

int
main()
{
  const std::string text = "subsection Part leaflets\n"
                           "  set Materials = anterior, chord\n"
                           "  set Mass matrix = lumped\n"
                           "  subsection Material anterior\n"
                           "    set Material id = 1, 3\n"
                           "    set Law = transversely isotropic\n"
                           "    subsection transversely isotropic\n"
                           "      set C1 = 100\n"
                           "      set a_f = 200\n"
                           "      set b_f = 60\n"
                           "    end\n"
                           "    set Stabilisation Poisson ratio = -1\n"
                           "  end\n"
                           "  subsection Material chord\n"
                           "    set Material id = 2\n"
                           "    set Law = neo-Hookean\n"
                           "    set Time factor = if(t > 0.2, 9, 0.5)\n"
                           "    subsection neo-Hookean\n"
                           "      set Bulk modulus = 5\n"
                           "    end\n"
                           "  end\n"
                           "  set Constraints = hold\n"
                           "  subsection Constraint hold\n"
                           "    set Type = tether\n"
                           "    set Region = x < 4\n"
                           "    set Stiffness = 12\n"
                           "  end\n"
                           "end\n";

  const BodyParameters<3> parameters = read(text);
  std::cout << parameters.name << ' ' << parameters.consistent_mass << std::endl;
  for (const Material<3> &material : parameters.materials)
    {
      std::cout << material.name << ':';
      for (const unsigned int id : material.ids)
        std::cout << ' ' << id;
      std::cout << ", " << material.time_factor.value(0.1) << ' '
                << material.time_factor.value(0.3) << ", "
                << material.law->n_fibre_families() << std::endl;
    }
  for (const NamedConstraint<3> &constraint : parameters.constraints)
    std::cout << constraint.name << std::endl;

  dealii::Tensor<2, 3> F = dealii::unit_symmetric_tensor<3>();
  F[0][0]                = 1.1;
  Fibres<3> fibres;
  fibres[0][0] = 1;
  std::cout << parameters.materials[0].law->first_piola_kirchhoff_stress(
                 F, fibres, 0.)[0][0]
            << std::endl;

  std::string wrong = text;
  wrong.replace(wrong.find("transversely"), 12, "transversly");
  try
    {
      read(wrong);
    }
  catch (const mitre::base::UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
}
