#!/usr/bin/env python3
"""Hostile and mistaken input through the program: the exact line it says, its exit code, nothing written.

Usage: messages_test.py --ensemble PROGRAM [--only TEXT]

A row is (arguments, exit code, message), the message without "ensemble: ". Rows of GLBs are run
with `inspect`, and through `tag` once as template and once as outfit. What the readers themselves refuse is
tested in more depth, and by the line, in tests/core/gltf_hostile*_test.cpp and scene_test.cpp.
"""
import argparse
import hashlib
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

import bad_files

AGAIN = "; export the file again"
BESIDE = "; put the file beside the glTF file and name it by a relative path"
DAMAGED = "; remove the damaged vertex or key and export the file again"
MAKE_AGAIN = "; make the wardrobe again with `ensemble tag`"
COPY_AGAIN = "; copy the whole folder again, or make it with `ensemble tag`"
NO_WARDROBE = ": there is no wardrobe here (no wardrobe.json); give a folder made by `ensemble tag`"
NO_DRIVER = "Vulkan: there is no Vulkan driver; install a Vulkan 1.3 driver, e.g. apt install mesa-vulkan-drivers"
NO_FOLDER = "the folder can't be made: Not a directory; choose a place that you may write to"
BODY_MEND = ("; export the outfit with the body that it dresses, its materials named as the template's, or use "
             "--body NODE")

# Files that no command takes: FILE -> what is said after its name.
GLBS = {
    "none.glb": "no such file; check the path",
    "empty.glb": "the file is empty" + AGAIN,
    "text.glb": "this is neither a GLB nor a .gltf; export as glTF 2.0",
    "truncated.glb": "byte 8: the header promises 10168 bytes, the file has 5084" + AGAIN,
    "header_of_2GB.glb": "byte 8: the header promises 2147483648 bytes, the file has 10168" + AGAIN,
    "chunk_of_2GB.glb": "byte 12: a chunk of 2147483648 bytes reaches beyond the file's end" + AGAIN,
    "sparse_2GB.glb": "has 2147483648 bytes, more than the 1073741824 that are read; split it or reduce its content",
    "deep.glb": "byte 99: the JSON is nested more than 64 deep; remove the nested extras",
    "index.glb": "/meshes/0/primitives/0/indices: index 40 at 7 is not below the number of vertices, 40" + AGAIN,
    "accessor.glb": "/meshes/0/primitives/0/attributes/POSITION: there is no 'accessors' number 99" + AGAIN,
    "accessor_count.glb":
        "/accessors/0: 4000000000 elements need 48000000000 bytes from byte 0, bufferView 0 has 480" + AGAIN,
    "huge_sparse.glb": "/meshes/0/primitives/0: 4000000000 vertices are more than the 16777216 still allowed in this "
                       "file; split the file",
    "view.glb": "/accessors/0/bufferView: there is no 'bufferViews' number 99" + AGAIN,
    "view_range.glb": "/bufferViews/0: bytes 0 to 1099511627776 reach beyond the buffer's 6620" + AGAIN,
    "joint.glb": "/meshes/0/primitives/0: vertex 8 names joint 2 of 2" + AGAIN,
    "skin_joint.glb": "/skins/0/joints/1: there is no 'nodes' number 77" + AGAIN,
    "node.glb": "/scenes/0/nodes/1: there is no 'nodes' number 5" + AGAIN,
    "node_mesh.glb": "/nodes/2/mesh: there is no 'meshes' number 3" + AGAIN,
    "node_skin.glb": "/nodes/2/skin: expected a whole number, found -1" + AGAIN,
    "material.glb": "/meshes/0/primitives/1/material: there is no 'materials' number 3" + AGAIN,
    "cycle.glb": "/nodes/0: the node is its own ancestor" + AGAIN,
    "self.glb": "/nodes/1: the node has two parents, 0 and 1" + AGAIN,
    "two_parents.glb": "/nodes/1: the node has two parents, 0 and 2" + AGAIN,
    "nan.glb": "/accessors/0: element 3 is not a finite number" + DAMAGED,
    "infinite.glb": "/accessors/0: element 3 is not a finite number" + DAMAGED,
    "weights.glb": "/meshes/0/primitives/0: vertex 2 has no weight: its weights sum to zero; bind the vertex to a "
                   "joint and export again",
    "weight_negative.glb": "/meshes/0/primitives/0: vertex 2 has the negative weight -1; normalise the weights and "
                           "export again",
    "traversal.gltf": "/buffers/0/uri: '../../../../etc/passwd' leads out of the file's folder" + BESIDE,
    "traversal_encoded.gltf": "/buffers/0/uri: '%2e%2e/secret.bin' leads out of the file's folder" + BESIDE,
    "absolute.gltf": "/buffers/0/uri: '/etc/passwd' is an absolute path" + BESIDE,
    "scheme.gltf": "/buffers/0/uri: 'file:///etc/passwd' is not a relative path" + BESIDE,
    "remote.gltf": "/buffers/0/uri: 'http://host/a.bin' is not a relative path" + BESIDE,
    "folder.gltf": "/buffers/0/uri: 'sub' is not a regular file" + BESIDE,
    "missing.gltf": "/buffers/0/uri: 'none.bin' can't be found" + BESIDE,
    "link.gltf": "/buffers/0/uri: 'sub/link.bin' leads out of the file's folder" + BESIDE,
}

