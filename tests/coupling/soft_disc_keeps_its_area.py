#!/usr/bin/python3
"""The soft disc of parameter_files/soft_disc.prm in a lid-driven cavity, quadratic triangles of
two cells, until t = 2. The lid has drawn it up and bent it, so that J is below 0.95 and above
1.05 in places; its area has changed by less than 6e-4 on a grid of 32 cells a side, and on one of
64 by less than 0.7 of what it has on that.

usage: soft_disc_keeps_its_area.py MITRE SOURCE_FOLDER WORK_FOLDER
"""

import csv
import os
import shutil
import subprocess
import sys

mitre, source, folder = map(os.path.abspath, sys.argv[1:4])
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)

CASE = """
include %(source)s/parameter_files/soft_disc.prm
set Output folder = run_%(n)d
subsection Time
  set End time  = 2
  set Time step = %(step).12g
end
subsection Grid
  set Base patches = %(patches)d, %(patches)d
end
subsection Structure
  subsection Part disc
    set Mesh file = %(source)s/meshes/soft_disc/%(mesh)s.msh
    subsection Material rubber
      subsection neo-Hookean
        set Bulk modulus = %(modulus)g
      end
    end
  end
end
subsection Output
  set Time between fields = 0
end
"""


def largest_change(n, mesh):
    """Of the area over time, and the range of J at the end."""
    with open("disc_%d.prm" % n, "w") as file:
        file.write(CASE % dict(source=source, n=n, step=1 / (32 * n), patches=n // 8,
                               mesh=mesh, modulus=n / 32))
    result = subprocess.run([mitre, "--resume=never", "disc_%d.prm" % n], capture_output=True,
                            text=True, timeout=500)
    if result.returncode != 0:
        sys.exit("%d cells: status %d\n%s" % (n, result.returncode,
                                              (result.stdout + result.stderr)[-2000:]))
    with open("run_%d/statistics.csv" % n) as file:
        rows = list(csv.DictReader(file))
    if abs(float(rows[-1]["time [s]"]) - 2) > 1e-6:
        sys.exit("%d cells: the run ended at t = %s" % (n, rows[-1]["time [s]"]))
    change = max(abs(float(row["disc volume ratio [1]"]) - 1) for row in rows)
    J = [float(rows[-1]["disc %s J [1]" % which]) for which in ("min", "max")]
    print("%d cells: area changes by %.2e at most, J from %.3f to %.3f" % (n, change, *J),
          flush=True)
    return change, J


coarse, J = largest_change(32, "disc_coarse")
fine, _ = largest_change(64, "disc")
failures = []
if not (J[0] < 0.95 and J[1] > 1.05):
    failures.append("the disc is hardly deformed")
if not coarse < 6e-4:
    failures.append("the area changes by %g on the coarser grid" % coarse)
if not fine < 0.7 * coarse:
    failures.append("the area changes by %g on the finer grid, %g on the coarser one" %
                    (fine, coarse))
sys.exit("; ".join(failures) or 0)
