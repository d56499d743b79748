#!/usr/bin/env python3
"""Two writers at once: both changes are in at the end, whoever came first; a reader beside them sees whole wardrobes."""
import json
import subprocess
import sys

from fault_kit import Kit, options


def main():
    chosen = options()
    kit = Kit(chosen.ensemble)
    for number in range(40 if chosen.full else 6):
        wardrobe = kit.renew()
        writers = [subprocess.Popen([kit.program, *arguments], cwd=kit.folder, stderr=subprocess.PIPE, text=True)
                   for arguments in (["add", "-q", "w", "coat.glb"], ["add", "-q", "w", "hat.glb"],
                                     ["remove", "-q", "w", "tunic"])]
        while any(writer.poll() is None for writer in writers):
            reader = kit.run(["inspect", "-q", "w"])
            kit.expect(reader.returncode == 0, f"round {number}: a reader beside them: {reader.stderr.strip()}")
        for writer in writers:
            kit.expect(writer.returncode == 0, f"round {number}: {writer.communicate()[1].strip()}")
        names = sorted(outfit["name"] for outfit in json.loads(kit.manifest(wardrobe))["outfits"])
        kit.expect(names == ["coat", "hat"], f"round {number}: the wardrobe holds {names}")
        kit.expect(kit.run(["inspect", "-q", "w"]).returncode == 0, f"round {number}: the wardrobe does not open")

        # Two add an outfit of one name: one does, the other is told.
        kit.renew()
        rivals = [subprocess.Popen([kit.program, "add", "-q", "w", "hat.glb"], cwd=kit.folder, stderr=subprocess.PIPE,
                                   text=True) for _ in range(2)]
        said = sorted((rival.wait(), rival.communicate()[1]) for rival in rivals)
        kit.expect(said == [(0, ""), (3, "ensemble: hat.glb: the wardrobe has an outfit 'hat' already; remove that first "
                                         "(`ensemble remove`), or rename the file\n")], f"round {number}: {said}")
    return kit.finish("two writers")


if __name__ == "__main__":
    sys.exit(main())