# Sound files that don't fit together.
TAGGING = [
    ("tag no_materials.glb -o new", 3,
     "no_materials.glb: /materials: the template's faces have no material name to make regions of; give each part of "
     "the body a named material, or use --regions joints"),
    ("tag no_names.glb -o new", 3,
     "no_names.glb: /materials: the template's faces have no material name to make regions of; give each part of the "
     "body a named material, or use --regions joints"),
    ("tag no_skin.glb -o new", 3,
     "no_skin.glb: /skins: the template has no skin, so it can't be animated; bind the body to a skeleton and export "
     "it with its skin"),
    ("tag template.glb no_body.glb -o new", 3,
     "no_body.glb: /materials: there is no body in this outfit: no material is named as one of the template's "
     "('legs', 'torso', 'head')" + BODY_MEND),
    ("tag template.glb other_body.glb -o new", 3,
     "other_body.glb: /meshes: 96 of the 96 body faces match no face of the template; corners are 5.00 mm (median) to "
     "5.00 mm (maximum) from it; tag it with the template that it was made for"),
    ("tag template.glb misnamed.glb -o new", 3,
     "misnamed.glb: /nodes/2: the 64 faces of material 'tail' in node 'body' are the template's body, which has no "
     "region of this name; name the material as the template's ('legs', 'torso', 'head'), or export it as a node of "
     "its own if it is a garment"),
    ("tag template.glb moved_much.glb -o new", 3,
     "moved_much.glb: /meshes: 6 of the 128 body faces match no face of the template; corners are 0.00 mm (median) to "
     "8.00 mm (maximum) from it; leave the faces of the template's body as they are, or raise --tolerance"),
    ("tag template.glb tunic.glb sub/tunic.glb -o new", 3,
     "sub/tunic.glb: two outfits are named 'tunic'; rename one of the files"),
    ("tag template.glb tunic.glb --body hips -o new", 3,
     "tunic.glb: /nodes: no mesh node is named 'hips'; name one with --body (`ensemble inspect` lists them)"),
    ("add w sub/tunic.glb", 3, "sub/tunic.glb: the wardrobe has an outfit 'tunic' already; remove that first "
                               "(`ensemble remove`), or rename the file"),
    ("add w_other w/outfits/{tunic}", 3,
     "w/outfits/{tunic}: /extras/ensemble/template/geometry_hash: this outfit was tagged for another template, its "
     "classes don't hold here; tag the raw outfit for this template"),
    ("remove w tunik", 3, "w: the wardrobe has no outfit 'tunik'; did you mean 'tunic'?"),
]

# Warnings: the message goes with exit code 0 and a wardrobe.
ACCEPTED = [
    ("tag template.glb moved_a_little.glb -o new", 0,
     "warning: moved_a_little.glb: 2 of the 128 body faces match no face of the template (corners up to 8.00 mm off); "
     "they stay as geometry of the outfit and their regions count as partial"),
    ("tag template.glb tail.glb -o new", 0,
     "warning: tail.glb: the 16 faces of material 'tail' in node 'body' are in no region of the template ('legs', "
     "'torso', 'head'), so they count as a garment"),
]

