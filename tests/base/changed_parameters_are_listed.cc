// The values of all parameters are listed by their paths, files with the checksum of what
// is in them; of two lists the differences are told: other texts and numbers, other
// contents, parameters that are not in both, but not other ways to write a number, other
// names of the same file, and what may differ. A parameter that was not there before and
// has its default now, because the program has learnt it since, does not differ.

#include <fstream>
#include <iostream>

#include <mitre/base/parameter_values.h>
#include <mitre/base/parameters.h>

using namespace mitre::base;
using dealii::ParameterHandler;
using dealii::Patterns::Anything;

int
main()
{
  for (const std::string name : {"a.msh", "b.msh", "c.msh"})
    std::ofstream(name) << (name == "c.msh" ? "other" : "mesh") << "\n";

  const auto list = [](const std::string &text) {
    ParameterHandler prm;
    parse_parameter_text(prm, text, "text", [](ParameterHandler &p) {
      p.declare_entry("Folder", "runs", Anything());
      for (const std::string &name : declare_names(p, "Parts", "", ""))
        {
          p.enter_subsection("Part " + name);
          p.declare_entry("Mesh (file)", "", InputFile());
          p.declare_entry("Stiffness", "1e-3", dealii::Patterns::Double());
          p.declare_entry("Label", "", Anything());
          p.enter_subsection("Output / more");
          p.declare_entry("Law", "linear", Anything());
          p.leave_subsection();
          p.leave_subsection();
        }
    });
    return list_parameter_values(prm);
  };
  const std::string first =
    "set Parts = A\nsubsection Part A\nset Mesh (file) = a.msh\nend";
  const auto values = list(first);
  for (const auto &[name, value] : values)
    std::cout << name << " = " << value << std::endl;

  const auto show = [&](const std::string &what, const std::string &text) {
    std::cout << what << ":\n"
              << describe_changed_parameters(
                   values,
                   list(text),
                   {"Folder", " / Label", "Part A / Output / more / "})
              << std::endl;
  };
  show("nothing", first);
  show("what may differ",
       "set Folder = there\n" + first +
         "\nsubsection Part A\nset Label = a\n"
         "subsection Output / more\nset Law = cubic\nend\nend");
  show("a number in other words",
       first + "\nsubsection Part A\nset Stiffness = 0.001\nend");
  show("another number", first + "\nsubsection Part A\nset Stiffness = 0.0011\nend");
  show("the same mesh elsewhere",
       first + "\nsubsection Part A\nset Mesh (file) = b.msh\nend");
  show("another mesh", first + "\nsubsection Part A\nset Mesh (file) = c.msh\nend");
  show("no mesh", first + "\nsubsection Part A\nset Mesh (file) =\nend");
  show("another part", "set Parts = B\n");

  // The list of an older program, which did not know a parameter.
  auto older = values;
  older.erase("Part A / Stiffness");
  for (const std::string value : {"0.001", "0.002"})
    {
      ParameterHandler prm;
      prm.enter_subsection("Part A");
      prm.declare_entry("Stiffness", "1e-3", dealii::Patterns::Double());
      prm.leave_subsection();
      auto now                  = values;
      now["Part A / Stiffness"] = value;
      std::cout << "a new parameter, " << value << ":\n"
                << describe_changed_parameters(
                     older, now, {}, list_parameter_defaults(prm))
                << std::endl;
    }
  older["Old"] = "1";
  std::cout << "a parameter of old:\n"
            << describe_changed_parameters(older, values, {}, values) << std::endl;
}
