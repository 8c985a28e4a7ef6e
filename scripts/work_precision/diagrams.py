# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work-precision diagrams: error against CPU seconds and memory, by gnuplot."""
import os
import subprocess
import tempfile

import richardson
import tables
from measure import ROOT

COLOURS = ("#b2182b", "#2166ac", "#4d9221", "#e08214", "#8073ac", "#01665e", "#dd3497",
           "#8c510a", "#525252", "#66bd63")
LEAST = 0.2 # errors below this part of the reference's error bar are drawn there


def write_points(name, rows, knob, quantity, limit):
    """Seconds, error, megabytes, label of the runs of a knob that got there;
    returns whether there are any."""
    lines = []
    for row in rows:
        found = tables.value(row, quantity)
        if row["knob"] == knob and found is not None:
            error = max(1e-8, LEAST * limit.error / abs(limit.value),
                        richardson.relative(found, limit.value))
            lines.append((float(row["user CPU [s]"]), error, row["peak memory [MB]"],
                          row["value"]))
    with open(name, "w", encoding="utf-8") as file:
        file.write("seconds,error,megabytes,label\n")
        file.writelines(f"{s},{e},{m},{label}\n" for s, e, m, label in lines)
    return bool(lines)


def curves(scratch, number, rows, knobs, quantity, limit, column):
    """The arguments of gnuplot's plot for one panel."""
    plots = []
    for index, knob in enumerate(knobs):
        name = os.path.join(scratch, f"{number}-{index}.csv")
        if not write_points(name, rows, knob, quantity, limit):
            continue
        level = knob == "level"
        colour = "#000000" if level else COLOURS[index]
        style = "lw 3 ps 2.4 pt 13" if level else "lw 1.6 ps 1.5 pt 7"
        kind = "points" if knob == "smoothing" else "linespoints"
        plots.append(f"'{name}' using {column}:2 with {kind} lc rgb '{colour}' {style} "
                     f"title '{knob}'")
        plots.append(f"'{name}' using {column}:2:4 with labels offset 0.6,0.5 left "
                     f"font ',{14 if level else 12}' tc rgb '{colour}' notitle")
    if limit.error > 0:
        plots.append(f"{limit.error / abs(limit.value)} with lines lc rgb '#888888' dt 2 lw 1.5 "
                     "title 'error bar of the reference'")
    return ", ".join(plots)


def draw(study, rows, references, folder):
    """STUDY-KIND.png for each kind of diagram of the study: a panel for each
    quantity against seconds, and the first one against memory if that varies."""
    panels = [(q, references[q.name], 1) for q in study.quantities if q.name in references]
    if not panels:
        return
    memory = [float(row["peak memory [MB]"]) for row in rows if row["peak memory [MB]"]]
    if max(memory) - min(memory) > 10:
        panels.append((*panels[0][:2], 3))
    lines = (len(panels) + 1) // 2
    for kind, knobs in study.diagrams.items():
        odd = len(panels) % 2 > 0 # then the legend takes the last place
        foot = 70 if odd else 190
        height = 480 * lines + foot - 60
        commands = [f"load '{ROOT}/scripts/plots/common.gp'",
                    f"set terminal pngcairo size 1600,{height} font 'DejaVu Sans,16' "
                    "linewidth 2 background 'white'",
                    f"set output '{folder}/{study.name}-{kind}.png'",
                    f"set multiplot layout {lines},2 margins 0.07,0.98,{foot / height},"
                    f"{1 - 45 / height} spacing 0.09,{115 / height}",
                    "set logscale xy", "set format y '10^{%T}'", "set format x '%g'"]
        with tempfile.TemporaryDirectory() as scratch:
            for number, (quantity, limit, column) in enumerate(panels):
                commands += [
                    f"set title '{quantity.name}: relative error' offset 0,-0.5",
                    "set xlabel 'CPU seconds' offset 0,0.5" if column == 1
                    else "set xlabel 'peak memory [MB]' offset 0,0.5",
                    "set logscale x" if column == 1 else "unset logscale x",
                    "unset key" if number > 0 else
                    f"set key at screen 0.56,{(foot + 330) / height} left top maxrows 12 "
                    "samplen 2 spacing 1.2 font ',16'" if odd else
                    f"set key at screen 0.5,{85 / height} center top maxrows 3 samplen 2 "
                    "spacing 1.1 font ',15'",
                    "plot " + curves(scratch, number, rows, knobs, quantity, limit, column)]
            commands.append("unset multiplot")
            result = subprocess.run(["gnuplot"], input="\n".join(commands), text=True,
                                    capture_output=True, check=False)
            if result.returncode != 0 or result.stderr.strip():
                raise SystemExit(f"accuracy: gnuplot: {result.stderr}")
