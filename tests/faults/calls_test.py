#!/usr/bin/env python3
"""Every n-th allocation, and every n-th open, read, write, fsync, rename, mkdir of a command fails in turn.

The program ends with one clear line and exit code 1 (or 0, where it can do without what failed), and
leaves a wardrobe that is the old or the new one, and no file half written. Each call fails once
alone, and once with all that come after it. Allocations are many, so of them a fixed sample is taken:
the first ones, then ever fewer, and the last; with --full up to 1,000, evenly over the whole run.
"""
import errno
import os
import shutil
import sys

from fault_kit import Kit, PEOPLE, SCENE, SKIPPED, options  # noqa: F401

KINDS = {"open": errno.EACCES, "read": errno.EIO, "write": errno.ENOSPC, "fsync": errno.EIO, "rename": errno.EIO,
         "mkdir": errno.ENOSPC}


EVERY = 1 << 40
MOST_OF_FULL = 1000


def sample(count, most, evenly):
    """Numbers of calls, from 1 to count: all, or about `most` of them, the first and the last among them."""
    if count <= most:
        return range(1, count + 1)
    shares = [i / (most - 1) for i in range(most)]
    return sorted({max(1, round(share * count if evenly else count ** share)) for share in shares})


class Calls:
    def __init__(self, kit, shim, full):
        self.kit, self.shim, self.full = kit, shim, full
        self.tally = {}

    def run(self, arguments, kind, at, lasts=False, error=0):
        count_file = self.kit.folder / "count"
        count_file.unlink(missing_ok=True)
        result = self.kit.run(arguments, environment={
            "LD_PRELOAD": self.shim, "FAULT": kind, "FAULT_AT": str(at), "FAULT_LASTS": "1" if lasts else "",
            "FAULT_ERRNO": str(error), "FAULT_FOLDER": str(self.kit.folder), "FAULT_COUNT": str(count_file),
            "MESA_SHADER_CACHE_DISABLE": "true"})
        return result, int(count_file.read_text()) if count_file.exists() else -1

    def each(self, name, arguments, kind, most, prepare, judge):
        """Runs the command with each call failing; `judge(what)` looks at what it left."""
        prepare()
        result, count = self.run(arguments, kind, 0)
        if result.returncode != 0 or count < 0:
            sys.exit(f"{name} without a fault: {result.returncode} {result.stderr}")
        numbers = sample(count, most, self.full)
        outcomes = {}
        for at in numbers:
            for lasts in (False, True):
                prepare()
                result, _ = self.run(arguments, kind, at, lasts, KINDS.get(kind, 0))
                what = f"{name}, {kind} {at} of {count}{' and all after' if lasts else ''}"
                if result.returncode == 0:
                    self.kit.expect(result.stderr == "", f"{what}: done, but says {result.stderr!r}")
                else:
                    self.kit.expect_clean_failure(result, what)
                outcomes[result.returncode] = outcomes.get(result.returncode, 0) + 1
                judge(what, result.returncode)
        print(f"{name}: {count} calls of {kind}, {len(numbers)} made to fail; exit codes {outcomes}", flush=True)


def wardrobe_commands(calls):
    kit = calls.kit
    for name, arguments in Kit.changes.items():
        old, new = kit.manifest(kit.old), kit.new_manifest(arguments)

        def judge(what, code):
            held = kit.expect_whole(kit.folder / "w", (old, new), what)
            kit.expect(code != 0 or held == new, f"{what}: exit code 0, but the wardrobe is the old one")
        for kind in ("alloc", *KINDS):
            most = EVERY if kind != "alloc" else MOST_OF_FULL if calls.full else 24
            calls.each(name, arguments, kind, most, kit.renew, judge)


def contents(folder):
    """name -> bytes of whole files; what is written aside, and its leftovers, have names of their own."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*")
            if path.is_file() and not path.name.startswith(".")}


def plain_commands(calls, device):
    """Commands whose unit is one file."""
    kit, target = calls.kit, calls.kit.folder / "out"
    (kit.folder / "scene.yaml").write_text(SCENE.format("old"))
    (kit.folder / "people.yaml").write_text(PEOPLE)
    commands = {"people": (["people", "-q", "-j", "1", "people.yaml", "-o", "out"], ("alloc", *KINDS))}
    if not calls.full:
        commands["people"] = (commands["people"][0], ("alloc", "write"))
    if device:
        commands["render"] = (["render", "-q", "scene.yaml", "-o", "out/"], ("write", "fsync", "rename", "mkdir"))
    for name, (arguments, kinds) in commands.items():
        kit.run_well(arguments)
        whole = contents(target)

        def prepare():
            shutil.rmtree(target, ignore_errors=True)

        def judge(what, code):
            for file, data in contents(target).items():
                kit.expect(whole.get(file) == data, f"{what}: {file} is not whole")
            kit.expect(code != 0 or contents(target) == whole, f"{what}: exit code 0, but files are missing")
        for kind in kinds:
            most = EVERY if kind != "alloc" else 100 if calls.full else 3
            calls.each(name, arguments, kind, most, prepare, judge)


def main():
    chosen = options()
    kit = Kit(chosen.ensemble)
    calls = Calls(kit, os.path.abspath(chosen.shim), chosen.full)
    wardrobe_commands(calls)
    device = "Vulkan device: none" not in kit.run(["--version"]).stdout
    if not device:
        print("SKIPPED: there is no Vulkan device, so `render` was left out")
    plain_commands(calls, device)
    return kit.finish("calls that fail")


if __name__ == "__main__":
    sys.exit(main())
