# SPDX-License-Identifier: BSD-3-Clause
"""The example with sliders ($EXAMPLES is its folder), without a screen."""

import os
import sys
import unittest

import numpy as np

os.environ["MPLBACKEND"] = "Agg"
sys.path.insert(0, os.environ["EXAMPLES"])

import pimg
import slider
from module_test import picture, scene


class Sliders(unittest.TestCase):
    def drag(self, tuner, name, value):
        """Moves a slider and returns the picture shown."""
        tuner.sliders[name].set_val(value)
        tuner.figure.canvas.draw()
        return np.array(tuner.image.get_array())

    def test_the_picture_follows(self):
        p = pimg.build(scene(width=160, height=120))
        tuner = slider.Tuner(p)
        start = np.array(tuner.image.get_array())
        self.assertTrue(np.array_equal(start, np.clip(pimg.srgb_encoded(p.hdr_compress()), 0, 1)))
        self.assertGreaterEqual(set(tuner.sliders), {"s0", "beta"})
        moved = self.drag(tuner, "beta", 1)
        self.assertTrue(np.array_equal(moved, np.clip(pimg.srgb_encoded(p.hdr_compress(beta=1)), 0, 1)))
        self.assertGreater(np.abs(moved - start).max(), 0.01)
        self.assertRegex(tuner.title.get_text(), r"^\d+ ms$")
        tuner.figure.savefig("slider.png")
        for each in tuner.sliders.values():
            each.reset()
        self.assertTrue(np.array_equal(tuner.image.get_array(), start))

    def test_other_filters_and_kinds_of_pictures(self):
        for source in (scene(), picture("uint8"), scene()[..., 0]):
            p = pimg.build(source)
            for name in ("feature_lowpass", "segment"):
                tuner = slider.Tuner(p, name)
                option = list(tuner.sliders)[0]
                shown = self.drag(tuner, option, 2)
                self.assertTrue(np.isfinite(shown).all())
                slider.plt.close(tuner.figure)


if __name__ == "__main__":
    unittest.main()
