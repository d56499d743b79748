"""The files of the table in messages_test.py: sound ones, and each broken in one way."""
import math
import os
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
import small_glb  # noqa: E402
import small_set  # noqa: E402
from small_glb import glb, outfit, template  # noqa: E402


def change(path, value):
    """A change of the finished JSON: change("nodes/0/mesh", 9)."""
    def apply(document):
        *steps, last = [int(step) if step.isdigit() else step for step in path.split("/")]
        place = document
        for step in steps:
            place = place[step]
        place[last] = value
    return apply


def with_rows(document, accessor, row, values):
    document.rows[accessor][row] = values
    return document


def moved(fraction, millimetres, document=None):
    """An outfit of which the first corners of about this share of the body's faces stand elsewhere."""
    document = document or outfit(keep=lambda region, face: region == 0 or region == 1)
    faces = int(fraction * 128 + 0.5)
    primitive = document.json["meshes"][0]["primitives"][0]
    positions, indices = document.rows[primitive["attributes"]["POSITION"]], document.rows[primitive["indices"]]
    # New corners, so that no other face moves with them.
    for name, accessor in primitive["attributes"].items():
        rows = document.rows[accessor]
        for face in range(faces):
            rows.append(list(rows[indices[3 * face][0]]))
        document.accessors[accessor]["count"] = len(rows)
    for face in range(faces):
        corner = len(positions) - faces + face
        positions[corner][1] += millimetres / 1000
        indices[3 * face] = [corner]
    return document


def another_body():
    """The same materials and joints, a person 5 mm wider."""
    return outfit(radius=0.205)


def without_material_names():
    document = template()
    document.json["materials"] = [{} for _ in document.json["materials"]]
    return document


def without_materials():
    document = template()
    del document.json["materials"]
    for primitive in document.json["meshes"][0]["primitives"]:
        del primitive["material"]
    return document


def without_skin():
    document = template()
    del document.json["skins"]
    for node in document.json["nodes"]:
        node.pop("skin", None)
    return document


def without_body():
    document = outfit()
    document.json["materials"][0]["name"] = document.json["materials"][1]["name"] = "skin"
    return document


def with_misnamed_region():
    """The legs' material is named 'tail', and the template has no region of that name."""
    document = outfit()
    document.json["materials"][0]["name"] = "tail"
    return document


def with_another_region():
    """A part 'tail' of the body that the template does not have at all."""
    document = outfit()
    tail = small_glb.band(document, 0.05, 0.1, 0.3, 1, lambda face: True, len(document.json["materials"]))
    document.json["meshes"][0]["primitives"].append(tail)
    document.json["materials"].append({"name": "tail"})
    return document


def far_set():
    """The street of small_set.py, in millimetres from somewhere far away."""
    document = small_set.street()
    document.json["nodes"][0]["translation"] = [0, 0, 2e9]
    return document


