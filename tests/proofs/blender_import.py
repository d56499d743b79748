"""Run inside Blender (--background --python blender_import.py -- OUT.json FILE.glb...): imports each
GLB into an empty scene and writes what Blender then has."""
import numpy

numpy.bool = bool  # Debian's Blender 3.4 was written for an older numpy

import json  # noqa: E402
import sys  # noqa: E402

import bpy  # noqa: E402


def describe(file):
    """Meshes with their triangles, materials and armatures; armatures with their bones; clips."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    meshes = [entry for entry in bpy.data.objects if entry.type == "MESH" and entry.users_scene
              and not entry.name.startswith("Icosphere")]  # the importer's own shape for bones
    for entry in meshes:
        entry.data.calc_loop_triangles()
    return {
        "meshes": {entry.name: {
            "triangles": len(entry.data.loop_triangles),
            "materials": sorted(slot.material.name for slot in entry.material_slots if slot.material),
            "armature": next((modifier.object.name for modifier in entry.modifiers
                              if modifier.type == "ARMATURE" and modifier.object), None),
        } for entry in meshes},
        "bones": sorted(bone.name for armature in bpy.data.armatures for bone in armature.bones),
        # The importer names its actions CLIP_ARMATURE, and the tracks that play them as the clips.
        "clips": sorted({track.name for entry in bpy.data.objects if entry.animation_data
                         for track in entry.animation_data.nla_tracks}),
    }


output, files = sys.argv[sys.argv.index("--") + 1], sys.argv[sys.argv.index("--") + 2:]
with open(output, "w") as stream:
    json.dump({file: describe(file) for file in files}, stream)
