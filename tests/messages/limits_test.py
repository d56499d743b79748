#!/usr/bin/env python3
"""Hostile files that claim or unfold to much: each is answered with one line, in bounded memory and time.

Usage: limits_test.py --ensemble PROGRAM

The program runs with RLIMIT_AS, so that a greedy reader ends with "out of memory" and exit code 1
instead of the message that is expected; peak memory is printed. Time is bounded generously, by the
CPU time that a run may take: it finds what grows without end, not what is slow.
"""
import argparse
import os
import pathlib
import resource
import struct
import subprocess
import sys
import tempfile
import zlib

import bad_files  # noqa: F401, finds small_glb
from small_glb import glb, template

MEGA = 1 << 20
ADDRESS_SPACE = 1536 * MEGA
CPU_SECONDS = 60


def png(width, height, rows):
    """A PNG that unfolds to `rows` empty rows."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    packer, data = zlib.compressobj(9), b""
    for _ in range(rows):
        data += packer.compress(b"\0" * (1 + 4 * width))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0))
            + chunk(b"IDAT", data + packer.flush()) + chunk(b"IEND", b""))


def textured(image):
    """The template with this picture on every region."""
    import base64
    document = template()
    document.json["images"] = [{"uri": "data:image/png;base64," + base64.b64encode(image).decode()}]
    document.json["textures"] = [{"source": 0}]
    for material in document.json["materials"]:
        material["pbrMetallicRoughness"] = {"baseColorTexture": {"index": 0}}
    return document.bytes()


def draco(offset):
    """The corpus' Draco file with a count in the head of its data made huge."""
    data = bytearray((pathlib.Path(__file__).resolve().parent.parent / "fuzz/corpus/glb/draco.glb").read_bytes())
    at = data.index(b"DRACO") + offset
    data[at:at + 5] = b"\xff\xff\xff\xff\x0f"
    return bytes(data)


def huge_accessor(document):
    document["accessors"][0].pop("bufferView")
    document["accessors"][0]["count"] = 4000000000


def huge_sparse(document):
    """16 million vertices of no bytes but for one sparse one; each attribute the same."""
    for attribute in document["meshes"][0]["primitives"][0]["attributes"].values():
        document["accessors"][attribute].pop("bufferView")
        document["accessors"][attribute]["count"] = 16000000


def with_text(text):
    return glb('{"asset":{"version":"2.0"},' + text + "}")


MANY = "the JSON has more than 4194304 values; remove the nested extras"
DRACO = ("/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: the Draco data announce 0 faces and {} vertices, "
         "the accessors 3 and 5; export the file again")
NO_ANCHORS = "2:{}: anchors (&) and aliases (*) are not accepted; write the value out"

# FILE -> (what makes its bytes, message); made one by one, so that this test itself stays small.
CASES = {
    "empty_lists.glb": (lambda: with_text('"extras":[' + "[]," * (20 * MEGA) + "0]"), "byte 6291486: " + MANY),
    "numbers.glb": (lambda: with_text('"nodes":[' + "0," * (30 * MEGA) + "0]"), "byte 8388635: " + MANY),
    "members.glb": (lambda: with_text('"nodes":[' + '{"a":{}},' * (6 * MEGA) + "{}]"), "byte 12582935: " + MANY),
    "much_json.glb": (lambda: with_text('"extras":"' + "x" * (65 * MEGA) + '"'),
                      "68157480 bytes of JSON are more than the 67108864 allowed; split the file"),
    "nodes.glb": (lambda: with_text('"nodes":[' + "{}," * MEGA + "{}]"), "/nodes: 1048577 nodes are more than the 65536 allowed; split the file"),
    "accessor.glb": (lambda: template().bytes(huge_accessor), "/meshes/0/primitives/0: 4000000000 vertices are more than "
                     "the 16777216 still allowed in this file; split the file"),
    "sparse.glb": (lambda: template().bytes(huge_sparse), "/meshes/0/primitives/0: 16000000 vertices have no bufferView; export the file again"),
    "picture_header.glb": (lambda: textured(png(60000, 60000, 1)),
                           "/images/0: the image of 60000 x 60000 pixels is larger than the 67108864 pixels allowed; "
                           "scale the texture down"),
    "draco_1.glb": (lambda: draco(11), DRACO.format(33554431)),
    "draco_2.glb": (lambda: draco(12), DRACO.format(4294967295)),
    "anchors.yaml": (lambda: b"version: 1\nwardrobe: &a [w, w]\npeople: [*a, *a, *a]\n", NO_ANCHORS.format(11)),
    "cycle.yaml": (lambda: b"version: 1\npeople: &a [*a]\n", NO_ANCHORS.format(9)),
    "flow.yaml": (lambda: b"version: 1\npeople: " + b"[" * (3 * MEGA),
                  "2:25: lists and maps are nested more than 32 deep; nest them less"),
    "keys.yaml": (lambda: b"version: 1\npeople: {" + b",".join(b"k%d: 1" % i for i in range(300000)) + b"}",
                  "2:2638876: more than 500000 values; keep data per person out of YAML"),
    "items.yaml": (lambda: b"version: 1\npeople: [" + b"a," * (2 * MEGA - 20) + b"a]",
                   "2:1000000: more than 500000 values; keep data per person out of YAML"),
    "long.yaml": (lambda: b"version: 1\npeople: " + b"x" * (5 * MEGA),
                  "has 5242899 bytes, more than the 4194304 that are read; split it or reduce its content"),
    "same_keys.yaml": (lambda: b"version: 1\nground: true\nground: false\n",
                       "3:1: the key 'ground' is here a second time (first at 2:1); remove one of them"),
}


class Limited:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.failures = self.passed = 0

    def run(self, arguments):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
            resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))
        errors = self.folder / "errors"
        with open(errors, "wb") as stream:
            process = subprocess.Popen([self.program, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                                       stdout=subprocess.DEVNULL, stderr=stream, preexec_fn=limit)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, errors.read_text(errors="replace"), usage

    def check(self, arguments, code, message):
        returned, said, usage = self.run(arguments)
        holds = returned == code and said == (f"ensemble: {message}\n" if message else "")
        self.passed += holds
        self.failures += not holds
        print(f"{'holds' if holds else 'FAILS'}: {usage.ru_maxrss // 1024:5} MiB, {usage.ru_utime + usage.ru_stime:5.1f} s "
              f"CPU: {' '.join(arguments)}" + ("" if holds else f"\n  exit code {returned}, says {said[:400]!r}"), flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ensemble", required=True)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        limited = Limited(os.path.abspath(options.ensemble), folder)
        for file, (make, message) in CASES.items():
            (folder / file).write_bytes(make())
            limited.check(["inspect", file], 3, f"{file}: {message}")
        (folder / "bomb.glb").write_bytes(textured(png(8192, 8192, 8192)))
        limited.check(["inspect", "bomb.glb"], 0, "")
        (folder / "w").mkdir()
        (folder / "w" / "wardrobe.json").write_text('{"a":[' + "0," * (30 * MEGA) + "0]}")
        limited.check(["inspect", "w"], 3, "w/wardrobe.json: byte 8388609: the JSON has more than 4194304 values; make "
                      "the wardrobe again with `ensemble tag`")
    print(f"{limited.passed} limits hold, {limited.failures} don't")
    return 1 if limited.failures else 0


if __name__ == "__main__":
    sys.exit(main())
