#!/usr/bin/python3
"""A run that stops and goes on from a checkpoint is the same run, to the last bit of its
fields, its statistics (but wall times) and its frames, on one and on two ranks, with equal and
with variable steps, from checkpoints before and after changes of the grid. Lines and frames
that are later than the checkpoint are dropped and written again. From one rank to two and back
it is the same within 1e-10, with parts of finite elements and of fibres. (SIGTERM, SIGUSR1 and the limit of the wall time end or do not end
it as they should.)

usage: resumed_run_is_the_same.py MITRE WORK_FOLDER
"""

import math
import os
import shutil
import signal
import subprocess
import sys
import time

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


steps_of = {"equal steps": {}, "variable steps": dict(courant="0.4", maximum="0.41", dt="8e-3")}
for kind, parameters in steps_of.items():
    for ranks in (1, 2):
        name = "%s, %d rank(s)" % (kind, ranks)
        through = "through_%s_%d" % (kind.split()[0], ranks)
        text = case.run(program, through, ranks, **parameters)
        heading = case.statistics(through)[0]
        ends = [heading.index("bar " + end + " [cm]") for end in ("min", "max")]
        error = max(abs(float(line[end]) - rest - 0.01 * math.sin(30 * float(line[0])))
                    for line in case.statistics(through)[1:]
                    for end, rest in zip(ends, (0.1, 0.16)))
        check(name + ": the rigid bar is where it shall be", error < 1e-9, "%g" % error)
        check(name + ": the grid follows the block", "The grid has been rebuilt" in text,
              [line for line in text.splitlines() if "rebuilt" in line])
        if kind == "variable steps":
            lengths = [float(line[3]) for line in case.statistics(through)[2:]]
            check(name + ": steps differ", max(lengths) > 1.2 * min(lengths),
                  "%g to %g" % (min(lengths), max(lengths)))
        every = case.checkpoints(through)
        for number in ((0, 3) if ranks == 1 else (2,)):
            resumed = "%s_resumed" % through
            shutil.rmtree(resumed, ignore_errors=True)
            shutil.copytree(through, resumed)
            for later in case.checkpoints(resumed)[number + 1:]:
                shutil.rmtree(later)
            # A mark in what has to be written again.
            with open(resumed + "/statistics.csv", "a") as file:
                file.write("0.2399," + ",".join(["1"] * len(case.statistics(through)[0])) + "\n")
            os.remove(resumed + "/output/block_00011.vtu")
            text = case.run(program, resumed, ranks, **parameters)
            step = os.path.basename(every[number])
            changes = case.changes_of_the_grid(through, 3)
            at = int(os.path.basename(every[number]))
            check(name + ": the grid changes after step %d%s" % (at, " and before" if number else ""),
                  max(changes) > at and (number == 0 or min(changes) < at), changes)
            check(name + ": resumed", "resumed from %s/checkpoints/%s" % (resumed, step) in text,
                  step)
            found = case.differences(through, resumed)
            check(name + ": the same", not found, found or "to the last bit")

# Stopped by a signal at any step, and by the end time.
case.write_parameters("stopped", period="0", end="0.24")
process = subprocess.Popen(case.command(program, "stopped"), stdout=subprocess.PIPE, text=True)
while not os.path.exists("stopped/output/fluid_00001.pvtu"):
    time.sleep(0.01)
process.send_signal(signal.SIGUSR1)
while not case.checkpoints("stopped"):
    time.sleep(0.01)
check("SIGUSR1: the run goes on", process.poll() is None)
process.send_signal(signal.SIGTERM)
text = process.communicate()[0]
check("SIGTERM: exit status", process.returncode == 75, process.returncode)
check("SIGTERM: message", "stops" in text and "signal 15" in text)
check("checkpoints of both", len(case.checkpoints("stopped")) == 2, case.checkpoints("stopped"))
case.run(program, "stopped", period="60")
found = case.differences("through_equal_1", "stopped")
check("after SIGTERM: the same", not found, found or "to the last bit")

case.run(program, "prolonged", end="0.12")
text = case.run(program, "prolonged", end="0.24")
found = case.differences("through_equal_1", "prolonged")
check("a later end time: the same", "resumed" in text and not found, found or "to the last bit")

