"""What the proofs share: their command line, running the program, loud skips, the comparison."""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys

PROJECT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77  # SKIP_RETURN_CODE of the tests


def skip(reason):
    """Ends the proof without a verdict, and says why where scripts/test.sh finds it."""
    print(f"SKIPPED: {reason}")
    sys.exit(SKIPPED)


def fail(what):
    print(f"FAILED: {what}")
    sys.exit(1)


def arguments(description):
    """The command line of every proof."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--ensemble", type=pathlib.Path, default=PROJECT / "build/ensemble", help="the program")
    parser.add_argument("--people", type=pathlib.Path, default=PROJECT.parent / "shared/people",
                        help="folder of real people (expected.json in it)")
    parser.add_argument("--node-modules", type=pathlib.Path, default=PROJECT / "build/proofs/node_modules",
                        help="what install_node_packages.sh made")
    parser.add_argument("--work", type=pathlib.Path, default=None, help="folder for the files made; emptied first")
    parser.add_argument("--full", action="store_true", default="ENSEMBLE_FULL_TESTS" in os.environ,
                        help="everything instead of a fixed sample")
    options = parser.parse_args()
    if options.work is None:
        options.work = PROJECT / "build/proofs" / pathlib.Path(sys.argv[0]).stem
    options.work = options.work.resolve()
    shutil.rmtree(options.work, ignore_errors=True)
    options.work.mkdir(parents=True)
    if not options.ensemble.is_file():
        fail(f"there is no program at {options.ensemble}")
    options.ensemble = options.ensemble.resolve()
    return options


def run(*command, may_fail=False, **keywords):
    """Runs a command; its standard output. A failure ends the proof with what the command said, or gives that."""
    done = subprocess.run([str(part) for part in command], text=True, capture_output=True, stdin=subprocess.DEVNULL,
                          **keywords)
    if done.returncode != 0 and may_fail:
        return done.stdout + done.stderr
    if done.returncode != 0:
        fail(f"exit code {done.returncode} of: {' '.join(map(str, command))}\n{done.stdout[-2000:]}{done.stderr[-4000:]}")
    return done.stdout


def needPeople(options):
    """The real people's expected.json, or a skip."""
    file = options.people / "expected.json"
    if not file.is_file():
        skip(f"there are no real people at {options.people}")
    return json.loads(file.read_text())


def needNode(options, package):
    """Skips unless Node.js and the npm package are there."""
    if shutil.which("node") is None:
        skip("node is not installed (scripts/install_packages.sh test)")
    if not (options.node_modules / package).is_dir():
        skip(f"the npm package {package} is not in {options.node_modules} (tests/proofs/install_node_packages.sh)")


def node(options, script, *parts):
    """Runs a script of this folder with Node.js; its standard output."""
    environment = dict(os.environ, NODE_PATH=str(options.node_modules))
    return run("node", PROJECT / "tests/proofs" / script, *parts, env=environment)


def tagAndReport(options, template, outfits, wardrobe, *more):
    """Tags outfits into a wardrobe; the report's JSON."""
    shutil.rmtree(wardrobe, ignore_errors=True)
    run(options.ensemble, "tag", template, *outfits, "-o", wardrobe, "-q", *more)
    return json.loads(run(options.ensemble, "report", wardrobe, "-q", "--json", "-"))


def differences(report, expected, names):
    """Where a report differs from what expected.json says of the outfits named, one line each."""
    found = []

    def compare(what, value, wanted):
        if value != wanted:
            found.append(f"{what} is {value}, not {wanted}")

    compare("template_faces", report["template_faces"], expected["template"]["faces"])
    compare("outfits", sorted(outfit["name"] for outfit in report["outfits"]), sorted(names))
    for outfit in report["outfits"]:
        name = outfit["name"]
        if name not in expected["outfits"]:
            continue
        wanted = expected["outfits"][name]
        for key in ("garment_faces", "dedicated_faces", "prefitted_faces"):
            compare(f"{name}: {key}", outfit[key], wanted[key])
        compare(f"{name}: regions", {
            region["name"]: (region["visibility"], region["template_faces"], region["visible_faces"])
            for region in outfit["regions"]
        }, {region: (tag["class"], tag["template"], tag["embedded"]) for region, tag in wanted["regions"].items()})
    rows = [expected["outfits"][name] for name in names]
    template, garments = expected["template"]["faces"], sum(row["garment_faces"] for row in rows)
    totals = {"naive": template + garments, "prefitted": sum(row["prefitted_faces"] for row in rows),
              "tagged": template + garments + sum(row["dedicated_faces"] for row in rows)}
    if len(names) == len(expected["outfits"]):  # then the file tells the sums itself
        totals = {technique: expected["totals"][technique] for technique in totals}
    for technique, faces in totals.items():
        compare(f"total of {technique}", report["techniques"][technique]["faces"], faces)
    return found


def madePeople(options):
    """Folders of people that the program makes from config/people, each with template.glb and outfits/."""
    configs = sorted((PROJECT / "config/people").glob("*.yaml"))
    if not configs:
        fail("there is no config/people/*.yaml")
    for config in configs:
        run(options.ensemble, "people", config, "-o", options.work / "people" / config.stem, "-q")
    return peopleIn(options.work / "people")


def peopleIn(folder):
    """The folders below that hold a template.glb and outfits/*.glb, sorted."""
    found = sorted(file.parent for file in folder.glob("**/template.glb") if any(file.parent.glob("outfits/*.glb")))
    if not found:
        fail(f"no folder with template.glb and outfits/*.glb in {folder}")
    return found


def everybody(options):
    """(name, folder) of the people made here and, where they exist, the real ones (else said)."""
    people = [(f"made/{folder.name}", folder) for folder in madePeople(options)]
    if (options.people / "expected.json").is_file():
        people += [(f"real/{folder.name}", folder) for folder in peopleIn(options.people)]
    else:
        print(f"NOTE: there are no real people at {options.people}; only those made here are proved")
    return people


def blender(script, *parts):
    """Runs a script of this folder inside Blender without a window; its output."""
    return blenderRun([], PROJECT / "tests/proofs" / script, *parts)


def blenderRun(files, script, *parts, **keywords):
    """Runs a script inside Blender with a file open, or none; its output."""
    if shutil.which("blender") is None:
        skip("Blender is not installed (scripts/install_packages.sh test)")
    # Debian's Blender takes the first python3 in PATH for its own, and that must be Debian's.
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
    environment["PATH"] = "/usr/bin:/bin:" + environment.get("PATH", "")
    return run("blender", "--background", "--factory-startup", *files, "--python-exit-code", "1", "--python",
               script, "--", *parts, env=environment, **keywords)
