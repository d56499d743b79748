#!/usr/bin/env python3
"""kill -9 at random moments of tag, add and remove: the wardrobe opens, and is the old or the new one.

201 kills with --full, 21 without; the moments are seeded, their outcome is the machine's. The
leftovers of the killed are cleared by the next writer.
"""
import random
import subprocess
import sys
import time

from fault_kit import Kit, options


def kill_after(kit, arguments, seconds):
    """Whether the command was still running when it was killed."""
    process = subprocess.Popen([kit.program, *arguments], cwd=kit.folder, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        process.wait(seconds)
        return False
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        return True


def seconds_of(kit, arguments):
    kit.renew()
    begin = time.monotonic()
    kit.run_well(arguments)
    return time.monotonic() - begin


def main():
    chosen = options()
    kit = Kit(chosen.ensemble)
    chance = random.Random(20)
    rounds = 67 if chosen.full else 7
    told, kills = [], 0
    for name, arguments in Kit.changes.items():
        old, new = kit.manifest(kit.old), kit.new_manifest(arguments)
        usual = min(seconds_of(kit, arguments) for _ in range(3))
        outcome = {"killed, old": 0, "killed, new": 0, "finished": 0}
        for number in range(20 * rounds):
            if outcome["killed, old"] + outcome["killed, new"] == rounds:
                break
            wardrobe = kit.renew()
            killed = kill_after(kit, arguments, usual * chance.uniform(0.02, 1.02))
            what = f"{name}, kill {number}"
            held = kit.expect_whole(wardrobe, (old, new), what)
            kit.expect(killed or held == new, f"{what}: it finished, but the wardrobe is the old one")
            kills += killed
            outcome["finished" if not killed else "killed, new" if held == new else "killed, old"] += 1
            # The next writer clears what was left.
            kit.run_well(["remove", "-q", "w", "coat"] if b'"coat"' in held else ["add", "-q", "w", "coat.glb"])
            rest = [path.name for path in wardrobe.rglob(".*.tmp")]
            kit.expect(not rest, f"{what}: {rest} was not cleared by the next writer")
            named = kit.manifest(wardrobe).decode()
            for file in wardrobe.rglob("*.glb"):
                kit.expect(f'"{file.relative_to(wardrobe)}"' in named, f"{what}: {file.name} was not cleared")
        told.append(f"{name}: {outcome}")
    print("\n".join(told))
    kit.expect(kills == 3 * rounds, f"only {kills} commands were killed before their end")
    return kit.finish(f"{kills} kills")


if __name__ == "__main__":
    sys.exit(main())
