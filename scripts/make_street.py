#!/usr/bin/env python3
"""Makes a street for a crowd to walk in: make_street.py FILE.glb

A paved street 16 m wide and 130 m long between two rows of houses, with windows, doors, awnings, lamps and trees.
It runs along Z; the middle is at the origin, the ground at y = 0. Metres. The same file every time.
"""
import json
import math
import random
import struct
import sys

HALF_WIDTH, NEAR, FAR = 8.0, 40.0, -90.0
COLORS = {"paving": (0.40, 0.385, 0.365), "slabs": (0.33, 0.32, 0.31), "plaster": (0.66, 0.60, 0.50),
          "ochre": (0.62, 0.44, 0.24), "brick": (0.40, 0.20, 0.15), "grey": (0.46, 0.48, 0.50),
          "rose": (0.60, 0.42, 0.37), "stone": (0.55, 0.53, 0.49), "glass": (0.07, 0.09, 0.12),
          "wood": (0.20, 0.12, 0.07), "roof": (0.24, 0.13, 0.10), "iron": (0.05, 0.055, 0.06),
          "red": (0.45, 0.07, 0.06), "green": (0.08, 0.22, 0.12), "leaves": (0.13, 0.24, 0.07),
          "lamp": (0.9, 0.85, 0.7)}
AXES = [((1, 0, 0), (0, 1, 0), (0, 0, 1)), ((0, 1, 0), (0, 0, 1), (1, 0, 0)), ((0, 0, 1), (1, 0, 0), (0, 1, 0))]


class Street:
    """Faces by material."""

    def __init__(self):
        self.faces = {name: ([], [], []) for name in COLORS}  # positions, normals, indices

    def polygon(self, name, corners, center=None):
        """Convex; seen from where its corners run anticlockwise. Round about a center, if there is one."""
        positions, normals, indices = self.faces[name]
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners[:3]
        u, v = (bx - ax, by - ay, bz - az), (cx - ax, cy - ay, cz - az)
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        length = math.sqrt(sum(c * c for c in normal))
        first = len(positions)
        positions += corners
        if center is None:
            normals += [tuple(c / length for c in normal)] * len(corners)
        else:
            apart = [[c - m for c, m in zip(corner, center)] for corner in corners]
            normals += [tuple(c / math.hypot(*way) for c in way) for way in apart]
        for k in range(1, len(corners) - 1):
            indices += [first, first + k, first + k + 1]

    def box(self, name, low, high):
        low, high = [min(a, b) for a, b in zip(low, high)], [max(a, b) for a, b in zip(low, high)]
        size = [b - a for a, b in zip(low, high)]
        for normal, along, up in AXES:
            n, a, u = ([s * c for s, c in zip(size, axis)] for axis in (normal, along, up))
            far = [c + d for c, d in zip(low, n)]
            corner = lambda at, *ways: tuple(c + sum(way[i] for way in ways) for i, c in enumerate(at))  # noqa: E731
            self.polygon(name, [corner(far), corner(far, a), corner(far, a, u), corner(far, u)])
            self.polygon(name, [corner(low), corner(low, u), corner(low, a, u), corner(low, a)])

    def blob(self, name, center, radius, sides=10):
        """A ball, a little flat."""
        ring = lambda k: [tuple(c + radius * f for c, f in zip(center, (  # noqa: E731
            math.sin(math.pi * k / 6) * math.cos(2 * math.pi * i / sides), -0.85 * math.cos(math.pi * k / 6),
            math.sin(math.pi * k / 6) * math.sin(2 * math.pi * i / sides)))) for i in range(sides)]
        for k in range(6):
            low, high = ring(k), ring(k + 1)
            for i in range(sides):
                j = (i + 1) % sides
                corners = [low[i], high[i], high[j], low[j]]
                self.polygon(name, corners[:3] if k == 0 else corners[:2] + corners[3:] if k == 5 else corners,
                             center)


def house(street, side, z, width, floors, wall, rng):
    """A front that stands on the street's edge, from z backwards."""
    x, deep = side * HALF_WIDTH, side * (HALF_WIDTH + 9)
    height = 3.9 + 3.1 * floors
    street.box(wall, (x, 0, z), (deep, height, z - width))
    out = x - side * 0.12
    street.box("stone", (x, 0, z), (out, 0.6, z - width))
    street.box("stone", (x, height - 0.35, z), (x - side * 0.35, height, z - width))
    street.polygon("roof", [(x - side * 0.35, height, z), (deep, height + 3.4, z), (deep, height + 3.4, z - width),
                            (x - side * 0.35, height, z - width)][::-side])
    columns = max(2, round(width / 2.6))
    pitch = width / columns
    for column in range(columns):
        middle = z - pitch * (column + 0.5)
        for floor in range(floors):
            foot = 4.6 + 3.1 * floor
            street.box("stone", (x, foot - 0.15, middle - 0.72), (x - side * 0.16, foot, middle + 0.72))
            street.box("stone", (x, foot, middle - 0.62), (x - side * 0.06, foot + 1.75, middle + 0.62))
            street.box("glass", (x, foot + 0.08, middle - 0.52), (x - side * 0.08, foot + 1.66, middle + 0.52))
        if column == columns // 2:
            street.box("wood", (x, 0, middle - 0.6), (x - side * 0.14, 2.4, middle + 0.6))
        else:
            street.box("glass", (x, 0.7, middle - pitch * 0.4), (x - side * 0.13, 2.9, middle + pitch * 0.4))
    if rng.random() < 0.6:
        near, far = (x - side * 0.02, 3.4), (x - side * 1.5, 2.9)
        cloth = [(near[0], near[1], z - 0.4), (far[0], far[1], z - 0.4), (far[0], far[1], z - width + 0.4),
                 (near[0], near[1], z - width + 0.4)]
        name = rng.choice(["red", "green"])
        street.polygon(name, cloth)
        street.polygon(name, cloth[::-1])


