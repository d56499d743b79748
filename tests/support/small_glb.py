"""Makes small GLBs, sound ones and ones to be broken: an open tube of three regions on two joints.

The tube is the one of tests/support/small_people.h. A `Document` holds the glTF JSON and, per
accessor, a list of rows that a test may change before `bytes()` lays them out.
"""
import json
import math
import struct

FLOAT, UINT, USHORT, UBYTE = 5126, 5125, 5123, 5121
FORMATS = {FLOAT: "f", UINT: "I", USHORT: "H", UBYTE: "B"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
SEGMENTS, RINGS = 8, 4
REGIONS = ["legs", "torso", "head"]
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


class Document:
    """`json` is the glTF document without accessors, views and buffers; `rows` are the accessors' values."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0"}, "scene": 0}
        self.accessors, self.rows, self.images = [], [], []

    def accessor(self, component, kind, rows):
        self.accessors.append({"componentType": component, "type": kind, "count": len(rows)})
        self.rows.append([list(row) if isinstance(row, (tuple, list)) else [row] for row in rows])
        return len(self.rows) - 1

    def add_image(self, mime_type, data):
        self.images.append((mime_type, data))
        return len(self.images) - 1

    def bytes(self, change_json=lambda document: None):
        """The GLB's bytes; `change_json` may break the finished JSON."""
        binary, views = bytearray(), []
        for entry, rows in zip(self.accessors, self.rows):
            flat = [number for row in rows for number in row]
            data = struct.pack(f"<{len(flat)}{FORMATS[entry['componentType']]}", *flat)
            views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
            binary += data + b"\0" * (-len(data) % 4)
            entry["bufferView"] = len(views) - 1
            if entry["type"] == "VEC3":
                entry["min"] = [min(column) for column in zip(*rows)]
                entry["max"] = [max(column) for column in zip(*rows)]
        images = []
        for mime_type, data in self.images:
            images.append({"mimeType": mime_type, "bufferView": len(views)})
            views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
            binary += data + b"\0" * (-len(data) % 4)
        document = json.loads(json.dumps(
            {**self.json, **({"images": images} if images else {}), "accessors": self.accessors, "bufferViews": views,
             "buffers": [{"byteLength": len(binary)}]}))
        change_json(document)
        return glb(json.dumps(document), bytes(binary))


def glb(text, binary=b""):
    """A GLB of any text and bytes, its lengths right."""
    text = text.encode() if isinstance(text, str) else text
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def band(document, radius, bottom, top, rings, keep, material):
    """A primitive: a band of a tube about +Y of the faces for which keep(number) holds."""
    positions, normals, joints, weights = [], [], [], []
    for ring in range(rings + 1):
        for segment in range(SEGMENTS):
            angle = 2 * math.pi * segment / SEGMENTS
            height = bottom + (top - bottom) * ring / rings
            normals.append((math.sin(angle), 0.0, math.cos(angle)))
            positions.append((radius * math.sin(angle), height, radius * math.cos(angle)))
            joints.append((0, 1, 0, 0))
            weights.append((1 - height / 1.8, height / 1.8, 0, 0))
    indices, number = [], 0
    for ring in range(rings):
        for segment in range(SEGMENTS):
            a, b = ring * SEGMENTS + segment, ring * SEGMENTS + (segment + 1) % SEGMENTS
            for face in ((a, b, a + SEGMENTS), (b, b + SEGMENTS, a + SEGMENTS)):
                if keep(number):
                    indices += face
                number += 1
    return {"attributes": {"POSITION": document.accessor(FLOAT, "VEC3", positions),
                           "NORMAL": document.accessor(FLOAT, "VEC3", normals),
                           "JOINTS_0": document.accessor(UBYTE, "VEC4", joints),
                           "WEIGHTS_0": document.accessor(FLOAT, "VEC4", weights)},
            "indices": document.accessor(USHORT, "SCALAR", indices), "material": material}


def person(keep=lambda region, face: True, garment=False, clip="sway", radius=0.2):
    """The template; with `keep` and `garment` an outfit for it: a body that lacks faces, and a tunic.

    Nodes: 0 pelvis, 1 spine, 2 body, 3 tunic. Accessors come by primitive: positions, normals,
    joints, weights, indices; the first five are those of the first region that is kept.
    """
    document = Document()
    primitives = []
    for region in range(len(REGIONS)):
        kept = [face for face in range(2 * SEGMENTS * RINGS) if keep(region, face)]
        if kept:
            primitives.append(band(document, radius, 0.6 * region, 0.6 * region + 0.6, RINGS, set(kept).__contains__, region))
    meshes, nodes = [{"name": "body", "primitives": primitives}], [{"name": "body", "mesh": 0, "skin": 0}]
    materials = [{"name": name} for name in REGIONS]
    if garment:
        tunic = band(document, radius + 0.03, 0.55, 1.25, 5, lambda face: True, len(REGIONS))
        meshes.append({"name": "tunic", "primitives": [tunic]})
        nodes.append({"name": "garment.tunic", "mesh": 1, "skin": 0})
        materials.append({"name": "cloth"})
    bind = document.accessor(FLOAT, "MAT4", [IDENTITY, IDENTITY[:13] + [-0.9, 0, 1]])
    document.json.update(
        scenes=[{"nodes": [0] + [2 + i for i in range(len(nodes))]}],
        nodes=[{"name": "pelvis", "children": [1]}, {"name": "spine", "translation": [0, 0.9, 0]}] + nodes,
        meshes=meshes, materials=materials, skins=[{"joints": [0, 1], "inverseBindMatrices": bind}])
    if clip and not garment:
        times = document.accessor(FLOAT, "SCALAR", [0.0, 0.5, 1.0])
        document.accessors[times].update(min=[0], max=[1])
        turns = document.accessor(FLOAT, "VEC4", [(0, 0, 0, 1), (0, 0, 0.6, 0.8), (0, 0, 0, 1)])
        document.json["animations"] = [{"name": clip, "samplers": [{"input": times, "output": turns}],
                                        "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}]
    return document


def template(**options):
    return person(**options)


def outfit(keep=lambda region, face: region == 0 or (region == 1 and face % 2 == 0), **options):
    """Legs full, torso partial (32 of 64 faces), head hidden; and a tunic."""
    return person(keep, garment=True, **options)
