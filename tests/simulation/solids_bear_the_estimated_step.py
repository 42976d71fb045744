#!/usr/bin/python3
"""The longest stable step that --validate says for a stiff block of finite elements in a fluid:
a run with 0.85 of it comes to its end, one with 1.25 of it does not; with elements of six cells
and of less than one. A material that stiffens during the run is judged by the time at which it is
stiffest. One and two ranks say the same.

usage: solids_bear_the_estimated_step.py MITRE WORK_FOLDER
"""

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
case.PARAMETERS = case.PARAMETERS.replace("set C1 = 5", "set C1 = 5000").replace(
    "set Minimum level = 1", "set Minimum level = 3")
failures = []


def check(name, good, found=""):
    print("%-70s %s" % (name, found if good else "FAILED: %s" % (found,)), flush=True)
    if not good:
        failures.append(name)


def estimate(ranks=1):
    """The longest stable step, and what limits it."""
    text = re.sub(r"\s+", " ", case.run(program, "estimate", ranks, options=["--validate"],
                                        dt="1e-4", period="0"))
    found = re.search(r"part block \(([^)]*)\): ([0-9.e+-]+) s", text)
    if not found:
        sys.exit("--validate:\n" + text)
    return float(found.group(2)), found.group(1)


def ends(dt):
    """Whether a run of 300 steps comes to its end."""
    case.write_parameters("run", dt="%.6g" % dt, end="%.6g" % (300 * dt), period="0",
                          resume="never", fields="0", statistics="100")
    result = subprocess.run([program, "run.prm"], capture_output=True, text=True, timeout=250)
    return result.returncode == 0


for n in (2, 16):
    case.write_mesh(n=n)
    stable, limited_by = estimate()
    check("%d x %d elements: limited by the material" % (n, n),
          limited_by == "material rubber", limited_by)
    check("%d x %d elements: 0.85 of the step is stable" % (n, n), ends(0.85 * stable),
          "%.3g s" % stable)
    check("%d x %d elements: 1.25 of the step is not" % (n, n), not ends(1.25 * stable))

parallel, limited_by = estimate(2)
check("two ranks", abs(parallel / stable - 1) < 0.02, "%.4g and %.4g s" % (stable, parallel))
case.PARAMETERS = case.PARAMETERS.replace(
    "      set Law         = neo-Hookean",
    "      set Time factor = 1 + 3 * (t > 0.1)\n      set Law         = neo-Hookean")
later, limited_by = estimate()
check("four times as stiff after 0.1 s: half the step", abs(2 * later / stable - 1) < 0.02,
      "%.4g s" % later)
found = re.match(r"material rubber at t = ([0-9.]+) s", limited_by)
check("four times as stiff after 0.1 s: when", bool(found) and 0.1 < float(found.group(1)) < 0.11,
      limited_by)
if failures:
    sys.exit("FAILED: " + ", ".join(failures))
