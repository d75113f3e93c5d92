# SPDX-License-Identifier: BSD-3-Clause
"""Effects of OpenFX: the pixels of pimgtool, whatever a host asks for and however it holds its images."""

import unittest

import numpy as np

import ofx_host
import pictures

# Two settings of each effect; words are those of pimgtool.
SETTINGS = (
    ("level", "fraction=0.1"),
    ("level", "faces=300"),
    ("wireframe", "fraction=0.05"),
    ("wireframe", "splits=200:overlay=1"),
    ("feature_lowpass", ""),
    ("feature_lowpass", "strength=0.4:log=1"),
    ("detail_enhance", "gain=3"),
    ("detail_enhance", "curve=0:1,0.2:3,1:2"),
    ("hdr_compress", ""),
    ("hdr_compress", "beta=4:s0=0.3:exposure=0.7"),
    ("hdr_compress", "fit=0"),
    ("dual_pieces", "fraction=0.1"),
    ("dual_pieces", "vertices=200:output=mean"),
    ("segment", "regions=30"),
    ("segment", "regions=30:output=boundaries"),
    ("paint", ""),
    ("paint", "min=4:max=12:seed=5:canvas=white"),
    ("mosaic", "tiles=300"),
    ("mosaic", "tiles=200:colour=0.5:grout=3"),
    ("ink", ""),
    ("ink", "cross=0:density=2"),
)


