#!/usr/bin/env python3
"""Writes corpus/glb/*.glb: small files that together use every kind of thing the reader knows.

What libFuzzer found stays beside them as refused_NAME.

Usage: make_corpus.py, then draco_encode.cjs (tests/proofs) of skinned.glb gives draco.glb.
"""
import json
import pathlib
import struct
import zlib

CORPUS = pathlib.Path(__file__).resolve().parent / "corpus/glb"
FLOAT, BYTE, UBYTE, SHORT, USHORT, UINT = 5126, 5120, 5121, 5122, 5123, 5125
FORMATS = {FLOAT: "f", BYTE: "b", UBYTE: "B", SHORT: "h", USHORT: "H", UINT: "I"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Writer:
    def __init__(self):
        self.binary, self.views, self.accessors = bytearray(), [], []

    def view(self, data, **more):
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **more})
        self.binary += data
        return len(self.views) - 1

    def accessor(self, component, kind, rows, **more):
        flat = [number for row in rows for number in (row if isinstance(row, (tuple, list)) else (row,))]
        packed = struct.pack(f"<{len(flat)}{FORMATS[component]}", *flat)
        entry = {"bufferView": self.view(packed), "componentType": component, "count": len(rows), "type": kind}
        if kind == "VEC3" and component == FLOAT:
            entry["min"] = [min(column) for column in zip(*rows)]
            entry["max"] = [max(column) for column in zip(*rows)]
        self.accessors.append({**entry, **more})
        return len(self.accessors) - 1

    def write(self, name, document):
        document = {"asset": {"version": "2.0"}, "scene": 0, **document, "accessors": self.accessors,
                    "bufferViews": self.views, "buffers": [{"byteLength": len(self.binary)}]}
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.binary) + b"\0" * (-len(self.binary) % 4)
        (CORPUS / name).write_bytes(
            struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(binary), len(text), b"JSON") + text
            + struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def png():
    """2 x 2 pixels, RGBA."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes([200, 100, 50, 255, 10, 20, 30, 0]) for _ in range(2))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 6, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


POSITIONS = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 1.0, 0.25), (0.5, 2.0, 0.0)]
FACES = [0, 1, 2, 2, 1, 3, 2, 3, 4]
IDENTITY = (1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0)


def skinned():
    """Two bones, two materials with a texture, clips of all three interpolations."""
    writer = Writer()
    attributes = {
        "POSITION": writer.accessor(FLOAT, "VEC3", POSITIONS),
        "NORMAL": writer.accessor(FLOAT, "VEC3", [(0.0, 0.0, 1.0)] * 5),
        "TEXCOORD_0": writer.accessor(FLOAT, "VEC2", [(x / 2, y / 2) for x, y, _ in POSITIONS]),
        "JOINTS_0": writer.accessor(UBYTE, "VEC4", [(0, 1, 0, 0)] * 5),
        "WEIGHTS_0": writer.accessor(FLOAT, "VEC4", [(0.75, 0.25, 0.0, 0.0)] * 5),
    }
    indices = writer.accessor(USHORT, "SCALAR", FACES)
    bind = writer.accessor(FLOAT, "MAT4", [IDENTITY, IDENTITY[:13] + (-1.0, 0, 1.0)])
    times = writer.accessor(FLOAT, "SCALAR", [0.0, 0.5, 1.0], min=[0.0], max=[1.0])
    turns = writer.accessor(FLOAT, "VEC4", [(0, 0, 0, 1.0), (0, 0, 0.6, 0.8), (0, 0, 0, 1.0)])
    moves = writer.accessor(FLOAT, "VEC3", [(0.0, 1.0, 0.0), (0.0, 1.1, 0.0), (0.0, 1.0, 0.0)])
    cubic = writer.accessor(FLOAT, "VEC3", [(0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)] * 3)
    image = writer.view(png())
    writer.write("skinned.glb", {
        "scenes": [{"nodes": [0, 2], "extras": {"ensemble": {"slot": "top", "layer": 1}}}],
        "nodes": [{"name": "root", "children": [1]}, {"name": "tip", "translation": [0, 1, 0]},
                  {"name": "body", "mesh": 0, "skin": 0}],
        "meshes": [{"name": "body", "primitives": [
            {"attributes": attributes, "indices": indices, "material": 0},
            {"attributes": attributes, "material": 1, "mode": 5}]}],
        "materials": [
            {"name": "skin", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "alphaMode": "MASK"},
            {"name": "cloth", "doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.2, 0.1, 1]}}],
        "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33071}],
        "images": [{"name": "pixels", "mimeType": "image/png", "bufferView": image}],
        "skins": [{"joints": [0, 1], "inverseBindMatrices": bind}],
        "animations": [{"name": "walk", "samplers": [
            {"input": times, "output": turns}, {"input": times, "output": moves, "interpolation": "STEP"},
            {"input": times, "output": cubic, "interpolation": "CUBICSPLINE"}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}},
                         {"sampler": 1, "target": {"node": 1, "path": "translation"}},
                         {"sampler": 2, "target": {"node": 1, "path": "scale"}}]}]})


def packed():
    """Quantised, interleaved, sparse and normalised accessors, 32-bit indices, a strip and a fan."""
    writer = Writer()
    rows = b"".join(struct.pack("<3hH3bB2H", int(x * 1000), int(y * 1000), int(z * 1000), 0, 0, 0, 127, 0,
                                int(x * 60000), int(y * 30000)) for x, y, z in POSITIONS)
    view = writer.view(rows, byteStride=16)

    def interleaved(offset, component, kind, **more):
        writer.accessors.append({"bufferView": view, "byteOffset": offset, "componentType": component, "count": 5,
                                 "type": kind, **more})
        return len(writer.accessors) - 1
    attributes = {"POSITION": interleaved(0, SHORT, "VEC3", min=[0, 0, 0], max=[1000, 2000, 250]),
                  "NORMAL": interleaved(8, BYTE, "VEC3", normalized=True),
                  "TEXCOORD_0": interleaved(12, USHORT, "VEC2", normalized=True)}
    sparse_indices, sparse_values = writer.view(struct.pack("<2B", 1, 3)), writer.view(struct.pack("<8H", *range(8)))
    writer.accessors.append({"componentType": USHORT, "count": 5, "type": "VEC4", "normalized": True, "sparse": {
        "count": 2, "indices": {"bufferView": sparse_indices, "componentType": UBYTE},
        "values": {"bufferView": sparse_values}}})
    attributes["COLOR_0"] = len(writer.accessors) - 1
    attributes["_HIDE"] = writer.accessor(FLOAT, "SCALAR", [1.0, 1.0, 1.0, -1.0, 0.0])
    wide, narrow = writer.accessor(UINT, "SCALAR", FACES), writer.accessor(UBYTE, "SCALAR", [0, 1, 2, 3, 4])
    writer.write("packed.glb", {
        "extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"],
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "hat", "mesh": 0, "scale": [-0.001, 0.001, 0.001], "children": [1]},
                  {"name": "brim", "mesh": 0, "matrix": list(IDENTITY)}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": wide},
                                   {"attributes": attributes, "indices": narrow, "mode": 6},
                                   {"attributes": attributes, "indices": narrow, "mode": 5}]}]})


CORPUS.mkdir(parents=True, exist_ok=True)
skinned()
packed()
