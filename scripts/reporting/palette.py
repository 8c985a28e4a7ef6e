# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes a PNG small: 256 colours instead of millions."""
import struct
import zlib


def pixels_of(data):
    """Width, height and rows of (r, g, b) of an 8-bit PNG in RGB or RGBA."""
    position, packed, head = 8, b"", None
    while position < len(data):
        length, kind = struct.unpack(">I4s", data[position:position + 8])
        body = data[position + 8:position + 8 + length]
        if kind == b"IHDR":
            head = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        position += 12 + length
    width, height, depth, colour = head[:4]
    if depth != 8 or colour not in (2, 6):
        raise ValueError("not an 8-bit PNG in colour")
    n = 3 if colour == 2 else 4
    raw, stride, before, rows = zlib.decompress(packed), width * n, bytearray(width * n), []
    for y in range(height):
        kind = raw[y * (stride + 1)]
        line = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        if kind == 1:
            for i in range(n, stride):
                line[i] = (line[i] + line[i - n]) & 255
        elif kind == 2:
            for i in range(stride):
                line[i] = (line[i] + before[i]) & 255
        elif kind == 3:
            for i in range(stride):
                left = line[i - n] if i >= n else 0
                line[i] = (line[i] + (left + before[i]) // 2) & 255
        elif kind == 4:
            for i in range(stride):
                a = line[i - n] if i >= n else 0
                b, c = before[i], before[i - n] if i >= n else 0
                pa, pb, pc = abs(b - c), abs(a - c), abs(a + b - 2 * c)
                line[i] = (line[i] + (a if pa <= pb and pa <= pc else b if pb <= pc else c)) & 255
        before = line
        rows.append([tuple(line[i:i + 3]) for i in range(0, stride, n)])
    return width, height, rows


def shrink(name):
    """Replace the file by one with a palette."""
    with open(name, "rb") as file:
        width, height, rows = pixels_of(file.read())
    count = {}
    for row in rows:
        for p in row:
            q = (p[0] >> 3, p[1] >> 3, p[2] >> 3)
            count[q] = count.get(q, 0) + 1
    palette = sorted(count, key=lambda q: (-count[q], q))[:256]
    index = {q: i for i, q in enumerate(palette)}

    def nearest(q):
        if q not in index:
            index[q] = min(range(len(palette)),
                           key=lambda i: sum((a - b) ** 2 for a, b in zip(q, palette[i])))
        return index[q]

    lines = b"".join(b"\0" + bytes(nearest((p[0] >> 3, p[1] >> 3, p[2] >> 3)) for p in row) for row in rows)

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    colours = bytes(round(c * 255 / 31) for q in palette for c in q)
    with open(name, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0))
                   + chunk(b"PLTE", colours) + chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b""))
