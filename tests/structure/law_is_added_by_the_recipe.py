#!/usr/bin/python3
"""Follow doc/adding_a_law.md: a copy of a law's two files under another name, and one line (with
its include) in library.cc, are all that a new law needs.

The three files lie in a folder of their own, in front of the repository's. With the registry-wide
test they are compiled, without optimisation, and linked with Mitre's library, which is not
compiled anew. The new law must then pass that test, beside all the others.

usage: law_is_added_by_the_recipe.py FOLDER_OF_THE_REPOSITORY LIBRARY NLOPT FOLDER_TO_WORK_IN
"""

import pathlib
import shutil
import subprocess
import sys

root, library, nlopt, work = (pathlib.Path(argument).resolve() for argument in sys.argv[1:5])
shutil.rmtree(work, ignore_errors=True)
LAWS = "structure/constitutive_laws"
for folder in (f"include/mitre/{LAWS}", f"source/{LAWS}"):
    (work / folder).mkdir(parents=True)

# Step 1 of the recipe.
for name in (f"include/mitre/{LAWS}/mooney_rivlin.h", f"source/{LAWS}/mooney_rivlin.cc"):
    text = (root / name).read_text()
    (work / name.replace("mooney_rivlin", "new_solid")).write_text(
        text.replace("mooney_rivlin", "new_solid").replace("MooneyRivlin", "NewSolid"))

# Step 2.
text = (root / "source/structure/library.cc").read_text()
include = f"#include <mitre/{LAWS}/mooney_rivlin.h>\n"
first = "      laws.template add<NeoHookean<dim>>("
assert text.count(include) == 1 and text.count(first) == 1
text = text.replace(include, include + include.replace("mooney_rivlin", "new_solid"))
text = text.replace(first, '      laws.template add<NewSolid<dim>>("new solid", "W = ...");\n' + first)
(work / "source/structure/library.cc").write_text(text)

# Step 3.
(work / "CMakeLists.txt").write_text(f"""
cmake_minimum_required(VERSION 3.18)
find_package(deal.II 9.4 REQUIRED)
deal_ii_initialize_cached_variables()
project(new_law CXX)
add_executable(check source/structure/library.cc source/{LAWS}/new_solid.cc
  {root}/tests/structure/stress_is_derivative_of_energy.cc)
target_include_directories(check PRIVATE include {root}/include {root}/tests/structure)
target_compile_options(check PRIVATE -std=c++17 -O0 -g0 -w)
target_link_libraries(check {library} {nlopt})
deal_ii_setup_target(check)
""")
for command in (["cmake", "-S", work, "-B", work / "build", "-DCMAKE_BUILD_TYPE=Release"],
                ["cmake", "--build", work / "build"], [work / "build/check"]):
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{command}:\n{result.stdout}{result.stderr}")

lines = result.stdout.splitlines()
expected = (root / "tests/structure/stress_is_derivative_of_energy.output").read_text()
model = [line for line in expected.splitlines() if line.startswith("Mooney-Rivlin")]
new = [line for line in lines if line.startswith("new solid")]
others = [line for line in lines if not line.startswith("new solid")]
print("\n".join(new))
if new != [line.replace("Mooney-Rivlin", "new solid") for line in model] or len(new) != 2:
    sys.exit(f"The new law does not pass the test: expected\n{model}, found\n{new}")
if others != expected.splitlines():
    sys.exit("The other laws differ:\n" + result.stdout)
