"""Run inside Blender (-- OUT.blend OUT.json TEMPLATE.glb NAME UNFITTED.glb FITTED.glb ...): a file as an artist has
it, for scripts/blender_export.py: a body with its actions in the collection Body, and in Clothes a collection for each
outfit.

For each NAME there are two items of the same garments: NAME, for rays to find what it hides, and NAME_painted, under
which the vertex group `hide.NAME_painted` of the body holds the corners of what the maker of FITTED.glb removed by
hand. OUT.json tells how many faces of each material show there: those with a corner that is not painted.
"""
import numpy

numpy.bool = bool  # Debian's Blender 3.4 was written for an older numpy

import collections  # noqa: E402
import json  # noqa: E402
import sys  # noqa: E402

import bpy  # noqa: E402


def imported(file):
    """The objects that a file brings: (armature, body, garments)."""
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=file)
    new = [thing for thing in bpy.data.objects if thing not in before]
    armature = next(thing for thing in new if thing.type == "ARMATURE")
    meshes = [thing for thing in new if thing.type == "MESH" and thing.find_armature() == armature]
    body = next(thing for thing in meshes if thing.name.split(".")[0] == "body")
    return armature, body, [thing for thing in meshes if thing is not body]


def place(vertex):
    return tuple(round(number, 6) for number in vertex.co)


def facePlaces(mesh):
    return [frozenset(place(mesh.vertices[index]) for index in face.vertices) for face in mesh.polygons]


def paintRemoved(body, fitted, group_name):
    """A vertex group of the corners of all faces that `fitted` lacks; {material: faces not all painted}."""
    left = set(facePlaces(fitted.data))
    removed = set().union(*(face for face in facePlaces(body.data) if face not in left), set())
    numbers = [vertex.index for vertex in body.data.vertices if place(vertex) in removed]
    body.vertex_groups.new(name=group_name).add(numbers, 1.0, "REPLACE")
    names = [slot.material.name for slot in body.material_slots]
    return collections.Counter(names[face.material_index] for face, places in
                               zip(body.data.polygons, facePlaces(body.data)) if not places <= removed)


def move(thing, collection):
    for old in list(thing.users_collection):
        old.objects.unlink(thing)
    collection.objects.link(thing)


def discard(*things):
    for thing in things:
        bpy.data.objects.remove(thing)


def addOutfit(clothes, armature, body, name, unfitted, fitted):
    its_armature, its_body, garments = imported(unfitted)
    found, painted = bpy.data.collections.new(name), bpy.data.collections.new(f"{name}_painted")
    clothes.children.link(found)
    clothes.children.link(painted)
    found["slot"], found["layer"] = "over", 3.0  # another slot than the default; a float, as Blender's panel makes it
    painted["occlusion"] = "authored"
    for garment in garments:
        move(garment, found)
        painted.objects.link(garment)
        garment.parent = armature
        next(modifier for modifier in garment.modifiers if modifier.type == "ARMATURE").object = armature
        garment.hide_set(True)  # as an artist leaves what is not worked on
    discard(its_body, its_armature)
    cut_armature, cut_body, cut_garments = imported(fitted)
    showing = paintRemoved(body, cut_body, f"hide.{name}_painted")
    discard(cut_body, *cut_garments, cut_armature)
    return showing


def main():
    target, told, template, *outfits = sys.argv[sys.argv.index("--") + 1:]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = 30
    armature, body, _ = imported(template)
    places = {name: bpy.data.collections.new(name) for name in ("Body", "Clothes")}
    for collection in places.values():
        bpy.context.scene.collection.children.link(collection)
    move(armature, places["Body"])
    move(body, places["Body"])
    showing = {name: addOutfit(places["Clothes"], armature, body, name, unfitted, fitted)
               for name, unfitted, fitted in zip(outfits[::3], outfits[1::3], outfits[2::3])}
    with open(told, "w") as stream:
        json.dump(showing, stream)
    mask = body.modifiers.new("Hide by hand", "MASK")  # the export must not cut the body with it
    mask.vertex_group, mask.invert_vertex_group = f"hide.{outfits[0]}_painted", True
    bpy.ops.wm.save_as_mainfile(filepath=target)


main()
