#!/usr/bin/python3
"""Our program and its peers draw one crowd in turn: one interleaved run, medians, ratios, and pictures side by side.

Usage: run.py --ensemble build/ensemble PERSON OUTFIT [-o out/peers] [--counts 1000,5000] [--rounds 7] [--rows WORD]...

PERSON is a folder with template.glb and outfits/OUTFIT.glb. In each round every row draws the crowd once, in a
process of its own; each round begins with another row. README.md tells what the rows are, and what is not equal.
"""
import argparse
import dataclasses
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys

try:
    import export_character
    import peers_report
except ImportError as missing:
    sys.exit(f"run.py: {missing}; run scripts/install_packages.sh peers, and start this with Debian's /usr/bin/python3")

HERE = pathlib.Path(__file__).resolve().parent
POSES = ("keys", "interpolated")
ORDERS = ("exported", "optimised")
# Our rows: a label, and what is set in the scene. What the program has no key for is skipped with a message.
OURS = {
    "ours, pipeline": {"raster": "pipeline"},
    "ours, compute": {"raster": "compute"},
}
# Everybody is on a key, or nobody is brought to one.
OUR_POSES = {"keys": "{snap_below: 1e6}", "interpolated": "{snap_below: 0}"}
# The peers that draw in a browser: a label, and three_crowd.py's driver.
BROWSERS = {"three.js, llvmpipe": "llvmpipe", "three.js, SwiftShader": "swiftshader"}
XVFB = ["xvfb-run", "-a", "-s", "-screen 0 640x480x24"]


class Skip(Exception):
    """Why a row cannot be measured here."""


def note(text):
    print(f"run.py: {text}", file=sys.stderr, flush=True)


