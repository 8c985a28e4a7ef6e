# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads the output folder of a run."""
import base64
import csv
import json
import os
import re
import struct
import xml.etree.ElementTree
import zlib


class Missing(Exception):
    """Something a report needs is not there."""


class Run:
    """What a run has written."""

    def __init__(self, folder):
        self.folder = folder
        self.columns = table(os.path.join(folder, "history.csv"))
        if not self.columns or not next(iter(self.columns.values())):
            raise Missing(f"there is no history.csv with a step in {folder}; "
                          "run a scene with --output " + folder)
        self.remeshes = table(os.path.join(folder, "remeshes.csv"))
        summary = read(os.path.join(folder, "summary.json"))
        self.summary = json.loads(summary) if summary else {}
        self.log = read(os.path.join(folder, "log.txt")).splitlines()
        self.parameters = read(os.path.join(folder, "parameters.prm")).splitlines()

    def rejected(self):
        """Time, step and reason of every attempt that was rejected."""
        pattern = re.compile(r"t = (\S+) T rejected \(step (\S+)\): (.*)")
        return [m.groups() for m in map(pattern.match, self.log) if m]

    def remarks(self):
        """Lines of the log that are neither progress nor accepted attempts."""
        return [line for line in self.log if not line.startswith("t = ")]

    def changed_parameters(self):
        """(section, name, value, default), where value and default differ."""
        section, result = [], []
        for line in self.parameters:
            words = line.strip()
            if words.startswith("subsection "):
                section.append(words[11:])
            elif words == "end" and section:
                section.pop()
            match = re.match(r"set (.*?)\s*=\s*(.*?)\s*# default:\s*(.*)$", words)
            if match:
                result.append((" / ".join(section),) + match.groups())
        return result

    def states(self):
        """Times and names of the files with fields, in order."""
        name = os.path.join(self.folder, "fields.pvd")
        if not os.path.exists(name):
            return []
        try:
            entries = list(xml.etree.ElementTree.parse(name).iter("DataSet"))
        except xml.etree.ElementTree.ParseError:
            return []
        last = {float(e.get("timestep")): os.path.join(self.folder, e.get("file"))
                for e in entries}
        return [(t, f) for t, f in sorted(last.items()) if os.path.exists(f)]


def read(name):
    try:
        with open(name, encoding="utf-8", errors="replace") as file:
            return file.read()
    except FileNotFoundError:
        return ""


def table(name):
    """Columns of a CSV file by name; numbers, NaN where there are none."""
    rows = list(csv.reader(read(name).splitlines()))
    if not rows:
        return {}
    columns = {heading: [] for heading in rows[0]}
    for row in rows[1:]:
        if len(row) != len(rows[0]):
            continue  # a line that a kill cut short
        for heading, cell in zip(rows[0], row):
            try:
                columns[heading].append(float(cell))
            except ValueError:
                columns[heading].append(float("nan"))
    return columns


# Fields as VTK files


class Fields:
    """Points, cells and values at points of a .vtu, or of the parts of a .pvtu."""

    def __init__(self, name):
        self.points, self.cells, self.values = [], [], {}
        root = xml.etree.ElementTree.parse(name).getroot()
        pieces = [p.get("Source") for p in root.iter("Piece") if p.get("Source")]
        for piece in pieces:
            part = Fields(os.path.join(os.path.dirname(name), piece))
            shift = len(self.points)
            self.points += part.points
            self.cells += [[v + shift for v in cell] for cell in part.cells]
            for key, values in part.values.items():
                self.values.setdefault(key, []).extend(values)
        for piece in root.iter("Piece"):
            if not piece.get("Source"):
                self.read_piece(piece)

    def read_piece(self, piece):
        shift = len(self.points)
        flat = numbers(piece.find("Points/DataArray"))
        self.points += list(zip(flat[0::3], flat[1::3], flat[2::3]))
        arrays = {a.get("Name"): numbers(a) for a in piece.find("Cells")}
        begin = 0
        for end in arrays["offsets"]:
            self.cells.append([v + shift for v in arrays["connectivity"][begin:end]])
            begin = end
        for array in piece.find("PointData"):
            if int(array.get("NumberOfComponents") or 1) == 1:
                self.values.setdefault(array.get("Name"), []).extend(numbers(array))


KINDS = {"Float32": "f", "Float64": "d", "Int32": "i", "UInt32": "I",
         "Int64": "q", "UInt64": "Q", "UInt8": "B", "Int8": "b"}


def numbers(array):
    """The numbers of a DataArray: text, or compressed and in base 64."""
    kind = KINDS[array.get("type")]
    text = (array.text or "").strip()
    if array.get("format") == "ascii":
        return [(float if kind in "fd" else int)(word) for word in text.split()]
    # Head: number of blocks, size of a block, of the last one, compressed sizes
    n_blocks = struct.unpack("<I", base64.b64decode(text[:8])[:4])[0]
    length = 4 * (3 + n_blocks)
    head = (length + 2) // 3 * 4
    sizes = struct.unpack(f"<{3 + n_blocks}I", base64.b64decode(text[:head])[:length])
    packed = base64.b64decode(text[head:])
    data, begin = b"", 0
    for size in sizes[3:]:
        data += zlib.decompress(packed[begin:begin + size])
        begin += size
    return list(struct.unpack(f"<{len(data) // struct.calcsize(kind)}{kind}", data))
