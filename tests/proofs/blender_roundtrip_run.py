"""Run inside Blender (--background --python blender_roundtrip_run.py -- IN.glb OUT.glb...): imports
each GLB and exports it again, with the exporter's own settings."""
import numpy

numpy.bool = bool  # Debian's Blender 3.4 was written for an older numpy

import sys  # noqa: E402

import bpy  # noqa: E402

files = sys.argv[sys.argv.index("--") + 1:]
for source, target in zip(files[::2], files[1::2]):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=source)
    bpy.ops.export_scene.gltf(filepath=target, export_format="GLB")
