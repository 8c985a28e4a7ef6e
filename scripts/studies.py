# SPDX-License-Identifier: LGPL-2.1-or-later
"""Key numbers of many runs of the academic case.

studies.py csv OUT FILE writes one row for each folder OUT/NAME with a
history.csv into FILE; studies.py density OUT REFERENCE NAME... prints how far
the final densities of the runs differ from those of the run REFERENCE.
Needs the standard library only.
"""
import array
import base64
import csv
import json
import os
import re
import struct
import sys
import zlib

FORCE_AT = (1, 2, 2.6, 4, 5, 5.25, 10.5)  # displacement of the tooth [mm]
MASS_AT = (1, 2.6, 5.25, 10.5)


# Histories


def read_history(folder):
    """Columns by name (without the unit), only complete rows."""
    with open(os.path.join(folder, "history.csv"), newline="") as file:
        rows = list(csv.reader(file))
    names = [name.split(" [")[0] for name in rows[0]]
    rows = [[float(v) for v in row] for row in rows[1:] if len(row) == len(names)]
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}


def at(history, name, displacement):
    """Linear interpolation in the displacement; None beyond the end."""
    x, y = history["tooth displacement"], history[name]
    for i in range(1, len(x)):
        if x[i] >= displacement - 1e-6:
            part = (displacement - x[i - 1]) / (x[i] - x[i - 1])
            return y[i - 1] + part * (y[i] - y[i - 1])
    return None


# Fields


def arrays(name):
    """The zlib-compressed arrays of a VTU file of one piece."""
    with open(name) as file:
        text = file.read()
    pattern = r'<DataArray type="(\w+)"([^>]*)format="binary">\s*([^<]*)</DataArray>'
    codes = {"Float32": "f", "Float64": "d", "Int32": "i", "UInt8": "B"}
    result = {}
    for kind, attributes, data in re.findall(pattern, text):
        data = data.strip()
        blocks, size, last, _ = struct.unpack("<4I", base64.b64decode(data[:24])[:16])
        if blocks != 1:
            raise ValueError(f"{name}: more than one block")
        values = array.array(codes[kind])
        values.frombytes(zlib.decompress(base64.b64decode(data[24:])))
        found = re.search(r'Name="([^"]*)"', attributes)
        result[found.group(1) if found else "points"] = values
    return result


