"""A small reader and writer of GLB files, independent of the program's own, for the proofs.

Every accessor becomes a flat array of numbers; writing lays out all buffers anew. Knows neither
sparse accessors nor compression: what it reads comes from the program or from `people/`.
"""
import array
import json
import struct

TYPECODES = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Accessor:
    """#count by `width` numbers, flat."""

    def __init__(self, component_type, kind, values, normalized=False):
        self.component_type, self.kind, self.normalized = component_type, kind, normalized
        self.values = values if isinstance(values, array.array) else array.array(TYPECODES[component_type], values)

    @property
    def width(self):
        return WIDTHS[self.kind]

    @property
    def count(self):
        return len(self.values) // self.width

    def rows(self, order):
        """A new accessor of the rows named, in that order."""
        width, values = self.width, self.values
        picked = array.array(values.typecode)
        for row in order:
            picked.extend(values[row * width:(row + 1) * width])
        return Accessor(self.component_type, self.kind, picked, self.normalized)


class Glb:
    """`json` is the document without accessors, views and buffers; `accessors` and `images` hold those."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        magic, version, length = struct.unpack_from("<4sII", data)
        if magic != b"glTF" or version != 2 or length != len(data):
            raise ValueError(f"{path}: not a GLB of version 2")
        json_length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + json_length])
        binary = data[20 + json_length + 8:]
        views = self.json.pop("bufferViews", [])
        self.json.pop("buffers", None)
        self.accessors = [self._readAccessor(entry, views, binary) for entry in self.json.pop("accessors", [])]
        self.images = [self._viewBytes(views[image.pop("bufferView")], binary) for image in self.json.get("images", [])]

    @staticmethod
    def _viewBytes(view, binary):
        start = view.get("byteOffset", 0)
        return binary[start:start + view["byteLength"]]

    def _readAccessor(self, entry, views, binary):
        if "sparse" in entry or "bufferView" not in entry:
            raise ValueError("sparse and compressed accessors are beyond this reader")
        view = views[entry["bufferView"]]
        data = self._viewBytes(view, binary)[entry.get("byteOffset", 0):]
        typecode, width = TYPECODES[entry["componentType"]], WIDTHS[entry["type"]]
        row_bytes = array.array(typecode).itemsize * width
        stride = view.get("byteStride", row_bytes)
        values = array.array(typecode)
        if stride == row_bytes:
            values.frombytes(data[:row_bytes * entry["count"]])
        else:
            for row in range(entry["count"]):
                values.frombytes(data[row * stride:row * stride + row_bytes])
        return Accessor(entry["componentType"], entry["type"], values, entry.get("normalized", False))

    def add(self, accessor):
        """Appends an accessor; its index."""
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def meshNodes(self):
        """(node, mesh) of every node that has a mesh."""
        return [(node, self.json["meshes"][node["mesh"]]) for node in self.json["nodes"] if "mesh" in node]

    def materialName(self, primitive):
        return self.json["materials"][primitive["material"]]["name"]

    def faceCount(self, primitive):
        accessor = primitive.get("indices", primitive["attributes"]["POSITION"])
        return self.accessors[accessor].count // 3

    def _dropUnused(self):
        """Forgets the accessors that nothing names any more, and renumbers the rest."""
        holders = []  # (dictionary, key) of every reference
        for mesh in self.json.get("meshes", []):
            for primitive in mesh["primitives"]:
                holders += [(primitive["attributes"], key) for key in primitive["attributes"]]
                holders += [(primitive, "indices")] if "indices" in primitive else []
        holders += [(skin, "inverseBindMatrices") for skin in self.json.get("skins", [])]
        for animation in self.json.get("animations", []):
            holders += [(sampler, key) for sampler in animation["samplers"] for key in ("input", "output")]
        used = sorted({holder[key] for holder, key in holders})
        number = {old: new for new, old in enumerate(used)}
        for holder, key in holders:
            holder[key] = number[holder[key]]
        self.accessors = [self.accessors[old] for old in used]

    def write(self, path):
        self._dropUnused()
        binary, views, entries = bytearray(), [], []

        def addView(data):
            views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
            binary.extend(data + b"\0" * (-len(data) % 4))
            return len(views) - 1

        for accessor in self.accessors:
            entry = {"bufferView": addView(self._padded(accessor)), "componentType": accessor.component_type,
                     "count": accessor.count, "type": accessor.kind}
            if accessor.normalized:
                entry["normalized"] = True
            entries.append(entry)
        for mesh in self.json.get("meshes", []):
            for primitive in mesh["primitives"]:
                self._setBounds(entries, primitive["attributes"]["POSITION"])
        for animation in self.json.get("animations", []):
            for sampler in animation["samplers"]:
                self._setBounds(entries, sampler["input"])
        document = dict(self.json, accessors=entries)
        if self.images:
            document["images"] = [dict(image, bufferView=addView(data))
                                  for image, data in zip(self.json["images"], self.images)]
        document.update(bufferViews=views, buffers=[{"byteLength": len(binary)}])
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)

    @staticmethod
    def _padded(accessor):
        """The bytes; rows of every vertex format in use here are multiples of four already."""
        data = accessor.values.tobytes()
        row_bytes = accessor.values.itemsize * accessor.width
        if accessor.kind != "SCALAR" and row_bytes % 4 != 0:
            raise ValueError("rows that are no multiple of four bytes are beyond this writer")
        return data

    def _setBounds(self, entries, index):
        accessor = self.accessors[index]
        columns = [accessor.values[column::accessor.width] for column in range(accessor.width)]
        entries[index]["min"] = [min(column) for column in columns]
        entries[index]["max"] = [max(column) for column in columns]
