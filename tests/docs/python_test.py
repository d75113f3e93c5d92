# SPDX-License-Identifier: BSD-3-Clause
"""Runs the examples of docs/python.md ($DOCS is the folder), one after the other as a reader would."""

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
        examples = blocks(os.path.join(os.environ["DOCS"], "python.md"), "python")
        self.assertGreaterEqual(len(examples), 5)
        names = {}
        for example in examples:
            exec(compile(example, "docs/python.md", "exec"), names)
        for beta in (2, 5, 10):
            self.assertTrue(os.path.exists(f"beta{beta}.png"))


if __name__ == "__main__":
    unittest.main()
