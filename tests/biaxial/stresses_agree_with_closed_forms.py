#!/usr/bin/python3
"""The tables of the neo-Hookean solid against its closed forms, with C = C1 in kPa.

Incompressible: uniaxial s11 = 2 C (l^2 - 1/l) with a lateral stretch l^(-1/2); equibiaxial
2 C (l^2 - l^-4); strip biaxial s11 = 2 C (l^2 - l^-2), s22 = 2 C (1 - l^-2); simple shear s12 =
2 C g, s11 = 2 C g^2, s22 = 0. First Piola stresses are s11/l, tensions that times the thickness.
Compressible, W = C1 (I1 - 3) - 2 C1 ln J + (kappa/2) (ln J)^2: the stretch l3 through the thickness
solves 2 C (l3^2 - 1) + kappa ln J = 0, and s11 J = 2 C (l1^2 - 1) + kappa ln J. Fibres at 90
degrees to direction 1 make direction 2 the stiff one: the table of uniaxial 2 is that of uniaxial 1
with fibres at 0 and the directions exchanged. The shear stress of the time-dependent
material is multiplied by its factor, here from a table. scripts/plot_biaxial draws all.
"""

import math
import subprocess

from biaxial_runs import ROOT, WORK, expect, expect_close, finish, run, start, table

start()
C = 20.
KAPPA = 90.
SOLID = """
  set Law = neo-Hookean
  subsection neo-Hookean
    set C1           = 2e5
    set Bulk modulus = 9e5
  end
"""
FIBROUS = """
  set Law = transversely isotropic
  subsection transversely isotropic
    set Bulk modulus = 1e6
  end
"""
ALL = "uniaxial 1, uniaxial 2, equibiaxial, strip biaxial 1, strip biaxial 2, simple shear"

for volume in ("incompressible", "compressible"):
    status, output = run(f"""
set Output folder = out
set Materials     = solid, along, across, weak
set Loadings      = {ALL}
set Volume        = {volume}
set Thickness     = 0.1
set Largest stretch = 1.3
set Smallest stretch = 0.8
set Steps         = 20
set Time          = 0.5
subsection Material solid
{SOLID}
end
subsection Material along
{FIBROUS}
  set Fibre angles = 0
end
subsection Material across
{FIBROUS}
  set Fibre angles = 90
end
subsection Material weak
{SOLID}
  set Time factor table  = factor.csv
  set Time factor column = factor
end
""", factor="time [s],factor [1]\n0,1\n0.5,0.25\n1,1\n")
    expect(status == 0, f"{volume}: runs ({output.strip()})" if status else f"{volume}: runs")

    uniaxial, equibiaxial, strip, shear = (table(f"solid_{name}") for name in (
        "uniaxial_1", "equibiaxial", "strip_biaxial_1", "simple_shear"))
    if volume == "incompressible":
        l = uniaxial["stretch 1 [1]"]
        expect_close(l, [0.8 + 0.025 * i for i in range(21)], 1e-9, "stretches")
        expect_close(uniaxial["Cauchy stress 11 [kPa]"],
                     [2 * C * (x**2 - 1 / x) for x in l], 1e-8, "uniaxial")
        expect_close(uniaxial["stretch 2 [1]"], [x**-0.5 for x in l], 1e-8, "lateral stretch")
        expect_close(uniaxial["first Piola stress 11 [kPa]"],
                     [2 * C * (x - 1 / x**2) for x in l], 1e-8, "first Piola stress")
        # kPa cm = 10 N/m
        expect_close(uniaxial["tension 11 [N/m]"],
                     [2 * C * (x - 1 / x**2) * 0.1 * 10 for x in l], 1e-8, "tension")
        expect_close(equibiaxial["Cauchy stress 22 [kPa]"],
                     [2 * C * (x**2 - x**-4) for x in l], 1e-8, "equibiaxial")
        expect_close(strip["Cauchy stress 11 [kPa]"],
                     [2 * C * (x**2 - x**-2) for x in l], 1e-8, "strip biaxial, pulled")
        expect_close(strip["Cauchy stress 22 [kPa]"],
                     [2 * C * (1 - x**-2) for x in l], 1e-8, "strip biaxial, held")
        g = shear["shear [1]"]
        expect_close(shear["Cauchy stress 12 [kPa]"], [2 * C * x for x in g], 1e-8, "shear")
        expect_close(shear["Cauchy stress 11 [kPa]"], [2 * C * x**2 for x in g], 1e-8,
                     "normal stress of shear")
        expect_close(shear["Cauchy stress 22 [kPa]"], [0 for x in g], 1e-8, "no stress across")
    else:
        for name, data in (("uniaxial", uniaxial), ("equibiaxial", equibiaxial),
                           ("strip biaxial", strip)):
            l1, l2, l3 = (data[f"stretch {i} [1]"] for i in (1, 2, 3))
            J = [a * b * c for a, b, c in zip(l1, l2, l3)]
            expect_close([2 * C * (c**2 - 1) + KAPPA * math.log(j) for c, j in zip(l3, J)],
                         [0] * len(J), 1e-7, f"{name}: no stress through the thickness")
            expect_close(data["Cauchy stress 11 [kPa]"],
                         [(2 * C * (a**2 - 1) + KAPPA * math.log(j)) / j
                          for a, j in zip(l1, J)], 1e-8, f"{name}: stress")
        expect_close(uniaxial["stretch 2 [1]"], uniaxial["stretch 3 [1]"], 1e-8,
                     "uniaxial: both lateral stretches agree")

    expect_close(table("across_uniaxial_2")["Cauchy stress 22 [kPa]"],
                 table("along_uniaxial_1")["Cauchy stress 11 [kPa]"], 1e-8,
                 "fibres along the pull in either direction")
    expect_close(table("across_strip_biaxial_2")["Cauchy stress 11 [kPa]"],
                 table("along_strip_biaxial_1")["Cauchy stress 22 [kPa]"], 1e-8,
                 "strip biaxial in either direction")
    expect_close(table("weak_simple_shear")["Cauchy stress 12 [kPa]"],
                 [s / 4 for s in shear["Cauchy stress 12 [kPa]"]], 1e-8, "time factor")

for stress in ("Cauchy stress", "tension"):
    result = subprocess.run([ROOT / "scripts" / "plot_biaxial", "--stress", stress, "--output",
                             WORK / "plot.png", WORK / "out"], capture_output=True, text=True)
    expect(result.returncode == 0 and (WORK / "plot.png").stat().st_size > 20000,
           f"plot of the {stress} {result.stderr}")
    (WORK / "plot.png").unlink(missing_ok=True)
result = subprocess.run([ROOT / "scripts" / "plot_biaxial", WORK], capture_output=True,
                        text=True)
expect(result.returncode == 1 and "There is no table" in result.stderr
       and "Traceback" not in result.stderr, "plot of a folder without tables")
finish()
