#!/usr/bin/python3
"""The first 50 steps of the mitral valve (coarse grid) on one and on two ranks: all
figures in statistics.csv but iterations and times agree to 1e-8 of the largest value
that their column has.

usage: ranks_agree.py MITRE MITRE_GEOMETRY REPOSITORY WORK_FOLDER
"""

import csv
import os
import shutil
import subprocess
import sys

mitre, geometry, repository, folder = sys.argv[1:5]
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)
files = os.path.join(repository, "parameter_files")


def execute(command):
    result = subprocess.run(command, capture_output=True, text=True, timeout=280)
    if result.returncode != 0:
        sys.exit("%s: status %d\n%s" % (" ".join(command), result.returncode,
                                         (result.stdout + result.stderr)[-3000:]))


execute([geometry, os.path.join(files, "geometry_mitral_valve_quick.prm")])
tables = []
for ranks in (1, 2):
    with open("ranks_%d.prm" % ranks, "w") as file:
        file.write("""include %s/mitral_valve_quick.prm
set Output folder = ranks_%d
subsection Time
  set End time = 5e-3
end
subsection Fluid
  subsection Solver
    set Relative tolerance = 1e-10
  end
end
subsection Output
  set Time between fields      = 0
  set Steps between statistics = 10
end
""" % (files, ranks))
    execute((["mpirun", "-np", "2", "--oversubscribe"] if ranks == 2 else []) +
            [mitre, "ranks_%d.prm" % ranks])
    with open("ranks_%d/statistics.csv" % ranks) as file:
        tables.append(list(csv.reader(file)))

one, two = tables
if one[0] != two[0] or len(one) != 7 or len(two) != 7:
    sys.exit("The tables differ in form: %d and %d lines" % (len(one), len(two)))
failures = 0
for c, name in enumerate(one[0]):
    if name in ("solver iterations", "wall time per step [s]", "largest divergence [1/s]"):
        continue
    largest = max(abs(float(line[c])) for line in one[1:])
    difference = max(abs(float(a[c]) - float(b[c])) for a, b in zip(one[1:], two[1:]))
    agrees = difference <= 1e-8 * max(largest, 1e-300) or difference == 0
    failures += not agrees
    print("%-40s largest %.3e, difference %.1e%s" %
          (name, largest, difference, "" if agrees else "  <-- too large"))
sys.exit("%d columns differ" % failures if failures else 0)
