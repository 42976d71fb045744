#!/usr/bin/python3
"""Mistakes in what a run is given must end it with exit status other than 0 and a message
that names the thing, what is seldom meant must be warned of, and the output of an earlier run
must stay as it is. doc/messages.md is the list of these cases.

usage: wrong_input_stops_with_a_message.py MITRE WORK_FOLDER DOC_FILE
       wrong_input_stops_with_a_message.py --write DOC_FILE
"""

import hashlib
import os
import re
import shutil
import subprocess
import sys

# Six tetrahedra that fill the cube [0.4, 0.6]^3, material id 1.
corners = [(x, y, z) for z in (0.4, 0.6) for y in (0.4, 0.6) for x in (0.4, 0.6)]
tetrahedra = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]


def mesh(points=corners, elements=tetrahedra, material=1, types=None):
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(points))]
    lines += ["%d %s %s %s" % ((i + 1,) + tuple(point)) for i, point in enumerate(points)]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    for i, element in enumerate(elements):
        kind = types[i] if types else {3: 2, 4: 4, 8: 5, 10: 11}[len(element)]
        nodes = " ".join(str(a + 1) for a in element)
        lines.append("%d %d 2 %d 1 %s" % (i + 1, kind, material, nodes))
    return "\n".join(lines + ["$EndElements", ""])


def scaled(factor, shift=0.0):
    return [tuple(factor * x + shift for x in point) for point in corners]


def box_mesh(lower, upper):
    points = [tuple(lower[d] + (x[d] - 0.4) / 0.2 * (upper[d] - lower[d]) for d in range(3))
              for x in corners]
    return mesh(points)


# corners, and the middles of the edges in gmsh's order
quadratic_tetrahedron = [(0.4, 0.4, 0.4), (0.6, 0.4, 0.4), (0.4, 0.6, 0.4), (0.4, 0.4, 0.6),
                         (0.5, 0.4, 0.4), (0.5, 0.5, 0.4), (0.4, 0.5, 0.4), (0.4, 0.4, 0.5),
                         (0.4, 0.5, 0.5), (0.5, 0.4, 0.5)]

base = """set Dimension     = 3
set Output folder = run
subsection Time
  set End time  = 0.01
  set Time step = 1e-3
end
subsection Grid
  set Minimum level = 1
  set Maximum level = 1
end
subsection Fluid
  set Initial velocity x = 0
end
subsection Boundary conditions
  set Conditions = end, sides
  subsection Condition end
    set Faces    = x min
    set Type     = pressure
    set Pressure = 0
  end
  subsection Condition sides
    set Faces = all
    set Type  = wall
  end
end
subsection Structure
  set Parts = cube
  subsection Part cube
    set Mesh file   = cube.msh
    set Materials   = rubber
    set Constraints = hold
    subsection Material rubber
      set Material id = 1
      set Law         = neo-Hookean
      subsection neo-Hookean
        set C1 = 10
      end
    end
    subsection Constraint hold
      set Type      = tether
      set Stiffness = 100
    end
  end
end
subsection Instruments
  set Instruments = flow
  subsection Instrument flow
    set Type     = flow meter
    set Axis     = x
    set Position = 0.5
    set Centre   = 0.5, 0.5
    set Radius   = 0.3
  end
end
subsection Output
  set Time between fields      = 0.002
  set Steps between statistics = 1
end
"""

table = "time [s],atrium [mmHg]\n0,5\n0.005,10\n0.01,5\n"
use_table = ("    set Pressure = 0\n",
             "    set Table file   = table.csv\n    set Table column = atrium\n")

def strand(text="", **files):
    """A second part of fibres; the files of a whole one but for those that are given."""
    texts = dict(vertex="3\n0.3 0.3 0.3\n0.3 0.33 0.3\n0.3 0.36 0.3\n",
                 spring="2\n0 1 10 0.03\n1 2 10 0.03\n", beam=None, target=None)
    texts.update(files)
    part = "    set Kind = fibres\n    set Vertex file = strand.vertex\n" + text
    return dict(change=[("Parts = cube\n",
                         "Parts = cube, strand\n  subsection Part strand\n%s  end\n" % part)],
                files={"strand." + ending: content for ending, content in texts.items()})


class Link(str):
    """In the place of a file's text: a symbolic link to this."""


def loaded(text):
    """A load on the cube."""
    return dict(change=[("set Constraints = hold\n", "set Constraints = hold\n    set Loads = push\n"
                         "    subsection Load push\n%s    end\n" % text)],
                files={"table.csv": table})


def measured(text):
    """An instrument in the place of the flow meter."""
    start = base.index("    set Type     = flow meter")
    return dict(change=[(base[start:base.index("  end\n", start)], text)])


