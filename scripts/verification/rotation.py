# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bodies turned by 360 degrees, on the Lagrangian mesh, on a mesh held in place,
and remeshed every 30 degrees."""
import math

from book import case
from elasticity import REFINEMENTS, SCHEMES, steps

HELD = ["Rezoning/Names=held", "Rezoning/held/Type=fixed",
        "Rezoning/held/On=disc, edge"]


def every_30_degrees(start, refinements):
    times = ", ".join(f"{start + k / 12:.10f}" for k in range(1, 12))
    return ["Remeshing/Type=outline", f"Remeshing/Times={times}",
            f"Remeshing/outline/Largest edges=disc: {1.2 / 2**refinements:g}"]


@case("Rigid rotation")
def rigid_rotation(book):
    source = "a rigid motion leaves a body without strain"
    variants = {"Lagrangian": [], "mesh held": HELD,
                "remeshed every 30°": every_30_degrees(0, 2)}
    for name, settings in variants.items():
        for o, scheme in SCHEMES.items():
            if name == "Lagrangian" and o == 2:
                continue
            run = book.run("rigid-rotation", settings + [scheme])
            title = name if name == "Lagrangian" else f"{name}, order {o}"
            book.below(f"greatest principal strain after one turn, {title}", source,
                       max(abs(run.last("rest: least Hencky strain")),
                           abs(run.last("rest: greatest Hencky strain"))), 1e-12)


@case("Stressed disc turned by 360°", short=False)
def disc(book):
    source = "u = ∇ Re(x+iy)³, turned"
    point, mean = "strain: error", "strain: error of cell means"
    levels = book.levels((2, 3, 4), (2, 3))

    def runs(extra):
        return [book.run("rotating-disc", [f"{REFINEMENTS}{k}"]
                         + steps(0.05 / 2 ** (k - 2)) + extra(k)) for k in levels]

    still = runs(lambda k: [])
    after = [run.last(point) for run in still]
    loaded = [run.history[point][run.history["time [T]"].index(0.05)] for run in still]
    book.below("change of the relative strain error by the turn, Lagrangian",
               "objectivity", after[-1] - loaded[-1], 1e-9)
    run = still[-1]
    first = run.history["time [T]"].index(0.05)
    scale = run.history["stress: greatest"][first]
    for kind in ("least", "greatest"):
        column = run.history[f"stress: {kind}"]
        book.below(f"change of the {kind} von Mises stress by the turn, Lagrangian, over "
                   "the greatest", "objectivity", (column[-1] - column[first]) / scale, 1e-9)
    zero = "0 (relative L2 error)"
    for title, column, least in (("at quadrature points", point, 0.9),
                                 ("cell means", mean, 1.8)):
        errors = [run.last(column) for run in still]
        book.converging(f"strain, {title}, Lagrangian", zero, source, errors, least,
                        errors=errors)
    for o, scheme in SCHEMES.items():
        errors = [run.last(mean) for run in runs(
            lambda k: [scheme] + every_30_degrees(0.05, k))]
        book.converging(f"strain, cell means, remeshed every 30°, order {o}", zero,
                        source, errors, 0.9 * o, errors=errors)
    for o, scheme in SCHEMES.items():
        errors = [run.last(mean) for run in runs(lambda k: [scheme] + HELD)]
        book.converging(f"strain, cell means, mesh held, order {o}", zero, source,
                        errors, 0.9 * o, errors=errors)


@case("Twisted ring turned by 360°", short=False)
def ring(book):
    moment, mean = "outer: moment [N mm]", "strain: error of cell means"
    exact = 2 * math.pi * 2 * 1000 / 2.6 * 1e-4 / 3
    source = "M = 4πμ·10⁻⁴/3, linear elasticity"
    levels = book.levels((1, 2, 3, 4), (1, 2))

    def runs(extra):
        return [book.run("twisted-ring", [f"{REFINEMENTS}{k}"]
                         + steps(0.05 / 2 ** (k - 1)) + extra) for k in levels]

    still = runs(["Rezoning/Names="])
    before = still[-1].history[moment][still[-1].history["time [T]"].index(0.05)]
    book.near("moment after the turn, Lagrangian [N mm]", before, "before the turn",
              still[-1].last(moment), 1e-9)
    book.converging("moment, Lagrangian [N mm]", exact, source,
                    [run.last(moment) for run in still], 1.8)
    for o, scheme in SCHEMES.items():
        found = runs([scheme])
        book.converging(f"moment, mesh held, order {o} [N mm]", exact, source,
                        [run.last(moment) for run in found], 0.9 * o)
        errors = [run.last(mean) for run in found]
        book.converging(f"strain, cell means, mesh held, order {o}",
                        "0 (relative L2 error)", "e_rt = 10⁻⁴/(3r²)", errors,
                        0.9 * o, errors=errors)
