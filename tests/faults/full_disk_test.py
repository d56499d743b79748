#!/usr/bin/env python3
"""A full disk: a small tmpfs in a mount namespace of its own, filled up to ever fewer free pages.

Needs leave to make a mount namespace (root, or unprivileged user namespaces); else skipped, loudly.
"""
import os
import shutil
import subprocess
import sys

from fault_kit import Kit, SKIPPED, options

PAGE = 4096
SIZE = 40 * PAGE


def enter_namespace():
    """Runs this script again inside a mount namespace, as root of a user namespace where needed."""
    flags = ["-m"] if os.geteuid() == 0 else ["-m", "-U", "-r"]
    probe = subprocess.run(["unshare", *flags, "mount", "-t", "tmpfs", "none", "/mnt"], capture_output=True, text=True)
    if probe.returncode != 0:
        print(f"SKIPPED: no mount namespace can be made here: {probe.stderr.strip()}")
        sys.exit(SKIPPED)
    os.execvp("unshare", ["unshare", *flags, sys.executable, *sys.argv])


def fill(folder, free_pages):
    """Takes up the disk but for these pages."""
    filler = folder / "filler"
    status = os.statvfs(folder)
    take = status.f_bavail - free_pages
    if take > 0:
        filler.write_bytes(b"x" * (take * PAGE))


def main():
    chosen = options()
    if os.environ.get("ENSEMBLE_IN_NAMESPACE") != "1":
        os.environ["ENSEMBLE_IN_NAMESPACE"] = "1"
        enter_namespace()
    kit = Kit(chosen.ensemble)
    disk = kit.folder / "disk"
    disk.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={SIZE}", "none", disk], check=True)
    told = []
    for name, arguments in Kit.changes.items():
        old, new = kit.manifest(kit.old), kit.new_manifest(arguments)
        arguments = ["disk/w" if argument == "w" else argument for argument in arguments]
        refused = 0
        for free in range(0, 20, 1 if chosen.full else 3):
            for leftover in disk.iterdir():
                shutil.rmtree(leftover) if leftover.is_dir() else leftover.unlink()
            shutil.copytree(kit.old, disk / "w")
            fill(disk, free)
            result = kit.run(arguments)
            what = f"{name} with {free} pages free"
            held = kit.expect_whole(disk / "w", (old, new), what)
            if result.returncode == 0:
                kit.expect(held == new, f"{what}: exit code 0, but the wardrobe is the old one")
                continue
            refused += 1
            kit.expect_clean_failure(result, what)
            kit.expect(held == old, f"{what}: it failed, but the wardrobe changed")
            kit.expect(result.stderr.endswith("can't be written: No space left on device; free some space and run it again\n"),
                       f"{what}: says {result.stderr!r}")
            rest = [path.name for path in (disk / "w").rglob("*.tmp")]
            kit.expect(not rest, f"{what}: it left {rest}")
        kit.expect(refused > 0, f"{name}: the disk was never full")
        told.append(f"{name}: refused {refused} times")
    subprocess.run(["umount", disk], check=True)
    return kit.finish("full disk, " + ", ".join(told))


if __name__ == "__main__":
    sys.exit(main())
