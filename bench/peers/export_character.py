#!/usr/bin/python3
"""Writes one crowd of one dressed person in a form that every program can read: scene.json and what it names.

Usage: export_character.py TEMPLATE.glb OUTFIT.glb -o DIR [--clip walk] [--counts 1000,5000]

The mesh is what OUTFIT.glb holds: garments, and the faces of the body that show. README.md tells the format.
"""
import argparse
import ctypes
import ctypes.util
import json
import math
import pathlib
import struct
import sys

import numpy as np

COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}

# A camera that has 1,000 people in sight and as large as they can be; it steps back with the root of the number.
VIEWS = {"near": ((0.0, 11.5, 22.0), (0.0, 0.0, 3.6)), "far": ((0.0, 46.0, 88.0), (0.0, 0.0, 14.4))}
VIEW_PEOPLE = 1000
FOV_Y = 40.0
SPACING = 0.7    # metres between neighbours
JITTER = 0.3     # of it
# One directional light and one from above and below, linear: those of our renderer (renderer/view_setup.cpp).
LIGHT = {"direction": (-0.4, -1.0, -0.3), "sun": (1.38, 1.26, 1.08), "ambient_up": (0.36, 0.42, 0.50),
         "ambient_down": (0.20, 0.185, 0.165)}
COLOUR = (0.30, 0.27, 0.22)  # of a peer's people, linear


class Problem(Exception):
    """What the user can mend: one line."""


class Glb:
    def __init__(self, path):
        self.path, data = path, path.read_bytes()
        if data[:4] != b"glTF":
            raise Problem(f"{path}: this is no binary glTF; give a .glb file")
        length, = struct.unpack_from("<I", data, 12)
        self.json = json.loads(data[20:20 + length])
        self.buffer = data[28 + length:]

    def accessor(self, index):
        accessor = self.json["accessors"][index]
        if "sparse" in accessor or "bufferView" not in accessor:
            raise Problem(f"{self.path}: accessor {index} is sparse; export it dense")
        view = self.json["bufferViews"][accessor["bufferView"]]
        dtype, width = np.dtype(COMPONENTS[accessor["componentType"]]), WIDTHS[accessor["type"]]
        stride = view.get("byteStride", dtype.itemsize * width)
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        values = np.ndarray((accessor["count"], width), dtype, self.buffer, start, (stride, dtype.itemsize)).copy()
        if accessor.get("normalized"):
            values = values.astype("f4") / np.iinfo(dtype).max
        return values

    def skin(self):
        if len(self.json.get("skins", [])) != 1:
            raise Problem(f"{self.path}: one skin is needed, not {len(self.json.get('skins', []))}")
        skin = self.json["skins"][0]
        # glTF stores columns; rows of matrices are wanted.
        inverse = self.accessor(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1).astype("f8")
        return skin["joints"], [self.json["nodes"][joint]["name"] for joint in skin["joints"]], inverse


def rotation_matrix(q):
    x, y, z, w = q / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def local_matrix(node):
    matrix = np.eye(4)
    matrix[:3, :3] = rotation_matrix(np.array(node.get("rotation", (0, 0, 0, 1)), "f8"))
    matrix[:3, :3] *= np.array(node.get("scale", (1, 1, 1)), "f8")
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def read_channels(template, name):
    """The clip's key times, and (node, path, values) of its channels."""
    clips = {clip["name"]: clip for clip in template.json.get("animations", [])}
    if name not in clips:
        raise Problem(f"{template.path}: there is no clip '{name}'; choose from {', '.join(clips) or 'none'}")
    times, channels = None, []
    for channel in clips[name]["channels"]:
        sampler = clips[name]["samplers"][channel["sampler"]]
        own = template.accessor(sampler["input"])[:, 0].astype("f8")
        times = own if times is None else times
        if sampler.get("interpolation", "LINEAR") != "LINEAR" or own.shape != times.shape or abs(own - times).max() > 1e-4:
            raise Problem(f"{template.path}: clip '{name}' has curves or keys at different times; bake it at one rate")
        channels.append((channel["target"]["node"], channel["target"]["path"], template.accessor(sampler["output"])))
    if len(times) < 3 or np.ptp(np.diff(times)) > 0.02 * np.diff(times).mean():
        raise Problem(f"{template.path}: the keys of clip '{name}' are too few or not equally spaced")
    return times - times[0], channels


