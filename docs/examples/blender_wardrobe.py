"""Makes a file as scripts/blender_export.py wants it: a body with its actions in the collection `Body`, and in
`Clothes` a collection for each file of somebody dressed, named as the file, with its slot and layer.

    blender -b --python blender_wardrobe.py -- OUT.blend TEMPLATE.glb DRESSED.glb...
"""
import numpy

numpy.bool = bool  # Debian's Blender 3.4 was written for an older NumPy

import json  # noqa: E402
import pathlib  # noqa: E402
import struct  # noqa: E402
import sys  # noqa: E402

import bpy  # noqa: E402


def newCollection(name, parent):
    made = bpy.data.collections.new(name)
    parent.children.link(made)
    return made


def moveTo(place, thing):
    for old in list(thing.users_collection):
        old.objects.unlink(thing)
    place.objects.link(thing)


def imported(file):
    """What a file brings: (armature, meshes that it moves)."""
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=file)
    new = [thing for thing in bpy.data.objects if thing not in before]
    armature = next(thing for thing in new if thing.type == "ARMATURE")
    return armature, [thing for thing in new if thing.type == "MESH" and thing.find_armature() == armature]


def properties(file):
    """The custom properties of a GLB's scene, which the importer leaves behind."""
    data = pathlib.Path(file).read_bytes()
    document = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])
    return document["scenes"][document.get("scene", 0)].get("extras", {}).get("ensemble", {})


def dress(clothes, armature, file):
    item = newCollection(pathlib.Path(file).stem, clothes)
    for key, value in properties(file).items():
        item[key] = value
    its_armature, meshes = imported(file)
    for mesh in meshes:
        if mesh.name.split(".")[0] == "body":
            bpy.data.objects.remove(mesh)
            continue
        moveTo(item, mesh)
        mesh.parent = armature
        next(modifier for modifier in mesh.modifiers if modifier.type == "ARMATURE").object = armature
    bpy.data.objects.remove(its_armature)


def main():
    target, template, *dressed = sys.argv[sys.argv.index("--") + 1:]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = 30  # before the import: times become frames there
    body, clothes = (newCollection(name, bpy.context.scene.collection) for name in ("Body", "Clothes"))
    armature, meshes = imported(template)
    for thing in [armature, *meshes]:
        moveTo(body, thing)
    for file in dressed:
        dress(clothes, armature, file)
    bpy.ops.wm.save_as_mainfile(filepath=str(pathlib.Path(target).resolve()))


main()
