#!/usr/bin/env python3
"""Proof: the Khronos glTF validator finds no error in any GLB that the program writes.

That is what `people` makes, what `author` makes for those people and for the real ones (a sample of the recipes, all of
them with --full, and one with a texture), and what `tag` writes of it all, with and without Draco.
"""
import json
import struct
import sys
import zlib

from proof import PROJECT, arguments, everybody, fail, needNode, node, run

# Of each kind of garment one, with trims, patterns, folds, solids and straps among them.
SAMPLE = ("cap", "coat", "hair_ponytail", "jumper", "sandals", "uniform")
SAMPLE_PEOPLE = ("made/woman", "real/male")


def writePng(path):
    """2 x 2 pixels."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = (b"\0" + bytes([200, 60, 40, 240, 230, 200])) * 2
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def recipes(options):
    """The recipes to author, and one with a texture of our own."""
    folder = options.work / "recipes"
    folder.mkdir()
    writePng(folder / "cloth.png")
    text = (PROJECT / "outfits/tshirt.yaml").read_text().replace("name: tshirt", "name: textured", 1)
    (folder / "textured.yaml").write_text(text.replace('    color: "#c4442f"', "    texture: cloth.png", 1))
    files = sorted((PROJECT / "outfits").glob("*.yaml"))
    return [folder / "textured.yaml", *(file for file in files if options.full or file.stem in SAMPLE)]


def authored(options, people):
    """{what: files} of items authored for people, raw and tagged."""
    sets, files = {}, recipes(options)
    for name, folder in people:
        if not options.full and name not in SAMPLE_PEOPLE:
            continue
        items = options.work / "authored" / name
        run(options.ensemble, "author", *files, "--template", folder / "template.glb", "-o", items, "-q")
        sets[f"{name} authored"] = sorted(items.glob("*.glb"))
        if len(sets[f"{name} authored"]) != len(files):
            fail(f"{name}: {len(files)} recipes made {sets[f'{name} authored']}")
        wardrobe = options.work / "wardrobes/authored" / name
        run(options.ensemble, "tag", folder / "template.glb", *sets[f"{name} authored"], "-o", wardrobe, "-q",
            "--occlusion", "auto")
        sets[f"{name} authored and tagged"] = sorted(wardrobe.glob("**/*.glb"))
    return sets


def main():
    options = arguments(__doc__)
    needNode(options, "gltf-validator")
    people = everybody(options)
    sets = authored(options, people)  # what was written -> files
    for name, folder in people:
        outfits = sorted(folder.glob("outfits/*.glb"))
        if name.startswith("made/"):
            sets[f"{name} as made"] = [folder / "template.glb", *outfits]
        for kind, flags in (("tagged", []), ("tagged, Draco", ["--draco"])):
            wardrobe = options.work / "wardrobes" / kind / name
            run(options.ensemble, "tag", folder / "template.glb", *outfits, "-o", wardrobe, "-q", *flags)
            sets[f"{name} {kind}"] = sorted(wardrobe.glob("**/*.glb"))
    errors = 0
    for what, files in sets.items():
        if len(files) < 2:
            fail(f"{what}: expected a template and outfits, found {files}")
        rows = [json.loads(line) for line in node(options, "gltf_validate.cjs", *files).splitlines()]
        if len(rows) != len(files):
            fail(f"{what}: the validator spoke of {len(rows)} files of {len(files)}")
        bad = [row for row in rows if row["errors"]]
        errors += sum(row["errors"] for row in bad)
        print(f"{what}: {len(files)} files, {sum(row['errors'] for row in rows)} errors, "
              f"{sum(row['warnings'] for row in rows)} warnings")
        for row in bad:
            print(f"  {row['file']}: " + "; ".join(row["texts"][:5]))
    print(f"{sum(map(len, sets.values()))} files: {errors} errors")
    sys.exit(1 if errors else 0)


if __name__ == "__main__":
    main()