def skinning_matrices(template, clip):
    """3x4 matrices by key and joint, and the clip's seconds. The last key is the first again."""
    joints, _, inverse = template.skin()
    times, channels = read_channels(template, clip)
    nodes = template.json["nodes"]
    parents = {child: index for index, node in enumerate(nodes) for child in node.get("children", [])}
    matrices = np.empty((len(times), len(joints), 3, 4))
    for key in range(len(times)):
        posed = {node: {} for node, _, _ in channels}
        for node, path, values in channels:
            posed[node][path] = values[key]
        known = {}

        def world(index):
            if index not in known:
                own = local_matrix({**nodes[index], **posed.get(index, {})})
                known[index] = world(parents[index]) @ own if index in parents else own
            return known[index]

        for number, joint in enumerate(joints):
            matrices[key, number] = (world(joint) @ inverse[number])[:3]
    turned = matrices[..., :3]
    if abs(turned @ turned.swapaxes(-1, -2) - np.eye(3)).max() > 1e-3:
        raise Problem(f"{template.path}: clip '{clip}' scales or shears joints, which OGRE's instancing does not do")
    if abs(matrices[0] - matrices[-1]).max() > 1e-3:
        raise Problem(f"{template.path}: clip '{clip}' does not end as it begins; take one that loops in place")
    return matrices.astype("<f4"), float(times[-1])


