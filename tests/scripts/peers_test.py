#!/usr/bin/python3
"""The peers' shared scene is what the artist's files say, and their report compares what it should.

The peers themselves are not run: run.py holds their pictures against ours whenever it measures.
"""
import json
import pathlib
import sys
import tempfile
import types
import unittest

PROJECT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(PROJECT / "bench/peers"), str(PROJECT / "tests/support")]
try:
    import numpy as np
    from PIL import Image
    import export_character
    import peers_report
    import run as peers_run
except ImportError as missing:
    print(f"SKIPPED: {missing} (scripts/install_packages.sh peers)")
    sys.exit(77)
import small_glb  # noqa: E402  (found through the line above)


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class ExportTest(InFolder):
    def export(self, template=None, outfit=None, clip="sway", counts=(5, 40)):
        (self.folder / "template.glb").write_bytes((template or small_glb.template()).bytes())
        (self.folder / "shirt.glb").write_bytes((outfit or small_glb.outfit()).bytes())
        return export_character.export(self.folder / "template.glb", self.folder / "shirt.glb", clip, counts,
                                       self.folder / "scene")

    def array(self, file, dtype, offset, count):
        return np.frombuffer((self.folder / "scene" / file).read_bytes(), dtype, count, offset)

    def mesh(self, entry):
        vertices, triangles = entry["vertices"], entry["triangles"]
        return (self.array(entry["file"], "<f4", 0, vertices * 3).reshape(-1, 3),
                self.array(entry["file"], "<u4", vertices * 44, triangles * 3).reshape(-1, 3))

    def testTheMeshIsWhatTheOutfitHolds(self):
        scene = self.export()
        exported = scene["meshes"]["exported"]
        # Legs 64 faces, torso 32, tunic 80; three bands of 5 and 6 rings of 8 vertices.
        self.assertEqual((exported["triangles"], exported["vertices"]), (64 + 32 + 80, 40 + 40 + 48))
        positions, indices = self.mesh(exported)
        first_of_tunic = positions[indices[96, 0]]
        self.assertAlmostEqual(float(first_of_tunic[1]), 0.55, places=6)
        self.assertEqual(indices[0].tolist(), [0, 1, 8])

    def testTheOptimisedOrderHoldsTheSameTriangles(self):
        scene = self.export()
        corners = {}
        for order, entry in scene["meshes"].items():
            positions, indices = self.mesh(entry)
            corners[order] = sorted(tuple(sorted(map(tuple, positions[face].tolist()))) for face in indices)
        self.assertEqual(corners["exported"], corners["optimised"])
        _, indices = self.mesh(scene["meshes"]["optimised"])
        firsts = [index for place, index in enumerate(indices.reshape(-1)) if index not in indices.reshape(-1)[:place]]
        self.assertEqual(firsts, list(range(len(firsts))))  # numbered by first use

    def testThePosesAreSkinningMatrices(self):
        scene = self.export()
        self.assertEqual((scene["poses"]["keys"], scene["poses"]["joints"], scene["poses"]["seconds"]), (3, 2, 1.0))
        matrices = self.array("poses.bin", "<f4", 0, 3 * 2 * 12).reshape(3, 2, 3, 4)
        np.testing.assert_allclose(matrices[0], np.eye(4)[None, :3].repeat(2, 0), atol=1e-6)
        # At the middle key the spine is turned about +Z by twice the angle whose cosine is 0.8, around (0, 0.9, 0).
        turned = [[0.28, -0.96, 0, 0.9 * 0.96], [0.96, 0.28, 0, 0.9 - 0.9 * 0.28], [0, 0, 1, 0]]
        np.testing.assert_allclose(matrices[1, 1], turned, atol=1e-6)

    def testJointsGoByName(self):
        outfit = small_glb.outfit()
        outfit.json["skins"][0]["joints"] = [1, 0]
        inverse = outfit.json["skins"][0]["inverseBindMatrices"]
        outfit.rows[inverse].reverse()
        scene = self.export(outfit=outfit)
        entry = scene["meshes"]["exported"]
        joints = self.array(entry["file"], "u1", entry["vertices"] * 40, 4)
        self.assertEqual(joints.tolist(), [1, 0, 1, 1])

    def testThePhasesAreOnKeysOrBetween(self):
        scene = self.export()
        tables = {}
        for poses, name in scene["crowds"].items():
            header, *lines = (self.folder / "scene" / name).read_text().splitlines()
            self.assertEqual(header, "x,z,heading,phase,outfit,clip,scale,tint")
            tables[poses] = [line.split(",") for line in lines]
        self.assertEqual(len(tables["keys"]), 40)
        self.assertEqual({row[3] for row in tables["keys"]}, {"0.0000000", "0.5000000"})
        self.assertGreater(len({row[3] for row in tables["interpolated"]}), 30)
        self.assertEqual([row[:3] for row in tables["keys"]], [row[:3] for row in tables["interpolated"]])
        self.assertEqual(tables["keys"][0][4:], ["shirt", "sway", "1", "1"])
        distances = [float(row[0]) ** 2 + float(row[1]) ** 2 for row in tables["keys"]]
        self.assertEqual(distances, sorted(distances))

    def testTheCameraStepsBack(self):
        views = {(view["name"], view["characters"]): view for view in self.export(counts=[10, 40])["views"]}
        self.assertAlmostEqual(views["near", 40]["position"][1], 2 * views["near", 10]["position"][1], places=3)

    def testRefusesWhatPeersCannotDraw(self):
        with self.assertRaisesRegex(export_character.Problem, "there is no clip 'run'; choose from sway"):
            self.export(clip="run")
        travelling = small_glb.template()
        travelling.rows[travelling.json["animations"][0]["samplers"][0]["output"]][2] = [0, 0, 0.6, 0.8]
        with self.assertRaisesRegex(export_character.Problem, "does not end as it begins"):
            self.export(template=travelling)
        stepping = small_glb.template()
        stepping.json["animations"][0]["samplers"][0]["interpolation"] = "STEP"
        with self.assertRaisesRegex(export_character.Problem, "bake it at one rate"):
            self.export(template=stepping)
        other = small_glb.outfit()
        other.json["nodes"][1]["name"] = "tail"
        with self.assertRaisesRegex(export_character.Problem, "joint 'tail' is not in"):
            self.export(outfit=other)


