#!/usr/bin/python3
"""Each mistake in a parameter file or in a table of measurements ends the program with status 1
and a message that names the place, what was found and what was expected."""

from biaxial_runs import expect, finish, run, start

start()
HEADING = "stretch 1 [1],stretch 2 [1],Cauchy stress 11 [kPa]\n"
GOOD = HEADING + "1.1,1.1,20\n1.2,1.2,40\n"


def expect_error(message, data=GOOD, law="neo-Hookean", names="C1", lower="1e3", upper="1e7",
                 more="", top=""):
    status, output = run(f"""
set Output folder = out
set Materials = sheet
{top}
subsection Material sheet
  set Law = {law}
  {more}
  subsection Fit
    set Measurements = data.csv
    set Parameters   = {names}
    set Lower bounds = {lower}
    set Upper bounds = {upper}
  end
end
""", data=data)
    expect(status == 1 and message in output,
           f"'{message}'" + ("" if message in output else f": status {status}, {output}"))


status, output = run("set Output folder = out\nset Materials = sheet\nsubsection Material sheet\n"
                     "end\n")
expect(status == 0, "without a mistake, and without a fit")

expect_error("data.csv:3: column 3: expected a number, found 'forty'",
             HEADING + "1.1,1.1,20\n1.2,1.2,forty\n")
expect_error("data.csv:3: found 2 columns, but the first line names 3", HEADING
             + "1.1,1.1,20\n1.2,1.2\n")
expect_error("data.csv:2: the stretch in column 2 is -1.1", HEADING + "1.1,-1.1,20\n")
expect_error("data.csv:1: the column 'stress' is not known.", "stretch 1 [1],stress [kPa]\n1,1\n")
expect_error("data.csv:1: the column heading 'stretch 1' is not a name and a unit",
             "stretch 1,Cauchy stress 11 [kPa]\n1,1\n")
expect_error("data.csv:1: 'Cauchy stress 11' has the unit [N/m]; expected [dyn/cm^2]",
             "stretch 1 [1],Cauchy stress 11 [N/m]\n1,1\n")
expect_error("data.csv:1: There is no unit 'kpa'. Did you mean 'kPa'?",
             "stretch 1 [1],Cauchy stress 11 [kpa]\n1,1\n")
expect_error("data.csv:1: there is no column 'stretch 1' or 'stretch 2'",
             "shear [1],Cauchy stress 11 [kPa]\n1,1\n")
expect_error("data.csv:1: the column 'tension 11' is of use only with a \"Thickness\"",
             "stretch 1 [1],tension 11 [N/m]\n1,1\n")
expect_error("data.csv: expected a line of headings and lines of numbers", HEADING)
expect_error("There are 1 measured values for 2 parameters", HEADING + "1.1,1.1,20\n",
             names="C1, Bulk modulus", lower="1e3, 0", upper="1e7, 1e7")
expect_error("the law 'neo-Hookean' has no constant 'c1'. Did you mean 'C1'?", names="c1")
expect_error("the law 'neo-Hookean' has no constant 'Reference stress'", names="Reference stress")
expect_error("Material sheet, Fit, Upper bounds: found 2 numbers for 1 parameters",
             upper="1e6, 1e7")
expect_error("The parameter 'C1' starts at 100000, which is not between its bounds 1000 and 5000",
             upper="5e3")
expect_error("neo-Hukean", law="neo-Hukean")
expect_error("the law 'Holzapfel-Ogden' needs 2 \"Fibre angles\"; found '10'",
             law="Holzapfel-Ogden", names="a", more="set Fibre angles = 10")
expect_error("has not converged within 3 evaluations", more="subsection Fit\n"
             "set Maximum evaluations = 3\nend")
expect_error("\"Time factor table\" is 'data.csv' and \"Time factor column\" is ''",
             more="set Time factor table = data.csv")
expect_error("as well as the \"Time factor\" '2*t'", more="set Time factor table = data.csv\n"
             "set Time factor column = x\nset Time factor = 2*t")
expect_error("data.csv:1: the first column must be time, in [s] or [ms]; found 'stretch 1 [1]'",
             more="set Time factor table = data.csv\nset Time factor column = x")
expect_error("\"Smallest stretch\" is 1.5", top="set Smallest stretch = 1.5")
expect_error("The stress is not finite with stretches", law="Holzapfel-Gasser-Ogden", names="mu",
             top="set Largest stretch = 5")
finish()