# Wardrobes: FOLDER -> what is said.
WARDROBES = {
    "nowhere": "nowhere" + NO_WARDROBE,
    "file": "file" + NO_WARDROBE,
    "w_no_manifest": "w_no_manifest" + NO_WARDROBE,
    "w_version": 'w_version/wardrobe.json: /schema: schema "ensemble.wardrobe/2" is not "ensemble.wardrobe/1"; make '
                 "the wardrobe again with this version's `ensemble tag`",
    "w_no_schema": 'w_no_schema/wardrobe.json: /schema: this is not a wardrobe manifest; expected "schema": '
                   '"ensemble.wardrobe/1"',
    "w_cut": "w_cut/wardrobe.json: 6:38: the JSON is malformed" + MAKE_AGAIN,
    "w_deep": "w_deep/wardrobe.json: byte 16: the JSON is nested more than 16 deep" + MAKE_AGAIN,
    "w_wrong_type": "w_wrong_type/wardrobe.json: /template/faces: Value type not permitted by 'type' constraint"
                    + MAKE_AGAIN,
    "w_escapes": "w_escapes/wardrobe.json: /outfits/0/file: file '../tunic.glb' is not in the wardrobe's folder"
                 + MAKE_AGAIN,
    "w_twice": "w_twice/wardrobe.json: /outfits/1/name: name 'tunic' stands twice" + MAKE_AGAIN,
    "w_lies": "w_lies/wardrobe.json: /outfits/0: the manifest describes another outfit than its file "
              "'outfits/{tunic}' holds" + COPY_AGAIN,
    "w_no_template": "w_no_template/template.glb: this file of the wardrobe is missing" + COPY_AGAIN,
    "w_no_outfit": "w_no_outfit/outfits/{tunic}: this file of the wardrobe is missing" + COPY_AGAIN,
    "w_damaged": "w_damaged/outfits/{tunic}: this file is damaged: its SHA-256 is not the one in wardrobe.json"
                 + COPY_AGAIN,
    "w_folder_for_file": "w_folder_for_file/template.glb: is not a regular file; give a file",
}

# Lines after a sound head of four -> place and message. The keys' every range is in core/scene_test.cpp.
SCENES = {
    "camera: {position: [1, 2, nan]}": "5:27: camera.position.2 is 'nan'; give a number from -1000000 to 1000000 (metres)",
    "camera: {fov_y: 180}": "5:17: camera.fov_y is '180'; give a number greater than 0 and less than 180 (degrees)",
    "light: {shadows: yes}": "5:18: light.shadows is 'yes'; give true or false",
    "ground: 010": "5:9: ground is '010'; give true or false",
    "environment: none.glb": "5:14: the environment none.glb: no such file; check the path",
    "environment: text.glb": "5:14: the environment text.glb: this is neither a GLB nor a .gltf; export as glTF 2.0",
    "environment: w": "5:14: the environment w: is not a regular file; give a file",
    "environment: [a.glb]": "5:14: environment is a list; give a glTF file",
    "technique: taged":
        "5:12: technique is 'taged'; give 'naive', 'prefitted' or 'tagged'; the nearest is 'tagged'",
    "people: {a: 1}": "5:9: people is a map; give a list of people",
    "people: [{phase: 2}]": "5:18: people.0.phase is '2'; give a number from 0 to 1",
    "people: [{outfit: tunik}]": "5:19: the wardrobe 'w' has no outfit 'tunik'; write 'tunic'",
    "people: [{clip: walk}]": "5:17: the wardrobe 'w' has no clip 'walk'; write 'sway'",
}

OUTPUTS = [  # also for root, who passes by permissions
    ("tag template.glb tunic.glb -o file/new", 1, "file/new: " + NO_FOLDER),
    ("tag template.glb tunic.glb -o file", 1, "file: " + NO_FOLDER),
    ("tag template.glb tunic.glb -o /proc/new", 1,
     "/proc/new: the folder can't be made: No such file or directory; choose a place that you may write to"),
    ("report w --json file/a.json", 1, "file/a.json: can't be written: Not a directory; choose another place"),
    ("report w --json nowhere/a.json", 1,
     "nowhere/a.json: can't be written: No such file or directory; make its folder first"),
    ("report w --json sub", 1, "sub: can't be written: Is a directory; choose another place"),
    ("report w --json /dev/full", 1,
     "/dev/full: can't be written: No space left on device; free some space and run it again"),
]

