# SPDX-License-Identifier: LGPL-2.1-or-later
"""The verification book: cases, the rows they measure, and the tables made of
them. A case is a function of a Book, registered by @case; it appends rows."""
import csv
import math
import os
import re

COLUMNS = ("case", "quantity", "exact", "source", "computed", "error", "order",
           "target", "verdict")

CASES = []  # (name, function, in the short book, only on request)


def case(name, short=True, long=False):
    def register(function):
        CASES.append((name, function, short, long))
        return function
    return register


def order(coarse, fine, ratio=2.0):
    """Observed order between two levels, nan if it cannot be known."""
    if coarse == 0 or fine == 0:
        return math.nan
    return math.log(abs(coarse / fine)) / math.log(ratio)


def text(value, digits=6):
    """A number as it stands in the table."""
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    return f"{value:.{digits}g}"


class Book:
    """Rows of one case. Verdicts: met, missed, or measured (no target)."""

    def __init__(self, case, runner, short):
        self.case, self.runner, self.short = case, runner, short
        self.rows = []

    def run(self, scene, settings=(), **options):
        return self.runner.run(scene, settings, **options)

    def levels(self, full, short):
        """What the short book takes instead of the full list."""
        return short if self.short else full

    def add(self, quantity, exact, source, computed, error, order, target, met):
        verdict = "measured" if met is None else "met" if met else "missed"
        self.rows.append(dict(zip(COLUMNS, (
            self.case, quantity, text(exact, 8), source, text(computed, 8),
            text(error, 3), text(order, 3), target, verdict))))

    def measured(self, quantity, computed, exact="", source="", error=None,
                 order=None):
        """A number without a target."""
        self.add(quantity, exact, source, computed, error, order, "", None)

    def near(self, quantity, exact, source, computed, tolerance, relative=True):
        """|computed - exact|, relative to exact or not, <= tolerance."""
        error = computed - exact
        if relative:
            error /= abs(exact)
        name = "relative error" if relative else "error"
        self.add(quantity, exact, source, computed, error, None,
                 f"{name} ≤ {tolerance:g}", abs(error) <= tolerance)

    def below(self, quantity, source, computed, bound):
        """A number whose exact value is zero: |computed| <= bound."""
        self.add(quantity, 0.0, source, computed, computed, None,
                 f"≤ {bound:g}", abs(computed) <= bound)

    def converging(self, quantity, exact, source, computed, least_order,
                   largest_error=None, ratio=2.0, errors=None, relative=True):
        """A sequence on finer and finer meshes: order between the last two
        levels, error on the last one, relative to exact if wanted."""
        if errors is None:
            scale = abs(exact) if relative else 1.0
            errors = [(value - exact) / scale for value in computed]
        observed = order(errors[-2], errors[-1], ratio) if len(errors) > 1 \
            else math.nan
        target = f"order ≥ {least_order:g}"
        met = observed >= least_order
        if largest_error is not None and not self.short:
            target += f", error ≤ {largest_error:g}"
            met = met and abs(errors[-1]) <= largest_error
        self.add(quantity, exact, source, computed[-1], errors[-1], observed,
                 target, met)
        return errors

    def within(self, quantity, reference, source, computed, bound, what):
        """|computed - reference| <= bound, e.g. the error of the mesh."""
        error = computed - reference
        self.add(quantity, reference, source, computed, error, None,
                 f"≤ {bound:.2g}, {what}", abs(error) <= bound)


def write_csv(rows, name):
    with open(name, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def markdown(rows):
    """One table a case, the column of the case left out."""
    shown = COLUMNS[1:]
    lines = []
    for name in dict.fromkeys(row["case"] for row in rows):
        lines += ["", f"**{name}**", "", "| " + " | ".join(shown) + " |",
                  "|" + "---|" * len(shown)]
        for row in rows:
            if row["case"] == name:
                cells = [row[c].replace("|", "\\|") for c in shown]
                if row["verdict"] == "missed":
                    cells[-1] = "**missed**"
                lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines[1:]) + "\n"


def document(rows, name):
    """Replace the tables between the markers '<!-- table CASE -->' and
    '<!-- end -->' of a page. Returns the cases it has no place for."""
    with open(name, encoding="utf-8") as file:
        page = file.read()
    homeless = []
    for title in dict.fromkeys(row["case"] for row in rows):
        table = markdown([r for r in rows if r["case"] == title])
        table = table.split("\n", 2)[2]  # without the title
        begin = f"<!-- table {title} -->"
        pattern = re.compile(re.escape(begin) + r".*?<!-- end -->", re.S)
        if not pattern.search(page):
            homeless.append(title)
        page = pattern.sub(lambda _: f"{begin}\n{table}<!-- end -->", page)
    temporary = name + ".new"
    with open(temporary, "w", encoding="utf-8") as file:
        file.write(page)
    os.replace(temporary, name)
    return homeless
