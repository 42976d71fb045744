#!/usr/bin/python3
"""The collapsible channel of parameter_files/collapsible_channel.prm on a grid of half its resolution.
Its wall starts at the steady shape that another method has found
(parameter_files/collapsible_channel_steady.csv, from fluid_beam_solution_converges.cc), over a flow that
is parabolic everywhere. In the first second it moves as on the finer grid: its depth, 1 - min y,
is within 2 % of what it was there, and of the steady shape's within 3 % (doc/verification.md).

usage: channel_wall_stays_near_steady_shape.py MITRE MITRE_GEOMETRY SOURCE_FOLDER WORK_FOLDER
"""

import csv
import os
import shutil
import subprocess
import sys

program, geometry, source, folder = sys.argv[1:5]
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)
os.symlink(os.path.join(source, "parameter_files"), "parameter_files")
SHAPE = "parameter_files/collapsible_channel_steady.csv"


def run(*arguments):
    result = subprocess.run(arguments, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if result.returncode != 0:
        sys.exit("%s ended with %d:\n%s" % (arguments, result.returncode, result.stdout[-3000:]))


with open("geometry.prm", "w") as file:
    file.write("""include parameter_files/geometry_collapsible_channel.prm
subsection Collapsible channel
  set Spacing     = 0.0416667
  set Start shape = %s
end
""" % SHAPE)
run(geometry, "geometry.prm")
height = "(1 - 0.2646*if(abs(x - 7.5) < 2.5, 1 - ((x - 7.5)/2.5)^2, 0))"
with open("coarse.prm", "w") as file:
    file.write("""include parameter_files/collapsible_channel.prm
set Output folder = run
subsection Time
  set End time  = 1
  set Time step = 1.5625e-4
end
subsection Grid
  set Maximum level = 0
end
subsection Fluid
  set Initial velocity x = if(y < %s, 30*y/%s^2*(1 - y/%s), 0)
  subsection Solver
    set Relative tolerance = 1e-5
  end
end
subsection Output
  set Time between fields      = 0
  set Steps between statistics = 1600
end
""" % (height, height, height))
run(program, "--resume=never", "coarse.prm")

with open(SHAPE) as file:
    expected = 1 - min(float(line["y [cm]"]) for line in csv.DictReader(file))
with open("run/statistics.csv") as file:
    lines = list(csv.DictReader(file))
# 1/24 cm about the elastic part, time step 5.5e-5 s
finer = {0.25: 0.26194, 0.5: 0.25957, 0.75: 0.25887, 1.0: 0.25961}
failed = False
for line in lines[1:]:
    depth = 1 - float(line["wall min [cm]"])
    there = finer.pop(round(float(line["time [s]"]), 6))
    good = abs(depth / expected - 1) < 0.03 and abs(depth / there - 1) < 0.02
    print("t = %s s: depth %.4f cm, on the finer grid %.4f, steady %.4f: %s"
          % (line["time [s]"], depth, there, expected, "ok" if good else "FAILED"))
    failed = failed or not good
sys.exit(1 if failed or finer else 0)
