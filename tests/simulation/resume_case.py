"""A small run for the tests of checkpoints, and what they compare: a soft block of 8 x 8
quadrilaterals in a channel, carried along by the flow, around which the grid is refined by two
levels and follows it, and a rigid bar that swings across the channel."""

import array
import csv
import glob
import math
import os
import re
import resource
import subprocess

PARAMETERS = """
set Dimension     = 2
set Output folder = %(folder)s
set Resume        = %(resume)s
subsection Time
  set End time  = %(end)s
  set Time step = %(dt)s
  set Courant number = %(courant)s
  set Maximum Courant number = %(maximum)s
end
subsection Checkpoints
  set Steps between checkpoints   = %(period)s
  set Minutes between checkpoints = %(minutes)s
  set Number kept                 = %(kept)s
  set Wall time limit             = %(limit)s
end
subsection Grid
  set Lower corner  = 0, 0
  set Upper corner  = 2, 1
  set Base patches  = 2, 1
  set Minimum level = 1
  set Maximum level = 3
  subsection Refinement
    set Check interval = 4
    set Structure buffer = 1
  end
end
subsection Fluid
  set Viscosity = 0.05
  set Initial velocity x = 4*y*(1-y)
  subsection Solver
    set Relative tolerance = %(tolerance)s
  end
end
subsection Boundary conditions
  set Conditions = inlet, outlet, plates
  subsection Condition inlet
    set Faces    = x min
    set Type     = pressure
    set Pressure = 20
  end
  subsection Condition outlet
    set Faces = x max
    set Type  = pressure
  end
  subsection Condition plates
    set Faces = y min, y max
    set Type  = wall
  end
end
subsection Structure
  set Parts = block, bar
  subsection Part block
    set Mesh file   = block.msh
    set Mass solver tolerance = %(mass_tolerance)s
    set Materials   = rubber
    set Constraints = hold
    subsection Material rubber
      set Material id = 1
      set Law         = neo-Hookean
      subsection neo-Hookean
        set C1 = 5
      end
    end
    subsection Constraint hold
      set Type      = tether
      set Stiffness = %(stiffness)s
    end
  end
  subsection Part bar
    set Mesh file   = bar.msh
    set Rigid       = true
    set Constraints = swing
    subsection Constraint swing
      set Type           = tether
      set Stiffness      = 1000
      set Damping        = 20
      set Displacement y = 0.01 * sin(30 * t)
    end
  end
end
subsection Instruments
  set Instruments = flow, energy, force, bar
  subsection Instrument flow
    set Type     = flow meter
    set Axis     = x
    set Position = 0.25
  end
  subsection Instrument energy
    set Type = energy
  end
  subsection Instrument force
    set Type = part force
    set Part = block
  end
  subsection Instrument bar
    set Type = part extent
    set Part = bar
    set Axis = y
  end
end
subsection Output
  set Time between fields      = %(fields)s
  set Steps between statistics = %(statistics)s
end
"""

STRAND = """  subsection Part strand
    set Kind = fibres
    set Vertex file = strand.vertex
    set Spring laws = straight, curled
    subsection Spring law straight
      set Type = linear
      set Compression = false
    end
    subsection Spring law curled
      set Type = exponential
      set Force function = 1
      set Exponent = 2
    end
    set Target displacement x = 0.1*t
    set Constraints = top
    subsection Constraint top
      set Type = tether
      set Acts on = points
      set Region = y > 0.72
      set Stiffness = 50
    end
  end
end
subsection Instruments
"""

DEFAULTS = dict(resume="auto", end="0.24", dt="4e-3", courant="0", maximum="1", period="10",
                kept="100", limit="0", tolerance="1e-6", mass_tolerance="1e-10",
                stiffness="1", fields="0.02", statistics="3", minutes="0")


def write_mesh(name="block", x=0.4, y=0.35, width=0.2, height=0.2, n=8):
    """A rectangle of n x n quadrilaterals."""
    with open(name + ".msh", "w") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % (n + 1) ** 2)
        for j in range(n + 1):
            for i in range(n + 1):
                file.write("%d %g %g 0\n" % (j * (n + 1) + i + 1, x + width * i / n,
                                             y + height * j / n))
        file.write("$EndNodes\n$Elements\n%d\n" % (n * n))
        for j in range(n):
            for i in range(n):
                a = j * (n + 1) + i + 1
                file.write("%d 3 2 1 1 %d %d %d %d\n"
                           % (j * n + i + 1, a, a + 1, a + n + 2, a + n + 1))
        file.write("$EndElements\n")


def write_meshes():
    write_mesh()
    write_mesh("bar", 0.75, 0.1, 0.06, 0.06, 4)