# Crowd tables: what is in the file -> what is said after its name. Every field is in core/crowd_table_test.cpp.
TABLES = {
    "": "the crowd table is empty; begin with a row of column names: x,z",
    "x;z\n1;2\n": "1:1: fields are parted by ';' here; part them by commas, and write 0.5, not 0,5",
    "0,0\n": "1:1: the table begins with a number; begin with a row of column names: x,z",
    "x,z,cloth\n": "1:5: unknown column 'cloth'; write 'clip' (known: number, wardrobe, outfit, clip, phase, speed, x, "
                   "y, z, heading, scale, tint)",
    "x,y\n0,0\n": "1:1: there is no column 'z'; add it: x and z are where people stand, in metres",
    "x,z\n0,nan\n": "2:3: z is 'nan'; give a number from -10000000000 to 10000000000 (metres)",
    "x,z\n0\n": "2:1: the row has 1 fields, the first row names 2 columns; write a field for each column; it may be "
                "empty",
    "x,z,clip\n0,0,\"sway\n": "2:5: the field's quotes are not closed; add the closing quote",
    "x,z,outfit\n0,0,tunik\n": "2:5: the wardrobe 'w' has no outfit 'tunik'; write 'tunic'",
    "x,z,clip\n0,0,\n0,0,walk\n": "3:5: the wardrobe 'w' has no clip 'walk'; write 'sway'",
    "x,z,wardrobe\n0,0,w\n": "2:5: there is no wardrobe 'w': the scene's only one has no key; remove the name, or give "
                             "'wardrobe: {KEY: FOLDER}'",
}

RENDERING = [
    ("render clips.yaml -o a.png", 3, "clips.yaml: 4:33: the wardrobe 'walking' has no clip 'sway'; write 'walk'"),
    ("render scene.yaml -o a.png --set environment=empty.glb", 3,
     "scene.yaml: environment: the environment empty.glb: the file is empty" + AGAIN),
    ("render scene.yaml -o a.png --set environment=index.glb", 3, "index.glb: " + GLBS["index.glb"]),
    ("bench scene.yaml --set environment=far_set.glb", 3,
     "far_set.glb: /nodes/0: a vertex of the node is more than 1000000 metres from the origin; scale the set to "
     "metres and export it again"),
    ("render nowhere.yaml -o a.png", 3, "nowhere.yaml: no such file; check the path"),
    ("render table.yaml -o a.png --set crowd.placement.file=none.csv", 3, "none.csv: no such file; check the path"),
    ("render scene.yaml -o a.png --annotations -", 2,
     "--annotations -: annotations go to a file, which --resume goes on with; write --annotations people.json"),
    ("render scene.yaml -o a.png --dump-crowd a.txt", 2,
     "--dump-crowd a.txt: a crowd table's name ends in .csv: a scene knows it by that; write --dump-crowd crowd.csv"),
    ("render scene.yaml -o a.bmp", 2, "-o a.bmp: pictures can't be written as '.bmp'; write .png, .exr or .mp4: name.png, "
                                      "name_%04d.exr, name.mp4, or a folder dir/"),
]
RECIPE = """version: 1
name: top
slot: upper
garments:
  - name: top
    kind: body
    hem: 0.4
    neck: {rise: 0}
"""
AUTHORING = [
    ("author none.yaml --template template.glb -o items", 3, "none.yaml: no such file; check the path"),
    ("author recipe.yaml --template none.glb -o items", 3, "none.glb: no such file; check the path"),
    ("author recipe.yaml --template text.glb -o items", 3, "text.glb: " + GLBS["text.glb"]),
    ("author recipe.yaml recipe.yaml --template template.glb -o items", 3,
     "recipe.yaml: its outfit is named 'top', as that of recipe.yaml; give each recipe a name of its own"),
    ("author recipe.yaml --template template.glb -o items", 3,
     "recipe.yaml: 5:5: garment 'top' needs the neck, for which the template has no joint ('neck_01', for example); "
     "name the joint under joints, or dress another template"),
    ("author scene.yaml --template template.glb -o items", 3,
     "scene.yaml: 2:1: unknown key 'wardrobe'; write 'version' (known: version, name, slot, layer, joints, garments)"),
]
DRAWING = [("render scene.yaml -o /proc/a.png", 1,
            "/proc/a.png: can't be written: No such file or directory; make its folder first"),
           ("render scene.yaml -o a.png --dump-crowd file/a.csv", 1,
            "file/a.csv: can't be written: Not a directory; choose another place")]


def snapshot(folder):
    """Every file below and what it holds, so that a run that should write nothing is found out."""
    contents = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_file() and not path.is_symlink() and path.stat().st_size < 1 << 30:
            contents[name] = hashlib.sha256(path.read_bytes()).hexdigest()
        else:
            contents[name] = path.lstat().st_mtime_ns if not path.is_dir() else "folder"
    return contents


