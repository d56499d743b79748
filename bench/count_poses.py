#!/usr/bin/env python3
"""Counts how many people of a scene share a pose, and what keeping skinned poses would store.

Usage: count_poses.py --ensemble PROGRAM SCENE.yaml [--counts 1000,5000]

A pose is a mesh (a template's body, or a distinct garment) at a clip's key frame; the last key of a loop is
its first. Bytes are of vertices at 8 bytes and of triangles written out at 36. The people are those whom
`render --dump-crowd` tells at time 0, so a Vulkan device is needed; nothing else depends on it.
"""
import argparse
import csv
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
from collections import Counter

VERTEX_BYTES = 8     # position 3 x 16 bit in the pose's box, normal 2 x 8 bit
TRIANGLE_BYTES = 36  # three corners of three floats
MIB = 1 << 20


def read_glb(path):
    data = path.read_bytes()
    length, = struct.unpack_from("<I", data, 12)
    return json.loads(data[20:20 + length])


class Wardrobe:
    """Vertices and faces of a wardrobe's meshes, by a key that is equal for garments of two outfits that are one."""

    def __init__(self, key, folder):
        manifest = json.loads((folder / "wardrobe.json").read_text())
        self.keys = {clip["name"]: max(1, clip["keys"] - 1) for clip in manifest["template"]["clips"]}
        self.body = (key, "body")
        self.meshes = {self.body: (manifest["template"]["vertices"], manifest["template"]["faces"])}
        self.items, self.visible = {}, {}
        for outfit in manifest["outfits"]:
            counts = Counter()
            document = read_glb(folder / outfit["file"])
            for node in document["nodes"]:
                for primitive in document["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
                    vertices = document["accessors"][primitive["attributes"]["POSITION"]]["count"]
                    faces = document["accessors"][primitive["indices"]]["count"] // 3
                    counts[node["name"], "vertices"] += vertices
                    counts[node["name"], "faces"] += faces
            names = {garment["name"] for garment in outfit["garments"]}
            self.items[outfit["name"]] = []
            for name in sorted(names):
                mesh = (key, name, counts[name, "vertices"], counts[name, "faces"])
                self.meshes[mesh] = mesh[2:]
                self.items[outfit["name"]].append(mesh)
            self.visible[outfit["name"]] = sum(region["visible_faces"] for region in outfit["regions"])


def tell(count, people, wardrobes):
    poses, triangles, skinned = Counter(), 0, 0
    for person in people[:count]:
        wardrobe = wardrobes[person["wardrobe"]]
        keys = wardrobe.keys[person["clip"]]
        key = int(float(person["phase"]) * keys) % keys
        worn = person["outfit"].split("+")
        meshes = [wardrobe.body] + [mesh for item in worn for mesh in wardrobe.items[item]]
        # Of several items each hides its own; the one that hides most bounds what shows of the body.
        triangles += min(wardrobe.visible[item] for item in worn) + sum(wardrobe.meshes[m][1] for m in meshes[1:])
        skinned += sum(wardrobe.meshes[m][0] for m in meshes)
        for mesh in meshes:
            poses[person["wardrobe"], mesh, person["clip"], key] += 1
    vertices = sum(wardrobes[w].meshes[mesh][0] for w, mesh, _, _ in poses)
    faces = sum(wardrobes[w].meshes[mesh][1] for w, mesh, _, _ in poses)
    print(f"{min(count, len(people)):,} people: {triangles:,} triangles; {len(poses):,} poses, each of "
          f"{sum(poses.values()) / len(poses):.1f} people on average; vertices to skin: {skinned:,} person by person, "
          f"{vertices:,} pose by pose ({vertices * VERTEX_BYTES / MIB:.1f} MiB); "
          f"{faces:,} triangles of poses ({faces * TRIANGLE_BYTES / MIB:.0f} MiB written out)")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--ensemble", required=True, help="the program")
    parser.add_argument("--counts", default="1000,5000", help="how many of the crowd's people to count, each")
    chosen = parser.parse_args()
    counts = [int(count) for count in chosen.counts.split(",")]
    with tempfile.TemporaryDirectory() as folder:
        run = [chosen.ensemble, "render", "-q", str(chosen.scene), "-o", f"{folder}/x.png", "--dump-crowd",
               f"{folder}/crowd.csv", "--set", f"crowd.count={max(counts)}", "--set", "output.width=16",
               "--set", "output.height=16", "--set", "output.samples=1", "--set", "output.frames=1"]
        if subprocess.run(run, check=False).returncode != 0:
            sys.exit(1)  # the program said why
        subprocess.run([chosen.ensemble, "inspect", str(chosen.scene), "--json", f"{folder}/scene.json"],
                       check=True, stdout=subprocess.DEVNULL)
        scene = json.loads(pathlib.Path(folder, "scene.json").read_text())
        with open(f"{folder}/crowd.csv", newline="") as file:
            people = list(csv.DictReader(file))
    wardrobes = {entry["key"]: Wardrobe(entry["key"], pathlib.Path(entry["folder"])) for entry in scene["wardrobes"]}
    for count in counts:
        tell(count, people, wardrobes)
    vertices = sum(w.meshes[mesh][0] * sum(w.keys.values()) for w in wardrobes.values() for mesh in w.meshes)
    faces = sum(w.meshes[mesh][1] * sum(w.keys.values()) for w in wardrobes.values() for mesh in w.meshes)
    print(f"All poses that there can be: {vertices:,} vertices ({vertices * VERTEX_BYTES / MIB:.1f} MiB), "
          f"{faces:,} triangles ({faces * TRIANGLE_BYTES / MIB:.0f} MiB written out)")


if __name__ == "__main__":
    main()
