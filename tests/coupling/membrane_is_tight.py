#!/usr/bin/python3
"""A membrane across a channel (2D) or a tube of square section (3D), held at its edges and
under 100 mmHg, whose elements are 2 and 4 times as large as the grid's cells, between planes of
symmetry. What the instrument "leak" sees pass through it in the last half of the run, when the
pressure stands, amounts to less than 0.1 mL in a valve's cycle of 0.7 s (in 2D to 0.1 mL for a
channel 1 cm deep). With nodal coupling, elements of 4 cells leave nodes so far apart that the
run warns, and at least ten times as much fluid passes.

usage: membrane_is_tight.py MITRE WORK_FOLDER [DIMENSION = 2 [END_TIME = 0.02]]
"""

import csv
import itertools
import os
import shutil
import subprocess
import sys

mitre, folder = sys.argv[1:3]
dim = int(sys.argv[3]) if len(sys.argv) > 3 else 2
end = float(sys.argv[4]) if len(sys.argv) > 4 else 0.02
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)
mitre = os.path.abspath(mitre) if os.path.dirname(mitre) else mitre

# cells across the channel, its width and the membrane's thickness [cm], and its middle
N, WIDTH, LAYERS, MIDDLE = 16, 1.0, 4, 1.0
H = WIDTH / N


def write_mesh(name, ratio):
    """Elements of `ratio` cells a side, the membrane of LAYERS cells' thickness."""
    around, through = N // ratio, LAYERS // ratio
    counts = [through] + [around] * (dim - 1)
    size = ratio * H
    strides = [1]
    for count in counts:
        strides.append(strides[-1] * (count + 1))

    def number(index):
        return 1 + sum(i * s for i, s in zip(index, strides))

    nodes = sorted(itertools.product(*[range(count + 1) for count in counts]), key=number)
    elements = itertools.product(*[range(count) for count in counts])
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    corners = square if dim == 2 else [c + (k,) for k in (0, 1) for c in square]
    with open(name, "w") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(nodes))
        for index in nodes:
            x = [MIDDLE - 0.5 * LAYERS * H + index[0] * size] + [i * size for i in index[1:]]
            file.write("%d %.12g %.12g %.12g\n" % tuple([number(index)] + (x + [0])[:3]))
        lines = []
        for element in elements:
            vertices = [number([e + c for e, c in zip(element, corner)]) for corner in corners]
            lines.append("%d %d 2 1 1 %s" % (len(lines) + 1, 3 if dim == 2 else 5,
                                             " ".join(map(str, vertices))))
        file.write("$EndNodes\n$Elements\n%d\n%s\n$EndElements\n" %
                   (len(lines), "\n".join(lines)))


PARAMETERS = """
set Dimension     = %(dim)d
set Output folder = %(name)s
subsection Time
  set End time  = %(end)g
  set Time step = 1e-5
end
subsection Grid
  set Lower corner  = %(lower)s
  set Upper corner  = %(upper)s
  set Base patches  = %(patches)s
  set Minimum level = 1
  set Maximum level = 1
end
subsection Fluid
  set Density   = 1
  set Viscosity = 0.04
end
subsection Boundary conditions
  set Conditions = upstream, downstream, sides
  subsection Condition upstream
    set Faces    = x min
    set Type     = pressure
    set Pressure = 100 * mmHg * min(t / %(ramp)g, 1)
  end
  subsection Condition downstream
    set Faces = x max
    set Type  = pressure
  end
  subsection Condition sides
    set Faces = all
    set Type  = slip
  end
end
subsection Structure
  set Parts = membrane
  subsection Part membrane
    set Mesh file   = %(mesh)s
    set Coupling    = %(coupling)s
    set Mass matrix = lumped
    set Materials   = rubber
    set Constraints = edge
    subsection Material rubber
      set Material id = 1
      set Law         = neo-Hookean
      subsection neo-Hookean
        set C1           = 3e6
        set Bulk modulus = 3e7
      end
    end
    subsection Constraint edge
      set Type      = tether
      set Stiffness = 1e9
      set Damping   = 1e4
      set Region    = %(region)s
    end
  end
end
subsection Instruments
  set Instruments = leak, flow
  subsection Instrument leak
    set Type = leak
    set Part = membrane
  end
  subsection Instrument flow
    set Type     = flow meter
    set Position = 0.25
  end
end
subsection Output
  set Time between fields      = 0
  set Steps between statistics = 20
end
subsection Checkpoints
  set Steps between checkpoints   = 0
  set Minutes between checkpoints = 0
end
"""


def run(ratio, coupling):
    """Volume in a cycle by the leak in the last half of the run, the same without signs, the
    largest flow in the flow meter, and what the program printed."""
    name = "%s_%d" % (coupling, ratio)
    write_mesh(name + ".msh", ratio)
    edge = " || ".join("%s < %g || %s > %g" % (x, 1e-6, x, WIDTH - 1e-6)
                       for x in "yz"[:dim - 1])
    with open(name + ".prm", "w") as file:
        file.write(PARAMETERS % dict(
            dim=dim, name=name, end=end, ramp=0.25 * end, mesh=name + ".msh", region=edge,
            coupling=coupling, lower=", ".join(["0"] * dim),
            upper=", ".join(["2"] + ["1"] * (dim - 1)),
            patches=", ".join(["2"] + ["1"] * (dim - 1))))
    result = subprocess.run([mitre, name + ".prm"], capture_output=True, text=True,
                            timeout=3000)
    if result.returncode != 0:
        sys.exit("%s: status %d\n%s" % (name, result.returncode,
                                         (result.stdout + result.stderr)[-2000:]))
    with open(name + "/statistics.csv") as file:
        lines = list(csv.reader(file))
    unit = "mL" if dim == 3 else "cm^2"
    column = {heading: [float(line[i]) for line in lines[1:]]
              for i, heading in enumerate(lines[0])}
    time, volume = column["time [s]"], column["leak volume [%s]" % unit]
    both = column["leak volume both ways [%s]" % unit]
    half = min(i for i, t in enumerate(time) if t >= 0.5 * end)
    scale = 0.7 / (time[-1] - time[half])
    spacing = max(column["membrane point spacing [cells]"])
    print("%-9s elements of %d cells: %10.3e in a cycle, %10.3e both ways, points %.2f cells "
          "apart, displacement of the edge %.2e cm, flow of %.2e at the end" %
          (coupling, ratio, scale * (volume[-1] - volume[half]),
           scale * (both[-1] - both[half]), spacing,
           column["membrane edge displacement [cm]"][-1],
           column["flow [%s/s]" % unit][-1]), flush=True)
    return scale * (volume[-1] - volume[half]), spacing, result.stdout


failures = []
tight = {}
for ratio in (2, 4):
    tight[ratio], spacing, text = run(ratio, "elemental")
    if not abs(tight[ratio]) < 0.1:
        failures.append("%g passes through elements of %d cells" % (tight[ratio], ratio))
    if not spacing <= 0.5 or "Warning" in text:
        failures.append("points of elemental coupling are %g cells apart" % spacing)
if dim == 2:
    leaking, spacing, text = run(4, "nodal")
    if not abs(leaking) > 10 * abs(tight[4]):
        failures.append("only %g passes with nodal coupling" % leaking)
    if not spacing > 3.9 or "points of part membrane are" not in text:
        failures.append("no warning of points %g cells apart" % spacing)
sys.exit("; ".join(failures) or 0)
