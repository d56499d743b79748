"""Sends a template through Blender: imports it and exports it again, with its clips at 30 frames a second.

    blender -b --python blender_template.py -- IN.glb OUT.glb
"""
import numpy

numpy.bool = bool  # Debian's Blender 3.4 was written for an older NumPy

import sys  # noqa: E402

import bpy  # noqa: E402

source, target = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.render.fps = 30  # before the import: times become frames there
bpy.ops.import_scene.gltf(filepath=source)
bpy.ops.export_scene.gltf(filepath=target, export_format="GLB")