def gltf_with_uri(uri):
    import json
    return json.dumps({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": uri}]}).encode()


def long_header(size):
    """A GLB whose header claims `size` bytes."""
    data = bytearray(template().bytes())
    struct.pack_into("<I", data, 8, size)
    return bytes(data)


def long_chunk(size):
    data = bytearray(template().bytes())
    struct.pack_into("<I", data, 12, size)
    return bytes(data)


def glbs():
    """name -> bytes"""
    sound = template().bytes()
    broken = {
        "empty.glb": b"",
        "truncated.glb": sound[:len(sound) // 2],
        "header_of_2GB.glb": long_header(0x80000000),
        "chunk_of_2GB.glb": long_chunk(0x80000000),
        "deep.glb": glb('{"asset":{"version":"2.0"},"extras":' + "[" * 100000 + "]" * 100000 + "}"),
        "text.glb": b"hello, I am no GLB at all",
        "index.glb": with_rows(template(), 4, 7, [40]).bytes(),
        "accessor.glb": template().bytes(change("meshes/0/primitives/0/attributes/POSITION", 99)),
        "accessor_count.glb": template().bytes(change("accessors/0/count", 4000000000)),
        "view.glb": template().bytes(change("accessors/0/bufferView", 99)),
        "view_range.glb": template().bytes(change("bufferViews/0/byteLength", 1 << 40)),
        "joint.glb": with_rows(template(), 2, 8, [0, 2, 0, 0]).bytes(),
        "skin_joint.glb": template().bytes(change("skins/0/joints", [0, 77])),
        "node.glb": template().bytes(change("scenes/0/nodes", [0, 5])),
        "node_mesh.glb": template().bytes(change("nodes/2/mesh", 3)),
        "node_skin.glb": template().bytes(change("nodes/2/skin", -1)),
        "material.glb": template().bytes(change("meshes/0/primitives/1/material", 3)),
        "cycle.glb": template().bytes(change("nodes/1/children", [0])),
        "self.glb": template().bytes(change("nodes/1/children", [1])),
        "two_parents.glb": template().bytes(change("nodes/2/children", [1])),
        "nan.glb": with_rows(template(), 0, 3, [0.0, math.nan, 0.0]).bytes(change("accessors/0/min", [0, 0, 0])),
        "infinite.glb": with_rows(template(), 0, 3, [math.inf, 0.0, 0.0]).bytes(change("accessors/0/max", [0, 0, 0])),
        "weights.glb": with_rows(template(), 3, 2, [0.0, 0.0, 0.0, 0.0]).bytes(),
        "weight_negative.glb": with_rows(template(), 3, 2, [-1.0, 2.0, 0.0, 0.0]).bytes(),
        "no_materials.glb": without_materials().bytes(),
        "no_names.glb": without_material_names().bytes(),
        "no_skin.glb": without_skin().bytes(),
        "no_body.glb": without_body().bytes(),
        "far_set.glb": far_set().bytes(),
        "other_body.glb": another_body().bytes(),
        "misnamed.glb": with_misnamed_region().bytes(),
        "tail.glb": with_another_region().bytes(),
        "moved_a_little.glb": moved(0.015, 8).bytes(),
        "moved_much.glb": moved(0.05, 8).bytes(),
        "huge_sparse.glb": template().bytes(lambda document: (
            document["accessors"][0].pop("bufferView"), document["accessors"][0].update(count=4000000000))),
    }
    for name, uri in URIS.items():
        broken[name] = gltf_with_uri(uri)
    return broken


URIS = {"traversal.gltf": "../../../../etc/passwd", "traversal_encoded.gltf": "%2e%2e/secret.bin",
        "absolute.gltf": "/etc/passwd", "scheme.gltf": "file:///etc/passwd", "remote.gltf": "http://host/a.bin",
        "folder.gltf": "sub", "missing.gltf": "none.bin", "link.gltf": "sub/link.bin"}

SCENE = "version: 1\nwardrobe: w\noutput: {width: 64, height: 64}\ncrowd: {count: 2}\n"


def write_files(folder):
    """Everything but the wardrobes, which the program itself makes."""
    for name, data in glbs().items():
        (folder / name).write_bytes(data)
    (folder / "template.glb").write_bytes(template().bytes())
    (folder / "two_clips.glb").write_bytes(template(clip="walk").bytes())
    (folder / "tunic.glb").write_bytes(outfit().bytes())
    (folder / "sub").mkdir()
    (folder / "sub" / "tunic.glb").write_bytes(outfit(keep=lambda region, face: region == 2).bytes())
    (folder / "secret.bin").write_bytes(b"1234")
    os.symlink("/etc/passwd", folder / "sub" / "link.bin")
    (folder / "file").write_text("a regular file\n")
    (folder / "scene.yaml").write_text(SCENE)
    with open(folder / "sparse_2GB.glb", "wb") as file:  # takes no room on the disk
        file.truncate(1 << 31)


def spoil_wardrobes(folder):
    """Copies of the wardrobe `w`, each spoilt in one way."""
    import json
    import shutil

    def copy(name):
        shutil.copytree(folder / "w", folder / name)
        return folder / name

    def edit(name, apply):
        path = copy(name) / "wardrobe.json"
        document = json.loads(path.read_text())
        apply(document)
        path.write_text(json.dumps(document))
    edit("w_version", change("schema", "ensemble.wardrobe/2"))
    edit("w_no_schema", lambda document: document.pop("schema"))
    edit("w_escapes", change("outfits/0/file", "../tunic.glb"))
    edit("w_lies", change("outfits/0/regions/1/visible_faces", 31))
    edit("w_wrong_type", change("template/faces", "many"))
    edit("w_twice", lambda document: document["outfits"].append(document["outfits"][0]))
    (copy("w_cut") / "wardrobe.json").write_text((folder / "w" / "wardrobe.json").read_text()[:200])
    (copy("w_deep") / "wardrobe.json").write_text("[" * 1000000)
    (copy("w_no_manifest") / "wardrobe.json").unlink()
    (copy("w_no_template") / "template.glb").unlink()
    outfit_file = next((folder / "w" / "outfits").iterdir()).name
    (copy("w_no_outfit") / "outfits" / outfit_file).unlink()
    damaged = copy("w_damaged") / "outfits" / outfit_file
    data = bytearray(damaged.read_bytes())
    data[len(data) // 2] ^= 1
    damaged.write_bytes(data)
    folder_for_file = copy("w_folder_for_file") / "template.glb"
    folder_for_file.unlink()
    folder_for_file.mkdir()
    return outfit_file