def run(command, timeout):
    """Standard output of a command. @throws Skip with the last line of what it says where it fails"""
    name = pathlib.Path(command[0]).name
    try:
        started = subprocess.Popen([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True, start_new_session=True)
    except FileNotFoundError:
        raise Skip(f"{command[0]} is missing") from None
    try:
        output, errors = started.communicate(timeout=timeout)
    except subprocess.TimeoutExpired:
        raise Skip(f"{name} took longer than {timeout} s") from None
    finally:
        if started.poll() is None:  # what it started goes with it: an X server, a browser
            os.killpg(started.pid, signal.SIGTERM)
            started.communicate()
    if started.returncode != 0:
        said = (errors.strip() or output.strip() or "it said nothing").splitlines()[-1]
        raise Skip(f"{name} ended with {started.returncode}: {said}")
    return output


@dataclasses.dataclass(frozen=True)
class Row:
    label: str
    poses: str
    order: str = ""  # of the mesh; our program has only its own

    def name(self):
        return ", ".join(part for part in (self.label, self.order, self.poses) if part)


class Peers:
    """Draws rows. `picture` is where a row leaves the first frame, or None."""

    def __init__(self, chosen):
        self.chosen = chosen
        self.scene_folder = chosen.out / "scene"
        self.scene = None

    def prepare(self):
        person, outfit = self.chosen.person, self.chosen.outfit
        wardrobe = self.chosen.out / "wardrobe"
        template, garments = person / "template.glb", person / "outfits" / f"{outfit}.glb"
        if wardrobe.exists():
            shutil.rmtree(wardrobe)
        run([self.chosen.ensemble, "tag", template, garments, "-o", wardrobe, "-q"], 600)
        self.scene = export_character.export(template, garments, self.chosen.clip, self.chosen.counts, self.scene_folder)

    def why_not(self, row):
        """Why a row cannot be drawn here, told before anything is measured; None if it can."""
        if row.label in OURS:
            known = run([self.chosen.ensemble, "scene"], 60)
            lacking = [key for key in OURS[row.label] if not re.search(rf"^{key}:", known, re.M)]
            return f"this program's scenes have no key '{lacking[0]}'" if lacking else None
        if shutil.which("xvfb-run") is None or shutil.which("xauth") is None:
            return "xvfb or xauth is missing"
        if row.label == "OGRE":
            program = self.chosen.ogre
            return None if program.exists() else f"{program} is not built (CMake option ENSEMBLE_PEERS)"
        if shutil.which("chromium") is None:
            return "chromium is missing"
        modules = self.chosen.out / "three" / "node_modules" / "three"
        return None if modules.exists() else "three.js is not installed"

    def install_three(self):
        folder, lock = self.chosen.out / "three", "package-lock.json"
        folder.mkdir(exist_ok=True)
        installed = folder / "node_modules" / "three"
        if installed.exists() and (folder / lock).read_bytes() == (HERE / "three" / lock).read_bytes():
            return
        for name in ("package.json", lock):
            shutil.copy(HERE / "three" / name, folder)
        if shutil.which("npm") is None:
            raise Skip("npm is missing")
        run(["npm", "ci", "--prefix", folder, "--ignore-scripts", "--no-audit", "--no-fund"], 300)

    def draw(self, row, count, picture):
        return self.draw_ours(row, count, picture) if row.label in OURS else self.draw_peer(row, count, picture)

    def draw_peer(self, row, count, picture):
        options = ["--order", row.order, "--poses", row.poses, "--view", self.chosen.view, "--characters", count,
                   "--warm", self.chosen.warm, "--frames", self.chosen.frames]
        options += ["--picture", picture] if picture else []
        if row.label == "OGRE":
            command = [self.chosen.ogre, self.scene_folder, "--log", self.chosen.out / "ogre.log"]
        else:
            command = [HERE / "three_crowd.py", self.scene_folder, "--modules", self.chosen.out / "three",
                       "--driver", BROWSERS[row.label], "--timeout", self.chosen.timeout]
        return json.loads(run([*XVFB, *command, *options], self.chosen.timeout + 60).splitlines()[-1])

    def draw_ours(self, row, count, picture):
        scene = self.our_scene(row.poses, count)
        values = {**OURS[row.label], "poses": OUR_POSES[row.poses]}
        settings = [part for key, value in values.items() for part in ("--set", f"{key}={value}")]
        if picture:
            run([self.chosen.ensemble, "render", "-q", scene, "-o", picture, *settings], self.chosen.timeout)
        told = run([self.chosen.ensemble, "bench", "-q", scene, "--techniques", "tagged", "--rounds", self.chosen.frames,
                    "--frames", f"0-{self.chosen.frames - 1}", "--json", "-", *settings], self.chosen.timeout)
        bench = json.loads(told[told.index("{"):])
        measured = bench["rows"][0]
        return {"peer": "ours", "characters": measured["characters"], "triangles": measured["triangles"],
                "device": bench["device"], "frame_ms": measured["frame_ms_of_rounds"]}

    def our_scene(self, poses, count):
        """The exported scene as our program reads it."""
        view = next(v for v in self.scene["views"] if v["name"] == self.chosen.view and v["characters"] == count)
        scene = {
            "version": 1, "wardrobe": "wardrobe", "technique": "tagged", "ground": False,
            "output": {"width": self.scene["width"], "height": self.scene["height"], "samples": 1,
                       "background": "transparent"},
            "crowd": {"count": count, "placement": {"kind": "file", "file": f"scene/{self.scene['crowds'][poses]}"}},
            "camera": {key: view[key] for key in ("position", "target", "fov_y", "near")},
            "light": {"direction": list(self.scene["light"]["direction"]), "shadows": False},
        }
        path = self.chosen.out / f"{self.chosen.view}-{count}-{poses}.yaml"
        path.write_text(json.dumps(scene, indent=1) + "\n")  # JSON is YAML
        return path


def choose_rows(peers, words):
    rows = [Row(label, poses) for label in OURS for poses in POSES]
    rows += [Row(label, poses, order) for label in ("OGRE", *BROWSERS) for order in ORDERS for poses in POSES]
    rows = [row for row in rows if not words or any(word in row.name() for word in words)]
    if any(row.label in BROWSERS for row in rows):
        try:
            peers.install_three()
        except Skip as skip:
            note(f"three.js could not be installed: {skip}")
    reasons = {row.label: peers.why_not(row) for row in rows}
    for label, reason in reasons.items():
        if reason:
            note(f"skipped: {label}: {reason}")
    return [row for row in rows if not reasons[row.label]]


def measure(peers, rows, chosen):
    """Per (row, number of people): the peers' answers, round by round."""
    answers = {}
    for turn in range(chosen.rounds):
        for count in chosen.counts:
            for row in rows[turn % len(rows):] + rows[:turn % len(rows)]:
                if turn and (row, count) not in answers:
                    continue
                picture = chosen.out / "pictures" / f"{picture_name(row, count)}.png" if turn == 0 else None
                try:
                    answers.setdefault((row, count), []).append(peers.draw(row, count, picture))
                except Skip as skip:
                    answers.pop((row, count), None)
                    note(f"skipped: {row.name()}, {count} people: {skip}")
        note(f"round {turn + 1} of {chosen.rounds} is done")
    return answers


def picture_name(row, count):
    return re.sub(r"[^a-z0-9]+", "-", f"{row.name()}-{count}".lower())


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("person", type=pathlib.Path, help="folder with template.glb and outfits/")
    parser.add_argument("outfit", help="name of the outfit, e.g. casualsuit01_shoes02")
    parser.add_argument("--ensemble", type=pathlib.Path, required=True, help="our program")
    parser.add_argument("--ogre", type=pathlib.Path, help="the program ogre_crowd (default: beside ours)")
    parser.add_argument("-o", "--out", type=pathlib.Path, default=pathlib.Path("out/peers"))
    parser.add_argument("--clip", default="walk")
    parser.add_argument("--view", default="near", choices=list(export_character.VIEWS))
    parser.add_argument("--counts", default="1000,5000", type=lambda text: [int(part) for part in text.split(",")])
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--warm", type=int, default=2, help="frames of a process before the first that counts")
    parser.add_argument("--frames", type=int, default=5, help="frames of a process that count")
    parser.add_argument("--rows", action="append", default=[], metavar="WORD",
                        help="only rows whose name holds this; may be given again")
    parser.add_argument("--timeout", type=int, default=900, help="seconds for one process")
    chosen = parser.parse_args()
    chosen.ensemble, chosen.out = chosen.ensemble.resolve(), chosen.out.resolve()
    chosen.ogre = (chosen.ogre or chosen.ensemble.parent / "ogre_crowd").resolve()
    return chosen


def main():
    chosen = parse_arguments()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("run.py: ended"))  # through the finally above
    (chosen.out / "pictures").mkdir(parents=True, exist_ok=True)
    peers = Peers(chosen)
    before = peers_report.machine_state()
    try:
        peers.prepare()
    except (Skip, export_character.Problem, OSError) as problem:
        sys.exit(f"run.py: {problem}")
    rows = choose_rows(peers, chosen.rows)
    answers = measure(peers, rows, chosen) if rows else {}
    if not answers:
        sys.exit("run.py: nothing could be measured; the messages above say why")
    pictures = {key: chosen.out / "pictures" / f"{picture_name(*key)}.png" for key in answers}
    report = peers_report.Report(answers, list(OURS), pictures, peers.scene)
    figures = report.figures({"before": before, "after": peers_report.machine_state()}, vars(chosen))
    (chosen.out / "peers.json").write_text(json.dumps(figures, indent=1) + "\n")
    page = f"{peers_report.caption(figures)}\n\n{report.table()}"
    (chosen.out / "peers.md").write_text(page)
    report.sheet().save(chosen.out / "peers.png")
    print(page, end="")
    note(f"written: {chosen.out}/peers.json, peers.md, peers.png")
    wrong = report.wrong()
    for line in wrong:
        note(line)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
