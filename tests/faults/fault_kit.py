"""What the fault tests share: a folder with small files and wardrobes, and how a wardrobe is judged."""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from small_glb import outfit, template  # noqa: E402

SKIPPED = 77
SCENE = ("version: 1\nwardrobe: {}\noutput: {{width: 32, height: 32, samples: 1, frames: 2, fps: 1}}\n"
         "crowd: {{count: 2}}\ncamera: {{position: [0, 1, 4], target: [0, 0.9, 0]}}\n")
PEOPLE = ("version: 1\npeople:\n  - {name: ann, sex: female, faces: 1500, outfits: [cap]}\n")


def options():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ensemble", required=True)
    parser.add_argument("--shim", help="library that has calls fail; for calls_test.py")
    parser.add_argument("--full", action="store_true", help="200 kills, and many more calls that fail")
    parsed = parser.parse_args()
    parsed.ensemble = os.path.abspath(parsed.ensemble)
    return parsed


class Kit:
    """`old` is a wardrobe of one outfit; each command of `changes` makes another of a copy of it."""

    # name -> (arguments, what it changes)
    changes = {
        "tag": ["tag", "-q", "-j", "2", "other.glb", "coat.glb", "-o", "w"],
        "add": ["add", "-q", "-j", "2", "w", "coat.glb", "hat.glb"],
        "remove": ["remove", "-q", "w", "tunic"],
    }

    def __init__(self, program):
        self.program = program
        self._temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self._temporary.name)
        self.old = self.folder / "old"
        self.failures = []
        self.checks = 0
        self.write("template.glb", template())
        self.write("other.glb", template(clip="walk"))
        self.write("tunic.glb", outfit())
        self.write("coat.glb", outfit(keep=lambda region, face: region == 2))
        self.write("hat.glb", outfit(keep=lambda region, face: region != 2 or face % 3 == 0))
        self.run_well(["tag", "-q", "template.glb", "tunic.glb", "-o", "old"])

    def write(self, name, document):
        (self.folder / name).write_bytes(document.bytes())

    def run(self, arguments, **more):
        environment = {**os.environ, **more.pop("environment", {})}
        return subprocess.run([self.program, *arguments], cwd=more.pop("cwd", self.folder), capture_output=True,
                              text=True, errors="replace", stdin=subprocess.DEVNULL, env=environment, timeout=600, **more)

    def run_well(self, arguments, **more):
        result = self.run(arguments, **more)
        if result.returncode != 0 or result.stderr:
            sys.exit(f"{' '.join(arguments)}: exit code {result.returncode}, {result.stderr}")
        return result

    def renew(self, name="w"):
        """A fresh copy of the old wardrobe, as `w`."""
        shutil.rmtree(self.folder / name, ignore_errors=True)
        shutil.copytree(self.old, self.folder / name)
        return self.folder / name

    def manifest(self, wardrobe):
        return (wardrobe / "wardrobe.json").read_bytes()

    def new_manifest(self, arguments):
        """What the command makes of the old wardrobe where nothing goes wrong."""
        wardrobe = self.renew()
        self.run_well(arguments)
        return self.manifest(wardrobe)

    def expect(self, condition, what):
        self.checks += 1
        if not condition:
            self.failures.append(what)
        return condition

    def expect_whole(self, wardrobe, manifests, what):
        """The wardrobe opens, and its manifest is one of these; inspecting it reads and checks every file."""
        held = self.manifest(wardrobe)
        self.expect(held in manifests, f"{what}: the manifest is neither the old nor the new one")
        opened = self.run(["inspect", "-q", str(wardrobe)])
        self.expect(opened.returncode == 0, f"{what}: the wardrobe does not open: {opened.stderr.strip()}")
        return held

    def expect_clean_failure(self, result, what, codes=(1,)):
        lines = result.stderr.splitlines()
        self.expect(result.returncode in codes, f"{what}: exit code {result.returncode}: {result.stderr.strip()}")
        self.expect(len(lines) == 1 and lines[0].startswith("ensemble: ") and len(lines[0]) > 20
                    and "a bug in ensemble" not in lines[0], f"{what}: not one clear line: {result.stderr!r}")

    def finish(self, told):
        print("\n".join(self.failures[:40]))
        print(f"{told}: {self.checks} checks, {len(self.failures)} failures")
        return 1 if self.failures or self.checks == 0 else 0
