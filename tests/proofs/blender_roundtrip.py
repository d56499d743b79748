#!/usr/bin/env python3
"""Proof: a trip through Blender changes no class and no count.

Template and outfits of the real people are imported into Blender and exported again. Tagging the
new outfits, the new template, or both gives exactly what expected.json says of the old ones.
"""
import sys

from proof import arguments, blender, differences, needPeople, tagAndReport


def main():
    options = arguments(__doc__)
    expected = needPeople(options)
    total = 0
    for sex in ("female", "male"):
        names = sorted(expected[sex]["outfits"])
        source = options.people / sex
        old = {"template": source / "template.glb", **{name: source / "outfits" / f"{name}.glb" for name in names}}
        new = {key: options.work / sex / file.name for key, file in old.items()}
        (options.work / sex).mkdir()
        blender("blender_roundtrip_run.py", *(part for key in old for part in (old[key], new[key])))
        for which, template, outfits in (("outfits", old, new), ("template", new, old), ("both", new, new)):
            report = tagAndReport(options, template["template"], [outfits[name] for name in names],
                                  options.work / sex / f"wardrobe_{which}")
            found = differences(report, expected[sex], names)
            print(f"{sex}, {which} through Blender: {len(names)} outfits, "
                  + ", ".join(f"{technique} {entry['faces']}" for technique, entry in report["techniques"].items())
                  + f"; {len(found)} differences", flush=True)
            for line in found:
                print(f"  {line}")
            total += len(found)
    print(f"{total} differences from expected.json")
    sys.exit(1 if total else 0)


if __name__ == "__main__":
    main()
