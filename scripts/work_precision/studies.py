# SPDX-License-Identifier: LGPL-2.1-or-later
"""The runs of doc/accuracy.md: for each study a base scene, the quantities that
are judged, and for each knob its settings."""
import levels
from study import Quantity, Study, steps


# The academic case, root tied, to 2.6 mm. Steps are not cut for the change of
# density, so that their length is the one that is set.

ACADEMIC_END = 90.4  # [T]; the tooth has gone 2.6005 mm


def academic():
    density = "Mesh/tooth in block/Mesh density="
    free = "Remodelling/Maximum density change=10"
    end = [f"Time/End={ACADEMIC_END}", f"Output/Field interval={ACADEMIC_END}"]
    second = "Transfer/Scheme=limited linear"
    none = "Regions/bone/Volumetric treatment=none"
    quadratic = "Mesh/Degree=2"
    study = Study(
        "academic", "Academic case, tied, to 2.6 mm", "verification/academic-tied",
        ACADEMIC_END, end + [free],
        [Quantity("force", "N", "force x"),
         # beside the root, on the side that is pulled
         Quantity("criterion", "MPa", field="stimulus", window=(-4.5, -1.5, -10, -4)),
         Quantity("mass", "mg", "bone mass"),
         Quantity("stored energy", "mJ", "stored energy")])
    study.knob("mesh", {d: [density + d] + steps(2) for d in ("0.25", "0.5", "1", "2", "4")})
    study.knob("step", {s: steps(s) for s in ("8", "4", "2", "1", "0.5", "0.25")})
    study.knob("tolerance", {t: steps(2) + [f"Solver/Tolerance={t}"]
                             for t in ("1e-3", "1e-5", "1e-7", "1e-11")})
    study.knob("degree 2", {d: [density + d, quadratic] + steps(2)
                            for d in ("0.25", "0.5", "1")})
    study.knob("full integration", {d: [density + d, none] + steps(2)
                                    for d in ("0.25", "0.5", "1", "2")})
    study.knob("degree 2, full integration",
               {d: [density + d, quadratic, none] + steps(2) for d in ("0.25", "0.5")})
    study.knob("second-order transfer", {d: [density + d, second] + steps(2)
                                         for d in ("0.25", "0.5", "1", "2")})
    study.knob("second-order transfer, step", {s: [second] + steps(s) for s in ("8", "4", "1", "0.5")})
    study.knob("smoothing", {"barrier": steps(2) + ["Rezoning/centre/Type=barrier"],
                             "equal": steps(2) + ["Rezoning/centre/Shapes=equal"],
                             "none": steps(2) + ["Rezoning/Names="]})
    study.knob("filter", {l: steps(2) + [f"Remodelling/Filter length={l}"]
                          for l in ("0.25", "0.5", "1", "2")})
    study.knob("cut for density", {c: steps(4) + [f"Remodelling/Maximum density change={c}"]
                                   for c in ("0.3", "0.1", "0.03")})
    study.knob("local tolerance", {t: steps(2) + [f"Remodelling/Local tolerance={t}"]
                                   for t in ("1e-2", "1e-4", "1e-8")})
    study.knob("both", {"d4 t0.5": [density + "4"] + steps(0.5),
                        "d2 t0.5": [density + "2"] + steps(0.5)})
    for level in ("fast", "balanced", "reference"):
        study.other("level", level, study.scene, end + ["Accuracy=" + level])
    study.meshes = [(("mesh", d), float(d) ** -0.5) for d in ("0.25", "0.5", "1", "2", "4")]
    study.mesh_order = 1.0 # corners of the root at the margin
    study.steps = [(("step", s), float(s)) for s in ("8", "4", "2", "1", "0.5", "0.25")]
    study.base_run = ("step", "2")
    study.diagrams = {
        "mesh": ("mesh", "second-order transfer", "degree 2", "full integration",
                 "degree 2, full integration", "level"),
        "step": ("step", "second-order transfer, step", "tolerance", "smoothing", "filter",
                 "cut for density", "local tolerance", "both", "level")}
    return study


# The beginning of the academic case, where iterated coupling converges.

COUPLING_END = 14 # [T]; 0.4 mm


