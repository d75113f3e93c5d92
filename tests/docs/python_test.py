# SPDX-License-Identifier: BSD-3-Clause
"""Runs the examples of README.md and docs/python.md ($DOCS is its folder), one after the other as a reader would."""

import os
import tempfile
import unittest

import numpy as np
import OpenImageIO as oiio

from markdown_code import blocks


class Examples(unittest.TestCase):
    def test_all_of_them(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        light = np.random.default_rng(3).lognormal(0, 2, (90, 120, 3)).astype(np.float32)
        picture = oiio.ImageBuf(oiio.ImageSpec(120, 90, 3, "half"))
        picture.set_pixels(picture.roi, light)
        picture.write("in.exr")
        for page, least in (("../README.md", 1), ("python.md", 5)):
            examples = blocks(os.path.join(os.environ["DOCS"], page), "python")
            self.assertGreaterEqual(len(examples), least)
            names = {}
            for example in examples:
                exec(compile(example, page, "exec"), names)
        for name in ("out.png", "beta2.png", "beta5.png", "beta10.png", "in.pimg"):
            self.assertTrue(os.path.exists(name))


if __name__ == "__main__":
    unittest.main()
