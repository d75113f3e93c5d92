# SPDX-License-Identifier: BSD-3-Clause
"""Our declarations of OpenFX beside the official headers, where they are: in $PIMG_OFX_HEADERS, from the CMake variable
PIMG_OFX_INCLUDE, or a folder of the system's. The compiler compares every name, number, offset and signature."""

import os
import shutil
import subprocess
import unittest

PLACES = (os.environ.get("PIMG_OFX_HEADERS", ""), "/usr/include/openfx", "/usr/local/include/openfx")
HEADERS = next((place for place in PLACES if place and os.path.exists(os.path.join(place, "ofxColour.h"))), None)
OFX = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "ofx")


@unittest.skipIf(HEADERS is None, "the official headers of OpenFX 1.5 are not here: expected them in PIMG_OFX_INCLUDE")
class Abi(unittest.TestCase):
    def compile(self, headers):
        return subprocess.run(
            [os.environ.get("CXX", "c++"), "-std=c++17", "-fsyntax-only", "-DPIMG_OFX_OFFICIAL", "-I", OFX, "-isystem", headers,
             os.path.join(OFX, "abi", "ofx_abi_check.cpp")], capture_output=True, text=True, check=False)

    def test_ours_are_the_official_ones(self):
        done = self.compile(HEADERS)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_difference_is_found(self):
        for file, before, after in (
            ("ofxCore.h", '"OfxActionLoad"', '"OfxActionLaod"'),
            ("ofxCore.h", "kOfxStatReplyDefault ((int) 14)", "kOfxStatReplyDefault ((int) 15)"),
            ("ofxImageEffect.h", "int (*abort)(OfxImageEffectHandle", "long (*abort)(OfxImageEffectHandle"),
            ("ofxProperty.h", "OfxStatus (*propReset)", "void *gap; OfxStatus (*propReset)"),
        ):
            shutil.rmtree("headers", ignore_errors=True)
            shutil.copytree(HEADERS, "headers")
            path = os.path.join("headers", file)
            with open(path, encoding="utf-8") as source:
                text = source.read()
            changed = text.replace(before, after)
            self.assertTrue(changed != text, f"{file} has no {before}")
            with open(path, "w", encoding="utf-8") as target:
                target.write(changed)
            self.assertIn("static assertion failed", self.compile("headers").stderr, (file, before))


if __name__ == "__main__":
    unittest.main()