def coupling():
    base = [f"Time/End={COUPLING_END}", "Output/Fields=false",
            "Remodelling/Maximum density change=10", "Mesh/tooth in block/Mesh density=0.5"]
    iterated = ["Remodelling/Coupling=iterated", "Remodelling/Maximum coupling iterations=60"]
    study = Study("coupling", "Academic case, tied, to 0.4 mm: coupling",
                  "verification/academic-tied", COUPLING_END, base,
                  [Quantity("force", "N", "force x"), Quantity("mass", "mg", "bone mass"),
                   Quantity("stored energy", "mJ", "stored energy")])
    short = ("2", "1", "0.5", "0.25", "0.125", "0.0625")
    study.knob("staggered", {s: steps(s) for s in short})
    study.knob("iterated", {"2": iterated + steps(2)})
    study.meshes = [(("staggered", s), float(s)) for s in short]
    study.mesh_order = 1.0
    study.diagrams = {"knobs": ("staggered", "iterated")}
    return study


# The levels on the academic scene as it is shipped, with its ligament, to the end.


def whole():
    study = Study("academic-whole", "Academic case with ligament, to 10.5 mm", "academic", 365,
                  [], [Quantity("force", "N", "force x"), Quantity("mass", "mg", "bone mass")])
    study.knob("level", {level: ["Output/Fields=false", "Accuracy=" + level]
                         for level in ("fast", "balanced", "reference")})
    return study


# The incisor on an ALE mesh to 0.4 N.

INCISOR_END = 0.4  # [T] = [N per mm]


def incisor():
    mesh = "Mesh/tooth in socket/"

    def layers(n):
        """Mesh with n instead of 4 elements across the ligament, without the cap at
        the rim, which would leave a single edge there."""
        return [mesh + f"Elements across ligament={n}",
                mesh + f"Elements along ligament={2 * round(125 * n / 4)}",
                mesh + f"Largest edge in tooth={0.32 * 4 / n:.4g}",
                mesh + f"Largest edge in bone={0.9 * 4 / n:.4g}",
                mesh + f"Growth in tooth={0.19 * 4 / n:.4g}",
                mesh + f"Growth in bone={0.25 * 4 / n:.4g}",
                mesh + "Cap at lingual rim=0"]
    none = "Regions/ligament/Volumetric treatment=none"
    end = [f"Time/End={INCISOR_END}", "Output/Fields=false"]
    study = Study(
        "incisor", "Incisor, ALE, to 0.4 N", "incisor-ale", INCISOR_END, end,
        [Quantity("tip", "mm", "tip: displacement"),
         Quantity("stored energy", "mJ", "stored energy"),
         Quantity("rotation", "degree", "tooth: rotation")])
    # The step does nothing here (below): long ones for the meshes
    study.knob("mesh", {n: [mesh + f"Refinement={n}"] + steps(0.1) for n in ("1", "2", "3")})
    study.knob("no cap", {"2": layers(2) + steps(0.1), "3": layers(3) + steps(0.1)})
    study.knob("step", {s: steps(s) for s in ("0.1", "0.05", "0.02")})
    study.knob("tolerance", {t: [f"Solver/Tolerance={t}"] for t in ("1e-3", "1e-5")})
    study.knob("degree 2", {"3": layers(3) + ["Mesh/Degree=2"] + steps(0.1)})
    study.knob("full integration", {"3": layers(3) + [none] + steps(0.1), "4": [none] + steps(0.1)})
    study.knob("second-order transfer", {"4": ["Transfer/Scheme=limited linear"],
                                         "8": [mesh + "Refinement=2",
                                               "Transfer/Scheme=limited linear"] + steps(0.1)})
    study.knob("smoothing", {"Giuliani": ["Rezoning/inside/Type=Giuliani"],
                             "both rims": ["Rezoning/rims/On=rim labial, rim lingual"],
                             "none": ["Rezoning/Names="]})
    for level in ("fast", "balanced", "reference"):
        study.other("level", level, study.scene, end + ["Accuracy=" + level])
    study.meshes = [(("mesh", n), 1 / int(n)) for n in ("1", "2", "3")]
    study.steps = [(("step", s), float(s)) for s in ("0.1", "0.05", "0.02")]
    study.base_run = ("step", "0.1")
    study.diagrams = {
        "knobs": ("mesh", "no cap", "step", "tolerance", "degree 2", "full integration",
                  "second-order transfer", "smoothing", "level")}
    return study


