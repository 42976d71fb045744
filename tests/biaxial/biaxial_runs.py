"""What the tests of mitre-biaxial share: running it on a text, reading its tables, judging.

usage of the tests: NAME.py MITRE_BIAXIAL FOLDER_TO_WORK_IN FOLDER_OF_THE_REPOSITORY
"""

import csv
import pathlib
import shutil
import subprocess
import sys

PROGRAM, WORK, ROOT = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
failures = []


def start():
    shutil.rmtree(WORK, ignore_errors=True)
    WORK.mkdir(parents=True)


def run(text, **files):
    """Exit status and output of the program for a parameter file and tables (NAME=text)."""
    for name, content in files.items():
        (WORK / f"{name}.csv").write_text(content)
    (WORK / "a.prm").write_text(text)
    result = subprocess.run([PROGRAM, "a.prm"], cwd=WORK, capture_output=True, text=True)
    return result.returncode, result.stdout + result.stderr


def table(name):
    """The columns of a table by their headings."""
    with open(WORK / "out" / f"{name}.csv", newline="") as file:
        lines = list(csv.reader(file))
    return {heading: [float(line[i]) for line in lines[1:]]
            for i, heading in enumerate(lines[0])}


def expect(condition, what):
    print(("ok: " if condition else "FAILED: ") + what)
    if not condition:
        failures.append(what)


def expect_close(values, expected, tolerance, what):
    """Largest difference relative to the largest expected value (or 1)."""
    scale = max(1, *(abs(e) for e in expected))
    error = max(abs(v - e) for v, e in zip(values, expected)) / scale
    expect(len(values) == len(expected) and error < tolerance, f"{what} ({error:.2g})")


def finish():
    sys.exit(1 if failures else 0)
