#!/usr/bin/python3
"""Check that the source tree keeps its structure.

usage: check_structure.py FOLDER

FOLDER is the top of the repository. Checked are

* the arrows between rooms: a file of include/mitre/ROOM or source/ROOM includes headers of
  its own room and of the rooms that ALLOWED names with it, and no others;
* that every header of Mitre's that is included exists, is included as <mitre/ROOM/x.h>, and
  lies in a room that ALLOWED knows;
* that headers have include guards that are named after their path;
* that there is nothing in the top folder of the repository but what TOP_LEVEL lists.

Prints each violation as FILE:LINE: what is wrong, and exits with status 1 if there is any.
"""

import pathlib
import re
import subprocess
import sys

# The rooms that a room may include besides itself.
ALLOWED = {
    "base": [],
    "grid": ["base"],
    "fluid": ["base", "grid"],
    "structure": ["base"],
    "coupling": ["base", "grid", "structure"],
    "instruments": ["base", "grid", "fluid", "structure", "coupling"],
    "io": ["base", "grid", "structure"],
    "geometry": ["base", "io"],
    "biaxial": ["base", "structure"],
    "simulation": ["base", "grid", "fluid", "structure", "coupling", "instruments", "io"],
}

# The programs, which lie in source/ itself.
PROGRAMS = {
    "main.cc": ["base", "simulation"],
    "prepare_geometry.cc": ["base", "io", "geometry"],
    "biaxial.cc": ["base", "biaxial"],
    "allocator.cc": [],  # a part of programs, see there
}

TOP_LEVEL = ["CMakeLists.txt", "LICENSE", "README.md", "doc", "include", "meshes",
             "parameter_files", "scripts", "source", "tests"]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def check_file(root, path, room, allowed):
    violations = []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        place = f"{path.relative_to(root)}:{number}: "
        quote, header = match.groups()
        if quote == '"':
            violations.append(f'{place}"{header}" must be included by its full path, '
                              "<mitre/ROOM/x.h>")
            continue
        if not header.startswith("mitre/"):
            continue
        if not (root / "include" / header).is_file():
            violations.append(f"{place}there is no header <{header}>")
        other = header.split("/")[1]
        if other != room and other not in allowed:
            violations.append(f"{place}{room} must not include {other}; it may include "
                              + (", ".join(allowed) or "no other room"))
    return violations


def check_guard(root, path):
    header = path.relative_to(root / "include").as_posix()
    guard = re.sub(r"[^A-Za-z0-9]", "_", header)
    lines = [line for line in path.read_text().splitlines() if line.startswith("#")]
    if lines[:2] != [f"#ifndef {guard}", f"#define {guard}"]:
        return [f"{path.relative_to(root)}:1: expected the include guard {guard}"]
    return []


def check_rooms(root):
    violations = []
    for parent in (root / "include" / "mitre", root / "source"):
        for path in sorted(parent.rglob("*")):
            if path.is_dir():
                continue
            parts = path.relative_to(parent).parts
            name = path.relative_to(root)
            if path.suffix != (".cc" if parent.name == "source" else ".h"):
                violations.append(f"{name}: only {'.cc' if parent.name == 'source' else '.h'} "
                                  "files belong here")
            elif len(parts) == 1:
                if parent.name == "source" and parts[0] in PROGRAMS:
                    violations += check_file(root, path, parts[0], PROGRAMS[parts[0]])
                else:
                    violations.append(f"{name}: files belong in the folder of a room")
            elif parts[0] not in ALLOWED:
                violations.append(f"{name}: '{parts[0]}' is not a room; rooms are "
                                  + ", ".join(ALLOWED))
            else:
                violations += check_file(root, path, parts[0], ALLOWED[parts[0]])
                if path.suffix == ".h":
                    violations += check_guard(root, path)
    return violations


def check_top_level(root):
    if not (root / ".git").exists():
        return []
    files = subprocess.run(["git", "-c", f"safe.directory={root}", "-C", str(root),
                            "ls-files"], capture_output=True, text=True, check=True).stdout
    names = {name.split("/")[0] for name in files.splitlines()}
    return [f"{name}: does not belong in the top folder"
            for name in sorted(names)
            if not name.startswith(".") and name not in TOP_LEVEL]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1]).resolve()
    if not (root / "include" / "mitre").is_dir():
        sys.exit(f"{root} has no folder include/mitre.")
    violations = check_rooms(root) + check_top_level(root)
    print("\n".join(violations) or "The rooms include only what they may.")
    sys.exit(1 if violations else 0)


if __name__ == "__main__":
    main()
