#!/usr/bin/env python3
"""Proof: the Khronos glTF validator finds no error in any GLB that the program writes.

That is what `people` makes, and what `tag` writes of it and of the real people, with and without
Draco.
"""
import json
import sys

from proof import arguments, everybody, fail, needNode, node, run


def main():
    options = arguments(__doc__)
    needNode(options, "gltf-validator")
    sets = {}  # what was written -> files
    for name, folder in everybody(options):
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
