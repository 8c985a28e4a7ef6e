# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page of a run."""
import html
import math
import os
import re

from . import drawing
from .results import Fields

STYLE = """
body { font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #222;
  max-width: 1100px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; margin-bottom: 0.2em; } h2 { font-size: 1.2em; margin-top: 2em; }
.good { color: #1a7f37; } .bad { color: #b2182b; }
table { border-collapse: collapse; font-size: 0.9em; }
td, th { border: 1px solid #ddd; padding: 0.2em 0.6em; text-align: left; vertical-align: top; }
th { background: #f4f4f4; } td.n { text-align: right; font-variant-numeric: tabular-nums; }
.flow { display: flex; flex-wrap: wrap; gap: 12px; }
svg { background: #fff; } svg text { font: 12px "DejaVu Sans", Arial, sans-serif; fill: #222; }
svg.chart { width: 520px; } svg.mesh { height: 520px; max-width: 520px; }
svg .title { font-weight: bold; font-size: 13px; }
svg .end { text-anchor: end; } svg .middle { text-anchor: middle; }
svg .grid { stroke: #ddd; stroke-width: 1; } svg .frame { fill: none; stroke: #444; }
svg .curve { fill: none; stroke-width: 2; }
pre { background: #f6f6f6; padding: 0.6em; overflow-x: auto; font-size: 0.85em; }
.wide { overflow-x: auto; } details { margin: 0.5em 0; }
"""

BALANCE = re.compile(r"balance|mass error|energy error|resultant|imbalance|through boundaries|"
                     r"volume error", re.I)
COUNTERS = ["Newton iterations", "linear iterations", "rejected attempts"]
FIELDS = [("stimulus", "stimulus [MPa]"), ("density", "apparent density [g/cc]"),
          ("damage", "damage [-]"), ("von_Mises_stress", "von Mises stress [MPa]")]
AT_MOST = 40000  # cells of a picture


def number(value):
    if isinstance(value, bool) or value is None:
        return str(value)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return f"{value:.6g}"
    return html.escape(str(value))


def rows(headings, lines):
    out = ["<div class='wide'><table><tr>",
           *(f"<th>{html.escape(str(h))}</th>" for h in headings), "</tr>"]
    for line in lines:
        out.append("<tr>")
        for cell in line:
            kind = " class='n'" if isinstance(cell, (int, float)) else ""
            out.append(f"<td{kind}>{number(cell)}</td>")
        out.append("</tr>")
    return "".join(out) + "</table></div>"


def unit_of(name):
    match = re.search(r"\[([^\]]*)\]$", name)
    return match.group(1) if match else ""


def groups(columns):
    """Curves that belong together: [(title, [names], logarithmic)]."""
    names = [n for n in columns if n != "time [T]" and unit_of(n) != "s"]
    out, taken = [], set()

    def take(title, chosen, logarithmic=False):
        chosen = [n for n in chosen if n in columns and n not in taken]
        moving = [n for n in chosen if any(v != 0 for v in drawing.finite(columns[n]))]
        taken.update(chosen)
        for i in range(0, len(moving), 6):
            part = moving[i:i + 6]
            out.append((title if len(part) > 1 else part[0], part, logarithmic))

    take("Forces", [n for n in names if unit_of(n).startswith("N")
                    and "mm" not in unit_of(n).replace("/mm", "")])
    # One chart for each thing that is recorded, e.g. "tip: ... [mm]"
    for n in names:
        if unit_of(n) == "mm" and n not in taken:
            owner = n.split(": ")[0] if ": " in n else ""
            take(f"{owner} [mm]".strip(), [m for m in names if unit_of(m) == "mm" and
                                          (m.split(": ")[0] if ": " in m else "") == owner])
    take("Iterations and rejected attempts in each step", [n for n in names if n in COUNTERS])
    take("Quality", [n for n in names if "scaled Jacobian" in n])
    take("Step", ["time step [T]"])
    take("Mass [mg]", [n for n in names if unit_of(n) == "mg"])
    take("Energy [mJ]", [n for n in names if unit_of(n).startswith("mJ")])
    take("Balances", [n for n in names if BALANCE.search(n)], True)
    for n in names:
        if n not in taken and unit_of(n):
            owner = n.split(": ")[0] if ": " in n else ""
            take(f"{owner} [{unit_of(n)}]".strip(),
                 [m for m in names if unit_of(m) == unit_of(n) and
                  (m.split(": ")[0] if ": " in m else "") == owner])
    for n in names:
        if n not in taken:
            owner = n.split(": ")[0] if ": " in n else ""
            take(owner or "Others", [m for m in names if not unit_of(m) and
                                     (m.split(": ")[0] if ": " in m else "") == owner])
    return out


def verdict(run):
    summary = run.summary
    if not summary:
        return ("<p class='bad'><b>Not finished:</b> there is no summary.json; the run goes on, "
                "or was killed.</p>")
    if summary.get("completed"):
        return "<p class='good'><b>Completed.</b></p>"
    return f"<p class='bad'><b>Stopped early:</b> {html.escape(str(summary.get('reason')))}</p>"


