"""Makes an outfit for `ensemble tag` in Blender: takes a person in clothes whose body is complete, removes the
skin that the clothes hide, and exports what is left.

    blender -b --python blender_outfit.py -- DRESSED.glb OUTFIT.glb [--mask]

Body is the object `body`, clothes are all others with a mesh; hair and parts of the face hide nothing, because
a head that shows in part would need a sub-mesh of its own in every outfit. A body vertex counts as hidden where a garment
lies within 4 cm outside it, or up to 1 cm inside it (skin that pokes through); a face is removed where its
vertices are hidden and all their neighbours too, so that a rim stays under every hem. With --mask nothing is
removed: the hidden vertices go into a vertex group with a Mask modifier, as MPFB does it, and the exporter
applies it; a Mask modifier takes every face that has one hidden vertex, so the rim is narrower.
"""
import numpy

numpy.bool = bool  # Debian's Blender 3.4 was written for an older NumPy

import sys  # noqa: E402

import bmesh  # noqa: E402
import bpy  # noqa: E402
from mathutils.bvhtree import BVHTree  # noqa: E402

OUTSIDE, INSIDE = 0.04, 0.01  # metres
HIDES_NOTHING = ("hair", "face")  # in an object's name


def garmentSurface(objects):
    """All garments as one surface to shoot rays at, in world space."""
    vertices, faces = [], []
    for garment in objects:
        first = len(vertices)
        vertices += [garment.matrix_world @ vertex.co for vertex in garment.data.vertices]
        faces += [[first + index for index in face.vertices] for face in garment.data.polygons]
    return BVHTree.FromPolygons(vertices, faces)


def coveredVertices(body, surface):
    """Numbers of the vertices that have a garment in front of them, and so have all their neighbours."""
    turn = body.matrix_world.to_3x3()
    under = set()
    for vertex in body.data.vertices:
        normal = (turn @ vertex.normal).normalized()
        start = body.matrix_world @ vertex.co - INSIDE * normal
        if surface.ray_cast(start, normal, INSIDE + OUTSIDE)[0] is not None:
            under.add(vertex.index)
    rim = set()
    for edge in body.data.edges:
        for a, b in (edge.vertices, reversed(edge.vertices)):
            if a in under and b not in under:
                rim.add(a)
    return under - rim


def removeFaces(body, hidden):
    mesh = bmesh.new()
    mesh.from_mesh(body.data)
    mesh.faces.ensure_lookup_table()
    bmesh.ops.delete(mesh, geom=[face for face in mesh.faces if all(v.index in hidden for v in face.verts)],
                     context="FACES")
    mesh.to_mesh(body.data)


def maskFaces(body, hidden):
    group = body.vertex_groups.new(name="Delete.clothes")
    group.add(sorted(hidden), 1.0, "REPLACE")
    modifier = body.modifiers.new("Hide under clothes", "MASK")
    modifier.vertex_group = group.name
    modifier.invert_vertex_group = True


def main():
    source, target, *options = sys.argv[sys.argv.index("--") + 1:]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=source)
    meshes = [thing for thing in bpy.data.objects if thing.type == "MESH" and thing.users_collection]
    body = next(thing for thing in meshes if thing.name == "body")
    clothes = [thing for thing in meshes if thing is not body and thing.find_armature()]
    before = len(body.data.polygons)
    covering = [thing for thing in clothes if not any(word in thing.name for word in HIDES_NOTHING)]
    hidden = coveredVertices(body, garmentSurface(covering))
    (maskFaces if "--mask" in options else removeFaces)(body, hidden)
    bpy.ops.export_scene.gltf(filepath=target, export_format="GLB", export_animations=False,
                              export_apply="--mask" in options)
    print(f"{source}: {len(hidden)} vertices hidden, {before} -> {len(body.data.polygons)} faces")


main()