# Where it is, the mistake, changes (pairs of texts), files, what the message must contain, in
# this order. "arguments" replaces what the program is called with.
errors = [
    ("Command line", [
        ("an unknown option", dict(arguments=["--validat", "run.prm"]),
         ['Argument "--validat" is not understood', "usage: mitre"]),
        ("no parameter file", dict(arguments=[]), ["No parameter file is given", "usage: mitre"]),
        ("a parameter file that is not there", dict(arguments=["nothing.prm"]),
         ["There is no parameter file 'nothing.prm'"]),
        ("a folder in the place of a parameter file", dict(arguments=["."]),
         ["There is no parameter file '.'"]),
        ("a run to go on from that is not there", dict(arguments=["--resume=nowhere", "run.prm"]),
         ["Resume: there is no checkpoint in nowhere", "expected were \"auto\", \"never\""]),
    ]),
    ("Parameter file", [
        ("a line that is no statement", dict(change=[("set Dimension", "sett Dimension")]),
         ["run.prm:1:", "expected 'set', 'subsection', 'end' or 'include'", "sett Dimension"]),
        ("a parameter without =", dict(change=[("End time  = 0.01", "End time 0.01")]),
         ["run.prm:4:", "expected 'set NAME = VALUE'", "End time 0.01"]),
        ("a subsection without `end`", dict(change=[("  set Time step = 1e-3\nend\n", "")]),
         ["run.prm:3:", "subsection 'Time'", "has no 'end'"]),
        ("an `end` too many", dict(change=[("1e-3\nend\n", "1e-3\nend\nend\n")]),
         ["run.prm:7:", "does not end a subsection"]),
        ("an included file that is not there", dict(change=[("set Dim", "include no.prm\nset Dim")]),
         ["run.prm:1:", "no.prm"]),
        ("a file that includes itself", dict(change=[("set Dim", "include run.prm\nset Dim")]),
         ["more than 20 files include one another"]),
        ("a misspelt parameter", dict(change=[("set Time step", "set Time stepp")]),
         ["run.prm:5:", "there is no parameter 'Time stepp' in the subsection Time",
          "Did you mean 'Time step'?"]),
        ("a misspelt subsection", dict(change=[("subsection Fluid", "subsection Fluids")]),
         ["there is no subsection 'Fluids'", "Did you mean 'Fluid'?"]),
        ("no number where one is wanted", dict(change=[("= 1e-3", "= 1e-3s")]),
         ["run.prm:5:", "'Time step'", "has the value '1e-3s', but must match"]),
        ("a number out of range", dict(change=[("= 1e-3", "= -1e-3")]),
         ["run.prm:5:", "'Time step'", "has the value '-1e-3', but must match"]),
        ("a misspelt choice", dict(change=[("= neo-Hookean", "= neo-Hokean")]),
         ["'Law'", "neo-Hokean", "Did you mean 'neo-Hookean'?"]),
        ("a misspelt kernel", dict(change=[("set Materials", "set Kernel = IB4\n    set Materials")]),
         ["'Kernel'", "'IB4'", "Did you mean 'IB_4'?"]),
        ("a part named twice", dict(change=[("Parts = cube", "Parts = cube, cube")]),
         ["Parts = cube, cube", "names 'cube' twice"]),
        ("a part without a subsection", dict(change=[("Parts = cube", "Parts = cube, ball")]),
         ["Part ball", "\"Mesh file\""]),
        ("a Courant number above the largest allowed one",
         dict(change=[("= 1e-3", "= 1e-3\n  set Courant number = 2")]),
         ["\"Time / Courant number\" is 2", "\"Maximum Courant number\" of 1"]),
        ("an expression that cannot be read",
         dict(change=[("velocity x = 0", "velocity x = sin(y")]),
         ["Fluid / Initial velocity x", "sin(y"]),
        ("an unknown variable in an expression",
         dict(change=[("velocity x = 0", "velocity x = 2*w")]),
         ["Fluid / Initial velocity x", "2*w", "The variables are x,y,z,t"]),
        ("an expression without a finite value",
         dict(change=[("velocity x = 0", "velocity x = 1/0")]),
         ["Fluid / Initial velocity x", "1/0", "not a finite number"]),
        ("a box whose corners are exchanged",
         dict(change=[("  set Minimum level", "  set Upper corner = 1, -1, 1\n  set Minimum level")]),
         ["\"Grid / Upper corner\" is -1", "must be larger than \"Lower corner\""]),
        ("two numbers for three directions",
         dict(change=[("  set Minimum level", "  set Base patches = 1, 1\n  set Minimum level")]),
         ["'Base patches'", "'1, 1'", "must match"]),
        ("a patch of 12 cells",
         dict(change=[("  set Minimum level", "  set Cells per patch side = 12\n  set Minimum level")]),
         ["\"Grid / Cells per patch side\" is 12", "power of two"]),
        ("a smallest level above the largest",
         dict(change=[("Minimum level = 1", "Minimum level = 2")]),
         ["\"Grid / Minimum level\" is 2, larger than \"Maximum level\", which is 1"]),
        ("a refinement box whose corners are exchanged",
         dict(change=[("  set Minimum level", """  subsection Refinement
    set Refinement boxes = jet
    subsection Box jet
      set Lower corner = 0, 0.5, 0
      set Upper corner = 1, 0.2, 1
    end
  end
  set Minimum level""")]),
         ["Grid / Refinement / Box jet", "\"Upper corner\" is 1, 0.2, 1"]),
        ("a part on a level that the grid does not have",
         dict(change=[("set Materials", "set Grid level = 3\n    set Materials")]),
         ["Part cube: \"Grid level\" is 3", "\"Grid / Maximum level\" is only 1"]),
    ]),
    ("Boundary conditions and tables", [
        ("a face without a condition", dict(change=[("Faces = all", "Faces = x max, y min, y max")]),
         ["No boundary condition is given on face \"z min\" at"]),
        ("a face that two dimensions do not have",
         dict(change=[("Dimension     = 3", "Dimension     = 2"), ("Faces = all", "Faces = z min"),
                      ("Centre   = 0.5, 0.5", "Centre   = 0.5"), ("Parts = cube", "Parts ="),
                      (base[base.index("  subsection Part cube"):base.index("subsection Instr")],
                       "end\n")]),
         ["Boundary condition \"sides\" names the face \"z min\"", "2 dimensions"]),
        ("a table that is not there", dict(change=[use_table]),
         ["'Table file'", "table.csv"]),
        ("a table column that is not there",
         dict(change=[use_table, ("= atrium", "= atrum")], files={"table.csv": table}),
         ["table.csv: there is no column 'atrum'", "Did you mean 'atrium'?"]),
        ("a table without a column",
         dict(change=[use_table, ("    set Table column = atrium\n", "")],
              files={"table.csv": table}),
         ["Boundary condition \"end\" names a \"Table file\", but no \"Table column\""]),
        ("a table without headings",
         dict(change=[use_table], files={"table.csv": table[table.index("\n") + 1:]}),
         ["table.csv:1:", "the column heading '0' is not a name and a unit"]),
        ("an unknown unit",
         dict(change=[use_table], files={"table.csv": table.replace("mmHg", "cmHg")}),
         ["table.csv:1:", "cmHg", "mmHg"]),
        ("a length where a pressure is needed",
         dict(change=[use_table], files={"table.csv": table.replace("mmHg", "cm")}),
         ["table.csv:1: the column 'atrium [cm]' is needed as a pressure", "[mmHg]"]),
        ("split forces with nodal coupling",
         dict(change=[("set Constraints = hold\n", "set Constraints = hold\n"
                       "    set Split forces = true\n    set Coupling = nodal\n")]),
         ["Part cube: \"Split forces\" is true, for which \"Coupling\" must be 'elemental'"]),
        ("an inclined disc without a radius",
         dict(change=[("    set Centre   = 0.5, 0.5\n", "    set Centre   = 0.5, 0.5, 0.5\n"
                       "    set Normal   = 1, 1, 0\n"), ("    set Radius   = 0.3\n", "")]),
         ["Radius is 0; a disc with a \"Normal\" needs one"]),
        ("an inclined disc beyond the box",
         dict(change=[("    set Centre   = 0.5, 0.5\n", "    set Centre   = 0.5, 0.5, 0.9\n"
                       "    set Normal   = 1, 1, 0\n")]),
         ["reaches beyond the fluid's box"]),
        ("a time that does not increase",
         dict(change=[use_table], files={"table.csv": table.replace("0.01,", "0.004,")}),
         ["table.csv:4:", "the time 0.004 is not later than the one before it"]),
        ("a line of a table with a column too many",
         dict(change=[use_table], files={"table.csv": table.replace("0.005,10", "0.005,10,3")}),
         ["table.csv:3:", "found 3 columns, but the first line names 2"]),
        ("a word among the numbers of a table",
         dict(change=[use_table], files={"table.csv": table.replace("0.005,10", "0.005,ten")}),
         ["table.csv:3:", "column 2", "expected a number, found 'ten'"]),
        ("a table of one line",
         dict(change=[use_table], files={"table.csv": "time [s],atrium [mmHg]\n0,5\n"}),
         ["table.csv", "at least two lines of numbers; found 1"]),
        ("a table to be repeated whose ends differ",
         dict(change=[use_table], files={"table.csv": table.replace("0.01,5", "0.01,7")}),
         ["table.csv", "'atrium'", "its first and its last value differ"]),
    ]),
    ("Meshes and materials", [
        ("a mesh that cannot be read", dict(files={"cube.msh": Link("nowhere")}),
         ["'Mesh file' in the subsection Structure / Part cube", "cube.msh"]),
        ("a folder in the place of a mesh", dict(change=[("cube.msh", "/")]),
         ["'Mesh file' in the subsection Structure / Part cube"]),
        ("a mesh that is not there", dict(change=[("cube.msh", "nothing.msh")]),
         ["'Mesh file' in the subsection Structure / Part cube", "nothing.msh"]),
        ("a mesh that is no mesh", dict(files={"cube.msh": "solid cube\nfacet normal 0 0 1\n"}),
         ["Mesh file", "cube.msh, line 1: expected the start of a section such as $Nodes",
          "'solid'"]),
        ("an empty mesh", dict(files={"cube.msh": ""}),
         ["cube.msh: expected elements of dimension 3, found none"]),
        ("a binary mesh", dict(files={"cube.msh": mesh().replace("2.2 0 8", "2.2 1 8")}),
         ["cube.msh, line 2: the file is binary; save it as ASCII"]),
        ("a mesh of an old format", dict(files={"cube.msh": mesh().replace("2.2 0 8", "1.0 0 8")}),
         ["cube.msh, line 2: format version 1", "is not supported; save the mesh as 2.2 or 4.1"]),
        ("a mesh that was cut off", dict(files={"cube.msh": mesh()[:-40]}),
         ["cube.msh, line 2", "expected a"]),
        ("a node that an element has and the mesh has not",
         dict(files={"cube.msh": mesh(elements=tetrahedra[:5] + [(0, 5, 1, 8)])}),
         ["cube.msh, line 22: element 6 has the node 9, which the file does not have"]),
        ("two nodes with one number",
         dict(files={"cube.msh": mesh().replace("\n2 0.6 0.4", "\n1 0.6 0.4")}),
         ["cube.msh, line 7: the node number 1 occurs twice"]),
        ("a coordinate that is not a number",
         dict(files={"cube.msh": mesh(points=corners[:7] + [(0.6, "nan", 0.6)])}),
         ["cube.msh, line 13: expected a coordinate, found 'nan'"]),
        ("a huge number of nodes",
         dict(files={"cube.msh": mesh().replace("$Nodes\n8", "$Nodes\n8000000000")}),
         ["cube.msh, line 14: expected a node number"]),
        ("a surface mesh",
         dict(files={"cube.msh": mesh(elements=[(0, 1, 3), (0, 3, 2)])}),
         ["cube.msh: expected elements of dimension 3, found 2 of dimension 2"]),
        ("nodal coupling of tetrahedra of second order",
         dict(change=[("    set Mesh file   = cube.msh\n",
                       "    set Mesh file   = cube.msh\n    set Coupling    = nodal\n")],
              files={"cube.msh": mesh(quadratic_tetrahedron, [tuple(range(10))])}),
         ["Part cube: \"Mass matrix\" is 'lumped', as nodal coupling has it, but the elements of "
          "cube.msh are quadratic", "the row sums are negative",
          "expected 'consistent' and elemental coupling, or linear elements"]),
        ("two shapes of elements",
         dict(files={"cube.msh": mesh(elements=tetrahedra + [(0, 1, 3, 2, 4, 5, 7, 6)])}),
         ["cube.msh: element 7 is a hexahedron, element 1 a tetrahedron",
          "must have one shape"]),
        ("an inverted element",
         dict(files={"cube.msh": mesh(elements=tetrahedra[:2] + [(0, 6, 2, 7)] + tetrahedra[3:])}),
         ["element 3 of", "cube.msh is inverted or flat: centroid", "volume -"]),
        ("a flat element", dict(files={"cube.msh": mesh(elements=tetrahedra + [(0, 1, 2, 3)])}),
         ["element 7 of", "cube.msh is inverted or flat"]),
        ("an id without a material", dict(files={"cube.msh": mesh(material=7)}),
         ["Part cube", "rubber", "has the id 1", "Its ids: 7"]),
        ("elements without a material",
         dict(files={"cube.msh": mesh().replace("\n6 4 2 1", "\n6 4 2 7")}),
         ["Part cube: no material has the id 7 of the element 6"]),
        ("a material without elements", dict(change=[("Material id = 1", "Material id = 1, 3")]),
         ["Part cube: the material 'rubber' has the id 3", "no element with it. Its ids: 1"]),
        ("an id of two materials",
         dict(change=[("= rubber\n", "= rubber, foam\n"),
                      ("    subsection Constraint", "    subsection Material foam\n"
                       "      set Material id = 1\n    end\n    subsection Constraint")]),
         ["Part cube: the material id 1 belongs to two materials, 'rubber' and 'foam'"]),
        ("a law with fibres on a mesh without",
         dict(change=[("= neo-Hookean\n", "= Holzapfel-Ogden\n"),
                      ("      subsection neo-Hookean\n        set C1 = 10\n      end\n", "")]),
         ["Part cube: the law of the material 'rubber' needs",
          "an $ElementData section \"fibre\" is expected"]),
        ("a rigid part with a material",
         dict(change=[("set Materials ", "set Rigid = true\n    set Materials ")]),
         ["Part cube: \"Rigid\" is true, but the part has the material 'rubber'"]),
        ("a rigid part that is not held",
         dict(change=[("set Materials   = rubber", "set Rigid = true"),
                      ("    subsection Material rubber\n      set Material id = 1\n"
                       "      set Law         = neo-Hookean\n      subsection neo-Hookean\n"
                       "        set C1 = 10\n      end\n    end\n", ""),
                      ("set Stiffness", "set Components = x, z\n      set Stiffness")]),
         ["Part cube: \"Rigid\" is true, but no constraint holds the node at",
          "in the direction y; expected a tether on all nodes"]),
        ("a constraint on no node",
         dict(change=[("set Stiffness", "set Region = x > 2\n      set Stiffness")]),
         ["Part cube, constraint hold: no node of", "is in its region"]),
        ("a rigid part whose stresses are wanted",
         dict(change=[("set Materials   = rubber", "set Rigid = true\n    set Element fields = J"),
                      ("    subsection Material rubber\n      set Material id = 1\n"
                       "      set Law         = neo-Hookean\n      subsection neo-Hookean\n"
                       "        set C1 = 10\n      end\n    end\n", "")]),
         ["Part cube: \"Rigid\" is true, but \"Element fields\" has 'J'; expected none"]),
        ("a tether in the volume that names faces",
         dict(change=[("set Stiffness", "set Boundary ids = 3\n      set Stiffness")]),
         ["constraint hold: \"Boundary ids\" is '3', but the tether acts on volume",
          "expected 'Acts on = surface'"]),
        ("a part outside of the box", dict(files={"cube.msh": mesh(points=scaled(1, 0.5))}),
         ["Part cube: a node of", "cube.msh is at", "outside of the fluid box"]),
        ("a mesh in mm", dict(files={"cube.msh": mesh(points=scaled(10))}),
         ["Part cube: a node of", "outside of the fluid box", "both in cm?"]),
    ]),
    ("Loads", [
        ("a misspelt load", loaded("      set Type = presure\n"),
         ["'Type'", "'presure'", "Did you mean 'pressure'?"]),
        ("a load on faces that the mesh does not have",
         loaded("      set Type = pressure\n      set Boundary ids = 4\n"),
         ["load push: \"Boundary ids\" has 4, but no surface element of",
          "cube.msh has this physical id. Its ids: none"]),
        ("a load on nothing", loaded("      set Type = traction\n      set Region = x > 2\n"),
         ["Part cube, load push: no element or face of", "cube.msh is in its region"]),
        ("a load with a table and no column",
         loaded("      set Type = pressure\n      set Pressure table = table.csv\n"),
         ["load push: \"Pressure table\" is 'table.csv' and \"Pressure column\" is ''",
          "expected both or neither"]),
        ("a load with an expression and a table",
         loaded("      set Type = pressure\n      set Pressure = 10\n"
                "      set Pressure table = table.csv\n      set Pressure column = atrium\n"),
         ["load push: there is a \"Pressure table\" as well as the \"Pressure\" '10'"]),
        ("a force that cannot be read",
         loaded("      set Type = body force\n      set Force x = 981*\n"),
         ["load push", "Force x", "981*"]),
        ("a parameter of another load", loaded("      set Type = damping\n      set Pressure = 1\n"),
         ["there is no parameter 'Pressure'", "Load push"]),
        ("a load on fibres", strand("    set Loads = push\n"),
         ["there is no parameter 'Loads' in the subsection Structure / Part strand"]),
    ]),
    ("Fibre files", [
        ("a fibre part without a vertex file",
         dict(change=[("Parts = cube\n", "Parts = cube, strand\n  subsection Part strand\n"
                       "    set Kind = fibres\n  end\n")]),
         ["Part strand: the parameter \"Vertex file\" is not set"]),
        ("a mesh in the place of a vertex file",
         dict(change=[("Parts = cube\n", "Parts = cube, strand\n  subsection Part strand\n"
                       "    set Kind = fibres\n    set Vertex file = cube.msh\n  end\n")]),
         ["Fibre file", "cube.msh: expected a name that ends with .vertex"]),
        ("a parameter of finite elements in a part of fibres",
         strand("    set Mesh file = cube.msh\n"),
         ["there is no parameter 'Mesh file' in the subsection Structure / Part strand"]),
        ("fewer nodes than announced", strand(vertex="3\n0.3 0.3 0.3\n"),
         ["Fibre file", "strand.vertex, line 3: the file ends after 1 nodes",
          "announces 3"]),
        ("more nodes than announced",
         strand(vertex="2\n0.3 0.3 0.3\n0.3 0.33 0.3\n0.3 0.36 0.3\n"),
         ["strand.vertex, line 4: expected the end of the file after 2 nodes"]),
        ("a node without its third coordinate", strand(vertex="1\n0.3 0.3 # flat\n"),
         ["strand.vertex, line 2: expected the coordinate z, found the end of the line"]),
        ("fibres outside of the box", strand(vertex="3\n0.3 0.3 0.3\n0.3 1.3 0.3\n0 0 0\n"),
         ["Part strand: a node of", "strand.vertex is at (0.3 1.3 0.3) cm, outside of the fluid"]),
        ("a spring to a node that is not there", strand(spring="1\n0 3 10 0.03\n"),
         ["strand.spring, line 2: the node 3 is not there; there are 3, counted from 0"]),
        ("a spring of negative stiffness", strand(spring="2\n0 1 10\n1 2 -10\n"),
         ["strand.spring, line 3: the stiffness is -10; it must not be negative"]),
        ("a spring whose law is not there", strand(spring="1\n0 1 10 0.03 2\n"),
         ["Part strand:", "strand.spring, line 2: the spring has the force function 2",
          "no law in \"Spring laws\"", "expected one of: 0"]),
        ("a spring without a rest length that its law needs",
         strand("    set Spring laws = skin\n    subsection Spring law skin\n"
                "      set Type = exponential\n    end\n", spring="1\n0 1 10 0\n"),
         ["strand.spring, line 2: the spring has the rest length 0", "the law 'skin'",
          "must be positive"]),
        ("two laws for the same springs",
         strand("    set Spring laws = skin, bone\n"),
         ["Part strand: the spring laws 'skin' and 'bone' have the same \"Force function\", 0"]),
        ("a misspelt spring law",
         strand("    set Spring laws = skin\n    subsection Spring law skin\n"
                "      set Type = exponental\n    end\n"),
         ["'Type'", "exponental", "Did you mean 'exponential'?"]),
        ("a beam that has a node twice", strand(beam="1\n0 1 0 10\n"),
         ["strand.beam, line 2: the nodes 0, 1, 0 of the beam are not three different ones"]),
        ("a file of beams that cannot be read", strand(beam=Link("nowhere")),
         ["Cannot read the file", "strand.beam'"]),
        ("half of a beam's curvature", strand(beam="1\n0 1 2 10 0.1\n"),
         ["strand.beam, line 2: expected the component y of the curvature"]),
        ("a node that is a target point twice", strand(target="2\n1 10\n1 10\n"),
         ["strand.target, line 3: the node 1 is already a target point"]),
        ("fibres without any forces", strand(spring=None),
         ["Part strand: beside", "strand.vertex there are neither springs nor beams nor target"]),
        ("a tether on the volume of fibres",
         strand("    set Constraints = hold\n"),
         ["Part strand, constraint hold: it acts on a volume or a surface",
          "expected 'Acts on = points'"]),
        ("an instrument that needs finite elements, on fibres",
         dict(strand(), change=strand()["change"] +
              [("= flow meter", "= part volume\n    set Part = strand"),
               ("    set Position = 0.5\n    set Centre   = 0.5, 0.5\n"
                "    set Radius   = 0.3\n", ""), ("    set Axis     = x\n", "")]),
         ["Instrument flow: the part strand consists of fibres",
          "expected one of finite elements"]),
    ]),
    ("Instruments and output", [
        ("an unknown instrument", dict(change=[("= flow meter", "= flowmeter")]),
         ["'Type'", "'flowmeter'", "Did you mean 'flow meter'?"]),
        ("an instrument outside of the box", dict(change=[("Position = 0.5", "Position = 1.5")]),
         ["Instrument flow", "1.5"]),
        ("an instrument on a part that there is not",
         dict(change=[("= flow meter", "= part extent\n    set Part = cub"),
                      ("    set Position = 0.5\n    set Centre   = 0.5, 0.5\n"
                       "    set Radius   = 0.3\n", "")]),
         ["Instrument flow: there is no part 'cub'", "cube"]),
        ("a leak through fibres",
         dict(strand(), change=strand()["change"] +
              measured("    set Type = leak\n    set Part = strand\n")["change"]),
         ["Instrument flow: the part strand consists of fibres"]),
        ("a leak without a direction",
         measured("    set Type = leak\n    set Part = cube\n    set Direction = 0, 0, 0\n"),
         ["Instrument flow: \"Direction\" is zero; expected is a vector"]),
        ("a misspelt stress",
         measured("    set Type = stress and strain\n    set Part = cube\n"
                  "    set Quantities = J, fibre stres\n"),
         ["'Quantities'", "'J, fibre stres', but must match", "Did you mean 'fibre stress'?"]),
        ("the stress of a material that there is not",
         measured("    set Type = stress and strain\n    set Part = cube\n"
                  "    set Materials = ruber\n"),
         ["Instrument flow: part cube has no material 'ruber'", "Did you mean 'rubber'?"]),
        ("the stretch of fibres where there are none",
         measured("    set Type = stress and strain\n    set Part = cube\n"
                  "    set Quantities = fibre stretch\n"),
         ["Instrument flow: the fibre stretch has no value, as there are no fibres in part cube"]),
        ("the force on a part that nothing holds",
         dict(change=[("    set Constraints = hold\n", "")] +
              measured("    set Type = part force\n    set Part = cube\n")["change"] +
              [("    subsection Constraint hold\n      set Type      = tether\n"
                "      set Stiffness = 100\n    end\n", "")]),
         ["Instrument flow: part cube has no constraints or loads"]),
        ("a pressure point outside of the box",
         measured("    set Type = pressure point\n    set Point = 0.5, 0.5, 1.2\n"),
         ["Instrument flow: the pressure is wanted at (0.5 0.5 1.2) cm, outside"]),
        ("a disc with three coordinates across its axis",
         dict(change=[("Centre   = 0.5, 0.5", "Centre   = 0.5, 0.5, 0.5")]),
         ["Instrument flow: Centre has 3 number(s), expected are the 2 coordinate(s) across "
          "the axis x"]),
        ("an output folder that is a file", dict(change=[("folder = run", "folder = cube.msh/run")]),
         ["Cannot make the folder cube.msh/run", "Not a directory"]),
        ("the same, found by `--validate`",
         dict(change=[("folder = run", "folder = cube.msh/run")],
              arguments=["--validate", "run.prm"]),
         ["run.prm cannot work", "cube.msh is not a folder"]),
    ]),
    ("Time step", [
        ("a tether too stiff for the time step, found by `--validate`",
         dict(change=[("Stiffness = 100", "Stiffness = 1e9")], arguments=["--validate", "run.prm"]),
         ["run.prm cannot work", "\"Time / Time step\" is 0.001",
          "stiffness of the constraints (part cube about", "allows about",
          "a smaller \"Stiffness\""]),
        ("a damper too strong for the time step, found by `--validate`",
         dict(change=[("Stiffness = 100", "Damping = 1e6")], arguments=["--validate", "run.prm"]),
         ["run.prm cannot work", "\"Time / Time step\" is 0.001",
          "damping of the constraints (part cube about", "a smaller \"Damping\""]),
        ("springs too stiff for the time step, found by `--validate`",
         dict(strand(spring="2\n0 1 1e6 0.03\n1 2 1e6 0.03\n"),
              arguments=["--validate", "run.prm"]),
         ["run.prm cannot work", "\"Time / Time step\" is 0.001",
          "the part strand (springs) allows about",
          "a smaller stiffness of the part"]),
        ("a flow too fast for the time step",
         dict(change=[("velocity x = 0", "velocity x = 400*cos(2*pi*y)")]),
         ["At t = 0.001 s the flow passes", "cells in a time step of 0.001 s",
          "the flow is fastest", "cm from the node of part cube", "try half of it",
          "Before this step"]),
    ]),
]

