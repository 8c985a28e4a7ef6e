# SPDX-License-Identifier: LGPL-2.1-or-later
"""See scripts/verify."""
import argparse
import concurrent.futures
import os
import re
import sys

import book
import runs
import academic  # noqa: F401  (these register their cases)
import elasticity  # noqa: F401
import plasticity  # noqa: F401
import remeshing  # noqa: F401
import rotation  # noqa: F401
import transfers  # noqa: F401


def main():
    parser = argparse.ArgumentParser(prog="verify", add_help=True)
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--long", action="store_true")
    parser.add_argument("--accept-known", action="store_true")
    parser.add_argument("--document", action="store_true")
    parser.add_argument("--only", default="", metavar="REGEX")
    parser.add_argument("binary", nargs="?",
                        default=os.path.join(runs.ROOT, "build", "alveolus"))
    parser.add_argument("out", nargs="?",
                        default=os.path.join(runs.ROOT, "output", "verification"))
    arguments = parser.parse_args()
    if not os.access(arguments.binary, os.X_OK):
        print(f"verify: there is no program {arguments.binary}", file=sys.stderr)
        return 2
    out = os.path.abspath(arguments.out)
    os.makedirs(out, exist_ok=True)
    runner = runs.Runner(arguments.binary, out)

    chosen = [(name, function) for name, function, short, long in book.CASES
              if re.search(arguments.only, name)
              and (short or not arguments.short) and (arguments.long or not long)]
    if not chosen:
        print(f"verify: no case matches '{arguments.only}'", file=sys.stderr)
        return 2
    broken = []

    def work(entry):
        name, function = entry
        pages = book.Book(name, runner, arguments.short)
        try:
            function(pages)
        except (runs.CannotRun, KeyError, IndexError, ValueError) as error:
            broken.append(name)
            pages.add("could not be run", "", "", "", None, None,
                      str(error).replace("\n", " "), False)
        for row in pages.rows:
            print(f"{name}: {row['quantity']}: {row['computed']} (exact "
                  f"{row['exact']}), error {row['error']}, order {row['order']}, "
                  f"target {row['target']}: {row['verdict']}", flush=True)
        return pages.rows

    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS", "2"))) as pool:
        rows = sum(pool.map(work, chosen), [])
    book.write_csv(rows, os.path.join(out, "verification.csv"))
    with open(os.path.join(out, "verification.md"), "w", encoding="utf-8") as file:
        file.write(book.markdown(rows))
    if arguments.document:
        for name in book.document(rows, os.path.join(runs.ROOT, "doc", "verification.md")):
            print(f"verify: doc/verification.md has no place for '{name}'", file=sys.stderr)
    count = {v: sum(row["verdict"] == v for row in rows)
             for v in ("met", "missed", "measured")}
    print(f"{count['met']} met, {count['missed']} missed, "
          f"{count['measured']} without target; {out}/verification.md")
    missed = {f"{row['case']}: {row['quantity']}" for row in rows
              if row["verdict"] == "missed"}
    if arguments.accept_known:
        with open(os.path.join(os.path.dirname(os.path.abspath(__file__)),
                               "known-misses.txt"), encoding="utf-8") as file:
            missed -= set(file.read().splitlines())
        for name in sorted(missed):
            print(f"verify: a new miss: {name}", file=sys.stderr)
    return 2 if broken else 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
