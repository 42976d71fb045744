#!/usr/bin/python3
"""Damaged checkpoints are recognised, and the one before is used; parameters that may not change
are reported; an error, a full disk among them, leaves the checkpoints and files from before, and
says which is the newest; Resume = never sets checkpoints aside.

usage: damaged_checkpoints_are_recognised.py MITRE WORK_FOLDER
"""

import os
import shutil
import sys
import zlib

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


def truncate(path):
    os.truncate(path, os.path.getsize(path) // 2)


def flip(path):
    with open(path, "r+b") as file:
        file.seek(os.path.getsize(path) // 2)
        byte = file.read(1)[0]
        file.seek(-1, 1)
        file.write(bytes([byte ^ 1]))


short = dict(end="0.12", dt="8e-3", period="5", maximum="5")
case.run(program, "through", **short)
damages = {"fields cut short": ("fields.0.bin", truncate),
           "a wrong bit in the fields": ("fields.0.bin", flip),
           "a wrong bit in the state": ("state.bin", flip),
           "grid missing": ("grid.bin", os.remove),
           "manifest cut short": ("manifest.txt", truncate),
           "a wrong bit in the manifest": ("manifest.txt", flip)}
for name, (file, damage) in damages.items():
    shutil.rmtree("damaged", ignore_errors=True)
    shutil.copytree("through", "damaged")
    damage(os.path.join(case.checkpoints("damaged")[-1], file))
    text = case.run(program, "damaged", **short)
    check(name + ": recognised", "00000015 cannot be used" in text and file in text
          and "resumed from damaged/checkpoints/00000010" in text)
    found = case.differences("through", "damaged")
    check(name + ": the same in the end", not found, found)

for checkpoint in case.checkpoints("damaged"):
    truncate(checkpoint + "/fields.0.bin")
before = case.frames("damaged"), case.statistics("damaged")
text = case.run(program, "damaged", status=1, **short)
check("all damaged: error", "No checkpoint can be used" in text and "--resume=never" in text)
check("all damaged: nothing changed",
      before == (case.frames("damaged"), case.statistics("damaged")))
text = case.run(program, "damaged", status=1, options=["--resume=nowhere"], **short)
check("no checkpoint there: error", "there is no checkpoint in nowhere" in text)

# Parameters.
text = case.run(program, "through", status=1, **dict(short, stiffness="3"))
check("changed parameter: error", "Structure / Part block / Constraint hold / Stiffness: was "
      '"1", is now "3"' in text and text.count(", is now ") == 1)
with open("block.msh", "a") as file:
    file.write("\n")
text = case.run(program, "through", status=1, **short)
check("changed mesh: error", "Mesh file: was" in text)
case.write_meshes()
case.run(program, "through", **dict(short, dt="0.008", end="0.16", fields="0.04", kept="2",
                                    statistics="1"))
check("parameters that may change", len(case.checkpoints("through")) == 2
      and case.statistics("through")[-1][0] == "0.16", case.checkpoints("through"))

# A checkpoint of a program that did not know a parameter: taken if it has its default now.
def forget(checkpoint, start):
    """Removes the line that begins with START from the list of parameters."""
    with open(checkpoint + "/parameters.txt") as file:
        lines = file.readlines()
    kept = [line for line in lines if not line.startswith(start)]
    assert len(kept) == len(lines) - 1, start
    data = "".join(kept).encode()
    with open(checkpoint + "/parameters.txt", "wb") as file:
        file.write(data)
    with open(checkpoint + "/manifest.txt") as file:
        lines = file.readlines()[:-1]
    text = "".join("file parameters.txt %d %08x\n" % (len(data), zlib.crc32(data))
                   if line.startswith("file parameters.txt") else line for line in lines)
    with open(checkpoint + "/manifest.txt", "w") as file:
        file.write(text + "checksum %08x\n" % zlib.crc32(text.encode()))


for name, line, good in (("at its default", "Fluid / Density = ", True),
                         ("not at its default", "Fluid / Viscosity = ", False)):
    shutil.rmtree("older", ignore_errors=True)
    shutil.copytree("through", "older")
    forget(case.checkpoints("older")[-1], line)
    text = case.run(program, "older", status=0 if good else 1,
                    **dict(short, end="0.176", fields="0"))
    words = "resumed from " if good else line.split(" =")[0] + ': was no parameter, is now "'
    check("older checkpoint, new parameter " + name, words in text,
          words if words in text else text[-600:])

# --resume has precedence over the parameter.
text = case.run(program, "through", options=["--resume"], resume="never",
                **dict(short, end="0.168", fields="0.04", kept="2", statistics="1"))
check("--resume: goes on", "resumed from through/checkpoints/" in text)

# Resume = never
kept = sorted(os.listdir("through/checkpoints"))
text = case.run(program, "through", options=["--resume=never"], **short)
check("never: set aside", sorted(os.listdir("through/checkpoints.1")) == kept
      and "through/checkpoints.1" in text and "resumed" not in text)
text = case.run(program, "branch", resume="through/checkpoints/00000010", **short)
check("from another folder", "resumed from through/checkpoints/00000010" in text
      and case.statistics("branch")[1:] == case.statistics("through")[5:],
      case.statistics("branch")[1][0])

# Full disks: no file may become as large as the fields of a checkpoint or of a frame are.
sizes = {}
for path, _, files in os.walk("through"):
    for file in files:
        sizes[os.path.join(path, file)] = os.path.getsize(os.path.join(path, file))
fields_size = sizes["through/checkpoints/00000010/fields.0.bin"]
for name, limit, words, changes in (
        ("checkpoint", fields_size - 4096, "00000020.tmp/fields.0.bin: File too large",
         dict(fields="0")),
        ("frame", 8192, "output/fluid_00007.0.vtu: File too large", {})):
    shutil.rmtree("full", ignore_errors=True)
    shutil.copytree("through", "full")
    before, lines = case.frames("full"), case.statistics("full")
    last = case.checkpoints("full")[-1]
    fields = case.fields(last)
    text = case.run(program, "full", status=1, largest_file=limit,
                    **dict(short, end="0.2", **changes))
    check("full disk, %s: message" % name, words in text and "newest checkpoint is " + last in text,
          text[-600:] if words not in text else words)
    after = case.frames("full")
    check("full disk, %s: earlier files" % name,
          all(after[file] == data for file, data in before.items() if file.endswith(".vtu"))
          and case.statistics("full")[:len(lines)] == lines and case.fields(last) == fields)
    check("full disk, %s: no remains" % name, not [
        file for path, folders, files in os.walk("full") for file in folders + files
        if file.endswith(".tmp")])
    text = case.run(program, "full", **dict(short, end="0.2", **changes))
    check("full disk, %s: goes on with room" % name, "resumed from " + last in text)

# A step that fails.
failed = case.run(program, "fails", status=1, **dict(short, stiffness="3e6", period="0"))
words = "The state before this step, at t = "
check("failed step: saved", words in failed and len(case.checkpoints("fails")) == 1,
      [line for line in failed.splitlines() if words in line])
check("failed step: nothing older to go on from", "--resume=" not in failed)
text = case.run(program, "kept", status=1, **dict(short, end="0.24", period="25", kept="1"))
kept = case.checkpoints("kept")
check("failed step: the checkpoint before it stays", len(kept) == 2
      and kept[0].endswith("00000025") and "is in " + kept[1] in text
      and "use --resume=" + kept[0] + "." in text, kept)
again = case.run(program, "fails", status=1, **dict(short, stiffness="3e6", period="0"))
check("failed step: the same error again", "resumed from fails/" in again
      and failed.split("mitre: ")[1].split(".\n")[0] == again.split("mitre: ")[1].split(".\n")[0])
if failures:
    sys.exit("FAILED: " + ", ".join(failures))
