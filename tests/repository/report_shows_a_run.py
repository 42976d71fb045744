#!/usr/bin/python3
"""Check scripts/report on a made-up run of two frames, and on folders that are not runs.

The flow is 300 sin(pi t / 0.2) mL/s until 0.2 s and 3 mL/s to and fro after it, so that the
peak is 300 mL/s at 0.1 s and the mean |flow| from 0.32 to 0.5 s is 3 mL/s, 1 % of the peak.
The pressure shuts the valve from 0.2 to 0.5 s, so that the middle of systole is 0.35 s. The
valve is a tetrahedron that is red when "open" and moves to the upper half of the tube when
"closed": the pictures must show something, and must differ. The shape that it is compared with is
the edge from (1, 1.5) to (2, 1.5) that it has when closed, 1 mm lower at one end.

usage: report_shows_a_run.py FOLDER_OF_THE_REPOSITORY
"""

import base64
import io
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import matplotlib.image

REPORT = pathlib.Path(sys.argv[1]) / "scripts" / "report"


def vtu(points, cells, kind, point_data):
    """The text of a .vtu file of cells that are all of one VTK type."""
    flat = [str(i) for cell in cells for i in cell]
    offsets = [str(len(cells[0]) * (i + 1)) for i in range(len(cells))]
    data = "".join(f'<DataArray type="Float64" Name="{name}" NumberOfComponents="3" '
                   f'format="ascii">{" ".join(str(v) for value in values for v in value)}'
                   "</DataArray>" for name, values in point_data.items())
    return f"""<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
{" ".join(str(x) for point in points for x in point)}</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">{" ".join(flat)}</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">{" ".join(offsets)}</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">{" ".join([str(kind)] * len(cells))}
</DataArray></Cells><PointData>{data}</PointData></Piece></UnstructuredGrid></VTKFile>"""


def pvd(name, times):
    items = "".join(f'<DataSet timestep="{t}" part="0" file="{name}_{i}.vtu"/>'
                    for i, t in enumerate(times))
    return ('<?xml version="1.0"?><VTKFile type="Collection" version="0.1"><Collection>'
            f"{items}</Collection></VTKFile>")


def make_run(folder):
    output = folder / "output"
    output.mkdir(parents=True)
    times = [0.1, 0.35]
    for i in range(2):
        corners = [(x, y, z) for z in (0, 2) for y in (0, 2) for x in (0, 4)]
        speed = [(10 * (1 - i) * y, 0, 0) for _, y, _ in corners]
        (output / f"fluid_{i}.vtu").write_text(
            vtu(corners, [(0, 1, 3, 2, 4, 5, 7, 6)], 12, {"velocity": speed}))
        tetrahedron = [(1, 0.5 + i, 0.5), (2, 0.5 + i, 0.5), (1, 1 + i, 0.5), (1, 0.5 + i, 1.5)]
        (output / f"leaflets_{i}.vtu").write_text(
            vtu(tetrahedron, [(0, 1, 2, 3)], 10, {"displacement": [(0, i, 0)] * 4}))
    (output / "fluid.pvd").write_text(pvd("fluid", times))
    (output / "leaflets.pvd").write_text(pvd("leaflets", times))
    lines = ["time [s],flow [mL/s],atrium [mmHg],ventricle [mmHg],"
             "forward volume [mL],displacement of leaflets [cm],"
             "wall time per step [s]"]
    for i in range(121):
        t = i * 0.005
        flow = 300 * math.sin(math.pi * t / 0.2) if t < 0.2 else 3 * (-1) ** i
        closing = 100 if 0.2 <= t < 0.5001 else 0
        lines.append(f"{t:.4f},{flow},8,{closing},{80 * t},{t * t},0.25")
    lines.append("0.605,3,8")  # a line that has not been finished
    (folder / "statistics.csv").write_text("\n".join(lines) + "\n")
    (folder / "parameters.prm").write_text("""set Output folder = a < b
subsection Structure
  subsection Part leaflets
    set Comparison shape = shapes/edge.csv # of the closed valve
    subsection Material a
      set Comparison shape = none
    end
  end
end
""")
    shapes = folder.parent / "shapes"
    shapes.mkdir()
    (shapes / "edge.csv").write_text("y [mm],s [cm],x [cm]\n15,0,1\n15,0.5,1.5\n14,1,2\n")


