# SPDX-License-Identifier: LGPL-2.1-or-later
"""Elastic bodies with closed or published solutions: on the Lagrangian mesh,
with ALE, and with a remesh in the middle."""
import math

from book import case

REFINEMENTS = "Mesh/grid generator/Refinements="
DEGREE = "Mesh/Degree="
FULL = "Regions/wall/Volumetric treatment=none"
A, B = "A: displacement x [mm]", "B: displacement x [mm]"


def steps(size):
    return [f"Time/Initial step={size}", f"Time/Maximum step={size}"]


def remeshed(blocks, edge, time=0.5):
    """One remesh with edges of another length."""
    return ["Remeshing/Type=structured", f"Remeshing/Times={time}",
            f"Remeshing/structured/Blocks={blocks}",
            f"Remeshing/structured/Edge length={edge:.10g}"]


def giuliani(region):
    """Giuliani's rule, towards cells of the same shape and size."""
    return ["Rezoning/Names=inside", "Rezoning/inside/Type=Giuliani",
            f"Rezoning/inside/On={region}", "Rezoning/inside/Shapes=equal"]


SCHEMES = {1: "Transfer/Scheme=Godunov", 2: "Transfer/Scheme=limited linear"}


def family(book, name, scene, column, exact, source, levels, variants,
           least_order=1.9):
    """The Lagrangian mesh, and VARIANTS of it (ALE, one remesh) with transfer
    of both orders: convergence of each, and the difference to the Lagrangian
    run of the finest mesh against the error of that mesh.

    LEVELS: settings of each mesh; VARIANTS: name -> list of further settings
    for each level."""
    def values(extra):
        return [book.run(scene, mesh + more).last(column)
                for mesh, more in zip(levels, extra)]

    lagrangian = values([["Rezoning/Names="]] * len(levels))
    error = book.converging(f"{name}, Lagrangian", exact, source, lagrangian,
                            least_order)[-1] * abs(exact)
    for variant, extra in variants.items():
        for o, scheme in SCHEMES.items():
            if book.short and o == 1:
                continue
            found = values([more + [scheme] for more in extra])
            book.converging(f"{name}, {variant}, transfer order {o}", exact,
                            source, found, min(0.9 * o, least_order))
            book.within(f"{name}, {variant}, transfer order {o}, against Lagrangian",
                        lagrangian[-1], "Lagrangian run, same mesh", found[-1],
                        abs(error), "the error of the mesh")


@case("Thick elastic cylinder")
def thick_cylinder(book):
    # So small that the nonlinear terms, of the relative order p/E, stay below
    # the error of the meshes; round-off of strains, 1e-16/1e-7, as well
    E, nu, p = 1000.0, 0.3, 1e-4
    pressure = ["Conditions/pressure/Function=1e-4*t", "Solver/Tolerance=1e-8"]
    source = "Lamé: u = p(1+ν)/(3E) ((1−2ν) r + 4/r)"

    def lame(r):
        return p * (1 + nu) / (3 * E) * ((1 - 2 * nu) * r + 4 / r)

    variants = (("degree 1", [], 1, 1.9, 2e-3),
                ("degree 1, full integration", [FULL], 1, 1.9, 4e-3),
                ("degree 2", [DEGREE + "2"], 0, 3.0, 5e-5))
    for name, settings, first, least, error in variants:
        levels = [first + i for i in book.levels(range(4), range(3))]
        for column, r, place in ((A, 1.0, "inner"), (B, 2.0, "outer")):
            u = [book.run("thick-cylinder", pressure + settings + [f"{REFINEMENTS}{k}"]).last(column)
                 for k in levels]
            book.converging(f"u {place} wall, {name} [mm]", lame(r), source, u,
                            least, error)

    # Four load steps; the remesh at half the load takes shorter edges.
    ks = book.levels((2, 3, 4, 5), (2, 3))
    family(book, "u inner wall [mm]", "thick-cylinder", A, lame(1.0), source,
           [pressure + steps(0.25) + [f"{REFINEMENTS}{k}"] for k in ks],
           {"ALE": [giuliani("wall")] * len(ks),
            "one remesh": [remeshed("wall", 0.8 / 2**k) for k in ks]})


def mooney_pressure(a, shear):
    """Pressure that draws an incompressible Mooney-Rivlin cylinder, plane
    strain, from the radii 1 and 2 to the inner radius a: equilibrium is
    dσ_r/dr = (σ_θ − σ_r)/r, σ_θ − σ_r = 2 (c1+c2) (l² − l⁻²), l = r/R."""
    c, n, total = a * a - 1.0, 2000, 0.0
    for i in range(n + 1):  # Simpson's rule in R, dr = (R/r) dR
        R = 1.0 + i / n
        r = math.sqrt(R * R + c)
        l = r / R
        weight = (1 if i in (0, n) else 4 if i % 2 else 2) / (3 * n)
        total += weight * 2 * shear * (l * l - 1 / (l * l)) / r * (R / r)
    return total


