#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Iterations of multigrid on a stiff block on a thin soft layer.

multigrid_iterations.py OUT.csv [PROGRAM [WORK]]

A block of 2 x 2 x 2 mm (E = 19 000 MPa, tooth) on a layer of 0.2 mm (three cells
across) that is held below, pushed sideways by a small force: the structure of a
tooth on its ligament. Counts the iterations of the first solution (CG with ML, to
1e-8) for contrasts of the stiffness, Poisson's ratios of the layer, and uniform
refinements. Needs the standard library only.
"""
import csv
import os
import re
import subprocess
import sys

SCENE = """set Title = Block on a soft layer
set Dimension = 3
subsection Mesh
  set Type = grid generator
  set Degree = 1
  subsection grid generator
    set Function       = subdivided_hyper_rectangle
    set Arguments      = 6, {n}, {n} : -1, 0, 0 : 1, 2, 2 : true
    set Map            = if(x<0, 2*x, 0.2*x); y; z
    set Boundary names = top: 0, base: 1
    set Region names   = {regions}
    set Refinements    = {refinements}
  end
end
subsection Regions
  set Names = block, layer
  subsection block
    set On = block
    set Material = stiff
  end
  subsection layer
    set On = layer
    set Material = soft
  end
end
subsection Materials
  set Names = stiff, soft
  subsection stiff
    set Type            = Hencky elastic
    set Young's modulus = 19000
    set Poisson's ratio = 0.3
  end
  subsection soft
    set Type            = Hencky elastic
    set Young's modulus = {soft}
    set Poisson's ratio = {poisson}
  end
end
subsection Conditions
  set Names = base, push
  subsection base
    set Type = displacement
    set On   = base
  end
  subsection push
    set Type      = distributed force
    set On        = top
    set Force     = {force}*t
    set Direction = 1, 1, 0
  end
end
subsection Solver
  set Linear solver      = multigrid
  set Linear tolerance   = 1e-8
  set Absolute tolerance = 1e9
end
subsection Time
  set End          = 1
  set Initial step = 1
  set Maximum step = 1
end
subsection Output
  set Fields = false
end
subsection Checkpoint
  set Write = false
end
"""

# contrast, Poisson's ratio of the layer, refinements
CASES = [(1, 0.3, (1, 2, 3)), (1e3, 0.3, (1, 2, 3)), (2.8e5, 0.3, (1, 2, 3))]
CASES += [(1, 0.49, (1, 2)), (2.8e5, 0.45, (1, 2)), (2.8e5, 0.49, (1, 2))]


def main():
    out = sys.argv[1]
    program = sys.argv[2] if len(sys.argv) > 2 else "build/alveolus"
    work = sys.argv[3] if len(sys.argv) > 3 else "output/multigrid"
    os.makedirs(work, exist_ok=True)
    with open(out, "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(
            ["contrast", "Poisson's ratio", "unknowns", "iterations", "replaced"]
        )
        for contrast, poisson, levels in CASES:
            for refinements in levels:
                scene = os.path.join(work, "scene.prm")
                with open(scene, "w") as text:
                    text.write(
                        SCENE.format(
                            n=4,
                            refinements=refinements,
                            regions="block: 6, layer: 7",
                            soft=19000 / contrast,
                            poisson=poisson,
                            force=1e-5 * 19000 / contrast,
                        )
                    )
                folder = os.path.join(work, "output")
                subprocess.run(
                    [program, "--quiet", "--threads", "1", "--output", folder, scene],
                    check=False,
                )
                with open(os.path.join(folder, "log.txt")) as log:
                    log = log.read()
                unknowns = int(re.search(r"(\d+) unknowns", log).group(1))
                found = re.search(
                    r"(\d+) linear iterations in (\d+) solutions"
                    r"(?:.*failed (\d+) times)?",
                    log,
                )
                row = [contrast, poisson, unknowns]
                if found is None:
                    row += ["", "not solved"]
                elif found.group(2) != "1":
                    row += [int(found.group(1)) / int(found.group(2))]
                    row += [found.group(3) or 0]
                else:
                    row += [int(found.group(1)), found.group(3) or 0]
                table.writerow(row)
                file.flush()
                print(*row, flush=True)


if __name__ == "__main__":
    main()
