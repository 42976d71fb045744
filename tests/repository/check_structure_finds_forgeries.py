#!/usr/bin/python3
"""Check that check_structure.py finds what it is to find.

Writes small trees, one of which is right while each of the others has one fault, and runs
the check on them.
"""

import pathlib
import subprocess
import sys
import tempfile

CHECK = pathlib.Path(__file__).with_name("check_structure.py")


def header(room, name, *includes):
    guard = f"mitre_{room}_{name}_h"
    text = f"#ifndef {guard}\n#define {guard}\n"
    return text + "".join(f"#include {include}\n" for include in includes) + "#endif\n"


RIGHT = {
    "include/mitre/base/units.h": header("base", "units", "<string>"),
    "include/mitre/structure/part.h": header("structure", "part", "<mitre/base/units.h>"),
    "include/mitre/fluid/stokes.h": header("fluid", "stokes", "<deal.II/base/point.h>"),
    "source/fluid/stokes.cc": "#include <mitre/fluid/stokes.h>\n",
}

# A fault, the files that make it, and words of the message.
FAULTS = {
    "fluid includes structure": (
        {"source/fluid/stokes.cc": "#include <mitre/structure/part.h>\n"},
        "source/fluid/stokes.cc:1: fluid must not include structure"),
    "structure includes fluid": (
        {"include/mitre/structure/part.h":
             header("structure", "part", "<mitre/fluid/stokes.h>")},
        "include/mitre/structure/part.h:3: structure must not include fluid"),
    "base includes a room": (
        {"source/base/units.cc": "#  include <mitre/fluid/stokes.h>\n"},
        "source/base/units.cc:1: base must not include fluid; it may include no other room"),
    "the program includes geometry": (
        {"source/main.cc": "#include <mitre/geometry/valve.h>\n",
         "include/mitre/geometry/valve.h": header("geometry", "valve")},
        "source/main.cc:1: main.cc must not include geometry"),
    "include in quotes": (
        {"source/fluid/stokes.cc": '#include "stokes.h"\n'},
        "must be included by its full path"),
    "missing header": (
        {"source/fluid/stokes.cc": "#include <mitre/fluid/stoke.h>\n"},
        "there is no header <mitre/fluid/stoke.h>"),
    "unknown room": (
        {"source/solids/part.cc": "\n"},
        "'solids' is not a room"),
    "wrong guard": (
        {"include/mitre/base/units.h": "#ifndef units_h\n#define units_h\n#endif\n"},
        "expected the include guard mitre_base_units_h"),
}


def run(files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        result = subprocess.run([sys.executable, CHECK, folder], capture_output=True, text=True)
        return result.returncode, result.stdout + result.stderr


def main():
    failures = []
    status, output = run(RIGHT)
    if status != 0:
        failures.append(f"the tree without a fault was rejected:\n{output}")
    for fault, (files, message) in FAULTS.items():
        status, output = run({**RIGHT, **files})
        if status == 0 or message not in output:
            failures.append(f"{fault}: expected '{message}', found status {status}:\n{output}")
        else:
            print(f"{fault}: found")
    print("\n".join(failures))
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
