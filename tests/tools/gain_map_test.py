# SPDX-License-Identifier: BSD-3-Clause
"""JPEG files with a gain map, written and read by pimgtool."""

import os
import subprocess
import tempfile
import unittest

import numpy as np
import OpenImageIO as oiio

TOOL = os.environ["PIMGTOOL"]
WIDTH, HEIGHT = 160, 120


def run(*arguments):
    return subprocess.run([TOOL, *arguments], capture_output=True, text=True, check=False)


def pixels(name):
    return oiio.ImageBuf(os.path.abspath(name)).get_pixels(oiio.FLOAT)[..., :3]  # relative names stay in a cache


def luminance(rgb):
    return np.log2(np.maximum(rgb @ np.float32([0.2126, 0.7152, 0.0722]), 1 / 64))


class GainMapFiles(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        os.chdir(self.folder.name)
        self.addCleanup(os.chdir, "/")
        x, y = np.meshgrid(np.arange(WIDTH, dtype=np.float32), np.arange(HEIGHT, dtype=np.float32))
        light = 0.05 + 0.001 * x
        light = np.where((abs(x - 115) < 28) & (abs(y - 40) < 26), 12 + 0.1 * y, light)
        picture = (light[..., None] * np.float32([1, 0.9, 0.8])).astype(np.float32)
        buf = oiio.ImageBuf(oiio.ImageSpec(WIDTH, HEIGHT, 3, "float"))
        buf.set_pixels(buf.roi, picture)
        buf.write("in.exr")

    def done(self, *arguments):
        result = run(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)

    def refused(self, words, *arguments):
        result = run(*arguments)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn(words, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1)

    def test_base_and_rendition(self):
        self.done("in.exr", "--hdr-compress", "-o", "base.jpg", "-o", "out.jpg:gainmap=1:scale=1")
        self.assertTrue((pixels("base.jpg") == pixels("out.jpg")).all(), "SDR displays show the same")
        self.done("out.jpg", "--gainmap", "-o", "back.exr")
        self.done("in.exr", "--hdr-compress:peak=1000", "-o", "wanted.exr")
        back, wanted = pixels("back.exr"), pixels("wanted.exr")
        self.assertGreater(wanted.max(), 1.5)
        self.assertLess(np.percentile(abs(luminance(back) - luminance(wanted)), 95), 0.1)

    def test_no_halo(self):
        """Beside the window light neither rises above that of the window's middle nor falls below that of the wall."""
        self.done("in.exr", "--hdr-compress", "-o", "out.jpg:gainmap=1:scale=4")
        self.done("out.jpg", "--gainmap", "-o", "back.exr")
        self.done("in.exr", "--hdr-compress:peak=1000", "-o", "wanted.exr")
        rows = slice(35, 45)
        back, wanted = (np.cbrt((pixels(name) @ np.float32([0.2126, 0.7152, 0.0722]))[rows].mean(axis=0))
                        for name in ("back.exr", "wanted.exr"))
        step = wanted[110] - wanted[40]
        self.assertGreater(step, 0.3)
        self.assertLess((back - wanted)[90:140].max(), 0.01 * step)  # the bright side of both edges
        self.assertGreater((back - wanted)[:87].min(), -0.01 * step)

    def test_display_p3(self):
        """A colour beyond Rec. 709: a base with the profile of Display P3 shows it, and the rendition has it, too."""
        buf = oiio.ImageBuf(oiio.ImageSpec(WIDTH, HEIGHT, 3, "float"))
        oiio.ImageBufAlgo.checker(buf, 40, 40, 1, (-0.06, 0.5, -0.02), (0.2, 0.2, 0.2))
        buf.specmod().attribute("Orientation", 6)
        buf.specmod().attribute("Artist", "nobody")
        buf.write("wide.exr")
        self.done("wide.exr", "--hdr-compress:gamut=p3", "-o", "base.jpg", "-o", "out.jpg:gainmap=1", "-o", "out.png")
        self.done("wide.exr", "--hdr-compress", "-o", "narrow.png")
        self.assertTrue((pixels("base.jpg") == pixels("out.jpg")).all())
        for name in ("base.jpg", "out.jpg", "out.png"):
            spec = oiio.ImageBuf(os.path.abspath(name)).spec()
            self.assertEqual(spec.getattribute("ICCProfile:profile_description"), "Display P3", name)
        self.assertEqual(oiio.ImageBuf(os.path.abspath("out.jpg")).spec()["Artist"], "nobody")
        self.done("out.png", "--tocolorspace", "linear", "-d", "float", "-o", "linear.exr")
        self.done("out.jpg", "--gainmap", "--tocolorspace", "linear", "-d", "float", "-o", "back.exr")
        for name in ("linear.exr", "back.exr"):
            self.assertLess(pixels(name)[..., 0].min(), -0.02, name)  # in linear Rec. 709
        self.assertGreater(pixels("narrow.png").min(), 0)

    def test_windows_and_names(self):
        buf = oiio.ImageBuf(os.path.abspath("in.exr"))
        buf.specmod().full_width, buf.specmod().full_height = WIDTH + 40, HEIGHT - 20
        buf.specmod().full_x = -10
        buf.write("overscan.exr")
        self.done("overscan.exr", "--hdr-compress", "-o", "base.jpg", "-o", "OUT.JPG:gainmap=1")
        self.assertTrue((pixels("base.jpg") == pixels("OUT.JPG")).all())
        self.done("OUT.JPG", "--gainmap", "-o", "back.exr")
        self.assertEqual(pixels("back.exr").shape, pixels("base.jpg").shape)

    def test_size(self):
        self.done("in.exr", "--hdr-compress", "-o", "base.jpg", "-o:gainmap=1:peak=600:channels=1", "out.jpeg")
        self.assertLess(os.path.getsize("out.jpeg"), 1.35 * os.path.getsize("base.jpg") + 2048)
        self.done("out.jpeg", "--gainmap", "-o", "back.exr")
        self.assertLess(pixels("back.exr").max(), 600 / 203 * 1.1)

    def test_bad_input(self):
        self.done("in.exr", "--hdr-compress", "-o", "base.jpg")
        before = open("base.jpg", "rb").read()
        self.refused("expected the result of --hdr-compress", "in.exr", "-o", "base.jpg:gainmap=1")
        self.refused("expected the result of --hdr-compress", "in.exr", "--hdr-compress", "--paint", "-o", "base.jpg:gainmap=1")
        self.refused("expected the result of --hdr-compress", "in.exr", "--hdr-compress:peak=800", "-o", "base.jpg:gainmap=1")
        self.refused("gainmap=1", "in.exr", "--hdr-compress", "-o", "base.jpg:peak=800")
        self.refused("channels", "in.exr", "--hdr-compress", "-o", "base.jpg:gainmap=1:channels=2")
        self.refused("scale", "in.exr", "--hdr-compress", "-o", "base.jpg:gainmap=1:scale=3")
        self.refused("gainmap", "in.exr", "--hdr-compress", "-o", "out.png:gainmap=1")
        self.refused("a gain has a sign", "in.exr", "--hdr-compress:output=gain", "-o", "out.png")
        self.refused("a gain has a sign", "in.exr", "--hdr-compress:output=gain", "-d", "uint16", "-o", "out.tif")
        self.refused("peak", "in.exr", "--hdr-compress", "-o", "base.jpg:gainmap=1:peak=5000")
        self.refused("no gain map", "base.jpg", "--gainmap", "-o", "back.exr")
        self.assertEqual(open("base.jpg", "rb").read(), before)
        self.assertEqual(sorted(os.listdir(".")), ["base.jpg", "in.exr"])


if __name__ == "__main__":
    unittest.main()
