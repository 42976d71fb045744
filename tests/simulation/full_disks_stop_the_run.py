#!/usr/bin/python3
"""A disk that is full, or that cannot be written to, stops a run with exit status 1 and a message
that names the file, the reason, the time and the newest checkpoint: during a frame, a checkpoint
and a line of the table, on one and two ranks, and at the start. Files from before are as they
were, the table ends with a whole line, and nothing is left of what could not be written. With
room again the run goes on, and is the same to the last bit as one that had room all the time.

The disk is a tmpfs in a mount namespace of its own, which ends with this script. Where the system
does not allow that, the exit status is 77, and the test counts as skipped.

usage: full_disks_stop_the_run.py MITRE WORK_FOLDER
"""

import glob
import os
import re
import shutil
import subprocess
import sys

import resume_case as case

program, folder = os.path.abspath(sys.argv[1]), sys.argv[2]
SKIPPED = 77
if "MITRE_OWN_MOUNTS" not in os.environ:
    unshare = ["unshare", "--mount"]
    if os.getuid() != 0:
        unshare += ["--user", "--map-root-user"]
    trial = unshare + ["mount", "-t", "tmpfs", "tmpfs", "/mnt"]
    if shutil.which("unshare") is None or subprocess.run(trial).returncode != 0:
        print("skipped: no file system can be mounted here")
        sys.exit(SKIPPED)
    os.environ["MITRE_OWN_MOUNTS"] = "1"
    os.execvp("unshare", unshare + [sys.executable] + sys.argv)

shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder + "/disk")
os.chdir(folder)
subprocess.run(["mount", "-t", "tmpfs", "-o", "size=32m", "tmpfs", "disk"], check=True)
os.makedirs("disk/run")
os.symlink("disk/run", "run")
case.write_meshes()
failures = []


def check(name, good, found=""):
    print("%-70s %s" % (name, found if good else "FAILED: %s" % (found,)), flush=True)
    if not good:
        failures.append(name)


def fill(room):
    """Fills the disk but for ROOM bytes, in whole pages."""
    with open("disk/filler", "wb") as file:
        left = os.statvfs("disk").f_bavail * os.statvfs("disk").f_frsize - room
        while left > 0:
            left -= file.write(b"x" * min(left, 1 << 20))
            file.flush()


def contents(top):
    """All files that do not grow, and the table."""
    result = {}
    for path, _, names in os.walk(top):
        for name in names:
            if name != "lock":
                with open(os.path.join(path, name), "rb") as file:
                    result[os.path.join(path, name)] = file.read()
    return result


short = dict(dt="8e-3", maximum="5", period="5", kept="3", statistics="1")
# What fills the disk, ranks, end of the first part, room [bytes], the file that the message names,
# changed parameters. (A run that goes on writes its parameters and the table anew.)
variants = [
    ("frame", 1, "0.08", 8192, r"run/output/fluid_0000\d\.\d\.vtu", dict(period="20")),
    ("checkpoint", 2, "0.08", 16384, r"run/checkpoints/000000\d\d\.tmp/\S+", dict(fields="0")),
    ("table", 1, "0.02", 12288, r"run/statistics\.csv",
     dict(dt="2e-3", period="80", fields="0")),
]
for name, ranks, end, room, file, changes in variants:
    what = "%s, %d rank(s)" % (name, ranks)
    through = "through_" + name
    shutil.rmtree("disk/run")
    os.makedirs("disk/run")
    case.run(program, "run", ranks, **dict(short, end=end, dt=changes.get("dt", "8e-3")))
    shutil.copytree("run", through)
    case.run(program, through, ranks, **dict(dict(short, end="0.16"), **changes))
    before = contents("run")
    last = case.checkpoints("run")[-1]

    fill(room)
    text = case.run(program, "run", ranks, status=1, **dict(dict(short, end="0.16"), **changes))
    text = re.sub(r"\s+", " ", text)
    words = (r"mitre: Cannot write " + file + r": No space left on device\. "
             r"The run stops after step \d+, at t = [0-9.]+ s\. .*"
             r"The newest checkpoint is " + last)
    check(what + ": message", re.search(words, text), "" if re.search(words, text) else text[-600:])
    check(what + ": one message", text.count(" mitre: ") == 1)
    after = contents("run")
    changed = [path for path in before if after.get(path) != before[path]
               and not path.endswith((".pvd", "statistics.csv", "parameters.prm"))]
    check(what + ": earlier files", not changed, changed)
    check(what + ": no remains", not [path for path in after if ".tmp" in path])
    table = after["run/statistics.csv"]
    check(what + ": lines are whole",
          table.startswith(before["run/statistics.csv"]) and table.endswith(b"\n")
          and len({line.count(b",") for line in table.splitlines()}) == 1)
    for collection in glob.glob("run/output/*.pvd"):
        listed = re.findall(rb'file="([^"]*)"', after[collection])
        check(what + ": " + collection, after[collection].rstrip().endswith(b"</VTKFile>")
              and all(os.path.exists("run/output/" + frame.decode()) for frame in listed),
              len(listed))

    os.remove("disk/filler")
    text = case.run(program, "run", ranks, **dict(dict(short, end="0.16"), **changes))
    check(what + ": goes on", "resumed from " + last in text)
    found = case.differences(through, "run")
    check(what + ": the same in the end", not found, found or "to the last bit")

# From the start.
shutil.rmtree("disk/run")
os.makedirs("disk/run")
fill(0)
text = case.run(program, "run", status=1, **short)
check("full at the start", re.search(r"mitre: Cannot write run/\S+: No space left on device", text),
      text[-300:])
os.remove("disk/filler")
case.run(program, "run", **dict(short, end="0.08"))
before = contents("run")
subprocess.run(["mount", "-o", "remount,ro", "disk"], check=True)
for options, words in ((), "mitre: Cannot write run/lock: Read-only file system"), \
        (["--validate"], 'no files can be made in .*/run: Read-only file system'):
    text = case.run(program, "run", status=1, options=options, **short)
    check("read-only" + "".join(options), re.search(words, text), text[-300:])
subprocess.run(["mount", "-o", "remount,rw", "disk"], check=True)
check("read-only: files from before", contents("run") == before)

# A folder in which its owner must not write; the superuser gives up the right to do so all the
# same.
os.chmod("disk/run", 0o555)
plain = case.command
case.command = lambda *arguments: ["setpriv", "--bounding-set", "-dac_override,-dac_read_search",
                                   "--"] + plain(*arguments)
for options, words in ((), "mitre: Cannot write run/lock: Permission denied"), \
        (["--validate"], 'no files can be made in .*/run: Permission denied'):
    # the lock is there already, and would be opened
    os.rename("disk/run/lock", "disk/lock") if os.path.exists("disk/run/lock") else None
    text = case.run(program, "run", status=1, options=options, **short)
    check("unwritable folder" + "".join(options), re.search(words, text), text[-300:])
os.chmod("disk/run", 0o755)
check("unwritable folder: files from before", contents("run") == before)
if failures:
    sys.exit("FAILED: " + ", ".join(failures))
