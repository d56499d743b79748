"""Turns FBX files (as Mixamo and other libraries of motion give them) into GLB.

    blender -b --python fbx_to_glb.py -- IN.fbx OUT.glb [IN.fbx OUT.glb ...]
"""
import numpy

numpy.bool = bool  # Debian's Blender 3.4 was written for an older NumPy

import sys  # noqa: E402

import bpy  # noqa: E402

files = sys.argv[sys.argv.index("--") + 1:]
for source, target in zip(files[::2], files[1::2]):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = 30  # before the import: times become frames there
    bpy.ops.import_scene.fbx(filepath=source)
    bpy.ops.export_scene.gltf(filepath=target, export_format="GLB")
