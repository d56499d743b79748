#!/usr/bin/env python3
"""check_layers.py finds each kind of breach, and passes a tree that has none."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import check_layers  # noqa: E402  (found through the line above)


class CheckLayersTest(unittest.TestCase):
    def breaches(self, files):
        """What check() says of a tree made of {path: text}."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for path, text in files.items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text)
            found, count = check_layers.check(root)
            self.assertEqual(count, len(files))
            return found

    def testAcceptsTheWayDown(self):
        self.assertEqual(self.breaches({
            "core/a.h": '#include "shaders/shared/s.h"\n#include <vector>\n',
            "shaders/shared/s.h": "",
            "renderer/r.cpp": '#include "renderer/r.h"\n#include <vulkan/vulkan.hpp>\n',
            "renderer/r.h": '#include "core/a.h"\n',
            "cli/main.cpp": '#include "renderer/r.h"\n#include "embedded/kText.h"\n',
        }), [])

    def testRefusesTheWayUp(self):
        self.assertEqual(self.breaches({"core/a.h": '\n#include "cli/b.h"\n', "cli/b.h": ""}),
                         ["core/a.h:2: core may not include cli/b.h"])

    def testKeepsAssetpipeAndRendererApart(self):
        self.assertEqual(self.breaches({"assetpipe/a.cpp": '#include "renderer/r.h"', "renderer/r.h": ""}),
                         ["assetpipe/a.cpp:1: assetpipe may not include renderer/r.h"])
        self.assertEqual(self.breaches({"renderer/r.cpp": '#include "assetpipe/a.h"', "assetpipe/a.h": ""}),
                         ["renderer/r.cpp:1: renderer may not include assetpipe/a.h"])

    def testHidesVulkan(self):
        self.assertEqual(self.breaches({"core/a.cpp": "#include <vulkan/vulkan.h>"}),
                         ["core/a.cpp:1: <vulkan/vulkan.h> belongs behind renderer and tests/renderer"])
        found = self.breaches({"cli/a.cpp": '#include "renderer/state.h"',
                               "renderer/state.h": '#include "renderer/vk/device.h"',
                               "renderer/vk/device.h": "#include <vulkan/vulkan.h>"})
        self.assertEqual(found, ["cli/a.cpp:1: renderer/state.h brings Vulkan along; "
                                 "include what renderer.h offers"])

    def testRefusesAPathThatIsNotFromTheRoot(self):
        self.assertEqual(self.breaches({"core/a.cpp": '#include "b.h"', "core/b.h": ""}),
                         ['core/a.cpp:1: "b.h" is no file of the project; name it from the root'])

    def testWantsTheOwnHeaderFirst(self):
        self.assertEqual(self.breaches({"core/a.cpp": '#include <map>\n#include "core/a.h"', "core/a.h": ""}),
                         ['core/a.cpp:1: the first include must be its own header "core/a.h"'])

    def testFindsACircle(self):
        self.assertEqual(self.breaches({"core/a.h": '#include "core/b.h"', "core/b.h": '#include "core/a.h"'}),
                         ["a circle of includes: core/a.h -> core/b.h -> core/a.h"])

    def testIgnoresComments(self):
        self.assertEqual(self.breaches({"core/a.h": '// #include "cli/b.h"\n/*\n#include "cli/b.h"\n*/\n'}), [])


if __name__ == "__main__":
    unittest.main()
