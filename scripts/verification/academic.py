# SPDX-License-Identifier: LGPL-2.1-or-later
"""The academic case (tied, remodelling) with transfer of both orders, three steps
and two meshes, against a run that is finer in mesh and step."""
import os
import sys

from book import case
from elasticity import SCHEMES, steps

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import studies  # noqa: E402  (reads fields)

FORCE, WAY = "force x [N]", "tooth displacement [mm]"


def at(run, column, way):
    x, y = run.history[WAY], run.history[column]
    for i in range(1, len(x)):
        if x[i] >= way - 1e-9:
            f = (way - x[i - 1]) / (x[i] - x[i - 1])
            return y[i - 1] + f * (y[i] - y[i - 1])
    raise ValueError("the tooth did not get so far")


def criterion(run, number):
    """The remodelling criterion (signed energy density) on a grid around the root."""
    data = studies.arrays(os.path.join(run.folder, f"fields-{number:05d}.vtu"))
    p, c, values = data["points"], data["connectivity"], data["stimulus"]
    cells = [[(p[3 * k], p[3 * k + 1]) for k in c[4 * i:4 * i + 4]]
             for i in range(len(c) // 4)]
    means = [sum(values[k] for k in c[4 * i:4 * i + 4]) / 4 for i in range(len(cells))]
    return studies.sampled((cells, means), step=0.25)


def distance(a, b):
    """Sum of |a - b| over that of |b|, where both are known."""
    both = [k for k in b if k in a]
    return sum(abs(a[k] - b[k]) for k in both) / sum(abs(b[k]) for k in both)


@case("Academic case", short=False, long=True)
def academic(book):
    def run(density, step, o):
        return book.run("academic-tied", [
            f"Mesh/tooth in block/Mesh density={density}"] + steps(step) + [
            SCHEMES[o], "Remodelling/Maximum density change=10",
            "Output/Field interval=73"], fields=True)

    ways = [0.5 * i for i in range(1, 22)]
    finest = run(4, 0.5, 2)
    reference = [at(finest, FORCE, w) for w in ways]
    fields = {i: criterion(finest, i) for i in (2, 5)}
    source = "3931 cells, steps of 0.5 T, order 2"
    for density, mesh in ((0.5, "h (493 cells)"), (2, "h/2 (1973 cells)")):
        own = [at(run(density, 0.5, 2), FORCE, w) for w in ways]
        for step, name in ((2, "T"), (1, "T/2"), (0.5, "T/4")):
            for o in SCHEMES:
                found = run(density, step, o)
                force = [at(found, FORCE, w) for w in ways]
                title = f"{mesh}, step {name}, order {o}"
                book.measured(f"{title}: force at 10.5 mm [N]", force[-1], reference[-1],
                              source, force[-1] / reference[-1] - 1)
                for against, values, what in (
                        ("the finest run", reference, source),
                        ("the best run on this mesh", own, "steps T/4, order 2")):
                    largest = max(abs(a - b) for a, b in zip(force, values)) \
                        / max(map(abs, values))
                    book.measured(f"{title}: largest difference of the force to "
                                  f"{against}, relative", largest, 0.0, what, largest)
                for i, place in ((2, "146 T, 4.2 mm"), (5, "365 T, 10.5 mm")):
                    size = distance(criterion(found, i), fields[i])
                    book.measured(f"{title}: criterion at {place}, L1 difference around "
                                  "the root, relative", size, 0.0, source, size)
