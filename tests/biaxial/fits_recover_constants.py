#!/usr/bin/python3
"""Fits to synthetic measurements find the constants that these were made with.

The measurements come from closed forms that are written down here, not from the program. Without
noise the constants are found to 1e-5. With Gaussian noise (1 % of the largest stress) they
lie within 3.5 of the standard errors that the program states, and these are not larger than a
tenth of the constants: so neither can be far off. A constant that is shut out by its bound
ends there and is reported so; one that has no effect is reported as not determined.
"""

import math
import random
import re

from biaxial_runs import expect, finish, run, start, table

start()


def constants(output):
    """Name: (value, standard error or None)."""
    found = {}
    for line in output.splitlines():
        match = re.match(r" *set (.*) = (\S+) +# (?:standard error (\S+))?", line)
        if match:
            found[match.group(1)] = (float(match.group(2)),
                                     float(match.group(3)) if match.group(3) else None)
    return found


def parameter_file(law, values, names, lower, upper):
    lines = "\n".join(f"set {name} = {value}" for name, value in values.items())
    return f"""
set Output folder = out
set Materials     = sheet
set Largest stretch = 1.1
set Steps = 2
set Thickness     = 0.05
subsection Material sheet
  set Law = {law}
  set Fibre angles = 0
  subsection {law}
    {lines}
  end
  subsection Fit
    set Measurements = data.csv
    set Parameters   = {names}
    set Lower bounds = {lower}
    set Upper bounds = {upper}
  end
end
"""


# Leaflet, equibiaxial, Cauchy stresses in kPa.
TRUE = {"C1": 1.7370e5, "a_f": 3.1275e5, "b_f": 55.9258}


def leaflet(noise):
    generator = random.Random(7)
    lines = ["# made up", "stretch 1 [1],stretch 2 [1],Cauchy stress 11 [kPa],"
             "Cauchy stress 22 [kPa]"]
    for i in range(1, 41):
        l = 1 + 0.003 * i
        across = 2 * TRUE["C1"] * (l**2 - l**-4)
        along = across + (2 * TRUE["a_f"] * (l**2 - 1) * math.exp(TRUE["b_f"] * (l**2 - 1)**2)
                          * l**2)
        lines.append(f"{l!r},{l!r},{along / 1e4 + noise * generator.gauss(0, 1)!r},"
                     f"{across / 1e4 + noise * generator.gauss(0, 1)!r}")
    return "\n".join(lines) + "\n"


START = {"C1": "1e4", "a_f": "1e6", "b_f": "10"}
BOUNDS = ("C1, a_f, b_f", "1e3, 1e3, 1", "1e7, 1e7, 500")
status, output = run(parameter_file("transversely isotropic", START, *BOUNDS), data=leaflet(0))
found = constants(output)
expect(status == 0 and set(found) == set(TRUE), f"leaflet: fitted {output}")
for name, value in TRUE.items():
    expect(abs(found[name][0] / value - 1) < 1e-5, f"leaflet, exact data: {name}")

status, output = run(parameter_file("transversely isotropic", START, *BOUNDS), data=leaflet(4.))
found = constants(output)
for name, value in TRUE.items():
    fitted, error = found[name]
    expect(abs(fitted - value) < 3.5 * error < 0.35 * value,
           f"leaflet, noise: {name} {fitted} +- {error}")
difference = float(re.search(r"Cauchy stress 11: root mean square difference (\S+) kPa",
                             output).group(1))
expect(2.5 < difference < 5.5, f"leaflet, noise: the difference is the noise ({difference})")
data = table("sheet_fit")
expect(len(data["measured Cauchy stress 22 [kPa]"]) == 40, "leaflet: table beside the fit")

# A bound in the way, and a constant without effect.
status, output = run(parameter_file("transversely isotropic", START, "C1, a_f, b_f",
                                    "1e3, 1e3, 1", "1e7, 1e7, 40"), data=leaflet(0))
found = constants(output)
expect(abs(found["b_f"][0] - 40) < 1e-3 and found["b_f"][1] is None, "a bound is kept")
status, output = run(parameter_file("transversely isotropic", START, "C1, Bulk modulus",
                                    "1e3, 0", "1e7, 1e7"), data=leaflet(0))
expect(constants(output)["Bulk modulus"][1] is None, "a constant without effect")

# Chord, uniaxial, tension in N/m (= 1e3 dyn/cm) of a thickness of 0.05 cm; one free constant
# (another method of NLopt), and two.
E, ALPHA, STRETCH, C1 = 7e8, 40., 1.1, 3e5
lines = ["stretch 1 [1],tension 11 [N/m]"]
for i in range(1, 31):
    l = 1 + 0.005 * i
    pull = (E / ALPHA * (math.exp(ALPHA * (min(l, STRETCH) - STRETCH))
                         - math.exp(ALPHA * (1 - STRETCH))) + E * max(0, l - STRETCH))
    lines.append(f"{l!r},{(pull + 2 * C1 * (l - l**-2)) * 0.05 / 1e3!r}")
DATA = "\n".join(lines) + "\n"
CHORD = {"C1": C1, "Linear modulus": 2e8, "Toe exponent": 40, "Transition stretch": 1.1}
status, output = run(parameter_file("toe-linear collagen", CHORD, "Linear modulus", "1e6",
                                    "1e10"), data=DATA)
expect(status == 0 and abs(constants(output)["Linear modulus"][0] / E - 1) < 1e-5,
       f"chord: one constant {output if status else ''}")
CHORD["Toe exponent"] = 20
status, output = run(parameter_file("toe-linear collagen", CHORD, "Linear modulus, Toe exponent",
                                    "1e6, 1", "1e10, 200"), data=DATA)
found = constants(output)
expect(abs(found["Linear modulus"][0] / E - 1) < 1e-5
       and abs(found["Toe exponent"][0] / ALPHA - 1) < 1e-5, "chord: two constants")
finish()
