# SPDX-License-Identifier: LGPL-2.1-or-later
"""One run of the program: what it cost and what came of it."""
import array
import base64
import csv
import json
import os
import re
import shutil
import struct
import subprocess
import xml.etree.ElementTree
import zlib

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def simulate(binary, folder, scene, settings, limit):
    """Run ROOT/prm/SCENE.prm into FOLDER on one thread, with the exit code and
    the CPU seconds of the process and its children in FOLDER/cost.json. A run
    with a cost is not repeated."""
    cost = os.path.join(folder, "cost.json")
    if os.path.exists(cost):
        return
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    command = [binary, "--quiet", "--threads", "1", "--output", folder,
               "--set", "Checkpoint/Write=false"]
    for setting in settings:
        command += (["--accuracy", setting[9:]] if setting.startswith("Accuracy=")
                    else ["--set", setting])
    command.append(os.path.join(ROOT, "prm", scene + ".prm"))
    environment = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")
    with open(os.path.join(folder, "terminal.txt"), "w", encoding="utf-8") as terminal:
        process = subprocess.Popen(["timeout", str(limit)] + command,
                                   stdout=terminal, stderr=terminal, env=environment)
        # This child's own use, whatever runs beside it
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    with open(cost, "w", encoding="utf-8") as file:
        json.dump({"exit code": process.returncode, "user": usage.ru_utime,
                   "system": usage.ru_stime}, file)
    print(f"{os.path.basename(folder):40s} exit code {process.returncode}  "
          f"{usage.ru_utime:7.1f} s", flush=True)


def history(folder):
    """Columns of history.csv by name without the unit, complete rows only."""
    with open(os.path.join(folder, "history.csv"), newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    names = [re.sub(r" \[[^]]*\]", "", name) for name in rows[0]]
    rows = [[float(v) if v else float("nan") for v in row]
            for row in rows[1:] if len(row) == len(names)]
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}


def at(columns, name, time):
    """Value of a column at a time, linear between steps; None if the run did
    not get there, or has no such column."""
    if name not in columns:
        return None
    x, y = [0.0] + columns["time"], [None] + columns[name]
    for i in range(1, len(x)):
        if x[i] >= time * (1 - 1e-9):
            if abs(x[i] - time) <= 1e-9 * time or y[i - 1] is None:
                return y[i] if abs(x[i] - time) <= 1e-9 * time else None
            part = (time - x[i - 1]) / (x[i] - x[i - 1])
            return y[i - 1] + part * (y[i] - y[i - 1])
    return None


def read_vtu(name):
    """The arrays of a VTU file of one piece."""
    with open(name, encoding="latin-1") as file:
        text = file.read()
    codes = {"Float32": "f", "Float64": "d", "Int32": "i", "UInt8": "B"}
    result = {}
    for kind, attributes, data in re.findall(
            r'<DataArray type="(\w+)"([^>]*)format="binary">\s*([^<]*)</DataArray>', text):
        data = data.strip()
        blocks = struct.unpack("<I", base64.b64decode(data[:8])[:4])[0]
        head = 4 * ((4 * (3 + blocks) + 2) // 3)
        sizes = struct.unpack(f"<{3 + blocks}I", base64.b64decode(data[:head])[:4 * (3 + blocks)])
        body, raw, begin = base64.b64decode(data[head:]), b"", 0
        for size in sizes[3:]:
            raw += zlib.decompress(body[begin:begin + size])
            begin += size
        found = re.search(r'Name="([^"]*)"', attributes)
        result[found.group(1) if found else "points"] = array.array(codes[kind], raw)
    return result


def clipped(polygon, window):
    """The part of a convex polygon inside window = (x0, x1, y0, y1)."""
    for axis, bound, side in ((0, window[0], 1), (0, window[1], -1),
                              (1, window[2], 1), (1, window[3], -1)):
        result = []
        for i, b in enumerate(polygon):
            a = polygon[i - 1]
            da, db = side * (a[axis] - bound), side * (b[axis] - bound)
            if (da < 0) != (db < 0):
                s = da / (da - db)
                result.append((a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])))
            if db >= 0:
                result.append(b)
        polygon = result
        if len(polygon) < 3:
            return []
    return polygon


def area(polygon):
    return abs(0.5 * sum(polygon[i - 1][0] * b[1] - b[0] * polygon[i - 1][1]
                         for i, b in enumerate(polygon)))


def window_mean(folder, field, window, time):
    """Mean over a fixed window of the current plane of a field that is constant
    in cells, in the state written at this time; None if there is none."""
    name = os.path.join(folder, "fields.pvd")
    if not os.path.exists(name):
        return None
    states = [(float(e.get("timestep")), e.get("file"))
              for e in xml.etree.ElementTree.parse(name).iter("DataSet")]
    found = [file for t, file in states if abs(t - time) <= 1e-9 * time]
    if not found:
        return None
    data = read_vtu(os.path.join(folder, found[-1]))
    if field not in data:
        return None
    points, connectivity, values = data["points"], data["connectivity"], data[field]
    total = content = 0.0
    begin = 0
    for end in data["offsets"]:
        corners = connectivity[begin:begin + 4] # the first four, also of degree 2
        begin = end
        part = clipped([(points[3 * k], points[3 * k + 1]) for k in corners], window)
        if part:
            a = area(part)
            total += a
            content += a * values[corners[0]]
    return content / total if total > 0 else None
