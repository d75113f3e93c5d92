# SPDX-License-Identifier: BSD-3-Clause
"""Filters at read time: keys in the query and as hints, on files with a stored hierarchy and without."""

import os
import subprocess
import unittest

import numpy as np
import OpenImageIO as oiio

import plugin_files
from plugin_files import opened, read, scene, write

FILTERS = (
    "level=200",
    "faces=500",
    "fraction=0.1",
    "error=5",
    "wireframe=1&faces=500",
    "feature_lowpass=100",
    "feature_lowpass=0.1",
    "feature_lowpass=on&strength=0.05",
    "detail_enhance=3&from=0.2",
    "hdr_compress=1",
    "hdr_compress=1&s0=0.2&beta=5&display=1",
    "segment=30&output=mean",
    "paint=1&min=4&max=12",
    "mosaic=1&tiles=100",
)


def config(**hints):
    spec = oiio.ImageSpec()
    for key, value in hints.items():
        spec.attribute("pimg:" + key, value)
    return spec


class Keys(plugin_files.PluginTest):
    def setUp(self):
        super().setUp()
        self.hdr = scene(90, 60) ** 3 * 200
        write("a.pimg", self.hdr, "half", {"pimg:profile": "full"})

    def test_every_spelling_of_a_value_is_the_same(self):
        wanted = read("a.pimg?feature_lowpass=100")
        for value in (100, 100.0, "100"):
            self.assertTrue(np.array_equal(read("a.pimg", config=config(feature_lowpass=value)), wanted), value)
        for spelling in (["--iconfig"], ["--iconfig:type=float"], ["--iconfig:type=string"], ["--iconfig:type=int"]):
            self.ok("oiiotool", *spelling, "pimg:feature_lowpass", 100, "a.pimg", "-d", "float", "-o", "b.exr")
            self.assertTrue(np.array_equal(read("b.exr"), wanted), spelling)
        self.ok("oiiotool", "--iconfig", "pimg:feature_lowpass", "0.1", "a.pimg", "-d", "float", "-o", "b.exr")
        self.assertTrue(np.array_equal(read("b.exr"), read("a.pimg?feature_lowpass=0.1")))

    def test_two_queries_of_one_file(self):
        self.ok("oiiotool", "a.pimg?level=10", "a.pimg?level=2000", "--sub", "-d", "float", "-o", "b.exr")
        difference = read("a.pimg?level=10") - read("a.pimg?level=2000")
        self.assertLess(np.abs(read("b.exr") - difference).max(), 1e-3 * np.abs(difference).max())

    def test_the_query_wins_over_hints(self):
        both = read("a.pimg?feature_lowpass=100", config=config(feature_lowpass=5))
        self.assertTrue(np.array_equal(both, read("a.pimg?feature_lowpass=100")))

    def test_hints_for_others_are_ignored(self):
        plain = read("a.pimg")
        for hints in (config(nonsense=1), config(beta=3.0), config(hdr_compress=0)):
            self.assertTrue(np.array_equal(read("a.pimg", config=hints), plain))

    def test_segment_gives_labels_as_they_are(self):
        labels = read("a.pimg?segment=30")
        self.assertEqual(labels.shape, (60, 90, 1))
        self.assertEqual(sorted(np.unique(labels)), list(range(30)))
        self.ok("oiiotool", "a.pimg?segment=30", "-d", "float", "-o", "labels.exr")
        self.assertTrue(np.array_equal(read("labels.exr"), labels))
        self.assertEqual(set(np.unique(read("a.pimg?segment=30&output=boundaries"))), {0.0, 1.0})

    def test_dual_pieces_of_a_level(self):
        labels = read("a.pimg?dual_pieces=1&vertices=200")
        self.assertEqual(sorted(np.unique(labels)), list(range(200)))

    def test_wrong_queries_say_what_is_known(self):
        for query, says in (
            ("lowpas=3", ["lowpas", "feature_lowpass", "hdr_compress", "s0", "mip", "guide"]),
            ("hdr_compress=1&betta=3", ["betta", "beta"]),
            ("beta=3", ["beta needs hdr_compress"]),
            ("hdr_compress=maybe", ["hdr_compress", "maybe"]),
            ("hdr_compress=1&s0=7", ["s0", "7"]),
            ("hdr_compress=1&level=3", ["level and hdr_compress", "one filter"]),
            ("feature_lowpass=", ["splits"]),
            ("segment=30&stats=a.csv", ["stats", "pimgtool"]),
            ("faces=10&vertices=10", ["faces"]),
        ):
            self.fails("iconvert", "a.pimg?" + query, "out.png", says=says)
            with self.assertRaises(RuntimeError) as refused:  # such a name opens; its first pixels are refused
                read("a.pimg?" + query)
            for word in says:
                self.assertIn(word, str(refused.exception))
            self.fails("oiiotool", "a.pimg?" + query, "-o", "b.exr", says=says)
        self.fails("oiiotool", "a.pimg?mip", "-o", "b.exr", says="a.pimg?mip")
        self.fails("oiiotool", "--iconfig", "pimg:feature_lowpass", "much", "a.pimg", "-o", "b.exr", says="much")

    def test_expressions_make_queries(self):
        self.ok("oiiotool", "--frames", "1-3", "a.pimg?level={FRAME_NUMBER*100}", "-o", "out.#.exr")
        self.assertFalse(np.array_equal(read("out.0001.exr"), read("out.0003.exr")))


