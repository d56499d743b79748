#!/usr/bin/env python3
"""Proof: Blender opens a wardrobe's files and finds in them what the wardrobe's manifest promises.

The template has its faces, the regions as materials, its bones and clips; each outfit has its
garments with their faces, and the body that shows as a mesh with the faces of the partial regions,
all hung on the armature.
"""
import json
import re
import sys

from glb import Glb
from proof import arguments, blender, everybody, fail, run


def lonelyFaces(glb, primitive):
    """How many faces a primitive has for Blender, which drops a face whose corners another face has
    (the back of a lash) or that names a corner twice."""
    corners = glb.accessors[primitive["indices"]].values
    faces = {frozenset(corners[start:start + 3]) for start in range(0, len(corners), 3)}
    return sum(len(face) == 3 for face in faces)


def fileMeshes(glb):
    """{node: (triangles, materials)} as Blender should have them."""
    return {node["name"]: (sum(lonelyFaces(glb, primitive) for primitive in mesh["primitives"]),
                           sorted({glb.materialName(primitive) for primitive in mesh["primitives"]}))
            for node, mesh in glb.meshNodes()}


def compareScene(what, seen, path, wanted):
    """Differences between Blender's scene and the file and, of `wanted`, the manifest; one line each."""
    found = []
    glb = Glb(path)
    meshes = fileMeshes(glb)
    if sorted(seen["meshes"]) != sorted(meshes):
        found.append(f"{what}: Blender has the meshes {sorted(seen['meshes'])}, the file {sorted(meshes)}")
        return found
    for name, (triangles, materials) in meshes.items():
        entry = seen["meshes"][name]
        # Two materials of one name get the endings .001 and so on.
        seen_materials = sorted({re.sub(r"\.\d{3}$", "", material) for material in entry["materials"]})
        if (entry["triangles"], seen_materials) != (triangles, materials):
            found.append(f"{what}: {name} has {entry['triangles']} triangles of {seen_materials}, "
                         f"not {triangles} of {materials}")
        if entry["armature"] is None:
            found.append(f"{what}: {name} hangs on no armature")
    total = sum(glb.faceCount(primitive) for _, mesh in glb.meshNodes() for primitive in mesh["primitives"])
    if total != wanted["faces"]:
        found.append(f"{what}: {total} triangles in all, the manifest says {wanted['faces']}")
    for key in ("bones", "clips"):
        if not set(wanted.get(key, [])) <= set(seen[key]):
            found.append(f"{what}: {key} are {seen[key]}, and lack some of {wanted[key]}")
    return found


def expectations(wardrobe):
    """{file: what the manifest says of it}."""
    manifest = json.loads((wardrobe / "wardrobe.json").read_text())
    template = manifest["template"]
    glb = Glb(wardrobe / template["file"])
    bones = [glb.json["nodes"][joint]["name"] for joint in glb.json["skins"][0]["joints"]]
    if len(bones) != template["joints"]:
        fail(f"{wardrobe}: {len(bones)} joints in the template, the manifest says {template['joints']}")
    wanted = {wardrobe / template["file"]: {"faces": template["faces"], "bones": bones,
                                            "clips": [clip["name"] for clip in template["clips"]]}}
    for outfit in manifest["outfits"]:
        faces = sum(garment["faces"] for garment in outfit["garments"])
        faces += sum(region["visible_faces"] for region in outfit["regions"] if region["visibility"] == "partial")
        wanted[wardrobe / outfit["file"]] = {"faces": faces, "bones": bones}
    return wanted


def main():
    options = arguments(__doc__)
    found, file_count = [], 0
    for name, folder in everybody(options):
        wardrobe = options.work / "wardrobes" / name
        run(options.ensemble, "tag", folder / "template.glb", *sorted(folder.glob("outfits/*.glb")), "-o", wardrobe, "-q")
        wanted = expectations(wardrobe)
        result = options.work / f"{name.replace('/', '_')}.json"
        blender("blender_import.py", result, *wanted)
        seen = json.loads(result.read_text())
        lines = [line for file, entry in wanted.items()
                 for line in compareScene(f"{name} {file.name}", seen[str(file)], file, entry)]
        meshes = sum(len(entry["meshes"]) for entry in seen.values())
        print(f"{name}: Blender opened {len(wanted)} files with {meshes} meshes; {len(lines)} differences")
        found += lines
        file_count += len(wanted)
    print("\n".join(found + [f"{file_count} files: {len(found)} differences"]))
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
