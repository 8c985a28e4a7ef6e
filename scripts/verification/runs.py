# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs of the program and of unit tests that measure, with their results."""
import csv
import json
import os
import re
import shutil
import subprocess
import threading

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


class CannotRun(Exception):
    pass


class Result:
    """Output of a run: history by column, summary, list of remeshes."""

    def __init__(self, folder, code):
        self.folder, self.code = folder, code
        self.history = self.columns("history.csv")
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            self.summary = json.load(file)

    def columns(self, name):
        with open(os.path.join(self.folder, name), newline="",
                  encoding="utf-8") as file:
            rows = list(csv.reader(file))
        if len(rows) < 2:
            raise CannotRun(f"{self.folder}: {name} has no row")
        return {title: [float(row[i]) if row[i] else float("nan")
                        for row in rows[1:]]
                for i, title in enumerate(rows[0])}

    def last(self, column):
        return self.history[column][-1]

    def remeshes(self):
        return self.columns("remeshes.csv")


class Runner:
    def __init__(self, binary, out, limit=3000):
        self.binary, self.out, self.limit = os.path.abspath(binary), out, limit
        self.lock, self.known, self.numbers = threading.Lock(), {}, {}
        self.environment = dict(
            os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1",
            OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")

    def _folder(self, name):
        """A new name for each run: SCENE, SCENE-2, ..."""
        with self.lock:
            self.numbers[name] = number = self.numbers.get(name, 0) + 1
        folder = os.path.join(self.out, "runs", name + (f"-{number}" if number > 1 else ""))
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        return folder

    def _call(self, command, folder):
        with open(os.path.join(folder, "command.txt"), "w", encoding="utf-8") as file:
            file.write(" ".join(f"'{c}'" if re.search(r"[\s=;]", c) else c
                                for c in command) + "\n")
        with open(os.path.join(folder, "terminal.txt"), "w", encoding="utf-8") as file:
            try:
                return subprocess.run(command, stdout=file, stderr=file,
                                      cwd=folder, env=self.environment,
                                      timeout=self.limit, check=False).returncode
            except subprocess.TimeoutExpired:
                raise CannotRun(f"{folder}: longer than {self.limit} s") from None
            except OSError as error:
                raise CannotRun(f"{command[0]}: {error}") from None

    def run(self, scene, settings=(), may_stop=False, fields=False):
        """Run prm/verification/SCENE.prm (or prm/SCENE.prm) with settings
        'Section/Parameter=value'; the same run is not made twice."""
        key = (scene, tuple(settings), fields)
        with self.lock:
            entry = self.known.setdefault(key, [threading.Lock(), None])
        with entry[0]:
            if entry[1] is None:
                entry[1] = self._run(scene, settings, fields)
        result = entry[1]
        if result.code != 0 and not may_stop:
            raise CannotRun(f"{result.folder}: stopped early, "
                            f"{result.summary['reason']}")
        return result

    def _run(self, scene, settings, fields):
        name = os.path.join(ROOT, "prm", "verification", scene + ".prm")
        if not os.path.exists(name):
            name = os.path.join(ROOT, "prm", scene + ".prm")
        folder = self._folder(scene)
        command = [self.binary, "--quiet", "--threads", "1", "--output", folder,
                   "--set", f"Output/Fields={'true' if fields else 'false'}",
                   "--set", "Checkpoint/Write=false"]
        for setting in settings:
            command += ["--set", setting]
        code = self._call(command + [name], folder)
        if code not in (0, 1) or not os.path.exists(os.path.join(folder, "summary.json")):
            raise CannotRun(f"{folder}: exit code {code}, see terminal.txt")
        return Result(folder, code)

    def history_bytes(self, scene, settings=()):
        """Bytes of history per cell of each region, as --validate says."""
        name = os.path.join(ROOT, "prm", "verification", scene + ".prm")
        folder = self._folder(scene + "-validated")
        command = [self.binary, "--validate", "--output", folder]
        for setting in settings:
            command += ["--set", setting]
        if self._call(command + [name], folder) != 0:
            raise CannotRun(f"{folder}: not valid, see terminal.txt")
        with open(os.path.join(folder, "terminal.txt"), encoding="utf-8") as file:
            found = re.findall(r"region\s+([^:]+):.* (\d+) bytes of history per cell",
                               file.read())
        return {region: int(count) for region, count in found}

    def unit_test(self, name, tests="*", environment=()):
        """Numbers that the unit test NAME records: by 'Suite.Test', then by
        key. Numbers of a test that failed are there, too."""
        program = os.path.join(os.path.dirname(self.binary), "tests", "unit",
                               "unit_" + name)
        if not os.path.exists(program):
            raise CannotRun(f"there is no {program}; build the tests, too")
        folder = self._folder(name)
        report = os.path.join(folder, "report.json")
        runner = self
        if environment:
            runner = Runner(self.binary, self.out, self.limit)
            runner.environment = dict(self.environment, **dict(environment))
        code = runner._call([program, f"--gtest_filter={tests}",
                             f"--gtest_output=json:{report}"], folder)
        if not os.path.exists(report):
            raise CannotRun(f"{folder}: exit code {code}, see terminal.txt")
        with open(report, encoding="utf-8") as file:
            suites = json.load(file)["testsuites"]
        known = {"name", "file", "line", "status", "result", "timestamp", "time",
                 "classname", "failures"}
        return {f"{suite['name']}.{test['name']}":
                dict({key: float(value) for key, value in test.items()
                      if key not in known}, passed="failures" not in test)
                for suite in suites for test in suite["testsuite"]}
