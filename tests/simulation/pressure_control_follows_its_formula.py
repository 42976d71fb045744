#!/usr/bin/python3
"""The control that shifts the pressure of a boundary so that the difference between two stations
follows a target, in a channel with slip walls. A plug of fluid has a linear pressure from inlet to
outlet, so that the difference is exactly the part a = distance of the stations / length of the
channel of the inlet's pressure p + s, and the shift obeys s <- s + dt / tau (target - a (p + s)).
It is computed here step by step, with a limit that it meets, and must agree to 1e-7; with a
constant target the difference must end there. A run that goes on from a checkpoint is the same to
the last bit.

usage: pressure_control_follows_its_formula.py MITRE WORK_FOLDER
"""

import math
import os
import shutil
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import resume_case as case

program, folder = sys.argv[1:3]
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)
failures = []

DT, N, TAU, LIMIT, PART = 2e-3, 60, 6e-3, 0.25, 0.75 / 2
PARAMETERS = """
set Dimension     = 2
set Output folder = %(folder)s
subsection Time
  set End time  = 0.12
  set Time step = 2e-3
end
subsection Checkpoints
  set Steps between checkpoints   = 25
  set Minutes between checkpoints = 0
  set Number kept = 10
end
subsection Grid
  set Lower corner  = 0, 0
  set Upper corner  = 2, 1
  set Base patches  = 2, 1
  set Minimum level = 1
  set Maximum level = 1
end
subsection Fluid
  set Viscosity = 0.05
  subsection Solver
    set Relative tolerance = 1e-11
  end
end
subsection Boundary conditions
  set Conditions = inlet, outlet, sides
  subsection Condition inlet
    set Faces    = x min
    set Type     = pressure
    set Pressure = mmHg * (0.2 + 0.1 * sin(40 * t))
  end
  subsection Condition outlet
    set Faces = x max
    set Type  = pressure
  end
  subsection Condition sides
    set Faces = y min, y max
    set Type  = slip
  end
end
subsection Pressure control
  set Condition           = %(condition)s
  set Axis                = x
  set Upstream position   = 0.5
  set Downstream position = 1.25
  set Pressure            = mmHg * %(target)s
  set Table file          = %(table)s
  set Table column        = %(column)s
  set Time constant       = 6e-3
  set Largest shift       = 0.25
end
subsection Output
  set Time between fields = 0
  set Steps between statistics = 1
end
"""


def check(name, good, found=""):
    print("%-70s %s" % (name, found if good else "FAILED: %s" % (found,)), flush=True)
    if not good:
        failures.append(name)


def run(folder, status=0, **changes):
    values = dict(folder=folder, condition="inlet", target="0.15", table="", column="")
    values.update(changes)
    with open(folder + ".prm", "w") as file:
        file.write(PARAMETERS % values)
    result = subprocess.run([program, folder + ".prm"], capture_output=True, text=True,
                            timeout=100)
    if result.returncode != status:
        sys.exit("%s: exit status %d\n%s" % (folder, result.returncode,
                                             result.stdout + result.stderr))
    return " ".join((result.stdout + result.stderr).split())


def columns(folder):
    table = case.statistics(folder)
    names = ("pressure shift [mmHg]", "controlled difference [mmHg]", "target difference [mmHg]")
    return [[float(line[table[0].index(name)]) for line in table[2:]] for name in names]


def compare(name, folder, target):
    found, s, largest, worst = columns(folder), 0.0, 0.0, 0.0
    for i in range(N):
        t = (i + 0.5) * DT
        difference = PART * (0.2 + 0.1 * math.sin(40 * t) + s)
        for column, exact in zip(found, (s, difference, target(t))):
            worst = max(worst, abs(column[i] - exact))
        largest = max(largest, abs(s))
        s = max(-LIMIT, min(s + DT / TAU * (target(t) - difference), LIMIT))
    check(name, worst < 1e-7, "largest error %.1e mmHg, largest shift %.3f mmHg"
          % (worst, largest))
    return found, largest


run("constant", target="0.1")
found, largest = compare("constant target", "constant", lambda t: 0.1)
run("out_of_reach", target="0.15 * (1 + t)")
_, largest = compare("target out of reach", "out_of_reach", lambda t: 0.15 * (1 + t))
check("the shift stays at its limit", largest == LIMIT, largest)

# A table is added to the expression.
with open("target.csv", "w") as file:
    file.write("time [s],difference [mmHg]\n0,0.03\n0.2,0.03\n")
text = run("table", target="0.06", table="target.csv\n  set Table extension = clamped",
           column="difference")
compare("target from a table", "table", lambda t: 0.09)

shutil.copytree("table", "resumed")
for later in case.checkpoints("resumed")[1:]:
    shutil.rmtree(later)
text = run("resumed", target="0.06", table="target.csv\n  set Table extension = clamped",
           column="difference")
check("resumed", "resumed from" in text)
found = case.differences("table", "resumed")
check("resumed: the same", not found, found or "to the last bit")

text = run("unknown", 1, condition="inlets")
check("unknown condition", "there is no boundary condition 'inlets'" in text, text)
text = run("sides", 1, condition="sides")
check("condition without pressure", "'sides' is not of the type pressure" in text, text)
if failures:
    sys.exit("FAILED: " + ", ".join(failures))
