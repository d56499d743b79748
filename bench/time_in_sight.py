#!/usr/bin/env python3
"""Plots what a frame takes over how many people are in sight, of a crowd most of whom are not.

Usage: time_in_sight.py --ensemble PROGRAM SCENE.yaml [-o out/in-sight] [--count 100000] [--set KEY=VALUE]...

The camera looks down on the crowd from one height after the other; what it sees grows with the height's square. The
heights are drawn in turn, round by round. Writes in-sight.csv and in-sight.svg (both axes logarithmic, with a line of
equal time per person through the lowest height that sees as many as 100), and prints the table.
"""
import argparse
import csv
import json
import math
import pathlib
import statistics
import subprocess
import sys

COLUMNS = ("height", "in_sight", "computed", "frame_ms", "ms_per_1000", "cpu_ms", "poses_ms", "shadows_ms", "triangles",
           "mesh_bytes", "pose_bytes")
LEAST_OF_LINE = 100  # below it a frame is mostly what it takes without people
WIDTH, HEIGHT, LEFT, BOTTOM, TOP, RIGHT = 760, 380, 90, 330, 40, 730
STYLE = """:root { color-scheme: light dark;
  --page: #fff; --ink: #1c2430; --faint: #667080; --grid: #dde2e9; --line: #2463c8; }
@media (prefers-color-scheme: dark) {
  :root { --page: #14181f; --ink: #e6eaf0; --faint: #98a3b3; --grid: #323a46; --line: #74a8f7; } }
svg { background: var(--page); font: 13px system-ui, sans-serif; } text { fill: var(--ink); }
.title { font-weight: 600; font-size: 15px; } .faint { fill: var(--faint); font-size: 12px; }
.grid { stroke: var(--grid); }
.line { fill: none; stroke: var(--line); stroke-width: 2; } .dot { fill: var(--line); }
.reference { stroke: var(--faint); stroke-dasharray: 2 4; }"""


def measure(chosen, height):
    """One process of the program: the row of its JSON, a few frames that go on, drawn before once, so that poses are kept."""
    camera = {"position": [0, height, 1.3 * height], "target": [0, 0, 0], "fov_y": 40}
    settings = [f"camera={json.dumps(camera)}", *chosen.set]
    command = [chosen.ensemble, "bench", "-q", chosen.scene, "--techniques", "tagged", "--counts", chosen.count,
               "--frames", f"0-{chosen.frames - 1}", "--rounds", chosen.frames, "--warm-up", chosen.frames,
               "--json", "-"]
    command += [part for setting in settings for part in ("--set", setting)]
    done = subprocess.run([str(part) for part in command], check=False, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(done.returncode)  # the program said why
    return json.loads(done.stdout[done.stdout.index("{"):])["rows"][0]


def line_of(height, rows):
    """A row of the table: medians over the rounds."""
    in_sight, time = rows[0]["characters_drawn"], statistics.median(row["frame_ms"]["median"] for row in rows)

    def part(name):
        return round(statistics.median(row["parts_ms"][name] for row in rows), 1)

    return {"height": height, "in_sight": in_sight, "computed": rows[0]["share_of_people_computed"],
            "frame_ms": round(time, 1), "poses_ms": part("poses"), "shadows_ms": part("shadows"),
            "ms_per_1000": round(1000 * time / max(1, in_sight), 1),
            "cpu_ms": round(statistics.median(row["cpu_ms"] for row in rows), 1), "triangles": rows[0]["triangles"],
            "mesh_bytes": rows[0]["gpu_mesh_bytes"], "pose_bytes": max(row["pose_bytes"] for row in rows)}


def plot(table, count):
    points = [(max(1, row["in_sight"]), row["frame_ms"]) for row in table]
    decades = [(math.floor(math.log10(min(axis))), math.ceil(math.log10(max(axis)))) for axis in zip(*points)]

    def place(value, axis):
        low, high = decades[axis]
        share = (math.log10(value) - low) / max(1, high - low)
        return LEFT + share * (RIGHT - LEFT) if axis == 0 else BOTTOM - share * (BOTTOM - TOP)

    parts = [f'<text x="0" y="18" class="title">Frame time by people in sight, of {count:,}</text>']
    for power in range(decades[0][0], decades[0][1] + 1):
        x = place(10**power, 0)
        parts += [f'<line class="grid" x1="{x:.1f}" y1="{TOP}" x2="{x:.1f}" y2="{BOTTOM}"/>',
                  f'<text class="faint" x="{x:.1f}" y="{BOTTOM + 18}" text-anchor="middle">{10**power:,}</text>']
    for power in range(decades[1][0], decades[1][1] + 1):
        y = place(10**power, 1)
        parts += [f'<line class="grid" x1="{LEFT}" y1="{y:.1f}" x2="{RIGHT}" y2="{y:.1f}"/>',
                  f'<text class="faint" x="{LEFT - 8}" y="{y + 4:.1f}" text-anchor="end">{10**power:,} ms</text>']
    start = next((point for point in points if point[0] >= LEAST_OF_LINE), points[-1])
    end = min(10**decades[0][1], start[0] * 10**decades[1][1] / start[1])
    parts += [f'<line class="reference" x1="{place(start[0], 0):.1f}" y1="{place(start[1], 1):.1f}" '
              f'x2="{place(end, 0):.1f}" y2="{place(end * start[1] / start[0], 1):.1f}"/>']
    line = " ".join(f"{place(x, 0):.1f},{place(y, 1):.1f}" for x, y in points)
    parts += [f'<polyline class="line" points="{line}"/>']
    parts += [f'<circle class="dot" cx="{place(x, 0):.1f}" cy="{place(y, 1):.1f}" r="4"><title>{x:,} in sight: '
              f'{y:,.1f} ms</title></circle>' for x, y in points]
    parts += [f'<text class="faint" x="{RIGHT}" y="{BOTTOM + 38}" text-anchor="end">people in sight; dotted: '
              f'equal time for each</text>']
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
            f'aria-label="Frame time by people in sight">\n<style>\n{STYLE}\n</style>\n' + "\n".join(parts) +
            "\n</svg>\n")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--ensemble", required=True, help="the program")
    parser.add_argument("-o", "--out", type=pathlib.Path, default=pathlib.Path("out/in-sight"))
    parser.add_argument("--count", type=int, default=100000, help="people of the crowd")
    parser.add_argument("--heights", default="3,6,12,24,48", help="of the camera, metres",
                        type=lambda text: [float(part) for part in text.split(",")])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=5, help="frames of a process that count")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="as the program's own")
    return parser.parse_args()


def main():
    chosen = parse_arguments()
    rows = {height: [] for height in chosen.heights}
    for _ in range(chosen.rounds):
        for height in chosen.heights:
            rows[height].append(measure(chosen, height))
    table = sorted((line_of(height, of_height) for height, of_height in rows.items()),
                   key=lambda line: line["in_sight"])
    chosen.out.mkdir(parents=True, exist_ok=True)
    with open(chosen.out / "in-sight.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(table)
    (chosen.out / "in-sight.svg").write_text(plot(table, chosen.count))
    print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS))
    for line in table:
        print("| " + " | ".join(f"{line[column]:,}" for column in COLUMNS) + " |")


if __name__ == "__main__":
    main()
