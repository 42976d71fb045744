#!/usr/bin/python3
"""Mistakes in what a run is given, and a time step that blows up, must end it with exit
status other than 0 and a message that names the thing; files written before stay whole.

usage: wrong_input_stops_with_a_message.py MITRE WORK_FOLDER
"""

import os
import shutil
import subprocess
import sys

program, folder = sys.argv[1:3]

# Six tetrahedra that fill the cube [0.4, 0.6]^3, material id 1.
corners = [(x, y, z) for z in (0.4, 0.6) for y in (0.4, 0.6) for x in (0.4, 0.6)]
tetrahedra = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]


def write_mesh(name, points=corners, elements=tetrahedra, material=1):
    with open(name, "w") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(points))
        for i, point in enumerate(points):
            file.write("%d %g %g %g\n" % ((i + 1,) + tuple(point)))
        file.write("$EndNodes\n$Elements\n%d\n" % len(elements))
        for i, element in enumerate(elements):
            file.write("%d 4 2 %d 1 %s\n" % (i + 1, material, " ".join(str(a + 1) for a in element)))
        file.write("$EndElements\n")


parameters = """
set Dimension     = 3
set Output folder = run
subsection Time
  set End time  = %(end)s
  set Time step = %(dt)s
end
subsection Grid
  set Periodic directions = x, y, z
  set Minimum level       = 1
  set Maximum level       = 1
end
subsection Fluid
  set Initial velocity x = cos(2*pi*y)
end
subsection Structure
  set Parts = cube
  subsection Part cube
    set Mesh file = %(mesh)s
    set Materials = rubber
    subsection Material rubber
      set Material id = %(id)s
      set Law         = %(law)s
      %(law_section)s
    end
  end
end
subsection Output
  set Time between fields      = 0.002
  set Steps between statistics = 1
end
"""
law_section = "subsection neo-Hookean\n set C1 = %s\nend"
defaults = dict(end="0.01", dt="1e-3", mesh="cube.msh", id="1", law="neo-Hookean",
                law_section=law_section % "10")

shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)
write_mesh("cube.msh")
write_mesh("other.msh", material=7)
write_mesh("outside.msh", points=[(x + 0.5, y, z) for x, y, z in corners])
write_mesh("inverted.msh", elements=tetrahedra[:2] + [(0, 6, 2, 7)] + tetrahedra[3:])

failures = 0


def run(**changes):
    with open("run.prm", "w") as file:
        file.write(parameters % dict(defaults, **changes))
    result = subprocess.run([program, "run.prm"], capture_output=True, text=True, timeout=250)
    return result.returncode, result.stdout + result.stderr


def expect(what, words, **changes):
    global failures
    status, text = run(**changes)
    missing = [word for word in words if word not in text]
    if status == 0 or missing:
        failures += 1
        print("%s: status %d, not in the message: %s\n%s" % (what, status, missing, text[-1500:]))
    else:
        print("%s: ok" % what)


status, text = run()
if status != 0:
    failures += 1
    print("a run without mistakes: status %d\n%s" % (status, text[-1500:]))
else:
    print("a run without mistakes: ok")

# not a periodic box, so that the structure can be outside of it
walls = parameters.replace("  set Periodic directions = x, y, z\n", "") + """
subsection Boundary conditions
  set Conditions = all
  subsection Condition all
    set Faces = all
    set Type  = wall
  end
end
"""
expect("missing mesh", ["nothing.msh", "Part cube"], mesh="nothing.msh")
expect("unknown law", ["neo-Hokean", "neo-Hookean"], law="neo-Hokean", law_section="")
expect("id without a law", ["7", "other.msh"], mesh="other.msh")
expect("material without elements", ["rubber", "3"], id="1, 3")
expect("inverted element", ["inverted.msh", "element 3"], mesh="inverted.msh")
expect("misspelt parameter", ["Time stepp", "Time step"], dt="1e-3\n  set Time stepp = 1")
expect("no number", ["Time step", "1e-3s"], dt="1e-3s")
periodic, parameters = parameters, walls
expect("structure outside the box", ["cube", "outside.msh", "box"], mesh="outside.msh")
parameters = walls.replace("Faces = all", "Faces = x min, x max, y min, y max")
expect("face without a condition", ["z min"])
parameters = periodic

# A cube so stiff that the step is far beyond what is stable: it must be noticed.
shutil.rmtree("run", ignore_errors=True)
expect("time step that blows up", ["ime step"], end="1", dt="5e-3",
       law_section=law_section % "1e9")
with open("run/statistics.csv") as file:
    lines = file.read().splitlines()
columns = lines[0].count(",")
if len(lines) < 2 or any(line.count(",") != columns for line in lines):
    failures += 1
    print("statistics.csv is not whole after the error")
for collection in ("fluid.pvd", "cube.pvd"):
    text = open("run/output/" + collection).read()
    frames = [part.split('"')[0] for part in text.split('file="')[1:]]
    if not text.rstrip().endswith("</VTKFile>") or not frames:
        failures += 1
        print("%s is not whole after the error" % collection)
    for frame in frames:
        if not open("run/output/" + frame, "rb").read().rstrip().endswith(b"</VTKFile>"):
            failures += 1
            print("%s is not whole after the error" % frame)

sys.exit("%d failures" % failures if failures else 0)
