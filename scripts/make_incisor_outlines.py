#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writes meshes/incisor-tooth.csv and meshes/incisor-bone.csv.

Labio-lingual section of a mandibular central incisor and of the symphysis
around it, drawn from dimensions of dental anatomy (mm), not from a scan: length
21.5 with a root of 12.5; labiolingual width 5.3 at the cervix, 6.0 at the crown,
about 1 at the incisal edge; crest of the bone 1.75 below the cervix, plates of
about 1.45 (labial) and 1.6 (lingual) over the root, thicker below it; symphysis
24 high below the crest and 14 wide. Origin at the root's apex, +y towards the
incisal edge, -x labial.
"""
import math
import os

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "meshes")

CERVIX = 12.5
HALF_WIDTH = 2.65  # at the cervix


def root_half_width(y):
    """Vertical tangent at the cervix, rounded at the apex."""
    return HALF_WIDTH * math.sqrt(1.0 - (1.0 - y / CERVIX) ** 1.6)


def periodic_spline(points, spacing):
    """Points about `spacing` apart on the closed cubic spline through `points`."""
    n = len(points)
    t = [0.0]
    for i in range(n):
        a, b = points[i], points[(i + 1) % n]
        t.append(t[-1] + math.hypot(b[0] - a[0], b[1] - a[1]))
    h = [t[i + 1] - t[i] for i in range(n)]
    moments = []
    for c in range(2):
        slope = [(points[(i + 1) % n][c] - points[i][c]) / h[i] for i in range(n)]
        m = [0.0] * n
        for _ in range(400):  # Gauss-Seidel: diagonally dominant
            for i in range(n):
                right = 6.0 * (slope[i] - slope[i - 1])
                m[i] = (right - h[i - 1] * m[i - 1] - h[i] * m[(i + 1) % n]) / (
                    2.0 * (h[i - 1] + h[i])
                )
        moments.append(m)
    result = []
    for i in range(n):
        steps = max(1, round(h[i] / spacing))
        for k in range(steps):
            b = k / steps
            a = 1.0 - b
            j = (i + 1) % n
            result.append(
                tuple(
                    a * points[i][c]
                    + b * points[j][c]
                    + h[i] ** 2
                    / 6.0
                    * ((a**3 - a) * moments[c][i] + (b**3 - b) * moments[c][j])
                    for c in range(2)
                )
            )
    return result


def tooth():
    # Root points at equal angles of a circle, denser at the apex
    right_root = []
    for i in range(1, 13):
        y = CERVIX * (1.0 - math.cos(0.5 * math.pi * i / 12))
        right_root.append((root_half_width(y), y))
    left_root = [(-x, y) for x, y in reversed(right_root)]
    lingual = [
        (3.0, 14.0),
        (2.62, 15.6),
        (1.98, 17.2),
        (1.42, 18.8),
        (0.93, 20.4),
        (0.6, 21.15),
    ]
    labial = [
        (-0.6, 21.1),
        (-1.2, 20.2),
        (-1.95, 18.7),
        (-2.57, 16.9),
        (-2.95, 15.2),
        (-2.95, 13.9),
    ]
    ring = [(0.0, 0.0)] + right_root + lingual + [(0.0, 21.5)] + labial + left_root
    points = periodic_spline(ring, 0.3)

    def label(a, b):
        x, y = 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])
        if y > 21.13:
            return "incisal edge"
        if y > CERVIX:
            return "crown labial" if x < 0 else "crown lingual"
        return "root"

    return points, label


def bone():
    ring = [
        (-1.5, 10.75),
        (-2.8, 10.75),
        (-3.45, 10.55),
        (-3.95, 9.9),
        (-4.15, 8.8),
        (-4.15, 7.0),
        (-4.0, 5.0),
        (-3.85, 3.2),
        (-3.85, 1.6),
        (-4.15, 0.0),
        (-5.1, -2.5),
        (-6.2, -5.3),
        (-6.75, -8.0),
        (-6.3, -10.6),
        (-5.0, -12.5),
        (-3.0, -13.25),
        (-1.0, -13.4),
        (1.0, -13.4),
        (3.0, -13.25),
        (5.2, -12.5),
        (6.7, -10.6),
        (7.25, -8.0),
        (7.1, -5.0),
        (6.6, -2.0),
        (6.0, 1.0),
        (5.35, 4.0),
        (4.8, 6.6),
        (4.4, 8.8),
        (4.15, 9.9),
        (3.6, 10.55),
        (2.8, 10.75),
        (1.5, 10.75),
        (0.0, 10.75),
    ]
    points = periodic_spline(ring, 0.3)

    def label(a, b):
        x, y = 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])
        if y > 9.9:
            return "crest"
        return "bone base" if y < -12.5 else "bone surface"

    return points, label


def write(name, title, points, label):
    with open(os.path.join(FOLDER, name), "w", encoding="ascii") as file:
        file.write("# %s\n" % title)
        file.write("# Made by scripts/make_incisor_outlines.py; a label belongs")
        file.write(" to the line from its point to the next.\n")
        file.write("x [mm],y [mm],piece\n")
        for i, point in enumerate(points):
            following = points[(i + 1) % len(points)]
            file.write("%.5f,%.5f,%s\n" % (point + (label(point, following),)))


write(
    "incisor-tooth.csv",
    "Section of a mandibular central incisor, closed ring, mm",
    *tooth()
)
write("incisor-bone.csv", "Section of the symphysis, closed ring, mm", *bone())