warnings = [
    ("a pressure a thousand times too large", dict(change=[("Pressure = 0", "Pressure = 1.6e8")]),
     ["Boundary condition \"end\": the pressure reaches", "mmHg", "right unit?"]),
    ("a density in kg/m^3",
     dict(change=[("  set Initial", "  set Density = 1060\n  set Initial")]),
     ["\"Fluid / Density\" is 1060 g/cm^3", "kg/m^3?"]),
    ("a viscosity in Pa s",
     dict(change=[("  set Initial", "  set Density = 1.06\n  set Viscosity = 0.004\n  set Initial")]),
     ["\"Fluid / Viscosity\" is 0.004 g/(cm s)", "Pa s?"]),
    ("a mesh in m", dict(files={"cube.msh": mesh(points=scaled(0.01, 0.5))}),
     ["Part cube: it is 500 times smaller than the box", "both in cm?"]),
    ("a table that ends before the run",
     dict(change=[use_table, ("= atrium\n", "= atrium\n    set Table extension = clamped\n"),
                  ("End time  = 0.01", "End time  = 0.02")], files={"table.csv": table}),
     ["Condition end / Table file", "goes from 0 to 0.01 s, the run from 0 to 0.02 s"]),
    ("a condition that holds nowhere",
     dict(change=[("= end, sides", "= end, sides, top"),
                  ("  subsection Condition sides", "  subsection Condition top\n"
                   "    set Faces = z max\n  end\n  subsection Condition sides")]),
     ["Boundary condition \"top\" holds nowhere"]),
    ("a part next to a wall", dict(files={"cube.msh": mesh(points=scaled(1, 0.3))}),
     ["Part cube: it is only 0.1 cm, 1.6 cells, away from the face x max",
      "the kernel IB_4 reaches 2 cells"]),
    ("elements much smaller than the cells of the grid",
     dict(files={"cube.msh": mesh(points=scaled(0.05, 0.5))}),
     ["Part cube: 6 of 6 elements (100 %) are smaller than half a cell of the grid"]),
    ("elements much larger than the cells of the grid",
     dict(change=[("Minimum level = 1\n  set Maximum level = 1",
                   "Minimum level = 2\n  set Maximum level = 2"),
                  ("set Materials", "set Point density = 1.5\n    set Materials")],
          files={"cube.msh": box_mesh((0.2, 0.2, 0.2), (0.8, 0.8, 0.8))}),
     ["Part cube: the longest edge of the element 1 of", "grid cells", "quadrature points"]),
    ("a bad element",
     dict(files={"cube.msh": mesh(points=corners[:7] + [(0.401, 0.42, 0.45)],
                                  elements=[(0, 2, 4, 7), (0, 1, 3, 6)])}),
     ["Part cube: 1 of 2 elements (50 %) have a quality below 0.05", "element 1 of"]),
    ("a part across two levels of the grid",
     dict(change=[("Minimum level = 1\n  set Maximum level = 1",
                   """Minimum level = 1
  set Maximum level = 2
  subsection Refinement
    set Refinement boxes = half
    subsection Box half
      set Lower corner = 0, 0, 0
      set Upper corner = 0.5, 1, 1
      set Level        = 2
    end
  end"""), ("set Materials", "set Grid level = 1\n    set Materials")]),
     ["Part cube: the kernels of", "reach cells of two levels", "where levels 1 and 2 meet"]),
    ("fibres with wide gaps between their nodes",
     strand(vertex="3\n0.3 0.3 0.3\n0.3 0.5 0.3\n0.3 0.7 0.3\n"),
     ["Part strand: the segment 0 of", "grid cells long; fluid may pass between its nodes"]),
    ("a tether a little too stiff for the time step",
     dict(change=[("Stiffness = 100", "Stiffness = 1e7")]),
     ["\"Time / Time step\" is 0.001", "stiffness of the constraints", "allows about 0.000"]),
]

