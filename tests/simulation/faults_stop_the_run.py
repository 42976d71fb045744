#!/usr/bin/python3
"""What goes wrong during a run stops all of its ranks, with exit status other than 0 and a
message that says what, where and when, and what to try. What has been written until then can
be read, and the run goes on from its newest checkpoint. More ranks than patches are no fault.

usage: faults_stop_the_run.py MITRE WORK_FOLDER [CASE...]
"""

import glob
import os
import re
import shutil
import signal
import subprocess
import sys
import time

import resume_case as case

program, folder, chosen = os.path.abspath(sys.argv[1]), sys.argv[2], sys.argv[3:]
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)
case.write_meshes()
failures = []


def fail(name, text):
    failures.append(name)
    print("%s: FAILED: %s" % (name, text), flush=True)


def write(name, change=(), **changes):
    case.write_parameters(name, **dict(dict(period="10", kept="2", statistics="1", fields="0.04"), **changes))
    with open(name + ".prm") as file:
        text = file.read()
    for old, new in change:
        assert old in text, old
        text = text.replace(old, new)
    with open(name + ".prm", "w") as file:
        file.write(text)


def check_files(name):
    """All that the run has left must be whole."""
    with open(name + "/statistics.csv") as file:
        lines = file.read().splitlines()
    if any(line.count(",") != lines[0].count(",") for line in lines):
        fail(name, "statistics.csv is not whole")
    for collection in glob.glob(name + "/output/*.pvd"):
        with open(collection) as file:
            text = file.read()
        if not text.rstrip().endswith("</VTKFile>"):
            fail(name, collection + " is not whole")
        for frame in re.findall('file="([^"]*)"', text):
            with open(name + "/output/" + frame, "rb") as file:
                if not file.read().rstrip().endswith(b"</VTKFile>"):
                    fail(name, frame + " is not whole")


def check_checkpoint(name):
    """The newest checkpoint can be read: the run is at its end there."""
    if os.path.isfile(name + "/output"):
        os.remove(name + "/output")
    last = case.checkpoints(name)[-1]
    with open(last + "/manifest.txt") as file:
        end = [line.split()[1] for line in file if line.startswith("time")][0]
    with open(name + ".prm") as file:
        text = re.sub("set End time *=.*", "set End time = " + end, file.read())
    with open(name + ".prm", "w") as file:
        file.write(text)
    result = subprocess.run([program, name + ".prm"], capture_output=True, text=True, timeout=100)
    if result.returncode != 0 or "resumed from " + last not in result.stdout:
        fail(name, "does not go on from " + last + "\n" + result.stdout + result.stderr)


def expect(name, words, ranks=(1, 2), change=(), meddle=None, checkpoint=True, **changes):
    """MEDDLE(process, folder) is called when the run has left its first checkpoint."""
    for n in ranks if name in chosen or not chosen else ():
        run = "%s_%d" % (name.replace(" ", "_"), n)
        write(run, change, **changes)
        begin = time.time()
        with open(run + ".log", "w") as log:
            process = subprocess.Popen(case.command(program, run, n), stdout=log, stderr=log,
                                       start_new_session=True)
            try:
                if meddle:
                    while not case.checkpoints(run) and process.poll() is None:
                        time.sleep(0.002)
                    meddle(process, run)
                process.wait(timeout=100)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                fail(run, "hangs")
                continue
        seconds = time.time() - begin
        with open(run + ".log") as log:
            text = re.sub(r"\s+", " ", log.read())
        at = 0
        for word in words:
            at = text.find(word, at)
            if at < 0:
                fail(run, "'%s' is not in its place in\n%s" % (word, text[-2000:]))
                break
        if process.returncode == 0:
            fail(run, "has the exit status 0")
        if text.count(" mitre: ") > 1:
            fail(run, "has more than one message\n" + text)
        check_files(run)
        if checkpoint:
            check_checkpoint(run)
        print("%s: status %d after %.1f s" % (run, process.returncode, seconds), flush=True)


saved = ["The run stops in step", "which begins at t =", "the flow is fastest",
         "from the node of part ", "whose place at rest is", "The state before this step",
         "The newest checkpoint is"]

# A step that is too long: the flow becomes too fast.
expect("fast flow", ["the flow passes", "the flow is fastest", "try half of it"] + saved,
       change=[("set Pressure = 20", "set Pressure = 20 + 1e8*(t > 0.05)")])

# Forces so large that nothing is finite any more.
expect("not finite", ["mitre:", "too large"] + saved,
       change=[("set C1 = 5", "set C1 = 5\n      end\n      set Time factor = "
                "if(t < 0.05, 1, 1e300)\n      subsection neo-Hookean")])

