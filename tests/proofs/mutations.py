#!/usr/bin/env python3
"""Proof: classes and counts do not depend on how a file was exported.

The real outfits, the template, or both are rewritten with other vertex numbers, face orders,
primitives, coordinates (0.01 mm), joint orders, material names and through Draco's own encoder at
14 bits; after tagging, every class, count and total must equal expected.json.
"""
import array
import random
import sys

from glb import Accessor, Glb
from proof import arguments, differences, fail, needNode, needPeople, node, tagAndReport

PERTURBATION = 1e-5  # metres, each coordinate at most


def bodyPrimitives(glb, regions):
    """(mesh, primitive) of every primitive whose material is named as a region."""
    return [(mesh, primitive) for _, mesh in glb.meshNodes() for primitive in mesh["primitives"]
            if glb.materialName(primitive) in regions]


def reindex(glb, regions, chance):
    """Renumbers the vertices of the body at random and starts each face at another corner."""
    for _, primitive in bodyPrimitives(glb, regions):
        count = glb.accessors[primitive["attributes"]["POSITION"]].count
        order = list(range(count))
        chance.shuffle(order)
        number = {old: new for new, old in enumerate(order)}
        for name, index in primitive["attributes"].items():
            primitive["attributes"][name] = glb.add(glb.accessors[index].rows(order))
        source, renumbered = glb.accessors[primitive["indices"]], []
        for start in range(0, len(source.values), 3):
            turn = chance.randrange(3)
            renumbered += [number[source.values[start + (corner + turn) % 3]] for corner in range(3)]
        primitive["indices"] = glb.add(Accessor(source.component_type, "SCALAR", renumbered))


def shuffle(glb, regions, chance):
    """Puts the faces of every primitive of the body in random order."""
    for _, primitive in bodyPrimitives(glb, regions):
        source = glb.accessors[primitive["indices"]]
        faces = [source.values[start:start + 3] for start in range(0, len(source.values), 3)]
        chance.shuffle(faces)
        shuffled = array.array(source.values.typecode)
        for face in faces:
            shuffled.extend(face)
        primitive["indices"] = glb.add(Accessor(source.component_type, "SCALAR", shuffled))


def split(glb, regions, chance):
    """Splits every primitive of the body in three at random; the third has no indices."""
    for mesh, primitive in bodyPrimitives(glb, regions):
        source = glb.accessors[primitive["indices"]]
        parts = [[], [], []]
        for start in range(0, len(source.values), 3):
            parts[chance.randrange(3)] += source.values[start:start + 3]
        mesh["primitives"].remove(primitive)
        for number, indices in enumerate(parts):
            if not indices:
                continue
            piece = dict(primitive, attributes=dict(primitive["attributes"]))
            if number == 2:
                del piece["indices"]
                for name, index in piece["attributes"].items():
                    piece["attributes"][name] = glb.add(glb.accessors[index].rows(indices))
            else:
                piece["indices"] = glb.add(Accessor(source.component_type, "SCALAR", indices))
            mesh["primitives"].append(piece)
        chance.shuffle(mesh["primitives"])


def perturb(glb, regions, chance):
    """Moves every corner of the body by up to 0.01 mm in each coordinate, seams apart from each other."""
    for _, primitive in bodyPrimitives(glb, regions):
        source = glb.accessors[primitive["attributes"]["POSITION"]]
        moved = [value + chance.uniform(-PERTURBATION, PERTURBATION) for value in source.values]
        primitive["attributes"]["POSITION"] = glb.add(Accessor(source.component_type, "VEC3", moved))


def reorderJoints(glb, regions, chance):
    """Puts the skin's joints and the file's nodes in random order, JOINTS_0 and bind matrices with them."""
    for skin in glb.json["skins"]:
        order = list(range(len(skin["joints"])))
        chance.shuffle(order)
        number = {old: new for new, old in enumerate(order)}
        skin["joints"] = [skin["joints"][old] for old in order]
        skin["inverseBindMatrices"] = glb.add(glb.accessors[skin["inverseBindMatrices"]].rows(order))
    done = {}
    for _, mesh in glb.meshNodes():
        for primitive in mesh["primitives"]:
            index = primitive["attributes"]["JOINTS_0"]
            if index not in done:
                source = glb.accessors[index]
                done[index] = glb.add(Accessor(source.component_type, "VEC4", [number[old] for old in source.values]))
            primitive["attributes"]["JOINTS_0"] = done[index]
    shuffleNodes(glb, chance)