preface = """# Wrong input and what Mitre says to it

Written by `tests/simulation/wrong_input_stops_with_a_message.py`, which tries all of these; do
not edit. Words that stand between dots are left out here.

`mitre --validate RUN.prm` reads the parameter file and all that it names, builds the geometry and
the grid, says what it has understood, and takes two steps on trial, which tell what a step costs;
it writes nothing. Errors end it, as they end a run, with exit status 1. Warnings tell of what is seldom meant;
a run prints those too that need no trial.

All ranks stop together, with one message. Files that an earlier run has left are as they were.
Errors in a parameter file are reported together, up to ten of them.

## Errors
"""


def document():
    text = preface

    def row(what, words):
        message = " ... ".join(words).replace("|", "\\|").replace("*", "\\*")
        return "| %s | %s |\n" % (what, message)

    for section, cases in errors:
        text += "\n### %s\n\n| Mistake | Message |\n|---|---|\n" % section
        text += "".join(row(what, words) for what, _, words in cases)
    text += "\n## Warnings\n\n| What is seldom meant | Message |\n|---|---|\n"
    text += "".join(row(what, words) for what, _, words in warnings)
    return text


if sys.argv[1] == "--write":
    with open(sys.argv[2], "w") as file:
        file.write(document())
    sys.exit(0)