class ReportTest(InFolder):
    def report(self, peer_columns, peer_triangles=70):
        """Ours and a peer, two rounds; each covers so many of 100 columns."""
        rows = [peers_run.Row("ours", "keys"), peers_run.Row("OGRE", "keys", "exported")]
        pictures = {}
        for row, columns in zip(rows, (50, peer_columns)):
            pixels = np.zeros((10, 100, 4), np.uint8)
            pixels[:, :columns, 3] = 255
            pictures[row, 10] = self.folder / f"{row.label}.png"
            Image.fromarray(pixels).save(pictures[row, 10])
        told = [[[1.0, 9.0, 2.0], [4.0, 4.0, 4.0]], [[20.0, 20.0, 30.0], [20.0, 20.0, 20.0]]]
        triangles = [70, peer_triangles]
        answers = {(row, 10): [{"frame_ms": ms, "triangles": count, "device": "d"} for ms in rounds]
                   for row, rounds, count in zip(rows, told, triangles)}
        scene = {"width": 100, "height": 10, "meshes": {"exported": {"triangles": 7, "vertices": 5}}}
        return peers_report.Report(answers, ["ours", "ours, compute"], pictures, scene)

    def testRatiosAreOfMediansAndOfRounds(self):
        settings = {"view": "near", "counts": [10], "rounds": 2, "warm": 0, "frames": 3, "outfit": "o", "clip": "walk"}
        machine = {"cpu": "C", "cores": 2, "load_average": [1.25, 0, 0]}
        figures = self.report(50).figures({"before": machine, "after": machine}, settings)
        json.dumps(figures)
        self.assertEqual(peers_report.caption(figures), "o, 7 triangles, 5 vertices; view near, 100 x 10; 2 rounds of 3 "
                         "frames; C, 2 cores, load 1.2 before and 1.2 after")
        ours, ogre = figures["rows"]
        self.assertEqual((ours["frame_ms_of_rounds"], ogre["frame_ms_of_rounds"]), ([2, 4], [20, 20]))
        ratio, = ogre["ratios"]
        self.assertEqual((ratio["to"], ratio["of_rounds"]["min"], ratio["of_rounds"]["max"]), ("ours", 5, 10))
        self.assertAlmostEqual(ratio["of_medians"], 20 / 3)
        self.assertIn("| 10 | keys | OGRE | exported | 20.0 | 20.0 to 20.0 | 0.000 % | 6.67 (6.25 to 8.75) |",
                      self.report(50).table())

    def testAnotherCrowdIsTold(self):
        self.assertEqual(self.report(50).wrong(), [])
        told, = self.report(52).wrong()
        self.assertIn("OGRE, exported, keys, 10 people: 3.85 % of the pixels", told)
        told, = self.report(50, peer_triangles=60).wrong()
        self.assertEqual(told, "OGRE, exported, keys: drew 60 triangles, not 70")

    def testTheSheetShowsEachRow(self):
        width, height = peers_report.TILE
        sheet = self.report(50).sheet()
        self.assertEqual(sheet.size, (2 * width, peers_report.LABEL_HEIGHT + 2 * height))


class SkipTest(InFolder):
    def testWhatIsMissingIsAReason(self):
        ensemble = self.folder / "ensemble"
        ensemble.write_text("#!/bin/sh\necho 'version: 1'\necho 'raster: auto'\necho 'poses:'\n")
        ensemble.chmod(0o755)
        peers = peers_run.Peers(types.SimpleNamespace(out=self.folder, ensemble=ensemble, ogre=self.folder / "none"))
        self.assertIsNone(peers.why_not(peers_run.Row("ours, compute", "keys")))
        ensemble.write_text("#!/bin/sh\necho 'version: 1'\n")
        self.assertEqual(peers.why_not(peers_run.Row("ours, compute", "keys")),
                         "this program's scenes have no key 'raster'")
        self.assertIsNotNone(peers.why_not(peers_run.Row("OGRE", "keys", "exported")))
        self.assertIsNotNone(peers.why_not(peers_run.Row("three.js, llvmpipe", "keys", "exported")))
        with self.assertRaisesRegex(peers_run.Skip, "ended with 3: no"):
            peers_run.run(["sh", "-c", "echo yes; echo no >&2; exit 3"], 60)
        with self.assertRaisesRegex(peers_run.Skip, "sh took longer than 0.2 s"):
            peers_run.run(["sh", "-c", "sleep 60 & wait"], 0.2)
        with self.assertRaisesRegex(peers_run.Skip, "/none is missing"):
            peers_run.run([str(self.folder / "none")], 60)


if __name__ == "__main__":
    unittest.main()
