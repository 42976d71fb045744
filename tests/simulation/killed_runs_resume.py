#!/usr/bin/python3
"""A run that writes a checkpoint each second step is killed (kill -9) at random moments: each
time there is a complete checkpoint from which it goes on, and in the end it is the same, to the
last bit, as one that nobody has killed.

usage: killed_runs_resume.py MITRE WORK_FOLDER [N_KILLS [RANKS [SEED]]]
"""

import os
import random
import shutil
import signal
import subprocess
import sys
import time

import resume_case as case

program, folder = sys.argv[1:3]
n_kills = int(sys.argv[3]) if len(sys.argv) > 3 else 3
ranks = int(sys.argv[4]) if len(sys.argv) > 4 else 1
seed = int(sys.argv[5]) if len(sys.argv) > 5 else random.randrange(10**6)
print("%d kills, %d rank(s), seed %d" % (n_kills, ranks, seed), flush=True)
generator = random.Random(seed)
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)
case.write_meshes()


def kill_session(leader):
    """Kills mpirun and its ranks, which are in process groups of their own, within a moment."""
    left = [leader]
    while left:
        for pid in left:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        left = []
        for pid in [int(name) for name in os.listdir("/proc") if name.isdigit()]:
            try:
                if os.getsid(pid) == leader and \
                        open("/proc/%d/stat" % pid).read().rsplit(")")[-1].split()[0] != "Z":
                    left.append(pid)
            except OSError:
                pass


# The end is too far for any of the killed runs to reach it, however fast or slow the machine is
# just then; when the last has been killed, it is brought near.
step = 5e-4
parameters = dict(period="2", kept="2", end="%g" % (1e5 * step), dt="%g" % step, fields="0.01")

killed, last, resumed = 0, "", 0
case.write_parameters("killed", **parameters)
while killed < n_kills:
    process = subprocess.Popen(case.command(program, "killed", ranks), stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, start_new_session=True)
    # Not before it has got further than its predecessor, so that all kills find it running.
    started = time.time()
    while case.checkpoints("killed")[-1:] in ([], [last]) and process.poll() is None \
            and time.time() - started < 100:
        time.sleep(0.002)
    time.sleep(generator.uniform(0, 0.6 / n_kills))
    if process.poll() is not None:
        sys.exit("The run has ended after %d kills: status %d\n%s"
                 % (killed, process.returncode, process.communicate()[0][-2000:]))
    kill_session(process.pid)
    text = process.communicate()[0]
    killed += 1
    resumed += "resumed from" in text
    found = sorted(os.listdir("killed/checkpoints"))
    last = case.checkpoints("killed")[-1]
    print("kill %2d: %s, t = %s" % (killed, found, [line for line in open(last + "/manifest.txt")
                                                     if line.startswith("time")][0].strip()),
          flush=True)
    if "cannot be used" in text:
        sys.exit("FAILED: a checkpoint was not complete\n" + text)
parameters["end"] = "%g" % ((int(os.path.basename(last)) + 4) * step)
text = case.run(program, "killed", ranks, **parameters)
case.run(program, "through", ranks, **parameters)
found = case.differences("through", "killed")
if resumed != n_kills - 1 or "resumed from" not in text or "cannot be used" in text:
    sys.exit("FAILED: resumed %d times\n%s" % (resumed, text))
if found:
    sys.exit("FAILED: the killed run differs in " + ", ".join(found))
print("%d kills: the same to the last bit" % n_kills)
