#!/usr/bin/python3
"""Seconds a step of a coupled run: a soft block of 40^3 hexahedra in 0.4^3 of a lid-driven
cavity of 64^3 cells, box 1 cm a side, viscosity 0.01, time step 2.5e-5 s, IB_4, three points a
cell. It is no test.

usage: block_in_cavity.py MITRE WORK_FOLDER [RANKS = 1 [STEPS = 20 [CELLS_PER_PATCH_SIDE = 16]]]
"""

import csv
import os
import statistics
import subprocess
import sys

mitre, folder = os.path.abspath(sys.argv[1]), sys.argv[2]
ranks, steps, side = (list(map(int, sys.argv[3:])) + [1, 20, 16][len(sys.argv) - 3:])
os.makedirs(folder, exist_ok=True)
os.chdir(folder)

N, LOWER, SIZE, DT = 40, 0.3, 0.4, 2.5e-5


def node(i, j, k):
    return 1 + i + (N + 1) * (j + (N + 1) * k)


with open("block.msh", "w") as file:
    file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % (N + 1) ** 3)
    for k in range(N + 1):
        for j in range(N + 1):
            for i in range(N + 1):
                file.write("%d %.12g %.12g %.12g\n" % (
                    (node(i, j, k),) + tuple(LOWER + SIZE * x / N for x in (i, j, k))))
    file.write("$EndNodes\n$Elements\n%d\n" % N ** 3)
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    for e in range(N ** 3):
        i, j, k = e % N, e // N % N, e // N ** 2
        nodes = [node(i + a, j + b, k + c) for c in (0, 1) for a, b in square]
        file.write("%d 5 2 1 1 %s\n" % (e + 1, " ".join(map(str, nodes))))
    file.write("$EndElements\n")

with open("block.prm", "w") as file:
    file.write(f"""set Dimension     = 3
set Output folder = run
subsection Time
  set End time  = {DT * steps}
  set Time step = {DT}
end
subsection Grid
  set Lower corner         = 0, 0, 0
  set Upper corner         = 1, 1, 1
  set Base patches         = {64 // side}, {64 // side}, {64 // side}
  set Cells per patch side = {side}
  set Maximum level        = 0
end
subsection Fluid
  set Viscosity = 0.01
end
subsection Boundary conditions
  set Conditions = lid, walls
  subsection Condition lid
    set Faces      = z max
    set Type       = velocity
    set Velocity x = 1
  end
  subsection Condition walls
    set Faces = x min, x max, y min, y max, z min
    set Type  = wall
  end
end
subsection Structure
  set Parts = block
  subsection Part block
    set Mesh file     = block.msh
    set Materials     = rubber
    set Kernel        = IB_4
    set Point density = 3
    subsection Material rubber
      set Material id = 1
      set Law         = neo-Hookean
      subsection neo-Hookean
        set C1 = 10
      end
    end
  end
end
subsection Output
  set Time between fields      = 0
  set Steps between statistics = 1
end
""")

command = ([] if ranks == 1 else ["mpirun", "-np", str(ranks)]) + [
    mitre, "--resume=never", "block.prm"]
result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
if result.returncode != 0:
    sys.exit(result.stdout)
with open("run/statistics.csv") as file:
    rows = list(csv.DictReader(file))
times = [float(row["wall time per step [s]"]) for row in rows[3:]]
iterations = [float(row["solver iterations"]) for row in rows[3:]]
print(f"{ranks} rank(s), patches of {side}^3 cells, {len(times)} steps: "
      f"{min(times):.3f} / {statistics.median(times):.3f} / {max(times):.3f} s a step "
      f"(least / median / largest), {statistics.mean(iterations):.1f} iterations")
