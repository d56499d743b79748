#!/usr/bin/env python3
"""Proof: scripts/blender_export.py brings a body and its clothes out of Blender as they were.

A .blend file as an artist has it is made of real people, and exported. Its items are tagged for the original template
and for the exported one. Where the faces that the makers removed are painted, as a vertex group, exactly those that
have all corners in it are hidden; where rays find them, the same as of the unfitted originals but for a few at most,
because positions move in the last bits.
"""
import json
import shutil
import sys

from proof import PROJECT, arguments, blender, blenderRun, needPeople, peopleIn, run

MAY_DIFFER = 0.005  # share of the template's faces whose verdict may change with the last bits of positions


def visibleFaces(options, wardrobe, outfit):
    """{(region, number)} that show under an outfit."""
    text = run(options.ensemble, "inspect", wardrobe, "--visible", outfit, "--json", "-", "-q")
    return {(region["name"], face) for region in json.loads(text)["regions"] for face in region["faces"]}


def tag(options, wardrobe, template, outfits, *more):
    """Tags outfits into a new wardrobe; its manifest."""
    shutil.rmtree(wardrobe, ignore_errors=True)
    run(options.ensemble, "tag", template, *outfits, "-o", wardrobe, "-q", *more)
    return json.loads((wardrobe / "wardrobe.json").read_text())


def regions(manifest, name):
    """{region: visible faces} of an outfit."""
    outfit = next(entry for entry in manifest["outfits"] if entry["name"] == name)
    return {region["name"]: region["visible_faces"] for region in outfit["regions"]}


def compareClips(ours, theirs):
    """Blender names actions anew when it imports them, so clips are compared by length."""
    lengths = [sorted(round(clip["seconds"], 3) for clip in manifest["template"]["clips"]) for manifest in (ours, theirs)]
    return [] if lengths[0] == lengths[1] else [f"clips last {lengths[0]}, not {lengths[1]} seconds"]


def compareOutfit(options, name, manifests, wardrobes, painted):
    """Differences of one outfit, one line each. `painted` tells what should show of its painted copy."""
    found, fitted = [], regions(manifests["fitted"], name)
    wanted = {region: painted.get(region, 0) for region in fitted}
    if sum(abs(wanted[region] - fitted[region]) for region in fitted) > 0.01 * sum(fitted.values()):
        found.append(f"{name}: painted are {wanted}, far from the makers' {fitted}")
    for kind in ("to_original", "to_exported"):
        shown = regions(manifests[kind], f"{name}_painted")
        if shown != wanted:
            found.append(f"{name}, painted, {kind}: {shown} faces show, not {wanted}")
    item = next(entry for entry in manifests["to_exported"]["outfits"] if entry["name"] == name)
    if (item["slot"], item["layer"]) != ("over", 3):
        found.append(f"{name}: slot {item['slot']}, layer {item['layer']}, not over, 3")
    faces = manifests["unfitted"]["template"]["faces"]
    before, after = (visibleFaces(options, wardrobes[kind], name) for kind in ("unfitted", "to_original"))
    print(f"  {name}: rays hide {faces - len(before)} faces, exported {faces - len(after)}; "
          f"{len(before ^ after)} differ; painted {sum(wanted.values())} show, the makers' {sum(fitted.values())}")
    if len(before ^ after) > MAY_DIFFER * faces:
        found.append(f"{name}: {len(before ^ after)} of {faces} faces have another verdict")
    return found


def proveOne(options, folder):
    work = options.work / folder.name
    work.mkdir()
    names = sorted(file.stem for file in folder.glob("outfits/*.glb"))
    if not options.full:
        names = names[:3]
    blender("blender_export_scene.py", work / "artist.blend", work / "painted.json", folder / "template.glb",
            *(part for name in names
              for part in (name, folder / f"unfitted/{name}.glb", folder / f"outfits/{name}.glb")))
    print(blenderRun([work / "artist.blend"], PROJECT / "scripts/blender_export.py", "--out", work / "out")
          .partition("blender_export: ")[2].partition("\n")[0])
    items = sorted((work / "out/outfits").glob("*.glb"))
    wardrobes = {kind: work / kind for kind in ("fitted", "unfitted", "to_original", "to_exported")}
    manifests = {
        "fitted": tag(options, wardrobes["fitted"], folder / "template.glb",
                      [folder / f"outfits/{name}.glb" for name in names]),
        "unfitted": tag(options, wardrobes["unfitted"], folder / "template.glb",
                        [folder / f"unfitted/{name}.glb" for name in names], "--occlusion", "auto"),
        "to_original": tag(options, wardrobes["to_original"], folder / "template.glb", items),
        "to_exported": tag(options, wardrobes["to_exported"], work / "out/template.glb", items),
    }
    painted = json.loads((work / "painted.json").read_text())
    found = compareClips(manifests["to_exported"], manifests["fitted"])
    for name in names:
        found += compareOutfit(options, name, manifests, wardrobes, painted[name])
    print(f"{folder.name}: {len(names)} outfits through blender_export.py, {len(found)} differences", flush=True)
    return found


def refusals(options, blend):
    """Messages of the script that are not as they should be, one line each."""
    found = []
    for parts, wanted in (
            (("--body", "Nobody"), "there is no collection 'Nobody'; make one, or name another (--body, --clothes)"),
            (("--clothes", "Body"), "'body' is body and clothes; take it out of a collection")):
        said = blenderRun([blend], PROJECT / "scripts/blender_export.py", "--out", options.work / "refused", *parts,
                          may_fail=True)
        if f"blender_export: {wanted}\n" not in said:
            found.append(f"{parts}: no line 'blender_export: {wanted}' in\n{said[-600:]}")
    return found


def main():
    options = arguments(__doc__)
    needPeople(options)
    folders = peopleIn(options.people)
    found = [line for folder in (folders if options.full else folders[:1]) for line in proveOne(options, folder)]
    found += refusals(options, next(options.work.glob("*/artist.blend")))
    print("\n".join(found + [f"{len(found)} differences"]))
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
