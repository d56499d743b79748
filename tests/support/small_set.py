#!/usr/bin/env python3
"""Makes a small set for crowds to stand in, a street corner: small_set.py FILE.glb

A pavement at y = 0, two house fronts that meet at the back left, a gate whose beam one walks under, a
fence of a texture that is cut out, an awning of one single-sided sheet. Metres; the middle is free.
"""
import struct
import sys
import zlib

from small_glb import FLOAT, UINT, Document

SIDES = [((1, 0, 0), (0, 1, 0), (0, 0, 1)), ((0, 1, 0), (0, 0, 1), (1, 0, 0)), ((0, 0, 1), (1, 0, 0), (0, 1, 0))]


def fence_png(side=64):
    """Bars on nothing: RGBA, alpha 0 between them."""
    rows = bytearray()
    for y in range(side):
        rows.append(0)
        for x in range(side):
            is_bar = x % 16 < 4 or y < 6 or y >= side - 6
            rows += bytes((52, 44, 40, 255 if is_bar else 0))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 6, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


class Faces:
    """Quads of one material."""

    def __init__(self):
        self.positions, self.normals, self.uvs, self.indices = [], [], [], []

    def quad(self, corner, along, up, tiles=(1, 1)):
        """Seen from where `along` x `up` points to."""
        cross = [along[1] * up[2] - along[2] * up[1], along[2] * up[0] - along[0] * up[2],
                 along[0] * up[1] - along[1] * up[0]]
        length = sum(c * c for c in cross) ** 0.5
        first = len(self.positions)
        for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
            self.positions.append(tuple(c + u * a + v * b for c, a, b in zip(corner, along, up)))
            self.normals.append(tuple(c / length for c in cross))
            self.uvs.append((u * tiles[0], (1 - v) * tiles[1]))
        self.indices += [first, first + 1, first + 2, first, first + 2, first + 3]

    def box(self, low, high):
        size = [b - a for a, b in zip(low, high)]
        for normal, along, up in SIDES:
            scaled = [[s * a for s, a in zip(size, axis)] for axis in (normal, along, up)]
            self.quad([a + n for a, n in zip(low, scaled[0])], scaled[1], scaled[2])
            self.quad(low, scaled[2], scaled[1])


def street():
    pavement, fronts, stone, fence, cloth = (Faces() for _ in range(5))
    pavement.quad((-14, 0, 14), (28, 0, 0), (0, 0, -28))
    fronts.box((-14, 0, -9), (10, 7, -8))
    fronts.box((-9, 0, -8), (-8, 5, 4))
    for x in (2.5, 6.5):
        stone.box((x, 0, -3), (x + 0.6, 3, -2.4))
    stone.box((2.2, 3, -3.1), (7.4, 3.5, -2.3))
    stone.box((-0.9, 0, 1.2), (0.9, 0.45, 1.7))  # a bench
    fence.quad((7.5, 0, 4), (0, 0, -8), (0, 1.3, 0), tiles=(8, 1))
    cloth.quad((-8, 3.2, 2), (2.4, -0.5, 0), (0, 0, -6))
    materials = [{"name": "pavement", "pbrMetallicRoughness": {"baseColorFactor": [0.42, 0.41, 0.40, 1]}},
                 {"name": "fronts", "pbrMetallicRoughness": {"baseColorFactor": [0.62, 0.44, 0.32, 1]}},
                 {"name": "stone", "pbrMetallicRoughness": {"baseColorFactor": [0.55, 0.55, 0.52, 1]}},
                 {"name": "fence", "doubleSided": True, "alphaMode": "MASK",
                  "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
                 {"name": "awning", "pbrMetallicRoughness": {"baseColorFactor": [0.50, 0.10, 0.08, 1]}}]
    document = Document()
    primitives = [{"attributes": {"POSITION": document.accessor(FLOAT, "VEC3", faces.positions),
                                  "NORMAL": document.accessor(FLOAT, "VEC3", faces.normals),
                                  "TEXCOORD_0": document.accessor(FLOAT, "VEC2", faces.uvs)},
                   "indices": document.accessor(UINT, "SCALAR", faces.indices), "material": number}
                  for number, faces in enumerate((pavement, fronts, stone, fence, cloth))]
    document.add_image("image/png", fence_png())
    document.json.update(
        scenes=[{"nodes": [0]}], nodes=[{"name": "street", "mesh": 0}], materials=materials,
        meshes=[{"name": "street", "primitives": primitives}], textures=[{"source": 0}])
    return document


def main():
    with open(sys.argv[1], "wb") as file:
        file.write(street().bytes())


if __name__ == "__main__":
    main()
