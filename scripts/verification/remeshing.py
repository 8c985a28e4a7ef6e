# SPDX-License-Identifier: LGPL-2.1-or-later
"""Twenty remeshes in a row."""
from book import case
from elasticity import A, B, REFINEMENTS, SCHEMES, steps


def times(start, end, n=20):
    return "Remeshing/Times=" + ", ".join(
        f"{start + (end - start) * i / n:.10g}" for i in range(n))


@case("Twenty remeshes in a row", short=False)
def twenty(book):
    # A uniform state: the bar while it is drawn, elastically and plastically
    uniform = ["Mesh/grid generator/Map=x; y", "Mesh/grid generator/Arguments=20, 10 : "
               "0, 0 : 26.667, 6.413 : true", "Mesh/grid generator/Point names=neck: 0, "
               "6.413; end: 26.667, 6.413", "Time/End=0.4"] + steps(0.02)
    gmsh = ["Remeshing/Type=outline", "Remeshing/outline/Largest edges=bar: 1.1"]
    still = book.run("necking", uniform)
    force = "grip: force x [N]"
    for o, scheme in SCHEMES.items():
        run = book.run("necking", uniform + gmsh + [scheme, times(0.0, 0.4)])
        book.near(f"uniform bar drawn with 20 remeshes (unstructured), order {o}: force "
                  "at 6.4 % [N]", still.last(force), "the same without", run.last(force),
                  1e-9)
        area = run.remeshes()["relative change of bar"]
        book.below("the same, largest relative change of area", "outlines stay",
                   max(map(abs, area)), 1e-12)

    # A stressed cylinder at rest under constant pressure
    base = ["Conditions/pressure/Function=0.4282284090965*min(t,1)",
            "Materials/rubber/Bulk modulus=100", "Time/End=2", f"{REFINEMENTS}3"] \
        + steps(0.05)
    outline = ["Remeshing/Type=outline", "Remeshing/outline/Largest edges=wall: 0.1"]
    reaction = ["Records/Names=A, B, held", "Records/held/Type=resultant",
                "Records/held/On=side y", "Records/held/Components=y"]
    still = book.run("thick-cylinder-rubber", base + reaction)
    # By equilibrium of the quarter, the plane carries p times the inner radius
    held = "held: force y [N]"
    for o, scheme in SCHEMES.items():
        run = book.run("thick-cylinder-rubber", base + reaction + outline
                       + [scheme, times(1.0, 2.0)])
        remeshes = run.remeshes()
        book.add(f"cylinder at rest, order {o}: remeshes", 20.0, "as planned",
                 float(len(remeshes["time [T]"])), None, None, "equal",
                 len(remeshes["time [T]"]) == 20)
        book.measured(f"the same, drift of the area, sum of 20",
                      sum(remeshes["relative change of wall"]), 0.0, "outlines stay")
        for column, name in ((A, "u inner wall [mm]"), (B, "u outer wall [mm]"),
                             (held, "resultant on a plane of symmetry [N]")):
            book.measured(f"the same, {name}", run.last(column), still.last(column),
                          "the same without remeshes",
                          run.last(column) / still.last(column) - 1)
    if not book.short:
        found = book.runner.unit_test("remeshing_outline", "*TwentyRemeshesAtRest")
        good = found["OutlineRemesher.TwentyRemeshesAtRest"]["passed"]
        book.add("unit test OutlineRemesher.TwentyRemeshesAtRest (three regions with "
                 "named points and pieces)", "", "names, points and corners as before, "
                 "areas and lengths to 10⁻¹²", "passed" if good else "failed", None,
                 None, "passes", good)