begin = time.time()
text = case.run(program, "limited", status=75, period="0", limit="0.2", dt="4e-5", end="1")
check("wall time limit: message",
      "Wall time limit" in text and len(case.checkpoints("limited")) == 1)
check("wall time limit: stops before", 1 < time.time() - begin < 12, "%.1f s" % (time.time() - begin))

# A checkpoint each 0.6 s; and signals to all ranks, twice, as batch systems and mpirun send them.
for ranks, number in ((1, signal.SIGINT), (2, signal.SIGUSR2)):
    run = "minutes_%d" % ranks
    case.write_parameters(run, period="0", minutes="0.01", dt="4e-5", end="10", fields="0")
    process = subprocess.Popen(case.command(program, run, ranks), stdout=subprocess.PIPE, text=True)
    begin = time.time()
    while len(case.checkpoints(run)) < 3 and time.time() < begin + 60:
        time.sleep(0.01)
    times = [os.path.getmtime(checkpoint) for checkpoint in case.checkpoints(run)]
    process.send_signal(number)
    time.sleep(0.05)
    process.send_signal(number)
    text = process.communicate()[0]
    check(run + ": a checkpoint each 0.6 s",
          len(times) == 3 and 0.6 < times[2] - times[1] + 1e-2 and times[2] - times[0] < 10,
          ["%.2f" % (b - a) for a, b in zip(times, times[1:])])
    check(run + ": stops on %s" % number.name, process.returncode == 75
          and "on signal %d" % number in text and len(case.checkpoints(run)) == 4,
          process.returncode)

# One rank, two ranks, one rank, with fibres.
case.add_strand()
tight = dict(tolerance="1e-13", mass_tolerance="1e-14", statistics="1", fields="0", dt="2e-3")
case.run(program, "one", **tight)
case.run(program, "changing", 1, end="0.08", **tight)
case.run(program, "changing", 2, end="0.16", **tight)
case.run(program, "changing", 1, end="0.24", **tight)
a, b = case.statistics("one"), case.statistics("changing")
changes = case.changes_of_the_grid("one", 1)
check("1, 2, 1 ranks: the grid changes on all of them",
      [sum(1 for at in changes if t < 2e-3 * at < t + 0.08) > 0 for t in (0, 0.08, 0.16)] == 3 * [True],
      changes)
check("1, 2, 1 ranks: lines", len(a) == len(b) == 122, (len(a), len(b)))
for c, name in enumerate(a[0]):
    if name in ("solver iterations", "largest divergence [1/s]"):
        continue
    size = max(abs(float(line[c])) for line in a[1:])
    difference = max(abs(float(x[c]) - float(y[c])) for x, y in zip(a[1:], b[1:]))
    # the table has ten digits
    check("1, 2, 1 ranks: " + name, difference <= 1.1e-9 * size,
          "largest %.3e, difference %.1e" % (size, difference))
a, b = case.velocities_and_pressures("one"), case.velocities_and_pressures("changing")
for name in a:
    size = max(abs(x) for x in a[name])
    difference = max(abs(x - y) for x, y in zip(a[name], b[name]))
    check("1, 2, 1 ranks: " + name, len(a[name]) == len(b[name]) and difference <= 1e-10 * size,
          "largest %.3e, difference %.1e" % (size, difference))

# With steps of half the length from the middle on, and stopped once more after that.
half = dict(tight, dt="1e-3", statistics="2")
case.run(program, "shorter", end="0.12", **tight)
text = case.run(program, "shorter", end="0.17", **half)
check("shorter steps: said", "since step 60, of other length before" in text, text[:900])
text = case.run(program, "shorter", end="0.24", **half)
b = case.statistics("shorter")
a = case.statistics("one")
check("shorter steps: lines", len(b) == len(a), (len(b), len(a)))
check("shorter steps: times", [line[0] for line in a] == [line[0] for line in b], b[-1][0])
for name in ("flow [cm^2/s]", "energy elastic [erg/cm]", "extent max [cm]"):
    c = a[0].index(name)
    size = max(abs(float(line[c])) for line in a[1:])
    difference = max(abs(float(x[c]) - float(y[c])) for x, y in zip(a[1:], b[1:]))
    check("shorter steps: " + name, 0 < difference < 0.02 * size,
          "largest %.3e, difference %.1e" % (size, difference))
if failures:
    sys.exit("FAILED: " + ", ".join(failures))
