# SPDX-License-Identifier: BSD-3-Clause
"""Effects of OpenFX on many threads, with a cache of any size: the same pixels."""

import unittest

import numpy as np

import ofx_host
import pictures


class Threads(ofx_host.HostTest):
    def setUp(self):
        super().setUp()
        ofx_host.write("a.exr", ofx_host.scene(60, 45))
        ofx_host.write("b.exr", ofx_host.scene(45, 60)[:, ::-1])

    def test_eight_threads_on_four_instances(self):
        said = self.host("stress", "a.exr", "b.exr", "--threads", 8, "--renders", 100, "--instances", 4)
        self.assertIn("800 renders", said)

    def test_a_cache_that_holds_nothing(self):
        self.host("stress", "a.exr", "b.exr", "--threads", 4, "--renders", 10, environment={"PIMG_OFX_CACHE_MB": "0"})

    def test_other_effects(self):
        self.host("stress", "a.exr", "--threads", 4, "--renders", 6, "--effects", "mosaic,ink,segment,level")

    def test_the_second_render_builds_nothing(self):
        ofx_host.write("large.exr", ofx_host.scene(500, 400))
        said = self.host("render", "hdr_compress", "large.exr", "out.exr", "beta=5..15", "--repeat", 6)
        times = [float(line.split()[0]) for line in said.splitlines() if " ms, " in line]
        self.assertEqual(len(times), 6)
        self.assertLess(min(times[1:]), 0.5 * times[0])
        self.assertTrue(np.array_equal(pictures.read("out.exr"), self.tool("hdr_compress", "beta=15", source="large.exr")))


if __name__ == "__main__":
    unittest.main()