def build():
    street, rng = Street(), random.Random(4)
    ground = lambda name, x0, x1, y: street.polygon(  # noqa: E731
        name, [(x0, y, NEAR), (x1, y, NEAR), (x1, y, FAR), (x0, y, FAR)])
    ground("paving", -HALF_WIDTH - 10, HALF_WIDTH + 10, 0.0)
    for z in range(int(FAR), int(NEAR), 3):  # lines of darker slabs
        street.polygon("slabs", [(-HALF_WIDTH, 0.004, z), (-HALF_WIDTH, 0.004, z + 0.22),
                                 (HALF_WIDTH, 0.004, z + 0.22), (HALF_WIDTH, 0.004, z)])
    for x in (-4.6, 4.6):
        ground("slabs", x - 0.2, x + 0.2, 0.006)
    for side in (-1, 1):
        z, before = NEAR, ""
        while z > FAR:
            width = rng.uniform(7.5, 13.0)
            wall = rng.choice([name for name in ("plaster", "ochre", "brick", "grey", "rose") if name != before])
            house(street, side, z, width, rng.choice([2, 3, 3, 4]), wall, rng)
            z, before = z - width, wall
        for number, z in enumerate(range(int(FAR) + 6, int(NEAR), 9)):
            x = side * 6.3
            if number % 2:
                street.box("iron", (x - 0.06, 0, z - 0.06), (x + 0.06, 3.8, z + 0.06))
                street.blob("lamp", (x, 4.0, z), 0.24, 8)
            else:
                street.box("wood", (x - 0.13, 0, z - 0.13), (x + 0.13, 2.6, z + 0.13))
                for dx, dy, dz, radius in ((0, 3.9, 0, 1.5), (0.6, 3.2, 0.5, 1.0), (-0.5, 3.3, -0.6, 1.05)):
                    street.blob("leaves", (x + dx, dy, z + dz), radius)
    street.box("ochre", (-HALF_WIDTH - 4, 0, FAR - 8), (HALF_WIDTH + 4, 13, FAR))  # where the street ends
    street.box("stone", (-HALF_WIDTH - 4, 12.6, FAR), (HALF_WIDTH + 4, 13, FAR + 0.4))
    for x in range(-9, 10, 3):
        for foot in (1.0, 5.0, 8.8):
            street.box("stone", (x - 0.85, foot - 0.2, FAR), (x + 0.85, foot + 2.6, FAR + 0.1))
            street.box("glass", (x - 0.65, foot, FAR), (x + 0.65, foot + 2.3, FAR + 0.15))
    return street


def glb(street):
    binary, views, accessors, primitives, materials = bytearray(), [], [], [], []

    def accessor(values, kind, code):
        views.append({"buffer": 0, "byteOffset": len(binary)})
        flat = [c for value in values for c in value] if kind == "VEC3" else values
        binary.extend(struct.pack(f"<{len(flat)}{code}", *flat))
        views[-1]["byteLength"] = len(binary) - views[-1]["byteOffset"]
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126 if code == "f" else 5125,
                          "count": len(values), "type": kind})
        return len(accessors) - 1
    for name, (positions, normals, indices) in street.faces.items():
        place = accessor(positions, "VEC3", "f")
        accessors[place]["min"] = [min(p[i] for p in positions) for i in range(3)]
        accessors[place]["max"] = [max(p[i] for p in positions) for i in range(3)]
        for bound in ("min", "max"):  # as single precision has them
            accessors[place][bound] = list(struct.unpack("<3f", struct.pack("<3f", *accessors[place][bound])))
        primitives.append({"attributes": {"POSITION": place, "NORMAL": accessor(normals, "VEC3", "f")},
                           "indices": accessor(indices, "SCALAR", "I"), "material": len(materials)})
        materials.append({"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*COLORS[name], 1]}})
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": [{"name": "street", "mesh": 0}], "meshes": [{"primitives": primitives}],
                "materials": materials, "accessors": accessors, "bufferViews": views,
                "buffers": [{"byteLength": len(binary)}]}
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(binary)
    return (struct.pack("<4sIIII", b"glTF", 2, total, len(text), 0x4E4F534A) + text
            + struct.pack("<II", len(binary), 0x004E4942) + bytes(binary))


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__.strip())
        sys.exit(0 if sys.argv[1:] in (["-h"], ["--help"]) else 2)
    with open(sys.argv[1], "wb") as file:
        file.write(glb(build()))
