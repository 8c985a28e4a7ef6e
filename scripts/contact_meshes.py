#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write the meshes of the contact scenes into a folder (default: meshes/).

two-blocks.msh         two blocks whose lines do not match, for the patch test
cylinder-on-block.msh  half of a cylinder on a block, for Hertz' contact

gmsh would merge the nodes of bodies that touch, so they are written here, in
its text format 2.2.
"""
import math
import pathlib
import sys


class Mesh:
    def __init__(self):
        self.nodes, self.elements, self.names = [], [], []

    def group(self, dim, name):
        if (dim, name) not in self.names:
            self.names.append((dim, name))
        return self.names.index((dim, name)) + 1

    def block(self, region, n_x, n_y, place, sides):
        """n_x times n_y quads at place(s, t), s and t from 0 to 1; `sides` are
        names of bottom, top, left and right, or None."""
        first = len(self.nodes) + 1
        self.nodes += [place(i / n_x, j / n_y)
                       for j in range(n_y + 1) for i in range(n_x + 1)]

        def node(i, j):
            return first + j * (n_x + 1) + i

        tag = self.group(2, region)
        for j in range(n_y):
            for i in range(n_x):
                self.elements.append((3, tag, tag, (
                    node(i, j), node(i + 1, j), node(i + 1, j + 1),
                    node(i, j + 1))))
        lines = ([(node(i, 0), node(i + 1, 0)) for i in range(n_x)],
                 [(node(i, n_y), node(i + 1, n_y)) for i in range(n_x)],
                 [(node(0, j), node(0, j + 1)) for j in range(n_y)],
                 [(node(n_x, j), node(n_x, j + 1)) for j in range(n_y)])
        for k, name in enumerate(sides):
            if name:
                for line in lines[k]:
                    self.elements.append(
                        (1, self.group(1, name), 10 * tag + k, line))

    def write(self, file):
        with open(file, "w", encoding="ascii") as out:
            print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames",
                  len(self.names), sep="\n", file=out)
            for tag, (dim, name) in enumerate(self.names, 1):
                print(dim, tag, f'"{name}"', file=out)
            print("$EndPhysicalNames\n$Nodes", len(self.nodes), sep="\n",
                  file=out)
            for number, (x, y) in enumerate(self.nodes, 1):
                print(number, f"{x:.12g} {y:.12g} 0", file=out)
            print("$EndNodes\n$Elements", len(self.elements), sep="\n",
                  file=out)
            for number, (kind, group, entity, nodes) in enumerate(
                    self.elements, 1):
                print(number, kind, 2, group, entity, *nodes, file=out)
            print("$EndElements", file=out)


def graded(s, fine, whole):
    """Two thirds of the lines over the length `fine`, the others grow."""
    if s < 2 / 3:
        return fine * 1.5 * s
    return fine * (whole / fine)**(3 * s - 2)


folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else
                      pathlib.Path(__file__).parent.parent / "meshes")

mesh = Mesh()
mesh.block("lower", 3, 2, lambda s, t: (3 * s, t),
           ("base", "lower top", "left", None))
mesh.block("upper", 5, 2, lambda s, t: (3 * s, 1 + t),
           ("upper bottom", "top", "left", None))
mesh.write(folder / "two-blocks.msh")

RADIUS = 100
mesh = Mesh()
mesh.block("block", 24, 24,
           lambda s, t: (graded(s, 0.8, 20), -graded(1 - t, 0.8, 20)),
           ("base", "block top", "axis", "side"))
mesh.block("cylinder", 24, 12,
           lambda s, t: (
               (RADIUS - graded(t, 0.8, 8)) *
               math.sin(graded(s, 1, 4) / RADIUS),
               RADIUS - (RADIUS - graded(t, 0.8, 8)) *
               math.cos(graded(s, 1, 4) / RADIUS)),
           ("cylinder surface", "pushed", "axis", None))
mesh.write(folder / "cylinder-on-block.msh")