# An expression that for a short time has no value in a part of the box, which one of two ranks
# has; the other waits for it in vain. (The look at the conditions before the first step is at
# other times.)
expect("no value", ["mitre: Boundary conditions / outlet / Pressure", "The run stops in step",
                    "The newest checkpoint is"],
       change=[("set Type  = pressure", "set Type  = pressure\n    set Pressure = "
                "if(abs(t - 0.0504) > 1e-4 && abs(t - 0.0504) < 2.3e-3 && y > 0.5, 1/(t-t), 0)")])

# Elements of a tissue without stiffness are turned inside out where the flow bends.
expect("inverted element", ["Part block", "element", "inside out", "at time", "centroid",
                            "A smaller time step"] + saved,
       change=[("set C1 = 5", "set C1 = 1e-6"), ("set Pressure = 20", "set Pressure = 0"),
               ("set Viscosity = 0.05", "set Viscosity = 1e-3"),
               ("set Initial velocity x = 4*y*(1-y)",
                "set Initial velocity x = 4*sin(10*pi*x)*cos(10*pi*y)\n"
                "  set Initial velocity y = -4*cos(10*pi*x)*sin(10*pi*y)")], stiffness="0",
       dt="2e-3", end="2")

# Nothing holds the part, which is carried out of the box.
expect("part leaves", ["Part block", "outside of the fluid's box"] + saved,
       change=[("set Pressure = 20", "set Pressure = 200"), ("Upper corner  = 2, 1",
               "Upper corner  = 1, 1"), ("Base patches  = 2, 1", "Base patches  = 1, 1"),
               ("set Maximum level = 3", "set Maximum level = 2")],
       stiffness="0", end="4", courant="0.5")

# The solver does not reach its tolerance.
expect("solver fails", ["mitre: The velocity-pressure solver has not converged in 1 iterations",
                        "Try a smaller time step", "Relative tolerance"] + saved,
       change=[("set Pressure = 20", "set Pressure = 20*(t > 0.05)"),
               ("set Initial velocity x = 4*y*(1-y)", ""),
               ("set Relative tolerance", "set Maximum iterations = 1\n    set Relative tolerance")])


# The folder of the frames is not there any more.
def take_folder(_, run):
    # in one go, as frames are being written
    os.rename(run + "/output", run + "/output_of_before")
    with open(run + "/output", "w"):
        pass


expect("no folder", ["mitre: Cannot write", "/output/", "Not a directory",
                     "The newest checkpoint is"], meddle=take_folder, end="4", period="5")


# A rank dies, as if the system had killed it for want of memory.
def kill_a_rank(process, _):
    with open("/proc/%d/task/%d/children" % (process.pid, process.pid)) as file:
        children = [int(child) for child in file.read().split()]
    os.kill(children[-1], signal.SIGKILL)


expect("dead rank", ["signal 9"], ranks=(2,), meddle=kill_a_rank, end="4", period="5")

# More ranks than patches: the same as on one rank, up to round-off and tolerances.
few = [("set Minimum level = 1", ""),
       ("set Maximum level = 3", "set Maximum level = 0")]
results = {}
for ranks in (1, 3) if "few patches" in chosen or not chosen else ():
    run = "few_patches_%d" % ranks
    write(run, few, end="0.08", tolerance="1e-10")
    status = subprocess.run(case.command(program, run, ranks), capture_output=True, text=True,
                            timeout=100)
    if status.returncode != 0:
        fail(run, status.stdout + status.stderr)
        continue
    results[ranks] = [[float(x) for x in line] for line in case.statistics(run)[1:]]
    write(run, few, end="0.1", tolerance="1e-10")
    status = subprocess.run(case.command(program, run, 4 - ranks), capture_output=True, text=True,
                            timeout=100)
    if status.returncode != 0 or "resumed from" not in status.stdout:
        fail(run, "does not go on: " + status.stdout + status.stderr)
if len(results) == 2:
    # time, cells, and all columns behind the divergence, which is round-off
    worst = max(abs(a - b) / (abs(a) + 1e-3) for one, other in zip(results[1], results[3])
                for c, (a, b) in enumerate(zip(one, other)) if c in (0, 2) or c > 5)
    print("two patches on 1 and 3 ranks: largest relative difference %.1e" % worst)
    if len(results[1]) != 21 or not worst < 1e-6:
        fail("few patches", "%d lines, difference %g" % (len(results[1]), worst))

sys.exit("FAILED: " + ", ".join(failures) if failures else 0)
