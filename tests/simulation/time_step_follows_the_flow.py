#!/usr/bin/python3
"""A channel with a soft block in it, driven by a pressure that swells in the middle of
the run, with steps of a given Courant number: no step passes more cells than the largest
number, those that would are repeated at half their length, the steps grow and shrink, the
run ends when it should, and flow and block end within 2 % (of their largest values) of a
run with short equal steps.

usage: time_step_follows_the_flow.py MITRE WORK_FOLDER
"""

import csv
import os
import re
import shutil
import subprocess
import sys

program, folder = sys.argv[1:3]
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)

n = 4
with open("block.msh", "w") as file:
    file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % (n + 1) ** 2)
    for j in range(n + 1):
        for i in range(n + 1):
            file.write("%d %g %g 0\n" % (j * (n + 1) + i + 1, 0.4 + 0.2 * i / n, 0.4 + 0.2 * j / n))
    file.write("$EndNodes\n$Elements\n%d\n" % (n * n))
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i + 1
            file.write("%d 3 2 1 1 %d %d %d %d\n" % (j * n + i + 1, a, a + 1, a + n + 2, a + n + 1))
    file.write("$EndElements\n")


def run(name, time):
    with open(name + ".prm", "w") as file:
        file.write("""
set Dimension     = 2
set Output folder = %s
subsection Time
  set End time = 0.5
%s
end
subsection Grid
  set Upper corner  = 1, 1
  set Lower corner  = 0, 0
  set Base patches  = 1, 1
  set Minimum level = 2
  set Maximum level = 2
end
subsection Fluid
  set Viscosity = 0.05
end
subsection Boundary conditions
  set Conditions = inlet, outlet, plates
  subsection Condition inlet
    set Faces    = x min
    set Type     = pressure
    set Pressure = 2 + 40*(t > 0.2)*(t < 0.3)*sin(31.415926535897931*(t - 0.2))^2
  end
  subsection Condition outlet
    set Faces = x max
    set Type  = pressure
  end
  subsection Condition plates
    set Faces = y min, y max
    set Type  = wall
  end
end
subsection Structure
  set Parts = block
  subsection Part block
    set Mesh file   = block.msh
    set Materials   = rubber
    set Constraints = hold
    subsection Material rubber
      set Material id = 1
      set Law         = neo-Hookean
      subsection neo-Hookean
        set C1 = 100
      end
    end
    subsection Constraint hold
      set Type      = tether
      set Stiffness = 500
    end
  end
end
subsection Instruments
  set Instruments = flow
  subsection Instrument flow
    set Type     = flow meter
    set Axis     = x
    set Position = 0.25
  end
end
subsection Output
  set Time between fields      = 0
  set Steps between statistics = 1
end
""" % (name, time))
    result = subprocess.run([program, name + ".prm"], capture_output=True, text=True, timeout=280)
    if result.returncode != 0:
        sys.exit("%s: status %d\n%s" % (name, result.returncode, (result.stdout + result.stderr)[-3000:]))
    with open(name + "/statistics.csv") as file:
        table = list(csv.reader(file))
    return result.stdout, {key: [float(line[c]) for line in table[1:]] for c, key in enumerate(table[0])}


_, equal = run("equal", "  set Time step = 2.5e-4")
text, varied = run("varied", """  set Time step = 0.02
  set Courant number = 0.4
  set Maximum Courant number = 0.6""")

failures = []


def check(name, good, found):
    print("%-60s %s" % (name, found))
    if not good:
        failures.append(name)


steps = varied["time step [s]"][1:]
check("largest Courant number", max(varied["Courant number"]) <= 0.6, max(varied["Courant number"]))
check("end", abs(varied["time [s]"][-1] - 0.5) < 1e-12, varied["time [s]"][-1])
check("sum of the steps", abs(sum(steps) - 0.5) < 1e-9, sum(steps))
check("longest and shortest step differ", max(steps) > 3 * min(steps), (max(steps), min(steps)))
check("fewer steps", len(steps) < 0.5 * (len(equal["time [s]"]) - 1), len(steps))
repeated = re.search(r"(\d+) steps were too long", text)
check("steps repeated", repeated and int(repeated.group(1)) >= 1, repeated and repeated.group(1))
for column in equal:
    if column.startswith(("flow", "block")):
        largest = max(abs(x) for x in equal[column])
        difference = abs(varied[column][-1] - equal[column][-1])
        check(column + ", difference at the end", difference <= 0.02 * largest,
              "%g of at most %g" % (difference, largest))
if failures:
    sys.exit("FAILED: " + ", ".join(failures))
