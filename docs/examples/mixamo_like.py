"""Makes files as Mixamo delivers them from a person of `ensemble people`, to try the how-to without an account:

    blender -b --python mixamo_like.py -- PERSON_FOLDER OUT_FOLDER

Figure.fbx: the body with one material and bones named mixamorig:..., without motion. Walking.fbx and Idle.fbx:
skeleton and skin with one clip each, named mixamo.com; the walk is not in place, its hips travel at 1.2 m/s.
dressed/NAME.glb: the figure in clothes, its body complete, as an artist would make it from Figure.fbx.
"""
import numpy

numpy.bool = bool  # Debian's Blender 3.4 was written for an older NumPy

import pathlib  # noqa: E402
import sys  # noqa: E402

import bpy  # noqa: E402
from mathutils import Vector  # noqa: E402

SPEED = 1.2  # metres a second
NAMES = {"pelvis": "Hips", "spine_01": "Spine", "spine_02": "Spine1", "spine_03": "Spine2", "neck_01": "Neck",
         "head": "Head", "thigh_l": "LeftUpLeg", "calf_l": "LeftLeg", "foot_l": "LeftFoot", "ball_l": "LeftToeBase",
         "thigh_r": "RightUpLeg", "calf_r": "RightLeg", "foot_r": "RightFoot", "ball_r": "RightToeBase",
         "clavicle_l": "LeftShoulder", "upperarm_l": "LeftArm", "lowerarm_l": "LeftForeArm", "hand_l": "LeftHand",
         "clavicle_r": "RightShoulder", "upperarm_r": "RightArm", "lowerarm_r": "RightForeArm",
         "hand_r": "RightHand"}


def mixamoName(name):
    return "mixamorig:" + NAMES.get(name, name)


def load(file):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = 30
    bpy.ops.import_scene.gltf(filepath=str(file))
    armature = next(thing for thing in bpy.data.objects if thing.type == "ARMATURE")
    body = bpy.data.objects["body"]
    for bone in armature.data.bones:
        bone.name = mixamoName(bone.name)  # actions and vertex groups follow
    body.data.materials.clear()
    body.data.materials.append(bpy.data.materials.new("Body_Mat"))
    for face in body.data.polygons:
        face.material_index = 0
    if armature.animation_data:
        for track in list(armature.animation_data.nla_tracks):
            armature.animation_data.nla_tracks.remove(track)
    return armature


def travel(armature, action):
    """Lets the hips move forwards, frame by frame, in the bone's own frame."""
    name = mixamoName("pelvis")
    to_bone = armature.data.bones[name].matrix_local.to_3x3().inverted()
    forwards = to_bone @ (armature.matrix_world.to_3x3().inverted() @ Vector((0, -1, 0)))
    first = action.frame_range[0]
    for curve in action.fcurves:
        if curve.data_path != f'pose.bones["{name}"].location':
            continue
        for key in curve.keyframe_points:
            key.co.y += forwards[curve.array_index] * SPEED * (key.co.x - first) / 30
        curve.update()


def export(target, armature, action):
    armature.animation_data.action = action
    if action:
        action.name = "mixamo.com"
        bpy.context.scene.frame_start, bpy.context.scene.frame_end = (round(f) for f in action.frame_range)
    bpy.ops.export_scene.fbx(filepath=str(target), add_leaf_bones=False, bake_anim=bool(action),
                             bake_anim_use_all_actions=False, bake_anim_use_nla_strips=False,
                             bake_anim_simplify_factor=0, object_types={"ARMATURE", "MESH"})


def main():
    folder, out = (pathlib.Path(path) for path in sys.argv[sys.argv.index("--") + 1:])
    out.mkdir(parents=True, exist_ok=True)
    for clip, target in ((None, "Figure.fbx"), ("walk", "Walking.fbx"), ("idle", "Idle.fbx")):
        armature = load(folder / "template.glb")
        action = next((action for action in bpy.data.actions if clip and action.name.startswith(clip)), None)
        if clip == "walk":
            travel(armature, action)
        export(out / target, armature, action)
    (out / "dressed").mkdir(exist_ok=True)
    for file in sorted((folder / "dressed").glob("*.glb")):
        load(file)
        bpy.ops.export_scene.gltf(filepath=str(out / "dressed" / file.name), export_format="GLB")


main()
