#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Other people's decoders show the HDR rendition that we meant: Debian's Chromium, and hdrify of npm.

Skipped where neither is there. hdrify is looked for in $HDRIFY, the folder that `npm install hdrify` was run in.
"""

import os
import pathlib
import shutil
import sys
import tempfile
import unittest

import numpy as np
import OpenImageIO as oiio

import pimg
from decoders import chromium_pixels, hdrify_pixels, stops_apart

SKIPPED = 77  # what ctest takes for it


def scene(width=160, height=120):
    """A dim room with a bright, coloured window; display-linear, up to five times SDR white."""
    y, x = np.mgrid[0:height, 0:width].astype(np.float32)
    light = 0.05 + 0.2 * x / width
    colour = np.stack([light, light * 0.9, light * 1.1], axis=-1)
    glow = np.exp(-((x - 100) ** 2 + (y - 50) ** 2) / 900)[..., None]
    return (colour + 5 * glow * np.array([1.0, 0.8, 0.5])).astype(np.float32)


def gain_map_file(folder):
    rendition = scene()
    base = pimg.srgb_encoded(rendition / (1 + rendition / 1.5))
    path = folder / "base.jpg"
    out = oiio.ImageOutput.create(str(path))
    spec = oiio.ImageSpec(base.shape[1], base.shape[0], 3, "uint8")
    spec.attribute("Compression", "jpeg:97")
    if not (out.open(str(path), spec) and out.write_image(base) and out.close()):
        raise RuntimeError(out.geterror())
    file = folder / "file.jpg"
    file.write_bytes(pimg.gain_map_jpeg(path.read_bytes(), rendition))
    return file


class DecodersTest(unittest.TestCase):
    def compare(self, decode, tool):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            ours = pimg.gain_map_rendition(gain_map_file(folder).read_bytes(), array=True)
            theirs = decode(folder, scene().shape[:2], tool)
        self.assertLess(stops_apart(ours, scene()), 0.1)
        self.assertLess(stops_apart(theirs, scene()), 0.1)

    @unittest.skipUnless(shutil.which("chromium"), "no Chromium")
    def test_chromium(self):
        self.compare(chromium_pixels, shutil.which("chromium"))

    @unittest.skipUnless(os.environ.get("HDRIFY") and shutil.which("node"), "no hdrify")
    def test_hdrify(self):
        self.compare(hdrify_pixels, os.environ["HDRIFY"])


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    sys.exit(SKIPPED if len(result.skipped) == result.testsRun else not result.wasSuccessful())
