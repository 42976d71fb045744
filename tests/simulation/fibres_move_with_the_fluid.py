#!/usr/bin/python3
"""Parts of fibres in runs. An ellipse of springs without rest length relaxes to a circle that
encloses the same area within 0.5 %. A strand of springs, beams and moving target points beside a
block of finite elements, with a grid that follows both: a run that goes on from a checkpoint is
the same to the last bit, on one and on two ranks; one and two ranks agree within 1e-6. --validate
knows the part, and its step: a run with half of the longest stable step is stable, one with twice
as long is refused.

usage: fibres_move_with_the_fluid.py MITRE WORK_FOLDER
"""

import array
import math
import os
import re
import shutil
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import resume_case as case

program, folder = sys.argv[1:3]
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)
case.write_meshes()
failures = []


def check(name, good, found=""):
    print("%-70s %s" % (name, found if good else "FAILED: %s" % (found,)), flush=True)
    if not good:
        failures.append(name)


# The ellipse: tension K |dX/ds| with the s of a circle, so stiffness K / ds.
CELLS, K = 64, 1.0
N = 4 * CELLS
A, B = 0.3, 0.2
DS = 2 * math.pi * math.sqrt(A * B) / N
with open("ring.vertex", "w") as file:
    file.write("%d\n" % N)
    for i in range(N):
        angle = 2 * math.pi * i / N
        file.write("%.17g %.17g\n" % (0.5 + A * math.cos(angle), 0.5 + B * math.sin(angle)))
with open("ring.spring", "w") as file:
    file.write("%d\n" % N)
    for i in range(N):
        file.write("%d %d %.17g 0 0\n" % (i, (i + 1) % N, K / DS))
RING = """
set Dimension = 2
set Output folder = ring
set Resume = never
subsection Time
  set End time  = %(end)s
  set Time step = %(dt)s
end
subsection Checkpoints
  set Steps between checkpoints = %(steps)s
  set Minutes between checkpoints = 0
end
subsection Grid
  set Minimum level = 3
  set Maximum level = 3
end
subsection Fluid
  set Viscosity = 0.1
end
subsection Boundary conditions
  set Conditions = walls
  subsection Condition walls
    set Faces = all
    set Type  = wall
  end
end
subsection Structure
  set Parts = ring
  subsection Part ring
    set Kind        = fibres
    set Vertex file = ring.vertex
  end
end
subsection Instruments
  set Instruments = energy
  subsection Instrument energy
    set Type = energy
  end
end
subsection Output
  set Time between fields = 0
end
"""


def run_ring(arguments=(), status=0, **values):
    with open("ring.prm", "w") as file:
        file.write(RING % values)
    result = subprocess.run([program, "ring.prm"] + list(arguments), capture_output=True,
                            text=True, timeout=250)
    if result.returncode != status:
        sys.exit("ring: exit status %d\n%s" % (result.returncode, result.stdout + result.stderr))
    return re.sub(r"\s+", " ", result.stdout + result.stderr)


def area(x):
    return 0.5 * sum(x[2 * i] * x[2 * ((i + 1) % N) + 1] - x[2 * ((i + 1) % N)] * x[2 * i + 1]
                     for i in range(N))


text = run_ring(["--validate"], end="1", dt="2.5e-3", steps="400")
check("ring: --validate", "%d nodes, %d springs, 0 beams" % (N, N) in text)
found = re.search(r"part ring \(springs\): ([0-9.e+-]+) s", text)
stable = float(found.group(1))
check("ring: longest stable step", 2.5e-3 < stable < 3e-2, stable)
text = run_ring(["--validate"], 1, end="1", dt="%g" % (2.1 * stable), steps="400")
check("ring: twice as long", "but the part ring (springs) allows about" in text)

run_ring(end="1.2", dt="%g" % (1.2 / math.ceil(1.2 / (0.5 * stable))),
         steps="%d" % math.ceil(1.2 / (0.5 * stable)))
state = case.state(case.checkpoints("ring")[-1])
x = array.array("d")
x.frombytes(state["part ring positions [cm]"])
radii = [math.hypot(x[2 * i] - 0.5, x[2 * i + 1] - 0.5) for i in range(N)]
check("ring: a circle", max(radii) / min(radii) < 1.01,
      "radii %.4f to %.4f" % (min(radii), max(radii)))
exact = N / 2 * math.sin(2 * math.pi / N) * A * B
check("ring: area", abs(area(x) / exact - 1) < 5e-3, "lost %.3f %%" % (100 * (1 - area(x) / exact)))
energies = [float(line[-1]) for line in case.statistics("ring")[1:]]
# a circle of the same area: K / 2 times circumference
circle = 0.5 * K / DS * N * (2 * math.sqrt(A * B) * math.sin(math.pi / N)) ** 2
check("ring: energy falls to that of the circle",
      energies[0] > 1.05 * circle and abs(energies[-1] / circle - 1) < 0.01,
      "%.4f, %.4f; %.4f" % (energies[0], energies[-1], circle))

# The strand, in the way of the block.
case.add_strand()
for ranks in (1, 2):
    through, resumed = "through_%d" % ranks, "resumed_%d" % ranks
    text = case.run(program, through, ranks, dt="2e-3", period="20")
    check("strand, %d rank(s): the grid follows" % ranks, "The grid has been rebuilt" in text)
    shutil.copytree(through, resumed)
    every = case.checkpoints(resumed)
    for later in every[3:]:
        shutil.rmtree(later)
    at, changes = int(os.path.basename(every[2])), case.changes_of_the_grid(through, 3)
    check("strand, %d rank(s): the grid changes before step %d and after" % (ranks, at),
          min(changes) <= at < max(changes), changes)
    text = case.run(program, resumed, ranks, dt="2e-3", period="20")
    check("strand, %d rank(s): resumed" % ranks, "resumed from" in text)
    found = case.differences(through, resumed)
    check("strand, %d rank(s): the same" % ranks, not found, found or "to the last bit")

# Springs belong to the run as the vertex file does.
with open("strand.spring", "a") as file:
    file.write("# softer\n")
text = case.run(program, "resumed_1", status=1, dt="2e-3", period="20", end="0.3")
check("strand: changed springs", "has other parameters" in text and text.count(", is now ") == 1
      and "Part strand / Vertex file (.spring): was" in text, text[-300:])
os.remove("strand.beam")
text = case.run(program, "resumed_1", status=1, dt="2e-3", period="20", end="0.3")
check("strand: no beams any more", '(.beam): was "strand.beam, contents ' in text
      and ', is now ""' in text, text[-300:])
a, b = case.statistics("through_1"), case.statistics("through_2")
names = a[0]
for name in ("strand target points displacement [cm]", "strand top displacement [cm]",
             "extent max [cm]", "energy elastic [erg/cm]", "force x [dyn/cm]"):
    c = names.index(name) if name in names else -1
    if c < 0:
        check(name, False, names)
        continue
    size = max(abs(float(line[c])) for line in a[1:])
    difference = max(abs(float(p[c]) - float(q[c])) for p, q in zip(a[1:], b[1:]))
    check("strand, 1 and 2 ranks: " + name, 0 < size and difference < 1e-6 * size,
          "largest %.3e, difference %.1e" % (size, difference))
x = [float(line[names.index("extent max [cm]")]) for line in a[1:]]
check("strand: it moves", max(x) - x[0] > 0.005, "%.4f to %.4f" % (x[0], max(x)))
if failures:
    sys.exit("FAILED: " + ", ".join(failures))
