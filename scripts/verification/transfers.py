# SPDX-License-Identifier: LGPL-2.1-or-later
"""Transfer of history: numbers that the unit tests record."""
from book import case, order

WAYS = {"swept": "same connectivity", "overlap": "between meshes"}


@case("Transfer", short=False)
def suite(book):
    found = {}
    for name in ("transfer_second_order", "transfer_limited"):
        found.update(book.runner.unit_test(
            name, "LimitedLinear.*",
            () if book.short else (("ALVEOLUS_FINE_TRANSFER", "1"),)))
    linear = found["LimitedLinear.LinearFieldIsExact"]
    book.below("linear field of sub-cell means, affine moves, order 2, largest relative "
               "error (2D, 3D, degree 1, 2)", "linear functions are reproduced",
               max(v for k, v in linear.items() if k != "passed"), 1e-12)
    shift = found["LimitedLinear.ExactShift"]
    book.below("shift by whole sub-cells, order 2, largest error", "the field itself",
               max(shift["swept"], shift["overlap"]), 1e-12)
    turned = found["LimitedLinear.TurnedScene"]
    book.below("scene turned by 37°, largest difference to the turned result (2D, 3D, "
               "scalars and tensors, orders 1 and 2)", "turned result",
               max(v for k, v in turned.items() if k != "passed"), 1e-12)
    orders = found["LimitedLinear.ObservedOrder"]
    cells = (8, 16, 32) if book.short else (8, 16, 32, 64)
    for way, what in WAYS.items():
        for o, least in ((1, 0.9), (2, 1.8)):
            errors = [orders[f"{way} {o} {n}"] for n in cells]
            book.converging(f"vortex motion, x + 2y and a sine bump, {what}, order {o}, "
                            "L1 error", "0", "the field itself", errors, least,
                            errors=errors)
    book.below("the same, largest drift of the content of one transfer", "conservation",
               max(v for k, v in orders.items() if k.endswith("drift")), 1e-13)
    book.below("the same, largest step beyond the old extrema", "bounds",
               max(v for k, v in orders.items() if k.endswith("beyond")), 1e-14)
    for name in ("ContentAndBounds", "ThousandTransfers", "RegionsNeverMix"):
        book.add(f"unit test LimitedLinear.{name}", "", "see the test",
                 "passed" if found[f"LimitedLinear.{name}"]["passed"] else "failed",
                 None, None, "passes", found[f"LimitedLinear.{name}"]["passed"])


@case("Slotted disc, cone and hump", short=False)
def slotted_disc(book):
    levels = (2, 3) if book.short else (2, 3, 4)
    runs = [book.runner.unit_test("transfer_rotation", "*", (
        ("ALVEOLUS_ROTATION_LEVELS", str(k)),
        ("ALVEOLUS_ROTATION_OUTPUT", book.runner.out))) for k in levels]
    for way, what in WAYS.items():
        tests = [run["Rotation." + way.capitalize()] for run in runs]
        for o in (1, 2):
            errors = [t[f"{way} {o} error"] for t in tests]
            book.measured(f"{what}, order {o}, L1 error/content", errors[-1], 0.0,
                          "LeVeque (1996), initial state", errors[-1],
                          order(errors[-2], errors[-1]))
            for body, height in (("disc", 1.0), ("cone", 1.0), ("hump", 0.5)):
                kept = tests[-1][f"{way} {o} {body}"]
                book.measured(f"{what}, order {o}, maximum of the {body}", kept, height,
                              "LeVeque (1996), initial state", kept - height)
            book.below(f"{what}, order {o}, largest drift of the content of one transfer",
                       "conservation", max(t[f"{way} {o} drift"] for t in tests), 1e-13)
            book.below(f"{what}, order {o}, least value below 0", "bounds",
                       min(0.0, min(t[f"{way} {o} minimum"] for t in tests)), 1e-14)


@case("History width")
def width(book):
    """Bytes that a cell of four points keeps, old and trial values."""
    # Numbers of a point, points of a cell
    sources = {"thick-cylinder": ("elastic (Hencky), plane strain", 4, 4),
               "thick-cylinder-rubber": ("Mooney–Rivlin, plane strain", 4, 4),
               "cook-membrane-plane-strain": ("neo-Hookean, plane strain", 4, 4),
               "cook-membrane": ("neo-Hookean, 3D", 6, 8),
               "ligament-uniaxial": ("ligament (Valanis–Landel), 3D", 6, 8),
               "necking": ("elastoplastic, not remodelled", 5, 4),
               "academic-tied-undamaged": ("bone, not remodelled", 5, 4),
               "academic-omega0": ("bone, density remodelled", 6, 4),
               "academic-tied": ("bone, density and fabric remodelled", 10, 4)}
    for scene, (name, values, points) in sources.items():
        settings = []
        if scene == "academic-omega0":
            scene = "academic-tied"
            settings = ["Remodelling/mechanostat/Degree of anisotropy=0"]
        exact = 8.0 * 2 * points * values
        for region, count in book.runner.history_bytes(scene, settings).items():
            book.add(f"{name} ({scene}: {region}) [bytes per cell]", exact,
                     f"{values} numbers × {points} points × 2 states × 8 bytes",
                     float(count), count - exact, None, "equal", count == exact)
