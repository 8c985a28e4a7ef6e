#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cost model of the academic case in three dimensions on many processes.

scaling_model.py [FOLDER] reads FOLDER/measured.csv and FOLDER/memory.csv (default:
doc/scaling), fits the model of doc/scaling.md by least squares, and writes
FOLDER/predicted.csv and FOLDER/scaling.png (the latter with gnuplot). Everything
beyond the measured sizes is a prediction. Needs the standard library only.
"""
import csv
import math
import os
import subprocess
import sys

# Assumptions about a cluster, none of them measured here
LATENCY = 3e-6  # of a message between nodes, with its software [s]
BANDWIDTH = 1e9  # of one process, with all others of its node sending [byte/s]
CORE = 1.0  # speed of a core relative to the one that was measured

# The step measured: solutions of linear systems, and iterations of each
SOLUTIONS, ITERATIONS = 2.33, 7.6
SWEEPS = 100  # of the rule Giuliani at the largest measured size: a guess
# The whole run: steps, and how much more a step costs on average than the
# measured ones, which need fewer Newton iterations
STEPS, MEAN = 103, 1.6
SIZES = [1e6, 1e7, 1e8]
PROCESSES = [16, 64, 256, 1024, 4096]


def read(path):
    with open(path, newline="") as file:
        return [
            {k: (v if k == "phase" else float(v)) for k, v in row.items()}
            for row in csv.DictReader(file)
        ]


def fit(rows, functions):
    """Coefficients >= 0 of the functions, least squares of relative errors;
    those that come out negative are left out."""
    active = list(range(len(functions)))
    while True:
        m = len(active)
        A = [[0.0] * (m + 1) for _ in range(m)]
        for row in rows:
            f = [functions[i](row) / row["seconds"] for i in active]
            for i in range(m):
                for j in range(m):
                    A[i][j] += f[i] * f[j]
                A[i][m] += f[i]
        for i in range(m):
            pivot = max(range(i, m), key=lambda k: abs(A[k][i]))
            A[i], A[pivot] = A[pivot], A[i]
            for k in range(m):
                if k != i:
                    factor = A[k][i] / A[i][i]
                    A[k] = [x - factor * y for x, y in zip(A[k], A[i])]
        x = [A[i][m] / A[i][i] for i in range(m)]
        if min(x) >= 0:
            result = [0.0] * len(functions)
            for i, value in zip(active, x):
                result[i] = value
            return result
        del active[x.index(min(x))]


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "doc/scaling"
    measured = read(os.path.join(folder, "measured.csv"))
    memory = read(os.path.join(folder, "memory.csv"))

    # Work of the busiest process: shared part, and part on every process that
    # grows with a surface of the mesh (halo, gathered surfaces of the rezoning)
    shared = lambda r: r["unknowns"] / r["processes"]
    surface = lambda r: r["unknowns"] ** (2 / 3) * (r["processes"] > 1)
    replicated = lambda r: r["unknowns"] ** (2 / 3)
    phases = {}
    for phase in dict.fromkeys(row["phase"] for row in measured):
        rows = [row for row in measured if row["phase"] == phase]
        second = replicated if phase == "rezoning" else surface
        phases[phase] = fit(rows, [shared, second])
        for row in rows:
            a, b = phases[phase]
            model = a * shared(row) + b * second(row)
            print(
                f"{phase}: {row['unknowns']:.0f} unknowns, {row['processes']:.0f} "
                f"processes: {row['seconds']:.4f} s measured, {model:.4f} s model"
            )
    base, own, copied = fit(
        [dict(r, seconds=r["bytes"]) for r in memory],
        [
            lambda r: r["processes"],
            lambda r: r["unknowns"],
            lambda r: r["unknowns"] * r["processes"],
        ],
    )
    print(
        f"memory: {base / 1e6:.0f} MB + {own:.0f} byte/unknown shared + {copied:.0f} "
        "byte/unknown on every process"
    )
    for phase, (a, b) in phases.items():
        print(f"{phase}: {1e6 * a:.2f} us/unknown shared, {1e6 * b:.2f} us/unknown^(2/3)")

    out = []
    largest = max(row["unknowns"] for row in measured)
    for n in SIZES:
        for p in PROCESSES:
            times = {}
            # Iterations grow by 1.2 for each halving of the cells (measured)
            growth = 1.2 ** (math.log(n / largest, 8))
            halo = 24 * 6 * (n / 3 / p) ** (2 / 3)  # byte of one exchange
            levels = max(1, math.log(n / 1000, 20))
            for phase, (a, b) in phases.items():
                t = CORE * (a * n / p)
                if phase == "rezoning":
                    t += CORE * b * n ** (2 / 3)
                if phase == "linear solver":
                    t *= growth
                    # Two smoothing sweeps and two transfers a level, three sums
                    exchanges = SOLUTIONS * ITERATIONS * growth
                    t += exchanges * (
                        levels * 8 * (6 * LATENCY + halo / BANDWIDTH / 3)
                        + 3 * 2 * math.log2(p) * LATENCY
                    )
                if phase == "rezoning":
                    # Sweeps grow with the number of cells along an edge
                    sweeps = SWEEPS * (n / largest) ** (1 / 3)
                    t += CORE * a * n / p * ((n / largest) ** (1 / 3) - 1)
                    t += sweeps * (
                        26 * LATENCY
                        + halo / BANDWIDTH
                        + 2 * math.log2(p) * LATENCY
                    )
                times[phase] = t
            total = sum(times.values())
            per_process = base + own * n / p + copied * n
            out.append(
                dict(
                    unknowns=f"{n:.0e}",
                    processes=p,
                    **{f"{k} [s/step]": f"{v:.3g}" for k, v in times.items()},
                    **{
                        "step [s]": f"{total:.3g}",
                        "run [h]": f"{STEPS * MEAN * total / 3600:.3g}",
                        "memory per process [GB]": f"{per_process / 1e9:.3g}",
                        "of it replicated cells [GB]": f"{copied * n / 1e9:.3g}",
                    },
                )
            )
    predicted = os.path.join(folder, "predicted.csv")
    with open(predicted, "w", newline="") as file:
        table = csv.DictWriter(file, out[0].keys(), lineterminator="\n")
        table.writeheader()
        table.writerows(out)
    for row in out:
        print(*row.values())
    draw(folder, predicted, list(out[0]).index("step [s]") + 1)


def draw(folder, predicted, column):
    sizes = "\n".join(
        f"'{predicted}' every ::{1 + i * len(PROCESSES)}::{(i + 1) * len(PROCESSES)} "
        f"using 2:{column + k} with linespoints lw 2 title '{n:.0e} unknowns'"
        + ("" if i + 1 == len(SIZES) else ", \\")
        for k in [0]
        for i, n in enumerate(SIZES)
    )
    memory = sizes.replace(f"2:{column}", f"2:{column + 2}")
    script = f"""set terminal pngcairo size 1000,420 font ',11'
set output '{os.path.join(folder, "scaling.png")}'
set datafile separator ','
set logscale xy
set grid
set xtics (16, 64, 256, 1024, 4096)
set xlabel 'processes'
set multiplot layout 1,2
set title 'Predicted time of a step [s]'
plot {sizes}
set title 'Predicted memory of a process [GB]'
plot {memory}
"""
    try:
        subprocess.run(["gnuplot"], input=script, text=True, check=True)
    except FileNotFoundError:
        print("gnuplot is missing: no figure")


if __name__ == "__main__":
    main()