class Results(plugin_files.PluginTest):
    def test_a_stored_hierarchy_gives_what_building_gives(self):
        hdr = scene(90, 60, 4) ** 3 * 200
        write("compact.pimg", hdr, "half")
        write("full.pimg", hdr, "half", {"pimg:profile": "full"})
        self.assertTrue(np.array_equal(read("compact.pimg"), read("full.pimg")))
        for query in FILTERS:
            built, stored = read("compact.pimg?" + query), read("full.pimg?" + query)
            scale = max(np.abs(built).max(), 1e-3)
            # The order of splits within a batch, a few percent of a level, is not stored.
            self.assertLess(np.abs(built - stored).mean() / scale, 0.02, query)
            if not query.startswith("wireframe"):
                self.assertTrue(np.array_equal(built[..., 3], stored[..., 3]), query)

    def test_header_tells_what_reading_gives(self):
        write("a.pimg", scene(90, 60), "uint8", {"pimg:profile": "full", "oiio:ColorSpace": "sRGB"})
        for query in FILTERS:
            spec = opened("a.pimg?" + query).spec()
            filtered = "hdr" in query or "detail" in query
            self.assertEqual(str(spec.format), "float" if filtered else "uint8", query)
            self.assertEqual((spec.width, spec.height, spec.nchannels), (90, 60, 3))
            self.assertIsNone(spec.getattribute("thumbnail_width"))
        self.assertEqual(opened("a.pimg?hdr_compress=1&display=1").spec()["oiio:ColorSpace"], "sRGB")
        self.assertNotEqual(opened("a.pimg?hdr_compress=1").spec()["oiio:ColorSpace"], "sRGB")
        light, display = read("a.pimg?hdr_compress=1"), read("a.pimg?hdr_compress=1&display=1")
        encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 0) ** (1 / 2.4) - 0.055)
        self.assertLess(np.abs(encoded - display).max(), 1e-4)

    def test_all_splits_are_the_picture(self):
        write("a.pimg", scene(90, 60), "uint8", {"pimg:profile": "full"})
        for query in ("fraction=1", "feature_lowpass=100000", "detail_enhance=1", "guide=rgb&fraction=1"):
            self.assertTrue(np.array_equal(read("a.pimg?" + query, oiio.UINT8), read("a.pimg", oiio.UINT8)), query)

    def test_windows_and_levels_go_with_filters(self):
        write("a.pimg", scene(90, 60), "half", {"pimg:profile": "full"}, origin=(-9, 7), full=(0, 0, 200, 100))
        spec = opened("a.pimg?level=50&mip=1").spec()
        self.assertEqual((spec.x, spec.y, spec.full_width, spec.tile_width), (-9, 7, 200, 64))
        self.ok("oiiotool", "a.pimg?level=50&mip=1", "-o", "b.exr")
        self.assertTrue(np.array_equal(read("b.exr"), read("a.pimg?level=50")))

    def test_every_program_sees_the_filter(self):
        write("a.pimg", scene(90, 60), "half", {"pimg:profile": "full"})
        wanted = read("a.pimg?level=50")
        self.ok("iconvert", "a.pimg?level=50", "b.exr")
        self.assertTrue(np.array_equal(read("b.exr"), wanted))
        self.ok("idiff", "b.exr", "a.pimg?level=50")
        buffer = oiio.ImageBuf("a.pimg?level=50")
        self.assertTrue(np.array_equal(buffer.get_pixels(oiio.FLOAT), wanted))
        self.assertIn("90 x   60", self.ok("iinfo", "a.pimg?level=50"))


class Thumbnails(plugin_files.PluginTest):
    def test_the_length_of_the_mesh_layer_does_not_spoil_them(self):
        """As many vertices as make a difference at that size, or all there are. A strip has a thumbnail of few pixels."""
        pixels = scene(4000, 100, 1)

        def thumbnail(vertices):
            write("a.pimg", pixels, "half", {"pimg:vertices": vertices})
            made = opened("a.pimg").get_thumbnail()
            self.assertEqual(made.spec().width, 256)
            return made.get_pixels(oiio.FLOAT)

        usual = thumbnail(0.015)
        for vertices in (0.2, 0.004):
            # 0.046 and 0.020 when the number of vertices was guessed instead of read.
            self.assertLess(np.abs(thumbnail(vertices) - usual).max(), 0.008, vertices)


if __name__ == "__main__":
    unittest.main()
