# SPDX-License-Identifier: LGPL-2.1-or-later
"""Raw numbers of the runs as CSV, and the errors that follow from them."""
import csv
import json
import os

import measure
import richardson
from studies import EXACT_CYLINDER

COST = ("exit code", "completed", "user CPU [s]", "system CPU [s]", "peak memory [MB]",
        "cells", "unknowns", "steps", "Newton iterations", "smallest scaled Jacobian")


def row_of(study, knob, label, scene, settings, folder):
    """All that is known of one run, or None if it was not made."""
    name = os.path.join(folder, "cost.json")
    if not os.path.exists(name):
        return None
    with open(name, encoding="utf-8") as file:
        cost = json.load(file)
    summary = {}
    name = os.path.join(folder, "summary.json")
    if os.path.exists(name):
        with open(name, encoding="utf-8") as file:
            summary = json.load(file)
    row = {"knob": knob, "value": label, "scene": scene, "settings": "; ".join(settings),
           "exit code": cost["exit code"], "completed": summary.get("completed", False),
           "user CPU [s]": round(cost["user"], 2), "system CPU [s]": round(cost["system"], 2)}
    if summary:
        row["peak memory [MB]"] = round(summary["peak memory [kB]"] / 1024, 1)
        for key in COST[5:]:
            row[key] = summary.get(key, "")
        columns = measure.history(folder)
        for quantity in study.quantities:
            value = (measure.at(columns, quantity.column, study.time) if quantity.column
                     else measure.window_mean(folder, quantity.field, quantity.window,
                                              study.time))
            row[f"{quantity.name} [{quantity.unit}]"] = "" if value is None else repr(value)
    return row


def collect(study, folder_of, name):
    """Write the CSV. Rows of an earlier one whose runs are not there stay."""
    rows = {(row["knob"], row["value"]): row for row in read(name)} if os.path.exists(name) else {}
    for knob, label, scene, settings in study.runs:
        row = row_of(study, knob, label, scene, settings, folder_of(knob, label))
        if row:
            rows[knob, label] = row
    columns = (["knob", "value", "scene", "settings"] + list(COST)
               + [f"{q.name} [{q.unit}]" for q in study.quantities])
    order = [(knob, label) for knob, label, _, _ in study.runs]
    if not any(key in rows for key in order):
        return
    with open(name, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns, restval="", extrasaction="ignore",
                                lineterminator="\n")
        writer.writeheader()
        for key in order:
            if key in rows:
                writer.writerow(rows[key])


def read(name):
    with open(name, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def value(row, quantity):
    text = row.get(f"{quantity.name} [{quantity.unit}]", "")
    return float(text) if text else None


def series(study, rows, quantity, entries):
    """Values and sizes of the runs of a series that got there."""
    known = {(row["knob"], row["value"]): row for row in rows}
    h, q = [], []
    for key, size in entries:
        found = value(known[key], quantity) if key in known else None
        if found is not None:
            h.append(size)
            q.append(found)
    return h, q


def references(study, rows):
    """The value each quantity is judged by: exact, or extrapolated."""
    result = {}
    known = {(row["knob"], row["value"]): row for row in rows}
    for quantity in study.quantities:
        if study.name == "cylinder":
            result[quantity.name] = richardson.Limit(EXACT_CYLINDER[quantity.name], 0.0, None, "exact")
            continue
        h, q = series(study, rows, quantity, study.meshes)
        if len(q) < 2:
            continue
        mesh = richardson.limit(h, q, study.mesh_order)
        limit = mesh
        if study.steps:
            h, q = series(study, rows, quantity, study.steps)
            base = value(known[study.base_run], quantity)
            if len(q) > 1:
                limit = richardson.combined(mesh, richardson.limit(h, q, 1.0), base)
        result[quantity.name] = limit
    return result


def show(study, rows, references):
    """A Markdown table of all runs: cost, and errors in percent."""
    print(f"\n## {study.title}\n")
    for quantity in study.quantities:
        limit = references.get(quantity.name)
        if limit:
            order = ", " + limit.kind + ("" if limit.order is None
                                         else f", order {limit.order:.2f}")
            print(f"* {quantity.name}: {limit.value:.8g} ± {limit.error:.2g} {quantity.unit} "
                  f"(± {100 * richardson.relative(limit.value + limit.error, limit.value):.2g} %)"
                  f"{order}")
    print("\n| knob | value | cells | CPU s | MB | steps | Newton | "
          + " | ".join(f"{q.name} %" for q in study.quantities) + " |")
    print("|---" * (7 + len(study.quantities)) + "|")
    for row in rows:
        errors = []
        for quantity in study.quantities:
            found = value(row, quantity)
            limit = references.get(quantity.name)
            errors.append("–" if found is None or limit is None
                          else f"{100 * (found - limit.value) / abs(limit.value):+.3g}")
        print(f"| {row['knob']} | {row['value']} | {row['cells']} | {row['user CPU [s]']} | "
              f"{row['peak memory [MB]']} | {row['steps']} | {row['Newton iterations']} | "
              + " | ".join(errors) + " |")
