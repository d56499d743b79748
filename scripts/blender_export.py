"""Exports a body and its clothes from Blender, ready for `ensemble tag`.

    blender -b FILE.blend --python scripts/blender_export.py -- [--out FOLDER] [--body NAME] [--clothes NAME]

or, in Blender's text editor, Run Script: then it writes to the folder `ensemble` beside the .blend file.

The collection `Body` holds the body, bound to an armature. In the collection `Clothes` each collection is an item of
one or more garments, and each mesh that lies there by itself is an item of its own. What is written:

    FOLDER/template.glb         body, armature and all its actions
    FOLDER/outfits/ITEM.glb     the item's garments, and the complete body under them

Custom properties of an item's collection (or of its mesh) go into its file: slot, layer, occlusion, keep, hide. An item
that does not say has occlusion `auto`, since its body is complete. Vertex groups of the body override what is found:
faces with all corners in `hide` go and in `keep` stay under every item, in `hide.ITEM` and `keep.ITEM` under one.
"""
import numpy

if "bool" not in vars(numpy):
    numpy.bool = bool  # Debian's Blender 3.4 was written for an older NumPy

import argparse  # noqa: E402
import os  # noqa: E402
import sys  # noqa: E402
import traceback  # noqa: E402

import bpy  # noqa: E402

PROPERTIES = ("slot", "layer", "occlusion", "keep", "hide")
# The exporter puts `_` before an attribute's name and writes capitals; since 3.5 it takes those that begin with `_`.
PAINT = "hide" if bpy.app.version < (3, 5) else "_HIDE"


class ExportError(Exception):
    pass


def collection(name):
    found = bpy.data.collections.get(name)
    if found is None:
        raise ExportError(f"there is no collection '{name}'; make one, or name another (--body, --clothes)")
    return found


def meshesIn(place):
    return sorted((thing for thing in place.all_objects if thing.type == "MESH"), key=lambda thing: thing.name)


def armatureOf(meshes):
    """The one armature that all of them are bound to."""
    for mesh in meshes:
        if mesh.find_armature() is None:
            raise ExportError(f"'{mesh.name}' is bound to no armature; give it an Armature modifier")
    armatures = {mesh.find_armature() for mesh in meshes}
    if len(armatures) > 1:
        names = ", ".join(sorted(armature.name for armature in armatures))
        raise ExportError(f"body and clothes are bound to several armatures ({names}); bind all to one")
    return armatures.pop()


def itemsIn(clothes):
    """{name: (what carries its custom properties, its meshes)}."""
    items = {child.name: (child, meshesIn(child)) for child in clothes.children}
    for mesh in (thing for thing in clothes.objects if thing.type == "MESH"):
        if mesh.name in items:
            raise ExportError(f"two items are named '{mesh.name}'; rename the mesh or the collection")
        items[mesh.name] = (mesh, [mesh])
    empty = sorted(name for name, (_, meshes) in items.items() if not meshes)
    if empty or not items:
        raise ExportError(f"there is no mesh in the collection '{(empty or [clothes.name])[0]}'")
    return items


def propertiesOf(owner):
    found = {"occlusion": "auto", **{key: owner[key] for key in PROPERTIES if key in owner}}
    if isinstance(found.get("layer"), float) and found["layer"].is_integer():
        found["layer"] = int(found["layer"])  # a new custom property of Blender's is a float
    return found


def paint(body, item):
    """Writes the vertex groups that concern an item into the attribute that `tag` reads; whether there are any."""
    signs = {"hide": 1.0, f"hide.{item}": 1.0, "keep": -1.0, f"keep.{item}": -1.0}
    groups = {group.index: signs[group.name] for group in body.vertex_groups if group.name in signs}
    if not groups:
        return False
    values = [sum(groups[entry.group] * entry.weight for entry in vertex.groups if entry.group in groups)
              for vertex in body.data.vertices]
    body.data.attributes.new(PAINT, "FLOAT", "POINT").data.foreach_set("value", values)
    return True


class Shown:
    """Puts objects alone into a collection, shown and active, for as long as an export takes; the exporter takes what
    is in the active collection, and applies modifiers only to what is not hidden."""

    def __init__(self, things):
        self.things = things

    def __enter__(self):
        self.place = bpy.data.collections.new("ensemble export")
        bpy.context.scene.collection.children.link(self.place)
        layer = bpy.context.view_layer
        self.active, self.hidden = layer.active_layer_collection, []
        for thing in self.things:
            self.place.objects.link(thing)
        layer.active_layer_collection = layer.layer_collection.children[self.place.name]
        for thing in self.things:
            self.hidden.append((thing, thing.hide_viewport, thing.hide_get()))
            thing.hide_viewport = False
            thing.hide_set(False)

    def __exit__(self, *error):
        for thing, viewport, eye in self.hidden:
            thing.hide_set(eye)
            thing.hide_viewport = viewport
        bpy.context.view_layer.active_layer_collection = self.active
        bpy.data.collections.remove(self.place)


def export(file, things, animations, attributes=False):
    with Shown(things):
        bpy.ops.export_scene.gltf(filepath=file, export_format="GLB", use_active_collection=True, export_apply=True,
                                  export_extras=True, export_animations=animations, export_attributes=attributes)


def exportItem(file, name, item, body, armature):
    owner, garments = item
    scene, before = bpy.context.scene, bpy.context.scene.get("ensemble")
    scene["ensemble"] = propertiesOf(owner)
    painted = [mesh for mesh in body if paint(mesh, name)]
    try:
        export(file, [armature, *body, *garments], animations=False, attributes=bool(painted))
    finally:
        for mesh in painted:
            mesh.data.attributes.remove(mesh.data.attributes[PAINT])
        del scene["ensemble"]
        if before is not None:
            scene["ensemble"] = before


def exportAll(options):
    body, items = meshesIn(collection(options.body)), itemsIn(collection(options.clothes))
    if not body:
        raise ExportError(f"there is no mesh in the collection '{options.body}'; put the body there")
    clothes = [mesh for _, meshes in items.values() for mesh in meshes]
    if set(body) & set(clothes):
        raise ExportError(f"'{(set(body) & set(clothes)).pop().name}' is body and clothes; take it out of a collection")
    armature = armatureOf(body + clothes)
    out = os.path.abspath(bpy.path.abspath(options.out))
    os.makedirs(os.path.join(out, "outfits"), exist_ok=True)
    # Mask modifiers hide skin by hand; here the body must be whole.
    masks = [m for mesh in body for m in mesh.modifiers if m.type == "MASK" and m.show_viewport]
    for mask in masks:
        mask.show_viewport = False
    try:
        export(os.path.join(out, "template.glb"), [armature, *body], animations=True)
        for name, item in sorted(items.items()):
            exportItem(os.path.join(out, "outfits", f"{name}.glb"), name, item, body, armature)
    finally:
        for mask in masks:
            mask.show_viewport = True
    print(f"blender_export: template.glb and {len(items)} items ({', '.join(sorted(items))}) in {out}")


def main():
    parser = argparse.ArgumentParser(prog="blender_export.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", default="//ensemble", help="folder to write to; // is that of the .blend (//ensemble)")
    parser.add_argument("--body", default="Body", help="collection of the body (Body)")
    parser.add_argument("--clothes", default="Clothes", help="collection of the items (Clothes)")
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    try:
        exportAll(options)
    except Exception as error:
        if not bpy.app.background:  # in the text editor: Blender shows it, and stays open
            raise
        if not isinstance(error, ExportError):
            traceback.print_exc()
        sys.exit(f"blender_export: {error}")


main()