class Effects(ofx_host.HostTest):
    def assert_same(self, result, expected):
        """Results of one channel are in every colour."""
        if expected.shape[2] == 1 and result.shape[2] > 1:
            expected = np.repeat(expected, 3, axis=2)
        self.assertTrue(np.array_equal(result[..., : expected.shape[2]], expected))

    def test_the_same_bits_as_pimgtool(self):
        arguments = ["in.exr", "-d", "float"]
        for i, (effect, options) in enumerate(SETTINGS):
            command = "--" + effect.replace("_", "-") + (":" + options if options else "")
            arguments += ["--dup", command, "-o", f"tool{i}.exr", "--pop"]
        self.ok(*arguments)
        for i, (effect, options) in enumerate(SETTINGS):
            with self.subTest(effect=effect, options=options):
                self.assert_same(self.render(effect, *_split(options)), pictures.read(f"tool{i}.exr"))

    def test_options_of_the_hierarchy(self):
        result = self.render("mosaic", "tiles=300", "build_guide=lab", "build_base=64")
        self.ok("in.exr", "--build:guide=lab:base=64", "--mosaic:tiles=300", "-d", "float", "-o", "tool.exr")
        self.assert_same(result, pictures.read("tool.exr"))

    def test_tiles_and_places_change_nothing(self):
        for effect in ("hdr_compress", "segment"):
            whole = self.render(effect)
            for more in (("--tile", 33), ("--tile", 17, "--threads", 3), ("--left", -40, "--bottom", 13),
                         ("--context", "general")):
                with self.subTest(effect=effect, more=more):
                    self.assertTrue(np.array_equal(self.render(effect, *more), whole))

    def test_rgb_and_alpha(self):
        ofx_host.write("rgb.exr", ofx_host.scene(90, 70, alpha=False))
        self.assert_same(self.render("hdr_compress", "--components", "rgb", source="rgb.exr"),
                         self.tool("hdr_compress", source="rgb.exr"))
        pictures.write("mask.exr", ofx_host.scene(90, 70)[..., 3:], "float", names=["Y"])
        result = self.render("feature_lowpass", "strength=0.1", "--components", "alpha", source="mask.exr")
        self.assert_same(result, self.tool("feature_lowpass", "strength=0.1", source="mask.exr"))

    def test_straight_alpha(self):
        """Colours that are not premultiplied are multiplied with alpha, filtered, and divided. Multiplied and divided once
        more they would differ in last bits, on which the order of collapses depends: where details are amplified four
        times, such a picture differs from this one by up to 2 %."""
        straight = ofx_host.scene(90, 70).astype(np.float32)
        cover = straight[..., 3:]
        straight[..., :3] = np.where(cover > 0, straight[..., :3] / np.maximum(cover, 1e-9), 0)
        ofx_host.write("straight.exr", straight)
        ofx_host.write("associated.exr", np.concatenate([straight[..., :3] * cover, cover], axis=2))
        for effect in ("hdr_compress", "feature_lowpass", "detail_enhance"):
            result = self.render(effect, "--straight", 1, source="straight.exr")
            expected = self.tool(effect, source="associated.exr")
            self.assertLess(np.abs(result[..., :3] * cover - expected[..., :3]).max(), 1e-6 * expected.max(), effect)
            self.assertTrue(np.array_equal(result[..., 3], expected[..., 3]))

    def test_straight_alpha_of_eight_bits(self):
        """Little alpha does not make colours coarse."""
        colours = pictures.scene(90, 70)
        alpha = np.linspace(0.05, 1, 90)[None, :, None] * np.ones((70, 1, 1))
        ofx_host.write("in8.exr", np.concatenate([colours, alpha], axis=2))
        result = self.render("feature_lowpass", "strength=0", "--straight", 1, "--depth", "byte", source="in8.exr")
        self.assertLessEqual(np.abs(result[..., :3] - colours).max() * 255, 1.01)

    def test_shapes_of_pixels_and_memory_change_nothing(self):
        whole = self.render("hdr_compress")
        for more in (("--aspect", 2, "--left", 30, "--tile", 40), ("--top-down", 1), ("--top-down", 1, "--tile", 33),
                     ("--without-end", 1, "--left", -7, "--bottom", 11), ("--without-end", 1, "--aspect", 0.5)):
            with self.subTest(more=more):
                self.assertTrue(np.array_equal(self.render("hdr_compress", *more), whole))

    def test_whole_numbers_are_those_of_files(self):
        display = pictures.scene(90, 70)
        for depth, kind, steps in (("byte", "uint8", 255), ("short", "uint16", 65535)):
            with self.subTest(depth=depth):
                pictures.write("in.tif", display, kind)
                for effect in ("hdr_compress", "detail_enhance", "feature_lowpass"):
                    result = self.render(effect, "--depth", depth, "--components", "rgb", source="in.tif")
                    self.ok("in.tif", "--" + effect.replace("_", "-"), "-d", kind, "-o", "tool.tif")
                    expected = pictures.read("tool.tif")
                    self.assertLessEqual(np.abs(result - expected).max() * steps, 1.001, effect)

    def test_labels_need_room(self):
        said = self.host("render", "segment", "in.exr", "out.exr", "regions=300", "--depth", "byte", status=1)
        self.assertIn("300 labels", said)
        result = self.render("segment", "regions=200", "--depth", "byte") * 255
        self.assertEqual(len(np.unique(np.rint(result[..., 0]))), 200)

    def test_a_field_is_every_other_line(self):
        whole, lower, upper = (self.render("feature_lowpass", "--field", field) for field in ("none", "lower", "upper"))
        # Lines count from below.
        self.assertTrue(np.array_equal(lower[::-1][0::2], whole[::-1][0::2]))
        self.assertTrue(np.array_equal(upper[::-1][1::2], whole[::-1][1::2]))
        self.assertFalse(np.array_equal(lower[::-1][1::2], whole[::-1][1::2]))

    def test_identity(self):
        for effect, options, expected in (
            ("feature_lowpass", "strength=0", 1), ("feature_lowpass", "strength=0.1", 0), ("feature_lowpass", "noise=0", 1),
            ("detail_enhance", "gain=1", 1), ("detail_enhance", "gain=2", 0), ("detail_enhance", "gain=1 curve=0:2", 0),
            ("paint", "opacity=0", 1), ("paint", "opacity=0 canvas=white", 0), ("paint", "opacity=0 style=wash", 0), ("hdr_compress", "", 0),
        ):
            said = self.host("render", effect, "in.exr", "out.exr", *options.split(), "--identity", 1)
            self.assertIn(f"identity: {expected}", said, (effect, options))
            if expected:
                self.assert_same(self.render(effect, *options.split()), pictures.read("in.exr"))

    def test_lengths_follow_proxies(self):
        """A stroke, a joint or a line covers the same share of a smaller picture."""
        ofx_host.write("step.exr", np.repeat(np.repeat(ofx_host.scene(64, 64), 4, axis=0), 4, axis=1))
        half, full = (self.render("mosaic", "tiles=150", "grout=8", "colour=white", "--scale", scale, source="step.exr")
                      for scale in (0.5, 1))
        self.assertEqual(half.shape[0] * 2, full.shape[0])
        share = [(picture[..., 0] >= 0.999).mean() for picture in (half, full)]
        self.assertLess(abs(share[0] - share[1]), 0.35 * share[1])


def _split(options):
    """key=value words of option text; a colon before a digit, sign or point belongs to the value."""
    words = []
    for word in filter(None, options.split(":")):
        if words and word[0] in "+-.0123456789":
            words[-1] += ":" + word
        else:
            words.append(word)
    return words


if __name__ == "__main__":
    unittest.main()