def read_mesh(outfit, template):
    """All triangles of the file, in its order, as one mesh."""
    _, names, inverse = template.skin()
    _, own_names, own_inverse = outfit.skin()
    if set(own_names) - set(names):
        raise Problem(f"{outfit.path}: joint '{sorted(set(own_names) - set(names))[0]}' is not in {template.path}")
    joint_of = np.array([names.index(name) for name in own_names])
    if abs(own_inverse - inverse[joint_of]).max() > 1e-3:
        raise Problem(f"{outfit.path}: its bind pose is not that of {template.path}")
    parts = {"positions": [], "normals": [], "weights": [], "joints": [], "indices": []}
    vertex_count = 0
    for node in outfit.json["nodes"]:
        for primitive in outfit.json["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            attributes = {name: outfit.accessor(index) for name, index in primitive["attributes"].items()}
            parts["positions"].append(attributes["POSITION"])
            parts["normals"].append(attributes["NORMAL"])
            parts["weights"].append(attributes["WEIGHTS_0"])
            parts["joints"].append(joint_of[attributes["JOINTS_0"]])
            parts["indices"].append(outfit.accessor(primitive["indices"]).reshape(-1, 3).astype("u4") + vertex_count)
            vertex_count += len(attributes["POSITION"])
    mesh = {name: np.concatenate(arrays) for name, arrays in parts.items()}
    mesh["weights"] = mesh["weights"] / mesh["weights"].sum(axis=1, keepdims=True)
    return mesh


def optimised(mesh):
    """The same triangles in vertex-cache order, the vertices renumbered by first use: what our program does."""
    name = ctypes.util.find_library("meshoptimizer")
    if name is None:
        raise Problem("the library meshoptimizer is missing; install libmeshoptimizer-dev")
    library, count = ctypes.CDLL(name), len(mesh["positions"])
    as_size, as_array = ctypes.c_size_t, np.ctypeslib.ndpointer("u4", flags="C_CONTIGUOUS")
    library.meshopt_optimizeVertexCache.argtypes = [as_array, as_array, as_size, as_size]
    library.meshopt_optimizeVertexFetchRemap.argtypes = [as_array, as_array, as_size, as_size]
    library.meshopt_optimizeVertexFetchRemap.restype = as_size
    before = np.ascontiguousarray(mesh["indices"].reshape(-1), "u4")
    indices, new_number = np.empty_like(before), np.empty(count, "u4")
    library.meshopt_optimizeVertexCache(indices, before, before.size, count)
    used = library.meshopt_optimizeVertexFetchRemap(new_number, indices, indices.size, count)
    source = np.empty(used, "u4")
    kept = new_number != 0xFFFFFFFF
    source[new_number[kept]] = np.nonzero(kept)[0]
    result = {name: values[source] for name, values in mesh.items() if name != "indices"}
    result["indices"] = new_number[indices].reshape(-1, 3)
    return result


def write_mesh(mesh, path):
    formats = {"positions": "<f4", "normals": "<f4", "weights": "<f4", "joints": "u1", "indices": "<u4"}
    path.write_bytes(b"".join(np.ascontiguousarray(mesh[name], dtype).tobytes() for name, dtype in formats.items()))
    return {"file": path.name, "vertices": len(mesh["positions"]), "triangles": len(mesh["indices"])}


def make_crowd(count, key_count):
    """Places from the middle outwards, headings and phases; the first n of them are a round crowd, too."""
    random = np.random.default_rng(7)
    side = math.ceil(math.sqrt(count * 4 / math.pi)) + 3
    grid = np.stack(np.meshgrid(*[np.arange(side) - side // 2] * 2), -1).reshape(-1, 2) * SPACING
    grid = grid + random.uniform(-JITTER, JITTER, grid.shape) * SPACING
    places = grid[np.argsort((grid ** 2).sum(axis=1), kind="stable")][:count]
    phases = random.uniform(0, 1, count)
    return {"places": places, "headings": random.uniform(-180, 180, count),
            "interpolated": phases, "keys": np.floor(phases * (key_count - 1)) / (key_count - 1)}


def write_crowd(crowd, poses, outfit, clip, path):
    rows = zip(crowd["places"], crowd["headings"], crowd[poses])
    lines = [f"{x:.4f},{z:.4f},{heading:.3f},{phase:.7f},{outfit},{clip},1,1" for (x, z), heading, phase in rows]
    path.write_text("\n".join(["x,z,heading,phase,outfit,clip,scale,tint"] + lines) + "\n")
    return path.name


def views(counts):
    found = []
    for count in counts:
        back = math.sqrt(count / VIEW_PEOPLE)
        for name, (position, target) in VIEWS.items():
            found.append({"name": name, "characters": count, "position": [round(back * v, 4) for v in position],
                          "target": [round(back * v, 4) for v in target], "fov_y": FOV_Y, "near": 0.1,
                          "far": round(back * 400, 1)})
    return found


def export(template_path, outfit_path, clip, counts, folder):
    template, outfit = Glb(template_path), Glb(outfit_path)
    matrices, seconds = skinning_matrices(template, clip)
    mesh = read_mesh(outfit, template)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "poses.bin").write_bytes(matrices.tobytes())
    crowd = make_crowd(max(counts), len(matrices))
    names = {poses: write_crowd(crowd, poses, outfit_path.stem, clip, folder / f"crowd-{poses}.csv")
             for poses in ("keys", "interpolated")}
    scene = {"width": 1280, "height": 720, "light": LIGHT, "colour": COLOUR, "views": views(counts), "crowds": names,
             "meshes": {"exported": write_mesh(mesh, folder / "mesh-exported.bin"),
                        "optimised": write_mesh(optimised(mesh), folder / "mesh-optimised.bin")},
             "poses": {"file": "poses.bin", "clip": clip, "keys": len(matrices), "joints": matrices.shape[1],
                       "seconds": seconds}}
    (folder / "scene.json").write_text(json.dumps(scene, indent=1) + "\n")
    return scene


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("template", type=pathlib.Path)
    parser.add_argument("outfit", type=pathlib.Path)
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True, help="the folder to write")
    parser.add_argument("--clip", default="walk")
    parser.add_argument("--counts", default="1000,5000", help="numbers of people, each with views of its own")
    chosen = parser.parse_args()
    try:
        scene = export(chosen.template, chosen.outfit, chosen.clip, [int(n) for n in chosen.counts.split(",")],
                       chosen.out)
    except (Problem, OSError) as problem:
        sys.exit(f"export_character.py: {problem}")
    mesh, poses = scene["meshes"]["exported"], scene["poses"]
    print(f"{mesh['triangles']:,} triangles, {mesh['vertices']:,} vertices, {poses['joints']} joints, {poses['keys']} keys")


if __name__ == "__main__":
    main()