def add_strand():
    """A strand of springs, beams and moving target points, in the way of the block, from here on."""
    global PARAMETERS
    n = 40
    with open("strand.vertex", "w") as file:
        file.write("%d # nodes\n" % (n + 2))
        for i in range(n):
            file.write("%.17g %.17g\n" % (1.0 + 0.05 * math.sin(5 * i / n), 0.15 + 0.6 * i / n))
        file.write("1.3 0.3\n1.3 0.6\n")
    with open("strand.spring", "w") as file:
        file.write("%d\n" % (n - 1))
        for i in range(n - 1):
            file.write("%d %d 60 %.17g %d\n" % (i, i + 1, 0.015, i % 3 == 0))
    with open("strand.beam", "w") as file:
        file.write("%d\n" % (n - 2))
        for i in range(n - 2):
            file.write("%d %d %d 40 0.0001 0\n" % (i, i + 1, i + 2))
    with open("strand.target", "w") as file:
        file.write("4\n0 80 0.01\n1 80 0.01\n%d 20\n%d 20\n" % (n, n + 1))
    for old, new in (("set Parts = block", "set Parts = block, strand"),
                     ("end\nsubsection Instruments\n", STRAND),
                     ("Instruments = flow,", "Instruments = extent, flow,"),
                     ("  subsection Instrument flow", """  subsection Instrument extent
    set Type = part extent
    set Part = strand
    set Axis = x
  end
  subsection Instrument flow"""), ("Part = block", "Part = strand")):
        assert old in PARAMETERS, old
        PARAMETERS = PARAMETERS.replace(old, new)


def write_parameters(folder, **changes):
    with open(folder + ".prm", "w") as file:
        file.write(PARAMETERS % dict(DEFAULTS, folder=folder, **changes))


def command(program, folder, ranks=1, options=()):
    mpirun = ["mpirun", "-np", str(ranks), "--oversubscribe"] if ranks > 1 else []
    return mpirun + [program, folder + ".prm"] + list(options)


def run(program, folder, ranks=1, status=0, options=(), largest_file=None, **changes):
    """Runs in FOLDER with changed parameters; returns what has been printed. LARGEST_FILE is the
    size [bytes] beyond which no file can grow once MPI, which needs larger ones, has started."""
    write_parameters(folder, **changes)
    process = subprocess.Popen(command(program, folder, ranks, options), text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    text = ""
    if largest_file is not None:
        text = process.stdout.readline()
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (largest_file, largest_file))
    text += process.communicate(timeout=280)[0]
    if process.returncode != status:
        raise SystemExit("%s on %d rank(s): exit status %d instead of %d\n%s"
                         % (folder, ranks, process.returncode, status, text[-3000:]))
    return text


def statistics(folder):
    """The lines of statistics.csv without the wall time."""
    with open(os.path.join(folder, "statistics.csv")) as file:
        table = list(csv.reader(file))
    wall = [c for c, name in enumerate(table[0]) if "wall time" in name]
    return [[x for c, x in enumerate(line) if c not in wall] for line in table]


def changes_of_the_grid(folder, period):
    """After which steps the number of cells has changed, as far as a line each PERIOD steps tells."""
    numbers = [line[2] for line in statistics(folder)[1:]]
    return [period * i for i in range(1, len(numbers)) if numbers[i] != numbers[i - 1]]


def checkpoints(folder):
    return sorted(glob.glob(os.path.join(folder, "checkpoints", "[0-9]" * 8)))


def fields(checkpoint):
    """Sizes and checksums of the fields and of the grid of a checkpoint."""
    with open(os.path.join(checkpoint, "manifest.txt")) as file:
        return [line for line in file if re.match(r"file (fields\.|grid)|step|time|patches", line)]


def state(checkpoint):
    """The arrays of a checkpoint's state.bin, but for wall times, by name; bytes."""
    with open(os.path.join(checkpoint, "state.bin"), "rb") as file:
        data = file.read()
    result, at = {}, 0
    while at < len(data):
        end = data.index(b"\n", at)
        kind, size, name = data[at:end].decode().split(" ", 2)
        size = int(size) * (8 if kind == "numbers" else 1)
        if "wall time" not in name:
            result[name] = data[end + 1:end + 1 + size]
        at = end + 1 + size + 1
    return result


def velocities_and_pressures(folder):
    """The fields of the last checkpoint of a run that has ended on one rank."""
    checkpoint = checkpoints(folder)[-1]
    values = array.array("d")
    with open(os.path.join(checkpoint, "fields.0.bin"), "rb") as file:
        values.frombytes(file.read())
    with open(os.path.join(checkpoint, "manifest.txt")) as file:
        n_patches = [int(line.split()[1]) for line in file
                     if line.startswith("patches_of_rank")][0]
    faces, cells = 2 * 9 * 8 * n_patches, 64 * n_patches
    assert len(values) == 3 * faces + 2 * cells
    result = {}
    for name, size in (("velocity", faces), ("old velocity", faces), ("advection", faces),
                       ("pressure", cells), ("old pressure", cells)):
        result[name], values = values[:size], values[size:]
    return result


def frames(folder):
    """The collections and the frames that they list, by file."""
    result = {}
    for path in glob.glob(os.path.join(folder, "output", "*")):
        with open(path, "rb") as file:
            # Collections say in a comment when they were written.
            result[os.path.basename(path)] = re.sub(b"<!--.*?-->", b"", file.read(), flags=re.S)
    return result


def differences(a, b):
    """In what two runs differ: a list of words."""
    result = []
    if statistics(a) != statistics(b):
        result.append("statistics")
    if frames(a) != frames(b):
        result.append("frames %s" % sorted(set(frames(a).items()) ^ set(frames(b).items()))[0][0])
    last_a, last_b = checkpoints(a)[-1], checkpoints(b)[-1]
    if fields(last_a) != fields(last_b):
        result.append("fields")
    state_a, state_b = state(last_a), state(last_b)
    result += sorted(name for name in set(state_a) | set(state_b)
                     if state_a.get(name) != state_b.get(name))
    return result