# A thick cylinder of rubber, drawn from radius 1 to 1.5 mm: exact values if
# incompressible (the bulk modulus is 2e5 times the shear modulus).


def energy_of_cylinder(n=2000):
    """Quarter of the cylinder, c1 + c2 = 0.5 MPa, R from 1 to 2 mm, r^2 = R^2 +
    1.25 mm^2: int 0.5 (l^2 + l^-2 - 2) R dR pi/2 with l = r/R, by Simpson."""
    import math

    def f(R):
        square = 1 + 1.25 / R ** 2
        return 0.5 * (square + 1 / square - 2) * R * math.pi / 2
    h = 1.0 / n
    return h / 3 * sum((1 if i in (0, n) else 4 if i % 2 else 2) * f(1 + i * h)
                       for i in range(n + 1))


EXACT_CYLINDER = {"inner wall": 0.5, "outer wall": 5.25 ** 0.5 - 2,
                  "stored energy": energy_of_cylinder()}


def cylinder():
    refined = "Mesh/grid generator/Refinements="
    none = "Regions/wall/Volumetric treatment=none"
    quadratic = "Mesh/Degree=2"
    study = Study(
        "cylinder", "Thick cylinder of rubber", "verification/thick-cylinder-rubber", 1.0,
        ["Output/Fields=false"],
        [Quantity("inner wall", "mm", "A: displacement x"),
         Quantity("outer wall", "mm", "B: displacement x"),
         Quantity("stored energy", "mJ", "stored energy")])
    study.knob("mesh", {n: [refined + n] for n in "12345"})
    study.knob("degree 2", {n: [refined + n, quadratic] for n in "0123"})
    study.knob("full integration", {n: [refined + n, none] for n in "2345"})
    study.knob("degree 2, full integration",
               {n: [refined + n, quadratic, none] for n in "1234"})
    study.knob("step", {s: [refined + "3"] + steps(s) for s in ("0.5", "0.25", "0.025")})
    study.knob("tolerance", {t: [refined + "3", f"Solver/Tolerance={t}"]
                             for t in ("1e-2", "1e-3", "1e-5", "1e-7")})
    study.diagrams = {"knobs": ("mesh", "degree 2", "full integration",
                                "degree 2, full integration", "step", "tolerance")}
    return study


# The same with a bulk modulus a hundred times the shear modulus, rezoned after
# every step; it has to equal the Lagrangian run.


def rezoned():
    refined = "Mesh/grid generator/Refinements="
    second = "Transfer/Scheme=limited linear"
    study = Study(
        "rezoned", "Thick cylinder, rezoned in every step",
        "verification/thick-cylinder-rezoned", 1.0, ["Output/Fields=false"],
        [Quantity("inner wall", "mm", "A: displacement x"),
         Quantity("outer wall", "mm", "B: displacement x"),
         Quantity("stored energy", "mJ", "stored energy")])
    for n in "1234":
        study.other("Lagrangian, degree 2", n, study.scene,
                    study.base + [refined + n, "Mesh/Degree=2", "Rezoning/Names="])
    study.knob("first-order transfer", {n: [refined + n] for n in "1234"})
    study.knob("second-order transfer", {n: [refined + n, second] for n in "1234"})
    study.knob("barrier", {n: [refined + n, "Rezoning/inside/Type=barrier"] for n in "1234"})
    study.knob("step, first order", {s: [refined + "3"] + steps(s)
                                     for s in ("0.2", "0.05", "0.025", "0.0125")})
    study.knob("step, second order", {s: [refined + "3", second] + steps(s)
                                      for s in ("0.2", "0.05", "0.025", "0.0125")})
    study.knob("reference map", {n: [refined + n, "Regions/wall/Transfer of deformation="
                                     "reference map"] for n in "1234"})
    study.meshes = [(("Lagrangian, degree 2", n), 2.0 ** -int(n)) for n in "1234"]
    study.mesh_order = 4.0
    study.diagrams = {"knobs": ("Lagrangian, degree 2", "first-order transfer",
                                "second-order transfer", "barrier", "reference map",
                                "step, first order", "step, second order")}
    return study


STUDIES = {study.name: study for study in (academic(), coupling(), whole(), incisor(), cylinder(), rezoned(),
                                              *levels.all_of_them())}
