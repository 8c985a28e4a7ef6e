#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_documents.py SOURCE BUILD WORK [CLASS [PATTERN]]

Takes every command out of README.md, CONTRIBUTING.md and doc/*.md (lines of code
blocks, and words in code style, that begin like a command) and looks it up in
commands.txt. A command that
is not listed there is a failure; lines there that no document has are told. Then
those of CLASS (default: short) are run, in a folder that looks like the source
folder (doc is a copy: some commands write there); build/alveolus is a wrapper that
adds the options of commands.txt. Each must end with the exit code that commands.txt
tells, 0 if none. With PATTERN only those of exactly this class that match it.

commands.txt: lines `CLASS | COMMAND | exit=N options`. Classes:

    short    run by this test
    slow     run with those of class short by class slow, a test of the label slow
    clone    builds, tests or measures everything: run by class clone, a test of the
             label slow, in a copy of the sources that was never built. Where the
             command itself takes hours the third column is `as SHORTER COMMAND`.
    pattern  has placeholders: no command
"""
import glob
import os
import re
import shlex
import shutil
import subprocess
import sys

BEGIN = re.compile(r"^(\$ )?([A-Z_]+=\S+ )*(scripts/|build[-/]|cmake|ninja|ctest|python3|mpirun|gmsh|gnuplot|git |cp |mv |"
                   r"cd |mkdir|sed |apt|sudo|alveolus|tests/|export|time |curl|wget|make |doxygen|xdg-open|paraview|"
                   r"for |while |docker|pip|less |cat |ls )")


INLINE = re.compile(r"`((?:[A-Z_]+=[^`\s]+ )*(?:scripts/[^`\s]+|(?:build/)?alveolus|cmake|ninja|ctest|python3|mpirun) [^`\n]+)`")


def code_lines(name):
    """Lines in fenced or indented code of a Markdown file."""
    fenced, blank = None, True
    for line in open(name, encoding="utf-8"):
        line = line.rstrip("\n")
        if line.lstrip().startswith("```"):
            fenced = line.lstrip()[3:].strip() or "text" if fenced is None else None
            continue
        if fenced is not None:
            if fenced in ("text", "sh", "bash", "console"):
                yield line
        elif line.startswith("    ") and not re.match(r"^ {4,}([-*+]|\d+\.) ", line):
            yield line[4:]
        blank = not line


def commands(name):
    """Commands of a file: continued lines and loops joined, remarks left out."""
    yield from INLINE.findall(open(name, encoding="utf-8").read())
    pending = ""
    for line in code_lines(name):
        if not pending and not BEGIN.match(line):
            continue
        line = re.sub(r"\s+#\s.*$", "", line).strip()
        if line.startswith("$ "):
            line = line[2:]
        pending = f"{pending} {line}".strip()
        if pending.endswith("\\"):
            pending = pending[:-1].strip()
            continue
        words = pending.split()
        if words[0] in ("for", "while") and "done" not in words and not pending.endswith("done"):
            pending += "" if pending.endswith("; do") or pending.endswith(" do") else ";"
            continue
        yield pending
        pending = ""


def plain(command):
    """The command as a key: one blank for several."""
    return re.sub(r"\s+", " ", command)


def classes(name):
    table = {}
    for number, line in enumerate(open(name, encoding="utf-8"), 1):
        line = line.strip()
        if not line or line.startswith("#"):
            continue
        parts = [part.strip() for part in line.split(" | ")]
        if len(parts) < 2 or parts[0] not in ("short", "slow", "clone", "pattern"):
            sys.exit(f"{name}, line {number}: not CLASS | COMMAND | options")
        table[plain(parts[1])] = (parts[0], parts[2] if len(parts) > 2 else "")
    return table


def workplace(source, build, work):
    """A folder with all of the source folder and a build folder with the wrapper."""
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(os.path.join(work, "build"))
    for entry in os.listdir(source):
        if entry.startswith(".") or entry.startswith("build") or entry == "output":
            continue
        if entry == "doc":
            shutil.copytree(os.path.join(source, entry), os.path.join(work, entry))
        else:
            os.symlink(os.path.join(source, entry), os.path.join(work, entry))
    for entry in os.listdir(build):
        if entry != "alveolus":
            os.symlink(os.path.join(build, entry), os.path.join(work, "build", entry))
    wrapper = os.path.join(work, "build", "alveolus")
    with open(wrapper, "w", encoding="utf-8") as file:
        file.write("#!/usr/bin/env bash\n# The program with the options that shorten a run\n"
                   'eval "more=($ALVEOLUS_SHORT)"\n'
                   '[[ " $* " == *" --threads "* ]] || more+=(--threads 1)\n'
                   f'exec {shlex.quote(os.path.join(build, "alveolus"))} "$@" "${{more[@]}}"\n')
    os.chmod(wrapper, 0o755)


def copy_of_sources(source, work):
    """All of the source folder but what was built or computed there."""
    shutil.rmtree(work, ignore_errors=True)
    shutil.copytree(source, work, symlinks=True,
                    ignore=lambda folder, names: [
                        name for name in names if folder == source and
                        (name in (".git", "output") or name.startswith("build"))])


def main():
    source, build, work = map(os.path.abspath, sys.argv[1:4])
    wanted = sys.argv[4] if len(sys.argv) > 4 else "short"
    pattern = sys.argv[5] if len(sys.argv) > 5 else ""
    listed = classes(os.path.join(source, "tests", "documents", "commands.txt"))
    documents = [os.path.join(source, n) for n in ("README.md", "CONTRIBUTING.md")]
    documents += sorted(glob.glob(os.path.join(source, "doc", "*.md")))
    found, failures = [], []
    for document in documents:
        for command in commands(document):
            place = os.path.relpath(document, source)
            if plain(command) not in listed:
                failures.append(f"{place}: not in tests/documents/commands.txt: {command}")
            found.append(command)
    known = {plain(command) for command in found}
    for command in listed:
        if command not in known:
            print(f"commands.txt: in no document: {command}")
    if not found:
        failures.append("no document has a command")

    # What a slow command needs, a short one before it may make
    if wanted == "clone":
        copy_of_sources(source, work)
    else:
        workplace(source, build, work)
    n_run = 0
    for command in dict.fromkeys(found):
        kind, options = listed.get(plain(command), ("", ""))
        if kind != wanted and (pattern or (kind, wanted) != ("short", "slow")):
            continue
        if not re.search(pattern, command):
            continue
        expected = re.search(r"exit=(\d+)", options)
        expected = int(expected.group(1)) if expected else 0
        more = re.sub(r"exit=\d+", "", options).strip()
        shown = command
        if kind == "clone" and more:
            if not more.startswith("as "):
                sys.exit(f"commands.txt: neither `as` nor `exit`: {options}")
            command, more = more[3:], ""
            shown += f" as {command}"
        environment = dict(os.environ, ALVEOLUS_SHORT=more)
        # Debian's python3 first: it has the modules
        environment["PATH"] = ":".join([os.path.join(work, "build"), "/usr/bin", environment["PATH"]])
        run = subprocess.run(["bash", "-c", command], cwd=work, env=environment,
                             capture_output=True, text=True, check=False)
        n_run += 1
        print(f"{'ok' if run.returncode == expected else 'FAILED'}: {shown}", flush=True)
        if run.returncode != expected:
            failures.append(f"exit code {run.returncode}, not {expected}: {shown}\n"
                            + (run.stdout + run.stderr)[-1500:])
    print(f"{len(dict.fromkeys(found))} commands in {len(documents)} documents, {n_run} run as {wanted}")
    for failure in failures:
        print("FAILED:", failure)
    return 1 if failures or n_run == 0 else 0


sys.exit(main())