def shuffleNodes(glb, chance):
    """Renumbers the nodes of the file at random."""
    order = list(range(len(glb.json["nodes"])))
    chance.shuffle(order)
    number = {old: new for new, old in enumerate(order)}
    glb.json["nodes"] = [glb.json["nodes"][old] for old in order]
    for node_entry in glb.json["nodes"]:
        if "children" in node_entry:
            node_entry["children"] = [number[child] for child in node_entry["children"]]
    for scene in glb.json["scenes"]:
        scene["nodes"] = [number[root] for root in scene["nodes"]]
    for skin in glb.json["skins"]:
        skin["joints"] = [number[joint] for joint in skin["joints"]]
        if "skeleton" in skin:
            skin["skeleton"] = number[skin["skeleton"]]
    for animation in glb.json.get("animations", []):
        for channel in animation["channels"]:
            channel["target"]["node"] = number[channel["target"]["node"]]


def renameMaterials(glb, regions, chance):
    """Gives the body's materials the endings that Blender puts to doubled names."""
    for material in glb.json["materials"]:
        if material["name"] in regions:
            material["name"] += f".{chance.randrange(1, 1000):03}"


def dropOneFace(glb, regions, chance):
    """The control: one face less in one region. This must show."""
    _, primitive = chance.choice(bodyPrimitives(glb, regions))
    source = glb.accessors[primitive["indices"]]
    primitive["indices"] = glb.add(Accessor(source.component_type, "SCALAR", source.values[3:]))


STEPS = {"re-indexed": [reindex], "shuffled": [shuffle], "split": [split], "perturbed": [perturb],
         "joints reordered": [reorderJoints], "renamed": [renameMaterials], "draco": [],
         "all at once": [reindex, shuffle, perturb, split, reorderJoints, renameMaterials],
         # Rewriting alone must change nothing; it checks this proof's own reader and writer.
         "rewritten": [], "robbed of a face": [dropOneFace]}
CONTROL = "robbed of a face"
THROUGH_DRACO = {"draco", "all at once"}


def mutate(options, source, target, name, regions):
    """Writes `source` changed to `target`. The same file and name give the same bytes."""
    glb = Glb(source)
    chance = random.Random(f"{name} {source.name}")
    for step in STEPS[name]:
        step(glb, regions, chance)
    target.parent.mkdir(parents=True, exist_ok=True)
    glb.write(target)
    if target.read_bytes() == source.read_bytes():
        fail(f"'{name}' left {source} as it was: the proof proves nothing")
    if name in THROUGH_DRACO:
        node(options, "draco_encode.cjs", target, target, "14")


def proveOne(options, sex, expected, name, which):
    """Tags one sex with `which` of its files changed by `name`; how many differences that gave."""
    regions, names = set(expected["template"]["regions"]), sorted(expected["outfits"])
    source, work = options.people / sex, options.work / sex / name.replace(" ", "_")
    files = {"template": source / "template.glb",
             **{outfit: source / "outfits" / f"{outfit}.glb" for outfit in names}}
    for key, file in files.items():
        if which == "both" or (which == "template") == (key == "template"):
            files[key] = work / file.name
            if not files[key].exists():
                mutate(options, file, files[key], name, regions)
    report = tagAndReport(options, files["template"], [files[outfit] for outfit in names], work / f"wardrobe_{which}")
    found = differences(report, expected, names)
    totals = ", ".join(f"{technique} {entry['faces']}" for technique, entry in report["techniques"].items())
    print(f"{sex}, {which} {name}: {len(names)} outfits, {totals}; {len(found)} differences", flush=True)
    if name != CONTROL:  # there they are wanted
        for line in found:
            print(f"  {line}")
    return len(found)


def main():
    options = arguments(__doc__)
    expected = needPeople(options)
    needNode(options, "draco3dgltf")
    total = 0
    for name in (key for key in STEPS if key != CONTROL):
        for which in ("outfits", "template", "both"):
            total += sum(proveOne(options, sex, expected[sex], name, which) for sex in ("female", "male"))
    for sex in ("female", "male"):
        if proveOne(options, sex, expected[sex], CONTROL, "outfits") < len(expected[sex]["outfits"]):
            fail("the control, outfits with one face less, went unnoticed")
    print(f"{len(STEPS) - 1} changes of outfits, template and both: {total} differences from expected.json")
    sys.exit(1 if total else 0)


if __name__ == "__main__":
    main()