def report(*arguments):
    result = subprocess.run([sys.executable, REPORT, *map(str, arguments)],
                            capture_output=True, text=True)
    return result.returncode, result.stdout + result.stderr


failures = []


def expect(condition, what):
    print(("ok: " if condition else "FAILED: ") + what)
    if not condition:
        failures.append(what)


def expect_error(message, *arguments):
    status, output = report(*arguments)
    expect(status == 1 and message in output and "Traceback" not in output,
           f"error '{message}' (status {status}: {output.strip()})")


with tempfile.TemporaryDirectory() as folder:
    run = pathlib.Path(folder, "a_run")
    make_run(run)
    status, output = report(run)
    expect(status == 0, f"the report is written ({output.strip()})")
    for line in ("Peak forward flow: 300.0 mL/s at 0.1000 s",
                 "Mean |flow| in 0.32-0.5 s: 3.00 mL/s, 1.00 % of the peak",
                 "Forward volume at the end: 48.00 mL",
                 "Largest displacement of leaflets: 0.36 cm",
                 "Mean wall time of a step: 0.250 s",
                 "leaflets at 0.35 s, distance from edge.csv: 0.1 cm at most "
                 "(at y = 1.4, x = 2 cm), 0.058 cm in the mean"):
        expect(line in output, line)

    page = (run / "report" / "index.html").read_text()
    expect("set Output folder = a &lt; b" in page, "the parameter file is in the page")
    expect('alt="Shape of leaflets"' in page, "the comparison is drawn")
    expect("Open: peak forward flow (t = 0.1 s" in page, "the open valve")
    expect("Closed: mid-systole (t = 0.35 s" in page, "the closed valve")
    expect(not re.search(r'(src|href)="(?!data:)', page), "the page needs no other file")
    images = [matplotlib.image.imread(io.BytesIO(base64.b64decode(data)))
              for data in re.findall(r'data:image/png;base64,([^"]+)"', page)]
    # two moments with three views each, and two frames with two pictures each
    expect(len(images) == 10, f"10 pictures ({len(images)})")
    expect(all(image[..., :3].std() > 0.01 for image in images), "no picture is blank")
    for view in range(3):
        expect(abs(images[view] - images[3 + view]).mean() > 1e-3,
               f"view {view} differs between open and closed")

    edge = pathlib.Path(folder, "shapes", "edge.csv")
    edge.write_text("x [cm],z\n1,2\n")
    expect_error("edge.csv: expected two columns such as 'x [cm],y [cm]'", run)
    edge.write_text("x [cm],z [cm]\n1,2\n1\n")
    expect_error("edge.csv: a line does not have 2 numbers", run)
    edge.unlink()
    expect_error("The comparison shape shapes/edge.csv of", run)
    (run / "parameters.prm").unlink()
    (run / "output" / "leaflets_1.vtu").unlink()
    expect_error("leaflets_1.vtu, which a .pvd file names, is missing", run)
    status, output = report("--no-pictures", run)
    expect(status == 0, "a report without pictures")
    for path in (run / "output").iterdir():
        path.unlink()
    expect_error("There is no .pvd file in", run)
    (run / "statistics.csv").write_text("time [s],flow [mL/s]\n0,1\n0,one\n0,1\n")
    expect_error("line 3 does not have 2 numbers", run)
    (run / "statistics.csv").unlink()
    expect_error("statistics.csv: is this the folder of a run?", run)
    expect_error("There is no folder", run / "nowhere")

sys.exit(1 if failures else 0)
