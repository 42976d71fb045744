// Every mistake in a parameter file must be reported with file, line, what was found and
// what was expected, and all unknown names and bad values of a file in one go.

#include <deal.II/base/parameter_handler.h>

#include <iostream>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>

using namespace mitre::base;
using dealii::ParameterHandler;

void
declare(ParameterHandler &prm)
{
  prm.declare_entry("Dimension", "3", dealii::Patterns::Integer(2, 3));
  prm.declare_entry("Time step", "1e-4", dealii::Patterns::Double(0.));
  prm.enter_subsection("Structure");
  for (const std::string &part : declare_names(prm, "Parts", "", ""))
    {
      prm.enter_subsection("Part " + part);
      prm.declare_entry("Mesh file", "", InputFile(), "");
      prm.declare_entry(
        "Kernel", "IB_4", dealii::Patterns::Selection("IB_3|IB_4|BSPLINE_3"));
      prm.declare_entry("Point density", "2", dealii::Patterns::Double(0.));
      prm.leave_subsection();
    }
  prm.leave_subsection();
}

void
try_to_parse(const std::string &text)
{
  try
    {
      ParameterHandler prm;
      parse_parameter_text(prm, text, "folder/run.prm", declare);
      std::cout << "no error" << std::endl;
    }
  catch (const UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
  std::cout << std::endl;
}

int
main()
{
  try_to_parse("set Dimension = 4\n"
               "set Timestep = 1e-5\n"
               "subsection Structre\n"
               "  set Parts = valve\n"
               "end\n"
               "subsection Structure\n"
               "  set Parts = valve\n"
               "  subsection Part valve\n"
               "    set Kernel = BSPLINE3\n"
               "    set Mesh file = valve.msh\n"
               "    set Density = 3\n"
               "  end\n"
               "  subsection Part valv\n"
               "    set Kernel = IB_4\n"
               "  end\n"
               "end\n");
  try_to_parse("subsection Structure\n"
               "  set Parts = valve, valve\n"
               "end\n");
  try_to_parse("subsection Structure\n"
               "  set Parts = valve,\n"
               "end\n");
  try_to_parse("subsection Structure\n");
  try_to_parse("end\n");
  try_to_parse("subsection Structure\nend Structure\n");
  try_to_parse("set Dimension 3\n");
  try_to_parse("Dimension = 3\n");
  try_to_parse("subsection\n");
  try_to_parse("set Dimension = 3 \\");
  try_to_parse("include other.prm\n");
  try_to_parse("subsection Dimension\nend\n");
  try_to_parse("set Structure = 3\n");
  try_to_parse("set Dimension = 3\nset Time step = \xb5\n");
  // underscores do not stand for other characters
  try_to_parse("subsection Structure\n"
               "  set Parts = left_of, a_be\n"
               "  subsection Part left_of\n"
               "    set Kernl = IB_3\n"
               "  end\n"
               "  subsection Part a_b\n"
               "  end\n"
               "end\n");
  try_to_parse("set \xb5 = 3\n");
  try_to_parse("subsection \xb5\nend\n");
  try
    {
      ParameterHandler prm;
      parse_parameter_file(prm, "missing.prm", declare);
    }
  catch (const UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
}
