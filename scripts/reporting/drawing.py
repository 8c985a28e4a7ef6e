# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves and meshes as SVG."""
import html
import math

COLOURS = ["#b2182b", "#2166ac", "#4d9221", "#8073ac", "#e08214", "#35978f"]
REGIONS = ["#c9dcee", "#fbe6bb", "#cfe8c5", "#f0cfd6", "#ddd3ec", "#c5e6e3"]
RAMP = [(68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37)]
N_BINS = 32


def finite(values):
    return [v for v in values if math.isfinite(v)]


def ticks(low, high, n=5):
    step = 10 ** math.floor(math.log10((high - low) / n))
    for factor in (1, 2, 5, 10):
        if (high - low) / (factor * step) <= n:
            step *= factor
            break
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def chart(title, x_label, x, curves, logarithmic=False):
    """Curves [(name, values)] against x; logarithmic leaves out what is <= 0."""
    if logarithmic:
        curves = [(n, [math.log10(v) if v > 0 else math.nan for v in values])
                  for n, values in curves]
    all_y = finite([v for _, values in curves for v in values])
    if not all_y or not finite(x):
        return ""
    low, high = min(all_y), max(all_y)
    if high - low < 1e-12 * max(abs(low), abs(high)) or high == low:
        pad = 0.5 * abs(high) or 1.0
        low, high = low - pad, high + pad
    x_low, x_high = min(finite(x)), max(finite(x))
    if x_high == x_low:
        x_low, x_high = x_low - 0.5, x_high + 0.5
    width, height, left, top = 520, 300, 70, 34
    right, bottom = width - 14, height - 44 - 18 * ((len(curves) + 1) // 2)

    def px(v):
        return left + (v - x_low) / (x_high - x_low) * (right - left)

    def py(v):
        return bottom - (v - low) / (high - low) * (bottom - top)

    out = [f'<svg viewBox="0 0 {width} {height}" class="chart">',
           f'<text x="{left}" y="20" class="title">{html.escape(title)}</text>']
    for v in ticks(low, high):
        text = f"1e{v:g}" if logarithmic else f"{v:.6g}"
        out.append(f'<path class="grid" d="M{left} {py(v):.1f}H{right}"/>'
                   f'<text x="{left - 6}" y="{py(v) + 4:.1f}" class="end">{text}</text>')
    for v in ticks(x_low, x_high, 6):
        out.append(f'<path class="grid" d="M{px(v):.1f} {top}V{bottom}"/>'
                   f'<text x="{px(v):.1f}" y="{bottom + 16}" class="middle">{v:.6g}</text>')
    out.append(f'<text x="{right}" y="{bottom + 32}" class="end">{html.escape(x_label)}</text>')
    out.append(f'<rect x="{left}" y="{top}" width="{right - left}" height="{bottom - top}" class="frame"/>')
    for k, (name, values) in enumerate(curves):
        colour = COLOURS[k % len(COLOURS)]
        path, pen = "", "M"
        for a, b in zip(x, values):
            if math.isfinite(b):
                path += f"{pen}{px(a):.1f} {py(b):.1f}"
                pen = "L"
            else:
                pen = "M"
        if path.count("M") + path.count("L") == 1:
            path += "h0.1"
        out.append(f'<path class="curve" stroke="{colour}" d="{path}"/>')
        if len(curves) > 1 or name != title:
            a, b = left + (k % 2) * 225, bottom + 48 + 18 * (k // 2)
            out.append(f'<path stroke="{colour}" stroke-width="3" d="M{a} {b - 4}h18"/>'
                       f'<text x="{a + 24}" y="{b}">{html.escape(name)}</text>')
    return "".join(out) + "</svg>"


# Meshes


def is_solid(fields):
    """Whether the cells are hexahedra: 8 or 27 points, not 4 or 9."""
    return len(fields.cells[0]) not in (4, 9)


def faces_of(fields):
    """Corners of what is seen, with the points that give the colour."""
    if not is_solid(fields):
        # Of degree 2 the corners come first, then the middles of the edges
        return [[cell[k] for k in (0, 4, 1, 5, 2, 6, 3, 7)] if len(cell) == 9 else cell[:4]
                for cell in fields.cells]
    # Hexahedra, their corners first: faces that belong to one cell only
    sides = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    seen = {}
    for cell in fields.cells:
        for side in sides:
            face = [cell[k] for k in side]
            key = tuple(sorted(tuple(round(c, 5) for c in fields.points[v]) for v in face))
            seen[key] = None if key in seen else face
    return [face for face in seen.values() if face]


def projection(three):
    """Right, up and towards the eye, from a point."""
    if not three:
        return lambda p: (p[0], p[1], 0.0)
    # y is up: the axis of teeth. Planes of symmetry are at z = 0.
    eye = (0.4784, 0.4305, -0.7654)
    right = (-0.848, 0.0, -0.53)
    up = (eye[1] * right[2] - eye[2] * right[1], eye[2] * right[0] - eye[0] * right[2],
          eye[0] * right[1] - eye[1] * right[0])
    return lambda p: tuple(sum(a * b for a, b in zip(axis, p)) for axis in (right, up, eye))


def ramp(s):
    s = min(max(s, 0.0), 1.0) * (len(RAMP) - 1)
    k = min(int(s), len(RAMP) - 2)
    rgb = [a + (b - a) * (s - k) for a, b in zip(RAMP[k], RAMP[k + 1])]
    return "#%02x%02x%02x" % tuple(round(c) for c in rgb)


def mesh(fields, name, title, bounds=None):
    """The mesh with the field `name` as colour; `region` gets plain colours."""
    values = fields.values.get(name)
    if not values or not fields.cells:
        return ""
    faces = faces_of(fields)
    three = is_solid(fields)
    project = projection(three)
    places = [project(p) for p in fields.points]
    used = {v for face in faces for v in face}
    x = [places[v][0] for v in used]
    y = [places[v][1] for v in used]
    size = max(max(x) - min(x), max(y) - min(y)) or 1.0
    scale, x0, y1 = 500 / size, min(x), max(y)
    width, height = (max(x) - x0) * scale + 20, (y1 - min(y)) * scale + 70
    means = [sum(values[v] for v in face) / len(face) for face in faces]
    low, high = bounds or (min(finite(means) or [0]), max(finite(means) or [1]))

    def colour(value):
        if not math.isfinite(value):
            return "#dddddd"
        if name == "region":
            return REGIONS[int(value) % len(REGIONS)]
        s = (value - low) / (high - low) if high > low else 0.5
        return ramp(round(s * N_BINS) / N_BINS)

    order = sorted(range(len(faces)), key=lambda i: sum(places[v][2] for v in faces[i])) \
        if three else sorted(range(len(faces)), key=lambda i: colour(means[i]))
    paths, last = [], None
    for i in order:
        points = ["%.1f %.1f" % (10 + (places[v][0] - x0) * scale, 30 + (y1 - places[v][1]) * scale)
                  for v in faces[i]]
        # In space each by itself: what overlaps in one path may cancel
        if three or colour(means[i]) != last:
            last = colour(means[i])
            paths.append((last, []))
        paths[-1][1].append("M" + "L".join(points) + "Z")
    stroke = min(0.6, 25 / math.sqrt(len(faces)))
    out = [f'<svg viewBox="0 0 {max(width, 260):.0f} {height:.0f}" class="mesh">',
           f'<text x="10" y="18" class="title">{html.escape(title)}</text>',
           f'<g stroke="#333" stroke-width="{stroke:.2f}">']
    out += [f'<path fill="{c}" d="{"".join(d)}"/>' for c, d in paths]
    out.append("</g>")
    if name != "region":
        for k in range(20):
            out.append(f'<rect x="{10 + 6 * k}" y="{height - 26:.0f}" width="6.5" height="10" fill="{ramp(k / 19)}"/>')
        out.append(f'<text x="10" y="{height - 3:.0f}">{low:.3g}</text>'
                   f'<text x="136" y="{height - 17:.0f}">{high:.3g}</text>')
    return "".join(out) + "</svg>"
