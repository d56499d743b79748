#!/usr/bin/env python3
"""Holds `render --annotations` of made and real people against what else can be known of the pictures:
2D boxes and visible shares against character AOVs, also of each person drawn alone; and planted feet, by the
joints, against the ground: over a path with turns and stops none may move 1 cm."""
import json
import math
import struct
import zlib

import proof

FEET = [("foot_l", "ball_l"), ("foot_r", "ball_r")]
FLAT = 0.005  # metres: a foot is planted where ankle and ball are within this of their lowest
SHARE = 0.01


def readZipUint(data):
    """A scan-line OpenEXR file with one UINT channel, ZIP or no compression."""
    at, attributes = 8, {}
    while data[at] != 0:
        name, _, rest = data[at:].partition(b"\0")
        kind, _, rest = rest.partition(b"\0")
        size = struct.unpack_from("<i", rest)[0]
        attributes[name.decode()] = rest[4:4 + size]
        at += len(name) + 1 + len(kind) + 1 + 4 + size
    at += 1
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    compression = attributes["compression"][0]
    lines = {0: 1, 2: 1, 3: 16}[compression]
    rows = [None] * height
    for chunk in range((height + lines - 1) // lines):
        begin = struct.unpack_from("<Q", data, at + 8 * chunk)[0]
        y, size = struct.unpack_from("<ii", data, begin)
        count = min(lines, height - (y - top))
        raw, expected = data[begin + 8:begin + 8 + size], 4 * width * count
        if size < expected:
            raw = bytearray(zlib.decompress(raw))
            for i in range(1, len(raw)):
                raw[i] = (raw[i - 1] + raw[i] - 128) & 255
            half = (len(raw) + 1) // 2
            mixed = bytearray(len(raw))
            mixed[0::2], mixed[1::2] = raw[:half], raw[half:]
            raw = bytes(mixed)
        for i in range(count):
            rows[y - top + i] = struct.unpack_from(f"<{width}I", raw, 4 * width * i)
    return rows


def boxesAndCounts(rows):
    """Per id: [x, y, width, height] and the number of pixels."""
    found = {}
    for y, row in enumerate(rows):
        for x, number in enumerate(row):
            if number == 0:
                continue
            box = found.setdefault(number, [x, y, x, y, 0])
            box[0], box[2], box[3] = min(box[0], x), max(box[2], x), y
            box[4] += 1
    return {number: ([x0, y0, x1 - x0 + 1, y1 - y0 + 1], count) for number, (x0, y0, x1, y1, count) in found.items()}


def outfitsOf(wardrobe):
    return [outfit["name"] for outfit in json.loads((wardrobe / "wardrobe.json").read_text())["outfits"]]


def proveShares(options, name, wardrobe, work):
    """A group, and each of its people alone in the same picture."""
    outfits = outfitsOf(wardrobe)
    people = [{"outfit": outfits[i % len(outfits)], "position": [0.55 * (i % 4) - 0.8, 0, 0.6 * (i // 4)],
               "heading": 40 * i % 360, "phase": i / 8} for i in range(8)]
    scene = {"version": 1, "wardrobe": str(wardrobe), "ground": False, "people": people,
             "output": {"width": 480, "height": 320, "samples": 1, "background": "transparent"},
             "camera": {"position": [0.5, 1.6, 5], "target": [0, 0.9, 0]}}

    def draw(stem, group):
        file = work / f"{stem}.yaml"
        file.write_text(json.dumps(dict(scene, people=group)))  # JSON is YAML
        proof.run(options.ensemble, "render", file, "-o", work / f"{stem}.png", "--frames", "0", "-q", "--aov",
                  "character", "--annotations", work / f"{stem}.json")
        return boxesAndCounts(readZipUint((work / f"{stem}.character.exr").read_bytes()))

    shown = draw("group", people)
    annotated = json.loads((work / "group.json").read_text())["frames"][0]["people"]
    if sorted(person["id"] for person in annotated) != sorted(shown):
        proof.fail(f"{name}: annotated are not those who show")
    worst = 0.0
    for person in annotated:
        box, pixels = shown[person["id"]]
        if person["bbox"] != box:
            proof.fail(f"{name}: person {person['id']}: box {person['bbox']}, in the AOV {box}")
        alone = draw("alone", [people[person["number"]]])[1][1]
        worst = max(worst, abs(person["visible"] - pixels / alone))
    least = min(person["visible"] for person in annotated)
    print(f"{name}: {len(annotated)} boxes equal the AOV's; shares from {least:.3f}, off by {worst:.5f} at most")
    if worst > SHARE or least > 0.9:
        proof.fail(f"{name}: shares are off by more than {SHARE}, or nobody is hidden")


def worstSlide(frames, joints):
    """(metres, stands) over all people and feet: the farthest that ankle or ball moves during a stand."""
    worst, stands = 0.0, 0
    for number in {person["number"] for frame in frames for person in frame["people"]}:
        track = [next((p["joints_3d"] for p in frame["people"] if p["number"] == number), None) for frame in frames]
        if None in track:
            proof.fail(f"person {number} is not in every frame: the scene is to show all")
        for foot in FEET:
            indices = [joints.index(name) for name in foot]
            lowest = [min(pose[i][1] for pose in track) for i in indices]
            stand = []
            for pose in track:
                places = [pose[i] for i in indices]
                if any(place[1] > low + FLAT for place, low in zip(places, lowest)):
                    stand = []
                    continue
                stands += not stand
                stand.append(places)
                worst = max([worst] + [math.hypot(now[0] - then[0], now[2] - then[2])
                                       for before in stand for now, then in zip(places, before)])
    return worst, stands


def proveFeet(options, name, wardrobe, work):
    """Three people on a closed path with turns and stops, half a minute."""
    scene = {"version": 1, "wardrobe": str(wardrobe),
             "poses": {"snap_below": 0},  # held feet are a matter of exact poses
             "output": {"width": 320, "height": 180, "samples": 1, "frames": 900 if options.full else 360, "fps": 30},
             "crowd": {"count": 3, "seed": 3, "outfits": dict.fromkeys(outfitsOf(wardrobe), 1),
                       "placement": {"kind": "paths", "spacing": 2, "paths": [
                 {"points": [[-3, 0, -3], [3, 0, -3], [3, 0, 3], [-2, 0, 2]], "closed": True,
                  "stops": [{"at": 4, "seconds": 1.5}, {"at": 9, "seconds": 1}]}]}},
             "camera": {"position": [0, 9, 9], "target": [0, 0, 0]}, "light": {"shadows": False}}
    file = work / "walk.yaml"
    file.write_text(json.dumps(scene))
    proof.run(options.ensemble, "render", file, "-o", work / "walk.mp4", "-q", "--annotations", work / "walk.json")
    document = json.loads((work / "walk.json").read_text())
    worst, stands = worstSlide(document["frames"], document["wardrobes"][0]["joints"])
    print(f"{name}: {stands} stands, the worst moves {1000 * worst:.1f} mm")
    if worst >= 0.01 or stands < 30:
        proof.fail(f"{name}: a planted foot moves 1 cm or more, or hardly any was seen")


def main():
    options = proof.arguments(__doc__)
    for name, folder in proof.everybody(options):
        work = options.work / name.replace("/", "_")
        work.mkdir()
        outfits = sorted(folder.glob("outfits/*.glb"))
        proof.tagAndReport(options, folder / "template.glb", outfits if options.full else outfits[:3],
                           work / "wardrobe")
        proveShares(options, name, work / "wardrobe", work)
        proveFeet(options, name, work / "wardrobe", work)


if __name__ == "__main__":
    main()
