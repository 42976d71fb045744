// The lists and choices in a file decide which subsections there are: two parts with a
// law each, whose parameters differ. All values must arrive, also those in an included
// file, of a line that is continued, and after a comment; what the file does not set has
// its default. Without a file, declaring gives the defaults' parameters.

#include <filesystem>
#include <fstream>
#include <iostream>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>

using namespace mitre::base;
using dealii::ParameterHandler;

void
declare(ParameterHandler &prm)
{
  prm.declare_entry("Dimension", "3", dealii::Patterns::Integer(2, 3));
  prm.enter_subsection("Structure");
  const auto parts = declare_names(prm, "Parts", "body", "names of the parts");
  for (const std::string &part : parts)
    {
      prm.enter_subsection("Part " + part);
      prm.declare_entry("Mesh file", "", InputFile(), "");
      const std::string law =
        declare_choice(prm, "Law", "neo-Hookean", {"neo-Hookean", "fibres"}, "");
      prm.enter_subsection(law);
      prm.declare_entry("C1", "1.5", dealii::Patterns::Double(0.));
      if (law == "fibres")
        prm.declare_entry("Exponent b_f", "55", dealii::Patterns::Double(0.));
      prm.leave_subsection();
      prm.leave_subsection();
    }
  prm.leave_subsection();
}

void
show(ParameterHandler &prm)
{
  std::cout << "dimension " << prm.get_integer("Dimension") << std::endl;
  prm.enter_subsection("Structure");
  for (const std::string &part : parse_names(prm.get("Parts")))
    {
      prm.enter_subsection("Part " + part);
      const std::string law = prm.get("Law");
      std::cout << part << ", mesh '" << prm.get("Mesh file") << "', " << law;
      prm.enter_subsection(law);
      std::cout << ", " << prm.get_double("C1");
      if (law == "fibres")
        std::cout << ' ' << prm.get_double("Exponent b_f");
      prm.leave_subsection();
      prm.leave_subsection();
      std::cout << std::endl;
    }
  prm.leave_subsection();
}

int
main()
{
  namespace fs = std::filesystem;
  fs::create_directories("case/meshes");
  fs::create_directories("case/parameters");
  std::ofstream("case/meshes/leaflet.msh") << "mesh";
  std::ofstream("case/parameters/cord.msh") << "mesh";
  std::ofstream("here.msh") << "mesh";
  std::ofstream("case/parameters/law.prm") << "set Law = fibres # of collagen\n"
                                              "SUBSECTION fibres\n"
                                              "  set Exponent b_f = 60\n"
                                              "end\n";
  std::ofstream("case/parameters/run.prm") << "# a run\n"
                                              "set Dimension = 2\n"
                                              "subsection Structure\n"
                                              "  set Parts = leaflet, \\\n"
                                              "              cord,    frame\n"
                                              "  subsection Part leaflet\n"
                                              "    set Mesh   file = meshes/leaflet.msh\n"
                                              "    include law.prm\n"
                                              "  end\n"
                                              "  subsection Part cord\n"
                                              "    set Mesh file = cord.msh\n"
                                              "    subsection neo-Hookean\n"
                                              "      set C1 = 2.5e5\n"
                                              "    end\n"
                                              "  end\n"
                                              "  subsection Part frame\n"
                                              "    set Mesh file = here.msh\n"
                                              "  end\n"
                                              "end\n";
  try
    {
      ParameterHandler prm;
      parse_parameter_file(prm, "case/parameters/run.prm", declare);
      show(prm);

      // The same with all that the file includes in one text.
      const std::string text = expand_includes("case/parameters/run.prm");
      std::cout << (text.find("include") == std::string::npos ? "expanded" : "includes")
                << std::endl;
      std::ofstream("case/parameters/expanded.prm") << text;
      ParameterHandler expanded;
      parse_parameter_file(expanded, "case/parameters/expanded.prm", declare);
      show(expanded);

      ParameterHandler defaults;
      declare(defaults);
      show(defaults);

      // An empty list is one, too.
      ParameterHandler empty;
      parse_parameter_text(
        empty, "subsection Structure\nset Parts =\nend", "text", declare);
      show(empty);
    }
  catch (const std::exception &error)
    {
      std::cout << error.what() << std::endl;
    }
}
