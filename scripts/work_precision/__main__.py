# SPDX-License-Identifier: LGPL-2.1-or-later
"""See scripts/accuracy."""
import argparse
import concurrent.futures
import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import diagrams  # noqa: E402
import measure  # noqa: E402
import tables  # noqa: E402
from studies import STUDIES  # noqa: E402


def folder_of(out, study, knob, label):
    return os.path.join(out, study.name, re.sub(r"[^\w.-]+", "-", f"{knob}-{label}"))


def main():
    parser = argparse.ArgumentParser(prog="accuracy")
    parser.add_argument("--redraw", action="store_true")
    parser.add_argument("--only", default=".")
    parser.add_argument("--data", default=os.path.join(measure.ROOT, "doc", "accuracy"))
    parser.add_argument("binary", nargs="?",
                        default=os.path.join(measure.ROOT, "build", "alveolus"))
    parser.add_argument("out", nargs="?",
                        default=os.path.join(measure.ROOT, "output", "accuracy"))
    options = parser.parse_args()
    os.makedirs(options.data, exist_ok=True)
    limit = float(os.environ.get("LIMIT", "1500"))
    if not options.redraw:
        if not os.access(options.binary, os.X_OK):
            sys.exit(f"accuracy: there is no program {options.binary}")
        chosen = [(study, *run) for study in STUDIES.values() for run in study.runs
                  if re.search(options.only, f"{study.name} {run[0]} {run[1]}")]
        if not chosen:
            sys.exit(f"accuracy: no run matches '{options.only}'")
        with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS", "2"))) as pool:
            list(pool.map(lambda run: measure.simulate(
                os.path.abspath(options.binary),
                folder_of(options.out, run[0], run[1], run[2]), run[3], run[4], limit), chosen))
        for study in STUDIES.values():
            tables.collect(study, lambda knob, label: folder_of(options.out, study, knob, label),
                           os.path.join(options.data, study.name + ".csv"))
    for study in STUDIES.values():
        name = os.path.join(options.data, study.name + ".csv")
        if os.path.exists(name):
            rows = tables.read(name)
            references = tables.references(study, rows)
            tables.show(study, rows, references)
            diagrams.draw(study, rows, references, options.data)


main()
