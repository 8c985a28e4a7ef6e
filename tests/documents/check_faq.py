# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_faq.py SOURCE: every message that doc/faq.md quotes in its tables is in
the source, so that a message that changes, changes there, too."""
import glob
import re
import sys


def main():
    top = sys.argv[1]
    source = ""
    for name in glob.glob(top + "/source/**/*.cc", recursive=True) \
            + glob.glob(top + "/include/**/*.h", recursive=True):
        text = open(name, encoding="utf-8").read()
        # Strings written in several parts
        source += re.sub(r'"\s*\n?\s*"', "", text) + "\n"
    missing, n = [], 0
    for line in open(top + "/doc/faq.md", encoding="utf-8"):
        if not line.startswith("| `"):
            continue
        cell = line.split(" | ")[0].lstrip("| ")
        for quote in re.findall(r"``(?: )?(.*?)(?: )?``|`([^`]+)`", cell):
            for part in re.split(r"\s*…\s*", quote[0] or quote[1]):
                part = part.strip(" '\"")
                if len(part) < 3:
                    continue
                n += 1
                if part not in source:
                    missing.append(part)
    print(f"{n} quotations")
    for part in missing:
        print("FAILED: not in the source:", part)
    return 1 if missing or n < 20 else 0


sys.exit(main())