def last_state(folder):
    """Corners of the cells in cyclic order and values of `density`, or None.

    Data of cells stand at the four points that each cell has for itself.
    """
    names = sorted(n for n in os.listdir(folder) if n.endswith(".vtu"))
    if len(names) < 2:
        return None
    data = arrays(os.path.join(folder, names[-1]))
    if "density" not in data:
        return None
    p, c, rho = data["points"], data["connectivity"], data["density"]
    cells = [[(p[3 * k], p[3 * k + 1]) for k in c[4 * i:4 * i + 4]]
             for i in range(len(c) // 4)]
    return cells, [rho[c[4 * i]] for i in range(len(cells))]


def chequered(cells, rho):
    """Mean over the cells of |rho - mean of the edge neighbours' rho|,
    relative to the range of rho: about 1/2 for a chessboard, of the order of
    the mesh size for a smooth field."""
    owners = {}
    for i, corners in enumerate(cells):
        keys = [(round(x, 3), round(y, 3)) for x, y in corners]
        for a in range(4):
            edge = frozenset((keys[a], keys[(a + 1) % 4]))
            owners.setdefault(edge, []).append(i)
    neighbours = [[] for _ in cells]
    for pair in owners.values():
        if len(pair) == 2:
            neighbours[pair[0]].append(rho[pair[1]])
            neighbours[pair[1]].append(rho[pair[0]])
    width = max(rho) - min(rho)
    if width < 1e-6:
        return 0.0
    return sum(abs(r - sum(n) / len(n)) for r, n in zip(rho, neighbours)
               if n) / len(cells) / width


def area(corners):
    return 0.5 * sum(corners[a - 1][0] * corners[a][1]
                     - corners[a][0] * corners[a - 1][1] for a in range(4))


def sampled(state, step=0.5, window=(-20, 40, -30, 0)):
    """Density at the points of a grid around the root; None outside."""
    cells, rho = state
    x0, x1, y0, y1 = window
    result = {}
    for corners, value in zip(cells, rho):
        xs, ys = [x for x, _ in corners], [y for _, y in corners]
        i0, i1 = int((max(min(xs), x0)) // step), int(min(max(xs), x1) // step)
        j0, j1 = int((max(min(ys), y0)) // step), int(min(max(ys), y1) // step)
        for i in range(i0, i1 + 1):
            for j in range(j0, j1 + 1):
                x, y = (i + 0.5) * step, (j + 0.5) * step
                sides = [(corners[a][0] - corners[a - 1][0]) * (y - corners[a - 1][1])
                         - (corners[a][1] - corners[a - 1][1]) * (x - corners[a - 1][0])
                         for a in range(4)]
                if min(sides) >= 0 or max(sides) <= 0:
                    result[i, j] = value
    return result


# Tables


def row_of(folder):
    history = read_history(folder)
    summary, code = {}, ""
    name = os.path.join(folder, "summary.json")
    if os.path.exists(name):
        with open(name) as file:
            summary = json.load(file)
    name = os.path.join(folder, "exit-code")
    if os.path.exists(name):
        with open(name) as file:
            code = file.read().strip()
    if not summary and not code:
        return None  # still running
    end = {n: v[-1] for n, v in history.items()}
    row = {"name": os.path.basename(folder), "exit code": code,
           "completed": summary.get("completed", False),
           "cells": summary.get("cells"),
           "end [T]": end["time"],
           "end displacement [mm]": end["tooth displacement"]}
    for d in FORCE_AT:
        row[f"force {d} [N]"] = at(history, "force x", d)
    if "bone mass" in history:
        row["mass 0 [mg]"] = history["bone mass"][0]
        for d in MASS_AT:
            row[f"mass {d} [mg]"] = at(history, "bone mass", d)
        row["least density [g/cc]"] = end["least density"]
        row["greatest density [g/cc]"] = end["greatest density"]
        row["points at least density"] = end["points at least density"]
        row["points at greatest density"] = end["points at greatest density"]
        row["largest mass balance"] = max(map(abs, history["bone mass balance"]))
    row["initial scaled Jacobian"] = history["smallest scaled Jacobian"][0]
    row["smallest scaled Jacobian"] = min(history["smallest scaled Jacobian"])
    row["most inverted corners"] = max(history["inverted corners"])
    inverted = [d for d, n in zip(history["tooth displacement"],
                                  history["inverted corners"]) if n > 0]
    row["first inverted corner [mm]"] = inverted[0] if inverted else None
    row["steps"] = summary.get("steps", len(history["time"]))
    row["Newton iterations per step"] = summary.get("Newton iterations per step")
    row["rejected attempts"] = sum(history["rejected attempts"]) \
        if "rejected attempts" not in summary else summary["rejected attempts"]
    for which in ("smallest interface strain", "largest interface strain",
                  "largest interface shear"):
        values = history.get("tooth: " + which)
        if values:
            row[which] = (min if which.startswith("small") else max)(values)
    row["wall time [s]"] = summary.get("wall time [s]")
    row["peak memory [MB]"] = summary.get("peak memory [kB]", 0) / 1024
    state = last_state(folder)
    if state:
        row["chequered density"] = chequered(*state)
    row["reason"] = summary.get("reason", "stopped at the wall time limit"
                                if code == "124" else "no summary")
    return row


def write_csv(out, target):
    rows = []
    for name in sorted(os.listdir(out)):
        folder = os.path.join(out, name)
        if os.path.exists(os.path.join(folder, "history.csv")):
            row = row_of(folder)
            if row:
                rows.append(row)
    columns = []
    for row in sorted(rows, key=len, reverse=True):
        columns += [c for c in row if c not in columns]
    with open(target, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for row in rows:
            writer.writerow([f"{v:.6g}" if isinstance(v, float) else
                             "" if v is None else v
                             for v in (row.get(c) for c in columns)])


def block_means(samples, width=4):
    """Means over squares of so many grid points, those entirely inside."""
    sums = {}
    for (i, j), value in samples.items():
        sums.setdefault((i // width, j // width), []).append(value)
    return {k: sum(v) / len(v) for k, v in sums.items() if len(v) == width ** 2}


def mean_difference(first, other):
    both = [k for k in first if k in other]
    return sum(abs(first[k] - other[k]) for k in both) / len(both)


def compare_density(out, reference, names):
    """Mean |difference| of the final densities around the root, at points and
    of means over squares of 2 mm, which cells do not blur [g/cc]."""
    first = sampled(last_state(os.path.join(out, reference)))
    for name in names:
        other = sampled(last_state(os.path.join(out, name)))
        print(f"{name:36s} points {mean_difference(first, other):.4f}  squares "
              f"{mean_difference(block_means(first), block_means(other)):.4f}")


def main():
    if len(sys.argv) == 4 and sys.argv[1] == "csv":
        write_csv(sys.argv[2], sys.argv[3])
    elif len(sys.argv) >= 5 and sys.argv[1] == "density":
        compare_density(sys.argv[2], sys.argv[3], sys.argv[4:])
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