program, folder, doc_file = [os.path.abspath(name) for name in sys.argv[1:4]]
failures = 0


def fail(what, text):
    global failures
    failures += 1
    print("%s: %s" % (what, text))


with open(doc_file) as file:
    if file.read() != document():
        fail("doc/messages.md", "differs from the cases; use the option --write")

shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)


def run(change=(), files=None, arguments=("run.prm",)):
    contents = {"run.prm": base, "cube.msh": mesh(), "table.csv": None}
    contents.update({"strand." + ending: None for ending in ("vertex", "spring", "beam", "target")})
    for old, new in change:
        assert old in contents["run.prm"], old
        contents["run.prm"] = contents["run.prm"].replace(old, new, 1)
    contents.update(files or {})
    for name, text in contents.items():
        if os.path.lexists(name):
            os.remove(name)
        if isinstance(text, Link):
            os.symlink(text, name)
        elif text is not None:
            with open(name, "w") as file:
                file.write(text)
    result = subprocess.run([program] + list(arguments), capture_output=True, text=True,
                            timeout=250)
    return result.returncode, re.sub(r"\s+", " ", result.stdout + result.stderr)


def missing(words, text):
    """The first of the words that does not follow the ones before it."""
    at = 0
    for word in words:
        at = text.find(re.sub(r"\s+", " ", word), at)
        if at < 0:
            return word
        at += 1
    return None


