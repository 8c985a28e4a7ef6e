# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_report.py SOURCE WORK: scripts/report on a run made up here, of which
every number is known; and on a folder without one."""
import base64
import os
import re
import shutil
import struct
import subprocess
import sys
import zlib

top, work = sys.argv[1:3]


def need(condition, what):
    if not condition:
        sys.exit("FAILED: " + what)


def array(kind, values, attributes):
    """A DataArray of two compressed blocks, as deal.II writes them."""
    code = {"Float32": "f", "Int32": "i", "UInt8": "B"}[kind]
    data = struct.pack(f"<{len(values)}{code}", *values)
    size = max(4, len(data) // 2 // 4 * 4)
    blocks = [data[i:i + size] for i in range(0, len(data), size)]
    packed = [zlib.compress(b) for b in blocks]
    last = len(blocks[-1])
    head = struct.pack(f"<{3 + len(packed)}I", len(packed), size, last, *map(len, packed))
    text = (base64.b64encode(head) + base64.b64encode(b"".join(packed))).decode()
    return f'<DataArray type="{kind}" {attributes} format="binary">\n{text}\n</DataArray>'


def vtu(shift):
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (1, 0, 0), (2 + shift, 0, 0), (2, 1, 0), (1, 1, 0)]
    return f"""<VTKFile type="UnstructuredGrid" compressor="vtkZLibDataCompressor"><UnstructuredGrid>
<Piece NumberOfPoints="8" NumberOfCells="2"><Points>
{array("Float32", [c for p in points for c in p], 'NumberOfComponents="3"')}
</Points><Cells>
{array("Int32", list(range(8)), 'Name="connectivity"')}
{array("Int32", [4, 8], 'Name="offsets"')}
{array("UInt8", [9, 9], 'Name="types"')}
</Cells><PointData>
{array("Float32", [0] * 4 + [1] * 4, 'Name="region"')}
{array("Float32", [0.25] * 4 + [0.75] * 4, 'Name="scaled_Jacobian"')}
{array("Float32", [3.5] * 4 + [12.25] * 4, 'Name="von_Mises_stress"')}
</PointData></Piece></UnstructuredGrid></VTKFile>"""


FILES = {
    "history.csv": "time [T],force x [N],time step [T],Newton iterations,rejected attempts,"
                   "smallest scaled Jacobian,bone mass balance,assembly [s]\n"
                   "0.5,2,0.5,3,0,0.25,1e-15,0.1\n1,4,0.5,4,2,0.25,-3e-15,0.2\n1.5,",  # cut short
    "remeshes.csv": "remesh,time [T],force x [N] before,force x [N] after\n1,0.5,2,2.02\n",
    "summary.json": '{"completed": false, "reason": "t = 1 T: it is <over>", "title": "Made & up", "steps": 2}',
    "log.txt": "Alveolus\nt = 1 T rejected (step 1): corner at (3, 4)\nt = 1 T rejected (step 0.7): corner at (5, 6)\n"
               "t = 1 T accepted, residuals 1\n",
    "parameters.prm": "set Title = Made up # default: \nsubsection Time\n  # The end.\n  set End = 7 # default: 1\n"
                      "  set Start = 0\nend\n",
    "fields.pvd": '<VTKFile type="Collection"><Collection><DataSet timestep="0" file="a.vtu"/>'
                  '<DataSet timestep="1" file="b.vtu"/></Collection></VTKFile>',
    "a.vtu": vtu(0),
    "b.vtu": vtu(0.5),
}

shutil.rmtree(work, ignore_errors=True)
run = os.path.join(work, "run")
os.makedirs(run)
for name, content in FILES.items():
    with open(os.path.join(run, name), "w", encoding="utf-8") as file:
        file.write(content)

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(top, "scripts"))
from reporting import drawing, results  # noqa: E402

fields = results.Fields(os.path.join(run, "b.vtu"))
need(fields.points[5] == (2.5, 0.0, 0.0), "points of a file with fields")
need(fields.cells == [[0, 1, 2, 3], [4, 5, 6, 7]], "cells of a file with fields")
need(fields.values["von_Mises_stress"][-1] == 12.25, "values of a file with fields")
state = results.Run(run)
need(state.columns["force x [N]"] == [2.0, 4.0], "columns of history.csv")
need(state.rejected() == [("1", "1", "corner at (3, 4)"), ("1", "0.7", "corner at (5, 6)")], "rejections")
need(state.changed_parameters() == [("", "Title", "Made up", ""), ("Time", "End", "7", "1")], "parameters")
need(drawing.ticks(0.0, 1.0) == [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0], "ticks")

# A cube of 2 x 2 x 2 hexahedra shows 24 faces.
cube = results.Fields(os.path.join(run, "a.vtu"))
cube.points, cube.cells = [], []
for k in range(8):
    corner = (k & 1, k >> 1 & 1, k >> 2)
    cube.cells.append(list(range(8 * k, 8 * k + 8)))
    cube.points += [tuple(a + b for a, b in zip(corner, p)) for p in
                    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]]
need(len(drawing.faces_of(cube)) == 24, "faces of a cube")

report = os.path.join(top, "scripts", "report")
subprocess.run([sys.executable, report, run], check=True, capture_output=True)
page = open(os.path.join(run, "report.html"), encoding="utf-8").read()
for words in ("Made &amp; up", "Stopped early:", "t = 1 T: it is &lt;over&gt;", "corner at (3, 4)", "bone mass balance",
              "2 → 2.02 (+1.000 %)", "Time</td>", "t = 0.5 T"):
    need(words in page, "not in the report: " + words)
need("<td class='n'>2</td><td>corner at (3, 4)" in page, "rejections are counted by reason")
need(not re.search(r"(src|href)=|@import|url\(|<script", page), "the report refers to other files")
need(page.count("<svg") == page.count("</svg>") >= 8, "curves and pictures")

empty = os.path.join(work, "empty")
os.makedirs(empty)
done = subprocess.run([sys.executable, report, empty], capture_output=True, text=True, check=False)
need(done.returncode == 2 and "no history.csv" in done.stderr, "a folder without a run")
print("report: all as it must be")
