# SPDX-License-Identifier: BSD-3-Clause
"""The operations of GEGL ($PIMG_GEGL is the module's folder, $GEGL its command): the same numbers as pimgtool, floats unclamped."""

import os
import subprocess
import unittest

import numpy as np

import pictures
from pictures import read

GEGL = os.environ["GEGL"]
MODULES = os.environ["PIMG_GEGL"] + ":" + os.environ["GEGL_MODULES"]
OPERATIONS = (
    "hdr-compress s0=0.2 beta=4",
    "hdr-compress fit=false",
    "paint seed=3 canvas=1,1,1",
    "feature-lowpass splits=300",
    "feature-lowpass strength=0.2 log=true",
    "mosaic tiles=150",
)


def run(*arguments):
    # Not all that gegl prints is text.
    return subprocess.run([GEGL, *arguments], capture_output=True, text=True, errors="replace", timeout=60,
                          env={**os.environ, "GEGL_PATH": MODULES})


class Gegl(pictures.ToolTest):
    def setUp(self):
        super().setUp()
        # Twice the picture, so that it is not as small as one of GEGL's tiles.
        pictures.write("in.exr", pictures.hdr_scene(150, 140), "float")

    def gegl(self, source, operation, result="out.exr"):
        done = run(source, "-o", result, "--", *operation.split())
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("pimg:", done.stderr)
        return read(result)

    def test_the_same_as_pimgtool(self):
        arguments = ["in.exr", "-d", "float"]
        for i, operation in enumerate(OPERATIONS):
            command = "--" + operation.replace(" ", ":").replace("false", "0").replace("true", "1")
            arguments += ["--dup", command, "-o", f"tool{i}.exr", "--pop"]
        self.ok(*arguments)
        for i, operation in enumerate(OPERATIONS):
            with self.subTest(operation=operation):
                expected, result = read(f"tool{i}.exr"), self.gegl("in.exr", "pimg:" + operation)
                self.assertTrue(np.array_equal(result[..., :3], expected))

    def test_floats_are_not_clamped(self):
        source = read("in.exr")
        result = self.gegl("in.exr", "pimg:feature-lowpass strength=0")
        self.assertGreater(source.max(), 50)
        self.assertTrue(np.array_equal(result[..., :3], source))

    def test_sides_meet_as_in_pimgtool(self):
        self.ok("in.exr", "--build:wrap=xy", "--feature-lowpass:fraction=0.05", "-d", "float", "-o", "tool.exr")
        result = self.gegl("in.exr", "pimg:feature-lowpass fraction=0.05 wrap=xy")
        self.assertTrue(np.array_equal(result[..., :3], read("tool.exr")))
        done = run("in.exr", "-o", "out.exr", "--", "pimg:level", "wrap=around")
        self.assertIn("expected one of none, x, xy", done.stderr)

    def test_the_layer_that_was_loaded_is_the_picture(self):
        # GEGL hands over R, G, B and A of the file; other layers and depth are not seen, and change nothing.
        picture = pictures.hdr_scene(150, 140)
        more = np.concatenate([picture[..., ::-1] * 7, picture, picture[..., :1] * 100], 2)
        pictures.write("layers.exr", more, "float", names=["key.R", "key.G", "key.B", "R", "G", "B", "Z"])
        result = self.gegl("layers.exr", "pimg:hdr-compress fit=false")
        self.assertTrue(np.array_equal(result[..., :3], self.gegl("in.exr", "pimg:hdr-compress fit=false")[..., :3]))

    def test_operations_chain_with_those_of_gegl(self):
        result = self.gegl("in.exr", "gegl:crop x=20 y=30 width=90 height=80 pimg:hdr-compress gegl:exposure exposure=1")
        pictures.oiiotool("in.exr", "--cut", "90x80+20+30", "-o", "cut.exr")
        self.ok("cut.exr", "-d", "float", "--hdr-compress", "-o", "tool.exr")
        self.assertLess(np.median(np.abs(result[:80, :90, :3] - 2 * read("tool.exr"))), 1e-3)

    def test_alpha_is_associated(self):
        pixels = pictures.hdr_scene(60, 50)
        alpha = np.linspace(0.1, 1, 60)[None, :, None] * np.ones((50, 1, 1))
        pictures.write("alpha.exr", np.concatenate([pixels * alpha, alpha], axis=2), "float", names=["R", "G", "B", "A"])
        self.ok("alpha.exr", "-d", "float", "--hdr-compress", "-o", "tool.exr")
        result = self.gegl("alpha.exr", "pimg:hdr-compress")
        self.assertLess(np.median(np.abs(result - read("tool.exr"))), 1e-3)

    def test_inputs_without_a_size_are_passed_on(self):
        for name in ("hdr-compress", "level"):
            done = run("-o", "out.png", "--", "gegl:checkerboard", "pimg:" + name, "gegl:crop", "width=60", "height=40")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("gegl:crop before it", done.stderr + done.stdout)
            run("-o", "plain.png", "--", "gegl:checkerboard", "gegl:crop", "width=60", "height=40")
            self.assertTrue(np.array_equal(read("out.png"), read("plain.png")))

    def test_what_is_wrong_is_said(self):
        done = run("in.exr", "-o", "out.exr", "--", "pimg:paint", "brush=nowhere.png")
        self.assertIn("nowhere.png", done.stderr)

    def test_properties_are_those_of_the_option_tables(self):
        done = run("--info", "pimg:hdr-compress")
        listed = subprocess.run([pictures.TOOL, "--help", "hdr-compress"], capture_output=True, text=True).stdout
        for name in ("s0", "beta", "dmax", "coherence", "saturation", "fit", "exposure"):
            self.assertIn(name, listed)
            self.assertRegex(done.stdout, rf"(?m)^\s*{name}\b")


if __name__ == "__main__":
    unittest.main()