def fingerprint(top):
    sums = {}
    for path, _, names in os.walk(top):
        for name in names:
            with open(os.path.join(path, name), "rb") as file:
                sums[os.path.join(path, name)] = hashlib.sha256(file.read()).hexdigest()
    return sums


status, text = run()
if status != 0 or "Warning" in text:
    fail("a run without mistakes", "status %d\n%s" % (status, text[-1500:]))
earlier = fingerprint("run")
status, text = run(arguments=["--validate", "run.prm"])
if status != 0 or "run.prm is valid." not in text:
    fail("validation of it", "status %d\n%s" % (status, text[-1500:]))
for words in (["part cube:", "material rubber (id 1): neo-Hookean", "constraint hold: tether",
               "from (0.4, 0.4, 0.4) to (0.6, 0.6, 0.6) cm", "kernel IB_4, 2 points a cell",
               "x min 0.4", "quadrature points", "two steps on trial", "memory:"],
              # the face x min of the cube, and the five others
              ["boundary condition end: 1 cm^2, pressure 0 to 0 mmHg",
               "boundary condition sides: 5 cm^2, wall"]):
    if missing(words, text):
        fail("validation of it", "'%s' is not in\n%s" % (missing(words, text), text))

for section, cases in errors:
    for what, case, words in cases:
        status, text = run(**case)
        word = missing(words, text)
        if status != 1 or word:
            fail(what, "status %d, not in the message: %s\n%s" % (status, word, text[-2500:]))
        if section == "Time step":
            # This one has begun: its own files are new, but must be whole.
            if os.path.exists("run/statistics.csv") and "--validate" not in str(case):
                lines = open("run/statistics.csv").read().splitlines()
                if any(line.count(",") != lines[0].count(",") for line in lines):
                    fail(what, "statistics.csv is not whole")
        elif fingerprint("run") != earlier:
            fail(what, "files of the earlier run have changed")
            earlier = fingerprint("run")

earlier = fingerprint("run")
for what, case, words in warnings:
    status, text = run(arguments=["--validate", "run.prm"], **case)
    word = missing(["Warning:"] + words, text)
    if status != 0 or word:
        fail(what, "status %d, not in the warning: %s\n%s" % (status, word, text[-2500:]))
    if fingerprint("run") != earlier:
        fail(what, "--validate has written files")
        earlier = fingerprint("run")

n_cases = sum(len(cases) for _, cases in errors) + len(warnings)
print("%d cases" % n_cases)
sys.exit("%d failures" % failures if failures else 0)