def summary_table(run):
    lines = []
    for key, value in run.summary.items():
        if key in ("completed", "reason", "title"):
            continue
        if isinstance(value, dict):
            value = ", ".join(f"{k}: {number(v)}" for k, v in value.items())
        elif isinstance(value, list):
            value = ", ".join(number(v) for v in value)
        lines.append((key, value))
    return rows(["", ""], lines) if lines else ""


def charts(run):
    x = run.columns["time [T]"]
    out = []
    for title, names, logarithmic in groups(run.columns):
        curves = [(n, [abs(v) for v in run.columns[n]] if logarithmic else run.columns[n])
                  for n in names]
        out.append(drawing.chart(title + (" (absolute)" if logarithmic else ""), "time [T]", x,
                                 curves, logarithmic))
    return "<div class='flow'>" + "".join(out) + "</div>"


def pictures(run):
    states = run.states()
    if not states:
        return "<p>No fields were written (`Output / Field interval`).</p>"
    out = []
    first = Fields(states[0][1])
    last = first if len(states) == 1 else Fields(states[-1][1])
    if max(len(first.cells), len(last.cells)) > AT_MOST:
        return (f"<p>The mesh has more than {AT_MOST} cells: see fields.pvd in ParaView.</p>")
    out.append(drawing.mesh(first, "region", f"Regions, t = {states[0][0]:g} T"))
    out.append(drawing.mesh(last, "region", f"Regions, t = {states[-1][0]:g} T"))
    out.append(drawing.mesh(last, "scaled_Jacobian",
                            f"Scaled Jacobian, t = {states[-1][0]:g} T", (0.0, 1.0)))
    for name, title in FIELDS:
        out.append(drawing.mesh(last, name, f"{title}, t = {states[-1][0]:g} T"))
    return "<div class='flow'>" + "".join(out) + "</div>"


def balances(run):
    lines = []
    for name, values in run.columns.items():
        good = drawing.finite(values)
        if BALANCE.search(name) and good:
            lines.append((name, good[-1], max(abs(v) for v in good)))
    for name in run.columns:
        if name in ("stored energy [mJ]", "bone mass [mg]"):
            good = drawing.finite(run.columns[name])
            lines.append((name, good[-1], max(abs(v) for v in good)))
    return rows(["quantity", "at the end", "largest absolute value"], lines) if lines else \
        "<p>The scene keeps no balance.</p>"


def rejected(run):
    found = run.rejected()
    if not found:
        return "<p>No attempt was rejected.</p>"
    reasons = {}
    for _, _, reason in found:
        plain = re.sub(r"[-+]?\d[\d.e+-]*", "#", reason)
        reasons.setdefault(plain, [0, reason])[0] += 1
    counted = rows(["times", "for example"], [(n, e) for n, e in reasons.values()])
    shown = rows(["time [T]", "step [T]", "reason"], found[-50:])
    return counted + f"<details><summary>the last {min(50, len(found))}</summary>{shown}</details>"


def remeshes(run):
    columns = {k: v for k, v in run.remeshes.items()}
    n = len(next(iter(columns.values()))) if columns else 0
    if n == 0:
        return ""
    pairs = [k[:-7] for k in columns if k.endswith(" before") and k[:-7] + " after" in columns]
    plain = [k for k in columns if not re.search(r" (before|after)$", k)]
    headings = ["remesh"] + [k for k in plain if k != "remesh"]
    out = ["<h2>Remeshes</h2>",
           rows(headings, [[columns[h][i] for h in headings if h in columns] for i in range(n)])]
    lines = []
    for k in pairs:
        line = [k]
        for i in range(n):
            a, b = columns[k + " before"][i], columns[k + " after"][i]
            change = f" ({100 * (b - a) / abs(a):+.3f} %)" if a and math.isfinite(a) else ""
            line.append(f"{a:.6g} → {b:.6g}{change}")
        lines.append(line)
    headings = ["before → after"] + [f"t = {t:g} T" for t in columns.get("time [T]", [])]
    out.append("<details open><summary>what changed at constant load</summary>"
               + rows(headings, lines) + "</details>")
    return "".join(out)


def report(run):
    title = str(run.summary.get("title") or os.path.basename(os.path.abspath(run.folder)))
    changed = run.changed_parameters()
    seconds = [(n, v[-1]) for n, v in run.columns.items() if unit_of(n) == "s" and v]
    parts = [
        "<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'>"
        f"<title>{html.escape(title)}</title><style>{STYLE}</style></head><body>",
        f"<h1>{html.escape(title)}</h1>", verdict(run),
        "<h2>Curves</h2>", charts(run),
        "<h2>Mesh</h2>", pictures(run),
        "<h2>Balances</h2>", balances(run),
        "<h2>Rejected attempts</h2>", rejected(run), remeshes(run),
        "<h2>Summary</h2>", summary_table(run),
        "<h2>Time spent</h2>", rows(["phase", "seconds"], seconds) if seconds else "",
        "<h2>Parameters that are not the default</h2>",
        rows(["section", "parameter", "value", "default"], changed) if changed else "<p>None.</p>",
        "<h2>Log</h2><details><summary>what was said beside the progress of steps</summary><pre>",
        html.escape("\n".join(run.remarks())), "</pre></details></body></html>\n"]
    return "".join(parts)