class Table:
    def __init__(self, program, folder, only):
        self.program, self.folder, self.only = program, folder, only
        self.passed, self.failures, self.names = 0, [], {}

    def run(self, arguments, environment=None):
        return subprocess.run([self.program, *shlex.split(arguments)], cwd=self.folder, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, env={**os.environ, **(environment or {})}, timeout=120)

    def setUp(self):
        bad_files.write_files(self.folder)
        for arguments in ("tag template.glb tunic.glb -o w", "tag two_clips.glb tunic.glb -o w_walk",
                          "tag other_body.glb -o w_other"):
            result = self.run(arguments)
            if result.returncode != 0:
                sys.exit(f"{arguments}: {result.stderr}")
        self.names["tunic"] = bad_files.spoil_wardrobes(self.folder)
        (self.folder / "clips.yaml").write_text(
            "version: 1\nwardrobe: {swaying: w, walking: w_walk}\noutput: {width: 64, height: 64}\n"
            "crowd: {count: 2, clips: {sway: 1}}\n")
        (self.folder / "table.yaml").write_text("version: 1\nwardrobe: w\ncrowd: {placement: {kind: file}}\n")

    def check(self, arguments, code, message, environment=None, writes=False):
        for name, value in self.names.items():
            arguments, message = (text.replace("{" + name + "}", value) for text in (arguments, message))
        if self.only not in arguments:
            return
        before = snapshot(self.folder)
        result = self.run(arguments, environment)
        wrong = []
        if result.returncode != code:
            wrong.append(f"  exit code {result.returncode} instead of {code}")
        if result.stderr != f"ensemble: {message}\n":
            wrong.append(f"  says     {result.stderr!r}\n  expected {'ensemble: ' + message!r}")
        if not writes:
            if result.stdout:
                wrong.append(f"  standard output: {result.stdout!r}")
            after = snapshot(self.folder)
            changed = [name for name in {**before, **after} if before.get(name) != after.get(name)]
            if changed:
                wrong.append(f"  wrote {', '.join(changed)}")
        if wrong:
            self.failures.append(arguments + "\n" + "\n".join(wrong))
        else:
            self.passed += 1


def check_all(table):
    for name, message in GLBS.items():
        for command in ("inspect {}", "tag {} -o new", "tag template.glb {} -o new", "add w {}"):
            table.check(command.format(name), 3, f"{name}: {message}")
    (table.folder / "recipe.yaml").write_text(RECIPE)
    for row in TAGGING + OUTPUTS + RENDERING + AUTHORING:
        table.check(*row)
    for row in ACCEPTED:
        table.check(*row, writes=True)
    for name, message in WARDROBES.items():
        for command in ("report {}", "add {} sub/tunic.glb"):
            table.check(command.format(name), 3, message)
    for lines, message in SCENES.items():
        name = f"scene{len(table.failures) + table.passed}.yaml"
        (table.folder / name).write_text(bad_files.SCENE + lines + "\n")
        table.check(f"render {name} -o a.png", 3, f"{name}: {message}")
    for number, (text, message) in enumerate(TABLES.items()):
        (table.folder / f"table{number}.csv").write_text(text)
        table.check(f"render table.yaml -o a.png --set crowd.placement.file=table{number}.csv", 3,
                    f"table{number}.csv: {message}")
    for command in ("render scene.yaml -o a.png", "bench scene.yaml"):
        for nothing in ("/nowhere", ""):
            table.check(command, 1, NO_DRIVER, {"VK_ICD_FILENAMES": nothing, "VK_DRIVER_FILES": nothing})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--ensemble", required=True)
    parser.add_argument("--only", default="", help="rows whose arguments contain this")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        table = Table(os.path.abspath(options.ensemble), pathlib.Path(folder), options.only)
        table.setUp()
        check_all(table)
        if "Vulkan device: none" in table.run("--version").stdout:
            print("SKIPPED: there is no Vulkan device, so rows that draw were left out:")
            print("\n".join(arguments for arguments, _, _ in DRAWING))
        else:
            for row in DRAWING:
                table.check(*row)
    print("\n".join(table.failures + [f"{table.passed} rows hold, {len(table.failures)} don't"]))
    return 1 if table.failures or table.passed == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