@case("Thick rubber cylinder")
def rubber_cylinder(book):
    source = "incompressible Mooney–Rivlin: p = ∫ 2(c1+c2)(l²−l⁻²) dr/r, l = r/R"
    exact = mooney_pressure(1.5, 0.5)
    variants = (("degree 1", [], 1, 1.9, 1e-3),
                ("degree 2", [DEGREE + "2"], 0, 3.0, 1e-5))
    for name, settings, first, least, error in variants:
        p = [mooney_pressure(1 + book.run("thick-cylinder-rubber", settings + [
            f"{REFINEMENTS}{first + i}"]).last(A), 0.5)
            for i in book.levels(range(3), range(2))]
        book.converging(f"p of the radius reached, {name} [MPa]", exact, source, p,
                        least, error)
    locked = mooney_pressure(1 + book.run("thick-cylinder-rubber", [
        f"{REFINEMENTS}2", FULL]).last(A), 0.5)
    book.measured("the same with full integration, which locks [MPa]", locked,
                  exact, source, locked / exact - 1)

    # Rezoned after every step (Giuliani inside), or remeshed at half the load
    rezoned, ks = "thick-cylinder-rezoned", book.levels((1, 2, 3), (1, 2))
    rules = ["Rezoning/Names=walls, planes, inside"]
    for bulk in book.levels(("100", "1e5"), ("1e5",)):
        K = [f"Materials/rubber/Bulk modulus={bulk}"]
        limit, source = 0.5, "incompressible: the radius 1.5 mm"
        if bulk == "100":  # slightly compressible
            limit = book.run(rezoned, K + [
                DEGREE + "2", REFINEMENTS + "2", "Rezoning/Names="]).last(A)
            source = "degree 2 on 48 cells, Lagrangian"
        family(book, f"u inner wall, κ = {bulk} MPa [mm]", rezoned, A, limit, source,
               [K + [f"{REFINEMENTS}{k}"] for k in ks],
               {"ALE": [rules] * len(ks),
                "one remesh": [["Rezoning/Names="] + remeshed("wall", 0.8 / 2**k)
                               for k in ks]})


@case("Ring of two bonded materials", short=False)
def two_materials(book):
    p, a, c, b = 1e-4, 1.0, 1.5, 2.0
    inner, outer = (1000.0, 0.3), (100.0, 0.4)

    def u(material, ri, ro, pi, po, r):
        E, nu = material
        area = ro * ro - ri * ri
        return (1 + nu) / E * ((1 - 2 * nu) * (pi * ri * ri - po * ro * ro) / area * r
                               + (pi - po) * ri * ri * ro * ro / (area * r))

    # u is linear in the pressure q of the interface, and the same on both sides
    def gap(q):
        return u(inner, a, c, p, q, c) - u(outer, c, b, q, 0.0, c)
    q = -gap(0.0) * p / (gap(p) - gap(0.0))
    exact = {"A": u(inner, a, c, p, q, a), "I": u(inner, a, c, p, q, c),
             "B": u(outer, c, b, q, 0.0, b)}
    source = "Lamé for both materials, continuity of u and σ_r at the interface"
    ks = book.levels((0, 1, 2), (0, 1))

    def mesh(k):
        return [f"Mesh/grid generator/Arguments={8 * 2**k}, {12 * 2**k} : -1, 0 : 1, 1 : true"]
    for point, place in (("A", "inner wall"), ("I", "interface"), ("B", "outer wall")):
        column = f"{point}: displacement x [mm]"
        if point == "B":
            values = [book.run("two-material-ring", mesh(k)).last(column) for k in ks]
            book.converging(f"u {place} [mm]", exact[point], source, values, 1.9)
            continue
        family(book, f"u {place} [mm]", "two-material-ring", column, exact[point], source,
               [mesh(k) for k in ks],
               {"ALE": [giuliani("core, shell")] * len(ks),
                "one remesh": [remeshed("core, shell", 0.1 / 2**k) for k in ks]})


def membrane(n, plane=False):
    if plane:
        return f"Mesh/grid generator/Arguments={n}, {n} : 0, 0 : 48, 44 : true"
    return f"Mesh/grid generator/Arguments={n}, {n}, 1 : 0, 0, 0 : 48, 44, 1 : true"


@case("Cook's membrane")
def cook(book):
    source = ("Pelteret & McBride (2016), deal.II code gallery, "
              "doi 10.5281/zenodo.1228964")
    tip = "tip: displacement y [mm]"
    published = {1: {1: 5.15, 2: 8.72, 4: 12.02, 8: 13.61, 16: 14.13},
                 2: {1: 12.19, 2: 13.83, 4: 14.22}}
    for degree, values in published.items():
        for n, value in values.items():
            if book.short and n > 4 // degree:
                continue
            computed = book.run("cook-membrane", [membrane(n), f"{DEGREE}{degree}"]).last(tip)
            book.near(f"tip, {n} × {n} elements of degree {degree} [mm]", value,
                      source, computed, 0.0051, relative=False)
    if book.short:
        return
    # In plane strain, where remeshers work; the tip of degree 2 as limit
    plane = "cook-membrane-plane-strain"
    limit = book.run(plane, [membrane(32, True), DEGREE + "2"]).last(tip)
    source = "degree 2 on 32 × 32 elements, Lagrangian"
    ns = (8, 16, 32)
    family(book, "tip, plane strain [mm]", plane, tip, limit,
           "degree 2 on 32 × 32 elements, Lagrangian",
           [[membrane(n, True)] for n in ns],
           {"ALE": [giuliani("membrane")] * len(ns),
            "one remesh": [remeshed("membrane", 30.0 / n) for n in ns]},
           least_order=1.2)
