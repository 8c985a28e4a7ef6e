# SPDX-License-Identifier: LGPL-2.1-or-later
"""The studies of doc/incisor.md.

incisor_studies.py [BINARY] [OUT] [PATTERN] runs BINARY (default
build/alveolus) once for each entry of RUNS whose name matches PATTERN, two at a
time, each at most LIMIT seconds (environment, default 900), into OUT/NAME
(default output/incisor-studies), and writes the key numbers of all runs found
there to doc/incisor/studies.csv. Runs whose summary.json exists are not
repeated. Needs the standard library only.
"""
import concurrent.futures
import csv
import json
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LIMIT = float(os.environ.get("LIMIT", "900"))
FORCES = (0.2, 0.4, 0.65, 0.9, 1.2)

STICKING = "Conditions/contact/Friction=sticking"
SECOND = "Transfer/Scheme=limited linear"
NO_CONTACT = "Conditions/Names=load, base"
FAR = "Time/End=5"


def finer(n):
    return f"Mesh/tooth in socket/Refinement={n}"


# name: scene, settings
RUNS = {
    "lagrangian": ("incisor-lagrangian",),
    "lagrangian-h2": ("incisor-lagrangian", finer(2)),
    "lagrangian-h4": ("incisor-lagrangian", finer(4)),
    "ale": ("incisor-ale",),
    "ale-h2": ("incisor-ale", finer(2)),
    "ale-h4": ("incisor-ale", finer(4)),
    "ale-second": ("incisor-ale", SECOND),
    "ale-sticking": ("incisor-ale", STICKING),
    "ale-no-contact": ("incisor-ale", NO_CONTACT),
    "remeshed": ("incisor", FAR),
    "remeshed-second": ("incisor", FAR, SECOND),
    "remeshed-sticking": ("incisor", FAR, STICKING),
    "remeshed-no-contact": ("incisor", FAR, NO_CONTACT),
    "remeshed-h2": ("incisor", finer(2)),
    "automatic": ("incisor-automatic", FAR),
    "unloading": ("incisor-unloading",),
    "valanis-landel": ("incisor-valanis-landel", FAR),
    "valanis-landel-h2": ("incisor-valanis-landel", finer(2)),
    "valanis-landel-h4": ("incisor-valanis-landel", finer(4)),
    "hypoelastic": ("incisor-hypoelastic", FAR),
    "hypoelastic-h2": ("incisor-hypoelastic", finer(2)),
}


def simulate(binary, out, name):
    folder = os.path.join(out, name)
    if os.path.exists(os.path.join(folder, "summary.json")):
        return
    os.makedirs(folder, exist_ok=True)
    scene, *settings = RUNS[name]
    command = [binary, "--quiet", "--threads", "1", "--output", folder]
    for setting in settings:
        command += ["--set", setting]
    command.append(os.path.join(ROOT, "prm", scene + ".prm"))
    with open(os.path.join(folder, "terminal.txt"), "w") as terminal:
        try:
            code = subprocess.run(
                command,
                timeout=LIMIT,
                stdout=terminal,
                stderr=subprocess.STDOUT,
                env=dict(os.environ, OPENBLAS_NUM_THREADS="1"),
            ).returncode
        except subprocess.TimeoutExpired:
            code = "out of time"
    print(f"{name:24s} exit code {code}", flush=True)


def rows_of(name):
    if not os.path.exists(name):
        return []
    with open(name, newline="") as file:
        return [r for r in csv.DictReader(file) if None not in r.values()]


def key_numbers(folder, name):
    rows = rows_of(os.path.join(folder, "history.csv"))
    try:
        with open(os.path.join(folder, "summary.json")) as file:
            summary = json.load(file)
    except (OSError, ValueError):
        summary = {}
    force = [float(r["applied force [N]"]) for r in rows]
    tip = [float(r["tip: displacement [mm]"]) for r in rows]
    result = {
        "run": name,
        "last force [N]": f"{force[-1]:.4g}",
        "steps": len(rows),
        "Newton per step": f"{sum(int(r['Newton iterations']) for r in rows) / len(rows):.2f}",
        "remeshes": rows[-1].get("remeshes", "0"),
        "smallest scaled Jacobian": f"{float(rows[-1]['smallest scaled Jacobian']):.3f}",
    }
    for wanted in FORCES:
        # The last row of equal force: after a remesh
        near = [i for i, f in enumerate(force) if abs(f - wanted) < 1e-6]
        result[f"tip at {wanted} N [mm]"] = f"{tip[near[-1]]:.6f}" if near else ""
    touching = [
        f
        for f, r in zip(force, rows)
        if float(r.get("contact: length [mm]", 0.0)) > 0.0
    ]
    result["contact from [N]"] = f"{touching[0]:.3g}" if touching else ""
    result["penetration [um]"] = (
        f"{1e3 * max(float(r['contact: penetration of lines [mm]']) for r in rows):.3g}"
        if touching
        else ""
    )
    result["why"] = summary.get("reason", "")[:160]
    return result


def main(binary, out, pattern):
    names = [name for name in RUNS if re.search(pattern, name)]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda name: simulate(binary, out, name), names))
    results = [
        key_numbers(os.path.join(out, name), name)
        for name in RUNS
        if rows_of(os.path.join(out, name, "history.csv"))
    ]
    target = os.path.join(ROOT, "doc", "incisor", "studies.csv")
    os.makedirs(os.path.dirname(target), exist_ok=True)
    with open(target, "w", newline="") as file:
        writer = csv.DictWriter(file, results[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(results)


if __name__ == "__main__":
    defaults = [
        os.path.join(ROOT, "build", "alveolus"),
        os.path.join(ROOT, "output", "incisor-studies"),
        ".",
    ]
    main(*(sys.argv[1:] + defaults[len(sys.argv) - 1 :]))
