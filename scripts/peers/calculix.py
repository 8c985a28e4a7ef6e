# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Lagrangian academic case without remodelling in CalculiX.

calculix.py [--element CPE4|CPE8] [--elastic] [--travel MM] [--increments N]
            [--residual R] [--binary FILE] [--out DIR]

runs prm/verification/academic-tied-undamaged.prm without rezoning in Alveolus
for N equal increments of travel, exports its mesh, supports and material as an
input deck of CalculiX (`ccx`, Debian's calculix-ccx), runs that with the same
increments, and writes the two force curves side by side (force.csv) and the
processor seconds of both (timing.csv) into DIR (default output/peers/...). One
thread each. Needs Debian's python3-vtk9 to read the mesh.

The deck: plane strain elements of CalculiX on the same nodes; J2 plasticity with
linear isotropic hardening and NLGEOM; *STATIC, DIRECT; the root moves with the
tooth. R is CalculiX's bound of the largest residual force over the mean one.
"""
import argparse
import csv
import json
import math
import os
import re
import resource
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(
    os.path.abspath(__file__))))
SCENE = "prm/verification/academic-tied-undamaged.prm"
YOUNG, POISSON, YIELD, HARDENING = 13750.0, 0.3, 200.0, 723.7
RATE = 10.5 / 365.0  # travel of the tooth [mm/T]


def run(command, log, **options):
    """Run it, output into a file; returns (processor seconds, exit code)."""
    environment = dict(os.environ, OMP_NUM_THREADS="1",
                       OPENBLAS_NUM_THREADS="1")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(log, "w") as stream:
        code = subprocess.run(command, stdout=stream, stderr=subprocess.STDOUT,
                              env=environment, **options).returncode
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (after.ru_utime + after.ru_stime - before.ru_utime -
            before.ru_stime), code


def alveolus(arguments, folder):
    end = arguments.travel / RATE
    step = repr(end / arguments.increments)
    settings = ["Rezoning/Names=", f"Time/End={end!r}",
                f"Time/Initial step={step}", f"Time/Maximum step={step}",
                f"Time/Minimum step={step}",
                "Regions/bone/Volumetric treatment=" + arguments.treatment,
                "Mesh/Degree=" + ("2" if arguments.element == "CPE8" else "1"),
                "Output/Field interval=0", "Checkpoint/Write=false"]
    if arguments.elastic:
        settings.append("Materials/bone/Plasticity=false")
    command = [arguments.binary, "--quiet", "--threads", "1", "--output",
               folder] + [part for s in settings for part in ("--set", s)]
    seconds, code = run(command + [os.path.join(ROOT, SCENE)],
                        folder + ".log")
    if code == 2:
        sys.exit(f"{arguments.binary} refused the scene, see {folder}.log")
    return seconds


def read_mesh(folder, quadratic):
    """Nodes [(x, y)] and cells (node numbers in CalculiX's order) of the first
    fields, where every cell has nodes of its own."""
    import vtk
    name = sorted(f for f in os.listdir(folder) if f.endswith(".vtu"))[0]
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(folder + "/" + name)
    reader.Update()
    grid = reader.GetOutput()
    numbers, nodes, cells = {}, [], []

    def number(x, y):
        key = (round(x, 7), round(y, 7))
        if key not in numbers:
            numbers[key] = len(nodes)
            nodes.append((x, y))
        return numbers[key]

    seen = set()
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        if cell.GetNumberOfPoints() != 4:
            sys.exit("the fields are not written as four-node cells")
        corners = [grid.GetPoint(cell.GetPointId(k))[:2] for k in range(4)]
        area = sum(corners[k][0] * corners[(k + 1) % 4][1] -
                   corners[(k + 1) % 4][0] * corners[k][1] for k in range(4))
        if area < 0:
            corners.reverse()
        cells.append([number(*p) for p in corners])
        seen.add(tuple(sorted(cells[-1])))
    assert len(seen) == len(cells)
    if quadratic:
        for cell in cells:
            cell += [number(*((nodes[cell[k]][i] + nodes[cell[(k + 1) % 4]][i])
                              / 2 for i in (0, 1))) for k in range(4)]
    return nodes, cells


def boundaries(nodes, cells):
    """Nodes of the base, the top, the ends and, what is left, the root."""
    edges = {}
    for cell in cells:
        for k in range(4):
            a, b = cell[k], cell[(k + 1) % 4]
            middle = [cell[4 + k]] if len(cell) == 8 else []
            edges.setdefault(frozenset((a, b)), []).append([a, b] + middle)
    boundary = [e[0] for e in edges.values() if len(e) == 1]
    low = min(y for _, y in nodes)
    high = max(y for _, y in nodes)
    left = min(x for x, _ in nodes)
    right = max(x for x, _ in nodes)

    def on(edge, axis, value):
        return all(abs(nodes[n][axis] - value) < 1e-6 for n in edge)

    sets = {"base": set(), "top": set(), "ends": set(), "root": set()}
    for edge in boundary:
        if on(edge, 1, low):
            sets["base"].update(edge)
        elif on(edge, 1, high):
            sets["top"].update(edge)
        elif on(edge, 0, left) or on(edge, 0, right):
            sets["ends"].update(edge)
        else:
            sets["root"].update(edge)
    return sets


def write_deck(arguments, nodes, cells, sets, name):
    def listed(values, width=12):
        values = [str(v + 1) for v in sorted(values)]
        return ",\n".join(", ".join(values[i:i + width])
                          for i in range(0, len(values), width))

    lines = ["*HEADING", "Academic case, Lagrangian, no remodelling, tied",
             "*NODE, NSET=ALL"]
    lines += [f"{n + 1}, {x!r}, {y!r}, 0." for n, (x, y) in enumerate(nodes)]
    lines.append(f"*ELEMENT, TYPE={arguments.element}, ELSET=BONE")
    lines += [f"{c + 1}, " + ", ".join(str(n + 1) for n in cell)
              for c, cell in enumerate(cells)]
    for key, members in sets.items():
        lines += [f"*NSET, NSET={key.upper()}", listed(members)]
    lines += ["*MATERIAL, NAME=BONE", "*ELASTIC", f"{YOUNG}, {POISSON}"]
    if not arguments.elastic:
        lines += ["*PLASTIC", f"{YIELD}, 0.",
                  f"{YIELD + 10.0 * HARDENING}, 10."]
    lines += ["*SOLID SECTION, ELSET=BONE, MATERIAL=BONE", "1.",
              "*BOUNDARY", "BASE, 1, 2"]
    lines += [f"{n + 1}, 2, 2" for n in sorted(sets["top"] - sets["root"])]
    lines += [f"{n + 1}, 1, 1" for n in sorted(sets["ends"] - sets["base"])]
    lines += ["*STEP, NLGEOM, INC=100000",
              "*STATIC, DIRECT" + (f", SOLVER={arguments.solver}"
                                   if arguments.solver else ""),
              f"{1.0 / arguments.increments!r}, 1.",
              "*CONTROLS, PARAMETERS=FIELD",
              f"{arguments.residual}, {math.sqrt(arguments.residual)}",
              "*BOUNDARY", "ROOT, 2, 2", f"ROOT, 1, 1, {arguments.travel!r}",
              "*NODE PRINT, NSET=ROOT, TOTALS=ONLY", "RF", "*END STEP", ""]
    with open(name + ".inp", "w") as stream:
        stream.write("\n".join(lines))


def read_totals(name):
    """[(time, force x)] from the printed totals."""
    with open(name + ".dat") as stream:
        text = stream.read()
    rows = []
    for match in re.finditer(r"total force .*? time\s+(\S+)\s*\n\s*\n"
                             r"\s*(\S+)\s+(\S+)\s+(\S+)", text):
        rows.append((float(match.group(1)), float(match.group(2))))
    return rows


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--element", choices=("CPE4", "CPE8"), default="CPE4")
    parser.add_argument("--treatment", default="none",
                        choices=("none", "mean dilatation"))
    parser.add_argument("--elastic", action="store_true")
    parser.add_argument("--travel", type=float, default=2.0)
    parser.add_argument("--increments", type=int, default=70)
    parser.add_argument("--residual", type=float, default=1e-8)
    parser.add_argument("--solver", default="")
    parser.add_argument("--binary", default=ROOT + "/build/alveolus")
    parser.add_argument("--out", default=ROOT + "/output/peers/calculix")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    ours = arguments.out + "/alveolus"
    theirs = arguments.out + "/deck"

    ours_seconds = alveolus(arguments, ours)
    nodes, cells = read_mesh(ours, arguments.element == "CPE8")
    sets = boundaries(nodes, cells)
    write_deck(arguments, nodes, cells, sets, theirs)
    theirs_seconds, code = run(["ccx", "-i", "deck"], theirs + ".log",
                               cwd=arguments.out)

    with open(ours + "/history.csv") as stream:
        history = list(csv.DictReader(stream))
    with open(ours + "/summary.json") as stream:
        summary = json.load(stream)
    peer = {round(t * arguments.increments): f for t, f in read_totals(theirs)}
    if not peer:
        sys.exit(f"ccx gave no result (exit code {code}), see {theirs}.log")
    with open(theirs + ".log") as stream:
        iterations = len(re.findall(r"^ *iteration +\d+", stream.read(),
                                    re.MULTILINE))
    rows = []
    for row in history:
        travel = float(row["time [T]"]) * RATE
        n = round(travel / arguments.travel * arguments.increments)
        if n in peer:
            rows.append((travel, float(row["force x [N]"]), peer[n]))
    with open(arguments.out + "/force.csv", "w") as stream:
        writer = csv.writer(stream)
        writer.writerow(["travel [mm]", "Alveolus [N]", "CalculiX [N]"])
        writer.writerows(rows)
    difference = max(abs(b / a - 1.0) for _, a, b in rows)
    n_ours, n_theirs = summary["steps"], len(peer)
    table = {
        "element": arguments.element, "treatment": arguments.treatment,
        "elastic": arguments.elastic, "cells": len(cells),
        "nodes": len(nodes), "travel [mm]": rows[-1][0],
        "largest difference of force": difference,
        "last difference of force": rows[-1][2] / rows[-1][1] - 1.0,
        "Alveolus increments": n_ours,
        "Alveolus Newton iterations": summary["Newton iterations"],
        "Alveolus CPU [s]": ours_seconds,
        "CalculiX increments": n_theirs,
        "CalculiX iterations": iterations,
        "CalculiX CPU [s]": theirs_seconds,
        "ratio per increment":
            (theirs_seconds / n_theirs) / (ours_seconds / n_ours)}
    with open(arguments.out + "/timing.csv", "w") as stream:
        writer = csv.writer(stream)
        writer.writerow(table.keys())
        writer.writerow(table.values())
    for key, value in table.items():
        print(f"{key}: {value}")


if __name__ == "__main__":
    main()
