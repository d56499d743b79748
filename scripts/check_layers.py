#!/usr/bin/env python3
"""Usage: check_layers.py [FOLDER]

Reads the #include lines of a source tree (default: this project) and names every one that breaks
the layout: who may include whom, what stays hidden behind which files, includes from the root, own
header first, no circle of headers. Exits with 1 if there is any.
"""
import pathlib
import re
import sys

# Folder -> the folders of ours that it may include. The CMake link graph says the same.
MAY_INCLUDE = {
    "core": {"core", "shaders/shared"},
    "assetpipe": {"assetpipe", "core"},
    "renderer": {"renderer", "core", "shaders/shared"},
    "server": {"server", "assetpipe", "renderer", "core"},
    "cli": {"cli", "server", "assetpipe", "renderer", "core"},
    "shaders": {"shaders", "shaders/shared"},
    "tests": {"tests", "cli", "server", "assetpipe", "renderer", "core", "shaders/shared"},
    "bench": {"bench", "assetpipe", "renderer", "core", "shaders/shared"},
}

# Foreign header -> where alone it may be included: folders, or single files.
HIDDEN = {
    r"vulkan/": ["renderer", "tests/renderer"],
    r"(CGAL|OpenMesh|embree[34])/": ["assetpipe", "tests/assetpipe"],
    r"(tiny_gltf\.h|draco/)": ["core/gltf_", "tests/core"],
    r"(yaml-cpp/)": ["core", "assetpipe", "tests"],
    r"(openssl/)": ["core/hash.cpp"],
    r"lib(av|sw)[a-z]+/": ["renderer/video_writer.cpp", "tests/renderer"],
    r"(CLI/)": ["cli", "tests/cli", "bench/peers"],
    r"(Ogre|GL/)": ["bench/peers"],
}

GENERATED = ("embedded/", "spirv/")  # made by the build, found from its folder
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)


def layerOf(path):
    """The key of MAY_INCLUDE, or the shared folder, that a path from the root belongs to."""
    if path.startswith("shaders/shared/"):
        return "shaders/shared"
    return path.split("/", 1)[0]


def withoutComments(text):
    """The text with comments blanked, lines kept."""
    return re.sub(r"//[^\n]*|/\*.*?\*/", lambda match: re.sub(r"[^\n]", " ", match.group()), text, flags=re.DOTALL)


def readIncludes(root):
    """{path from the root: [(line, ours or None, foreign or None)]} of every C++ and GLSL source."""
    includes = {}
    for folder in sorted(MAY_INCLUDE):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in (".h", ".cpp", ".vert", ".frag", ".comp", ".glsl"):
                continue
            text = withoutComments(file.read_text(encoding="utf-8"))
            includes[file.relative_to(root).as_posix()] = [
                (text.count("\n", 0, match.start()) + 1, match.group(1), match.group(2))
                for match in INCLUDE.finditer(text)]
    return includes


def bringsVulkan(path, includes, seen=None):
    """Whether a header includes Vulkan, itself or through others of ours."""
    seen = seen if seen is not None else set()
    if path in seen:
        return False
    seen.add(path)
    return any(bringsVulkan(ours, includes, seen) if ours else foreign.startswith("vulkan/")
               for _, ours, foreign in includes.get(path, []))


def checkOurs(path, line, target, includes):
    """What is wrong with including our own header `target`, or None."""
    if target.startswith(GENERATED):
        return None
    if target not in includes:
        return f'{path}:{line}: "{target}" is no file of the project; name it from the root'
    layer = layerOf(path)
    # What C++ and GLSL share stands below everything, but for the vectors it is made of.
    if layerOf(target) not in MAY_INCLUDE.get(layer, {layer}) and (layer, target) != ("shaders/shared", "core/math.h"):
        return f"{path}:{line}: {layer} may not include {target}"
    if layer not in ("renderer", "tests") and bringsVulkan(target, includes):
        return f"{path}:{line}: {target} brings Vulkan along; include what renderer.h offers"
    return None


def checkForeign(path, line, target):
    """What is wrong with including somebody else's header `target`, or None."""
    for pattern, places in HIDDEN.items():
        if re.match(pattern, target) and not any(
                path == place or path.startswith(place if place.endswith("_") else place + "/") for place in places):
            return f"{path}:{line}: <{target}> belongs behind {' and '.join(places)}"
    return None


def checkOwnHeaderFirst(path, lines, includes):
    """A source includes its own header before anything else, so that the header stands on its own."""
    header = re.sub(r"\.cpp$", ".h", path)
    if path == header or header not in includes or not lines or lines[0][1] == header:
        return None
    return f'{path}:{lines[0][0]}: the first include must be its own header "{header}"'


def findCircle(includes):
    """A circle of headers as a list of paths, or None."""
    done, way = set(), []

    def visit(path):
        if path in way:
            return way[way.index(path):] + [path]
        if path in done or path not in includes:
            return None
        way.append(path)
        for _, ours, _ in includes[path]:
            circle = ours and visit(ours)
            if circle:
                return circle
        way.pop()
        done.add(path)
        return None

    return next(filter(None, map(visit, sorted(includes))), None)


def check(root):
    """Every breach in the tree, one line each, and how many files were read."""
    includes = readIncludes(root)
    breaches = []
    for path, lines in includes.items():
        breaches.append(checkOwnHeaderFirst(path, lines, includes))
        for line, ours, foreign in lines:
            breaches.append(checkOurs(path, line, ours, includes) if ours else checkForeign(path, line, foreign))
    circle = findCircle(includes)
    if circle:
        breaches.append("a circle of includes: " + " -> ".join(circle))
    return [breach for breach in breaches if breach], len(includes)


def main():
    if len(sys.argv) > 2 or (len(sys.argv) == 2 and sys.argv[1].startswith("-")):
        sys.exit(__doc__.strip())
    root = pathlib.Path(sys.argv[1] if len(sys.argv) == 2 else pathlib.Path(__file__).parent.parent)
    breaches, file_count = check(root)
    if file_count == 0:
        sys.exit(f"check_layers.py: found no sources in {root}")
    print("\n".join(breaches + [f"{file_count} files read, {len(breaches)} breaches."]))
    sys.exit(1 if breaches else 0)


if __name__ == "__main__":
    main()
