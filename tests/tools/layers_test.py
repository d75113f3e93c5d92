# SPDX-License-Identifier: BSD-3-Clause
"""Which channels of a file are the picture, and what becomes of the others."""

import unittest

import numpy as np
import OpenImageIO as oiio

import pictures

DATA = np.random.default_rng(5)


def layered(*layers):
    """Channels and their names, of (names, values) pairs."""
    names = [name for these, _ in layers for name in these]
    return np.concatenate([np.atleast_3d(values) for _, values in layers], axis=2), names


class LayersTest(pictures.ToolTest):
    def setUp(self):
        super().setUp()
        self.picture = pictures.hdr_scene(64, 48)

    def layers(self, prefix, values=None):
        values = self.picture if values is None else values
        return [prefix + c for c in "RGBA"[: values.shape[2]]], values

    def changed(self, before, after):
        """Names of the channels whose samples are not the same in both files."""
        names = spec_names(after)
        self.assertEqual(spec_names(before), names)
        a, b = pictures.read(before), pictures.read(after)
        return [n for i, n in enumerate(names) if not np.array_equal(a[..., i], b[..., i])]

    def warned(self, *arguments):
        """Runs a command that succeeds and returns what it says on standard error."""
        done = self.run_tool(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr

    def write_layers(self, name, *layers, kind="float"):
        values, names = layered(*layers)
        pictures.write(name, values, kind, names=names)


def spec_names(name):
    return list(pictures.spec_of(name).channelnames)


class Which(LayersTest):
    def test_the_picture_is_found(self):
        normals = (["N.X", "N.Y", "N.Z"], DATA.normal(0, 1, (48, 64, 3)))
        other = DATA.random((48, 64, 3))
        for expected, layers in (
            ("", [normals, self.layers("AO.", other), self.layers("")]),
            ("albedo.", [normals, self.layers("albedo.")]),
            ("ViewLayer.Combined.", [self.layers("ViewLayer.AO.", other), self.layers("ViewLayer.Combined.")]),
            ("rgba.", [self.layers("diffuse.", other), self.layers("rgba.")]),
            ("beauty.", [self.layers("crypto00.", other), self.layers("beauty.")]),
            ("C.", [self.layers("A.", other), self.layers("C.")]),
        ):
            with self.subTest(expected=expected):
                self.write_layers("in.exr", *layers)
                self.ok("in.exr", "--hdr-compress", "-o", "out.exr")
                self.assertEqual(sorted(self.changed("in.exr", "out.exr")), sorted(expected + c for c in "RGB"))

    def test_several_layers_are_listed_and_one_can_be_named(self):
        self.write_layers("in.exr", self.layers("key.", DATA.random((48, 64, 3))), self.layers("fill."))
        self.fails("in.exr", "--hdr-compress", "-o", "out.exr", says="one of fill, key")
        self.fails("in.exr", "--layer", "rim", "--hdr-compress", "-o", "out.exr", says="expected one of fill, key")
        for words in (("--layer", "fill", "--hdr-compress"), ("--build:layer=fill", "--hdr-compress")):
            self.ok("in.exr", *words, "-o", "out.exr")
            self.assertEqual(sorted(self.changed("in.exr", "out.exr")), ["fill.B", "fill.G", "fill.R"])

    def test_a_layer_is_named_while_reading(self):
        self.write_layers("in.exr", self.layers("key.", DATA.random((48, 64, 3))), self.layers("fill."))
        self.ok("in.exr", "--layer", "fill", "-d", "float", "-o", "in.pimg")
        self.ok("in.exr", "--layer", "fill", "--hdr-compress", "-d", "float", "-o", "expected.exr")
        self.ok("in.pimg?hdr_compress=1&layer=fill", "-d", "float", "-o", "out.exr")
        np.testing.assert_allclose(pictures.read("out.exr"), pictures.read("expected.exr"), rtol=1e-5, atol=1e-6)


class WithoutNames(LayersTest):
    """Formats that hold a picture and its alpha."""

    def test_depth_is_no_alpha(self):
        depth = 3 + DATA.random((48, 64, 1))
        self.write_layers("in.exr", self.layers(""), (["Z"], depth))
        said = self.warned("in.exr", "--hdr-compress", "-o", "out.png")
        self.assertEqual(pictures.spec_of("out.png").nchannels, 3)
        self.assertIn("without Z", said)

    def test_many_channels_leave_the_picture_and_its_alpha(self):
        alpha = np.linspace(0, 1, 48 * 64).reshape(48, 64, 1)
        more = [([f"more{i}.X"], DATA.random((48, 64, 1))) for i in range(14)]
        self.write_layers("in.exr", *more, self.layers("Combined.", np.concatenate([self.picture * alpha, alpha], 2)))
        for name, channels in (("out.png", 4), ("out.jpg", 3), ("out.tif", 18)):
            with self.subTest(name=name):
                said = self.warned("in.exr", "--hdr-compress", "-d", "uint8", "-o", name)
                self.assertEqual(pictures.spec_of(name).nchannels, channels)
                self.assertEqual("warning" in said, channels < 18)
        np.testing.assert_allclose(pictures.read("out.png")[..., 3:], alpha, atol=0.6 / 255)


class Alpha(LayersTest):
    def test_nothing_is_drawn_where_there_is_no_picture(self):
        y, x = np.mgrid[0:48, 0:64]
        alpha = (np.hypot(x - 40, y - 24) < 14).astype(np.float32)[..., None]
        pictures.write("cut.exr", np.concatenate([pictures.scene(64, 48) * alpha, alpha], 2), "half",
                       names=("R", "G", "B", "A"))
        for operation in ("--ink", "--wireframe:faces=90", "--wireframe:faces=90:overlay=1", "--mosaic:tiles=60", "--paint",
                          "--paint:canvas=white:impasto=0.5:jitter_colour=0.5"):
            with self.subTest(operation=operation):
                self.ok("cut.exr", operation, "-d", "float", "-o", "out.exr")
                result = pictures.read("out.exr")
                self.assertEqual(np.abs(result[..., :3][result[..., 3] == 0]).max(), 0)
                self.assertGreater(result[..., :3][result[..., 3] == 1].max(), 0.2)

    def test_soft_edges_keep_their_straight_colour(self):
        y, x = np.mgrid[0:48, 0:64]
        alpha = np.clip((40 - x) / 20, 0, 1)[..., None] * np.ones((48, 1, 1))
        pictures.write("soft.exr", np.concatenate([0.4 * alpha] * 3 + [alpha], 2), "float", names=("R", "G", "B", "A"))
        self.ok("soft.exr", "--hdr-compress", "-o", "out.exr")
        result = pictures.read("out.exr")
        straight = (result[..., 0] / np.maximum(result[..., 3], 1e-6))[result[..., 3] > 0.04]
        self.assertLess(straight.max() / straight.min(), 1.1)

    def test_paint_is_associated_with_alpha(self):
        y, x = np.mgrid[0:48, 0:64]
        alpha = np.clip((44 - np.hypot(x - 32, 2 * y - 48)) / 16, 0, 1)[..., None]
        for kind, name in (("float", "soft.exr"), ("uint8", "soft.png")):
            picture = pictures.scene(64, 48)
            pictures.write(name, np.concatenate([picture * alpha, alpha], 2), kind, names=("R", "G", "B", "A"))
            for options in ("", ":canvas=0.9,0.1,0.1", ":opacity=0.6:impasto=0.5"):
                with self.subTest(kind + options):
                    self.ok(name, "--paint" + options, "-d", kind, "-o", "out" + name[-4:])
                    result = pictures.read("out" + name[-4:])
                    # Paint is as bright as the picture, a little lit; PNG rounds small alpha.
                    most = 1.35 if kind == "float" else 1.0
                    self.assertTrue(np.all(result[..., :3] <= most * result[..., 3:] + 0.02))
                    soft = (result[..., 3] > 0.1) & (result[..., 3] < 0.6)
                    straight = result[..., :3][soft] / result[..., 3:][soft]
                    self.assertLess(np.abs(straight - picture[soft]).mean(), 0.12)

    def test_paint_of_opaque_pixels_does_not_know_of_alpha(self):
        picture = pictures.scene(64, 48)
        pictures.write("rgb.exr", picture, "float", names=("R", "G", "B"))
        pictures.write("rgba.exr", np.concatenate([picture, np.ones((48, 64, 1))], 2), "float",
                       names=("R", "G", "B", "A"))
        self.ok("rgb.exr", "--paint:impasto=0.5", "-o", "a.exr", "rgba.exr", "--paint:impasto=0.5", "-o", "b.exr")
        np.testing.assert_array_equal(pictures.read("a.exr"), pictures.read("b.exr")[..., :3])

    def test_tiles_at_the_edge_are_as_bright_as_others(self):
        y, x = np.mgrid[0:48, 0:64]
        alpha = np.clip((40 - x) / 20, 0, 1)[..., None] * np.ones((48, 1, 1))
        pictures.write("soft.exr", np.concatenate([0.4 * alpha] * 3 + [alpha], 2), "float", names=("R", "G", "B", "A"))
        self.ok("soft.exr", "--mosaic:tiles=60:grout=0:bevel=0:variation=0", "-o", "out.exr")
        result = pictures.read("out.exr")
        np.testing.assert_allclose(result[..., 0], 0.4 * result[..., 3], rtol=0.05, atol=1e-4)


class Orientation(LayersTest):
    """A picture stored on its side."""

    def setUp(self):
        super().setUp()
        self.upright = pictures.scene(64, 48)
        pictures.write("side.tif", np.rot90(self.upright, 1), "float", {"Orientation": 6})
        pictures.write("upright.tif", self.upright, "float")

    def test_formats_that_cannot_say_it_get_it_upright(self):
        for name in ("out.exr", "out.pimg", "out.png"):
            self.ok("side.tif", "-o", name, "upright.tif", "-o", "expected_" + name)
            self.assert_same(name, "expected_" + name)
            self.assertEqual(pictures.spec_of(name).getattribute("Orientation") or 1, 1)

    def test_the_others_keep_it_unless_told(self):
        self.ok("side.tif", "-o", "out.tif")
        self.assert_same("out.tif", "side.tif")
        self.assertEqual(pictures.spec_of("out.tif")["Orientation"], 6)
        self.ok("side.tif", "--autoorient", "-o", "out.tif")
        self.assert_same("out.tif", "upright.tif")

    def test_strokes_are_upright(self):
        self.ok("side.tif", "--paint:strokes=out.svg", "-o", "out.tif", "upright.tif", "--paint:strokes=expected.svg",
                "-o", "expected.tif")
        with open("out.svg") as out, open("expected.svg") as expected:
            self.assertEqual(out.read(), expected.read())


class Types(LayersTest):
    def test_data_keep_their_type(self):
        ids = (DATA.random((48, 64, 2)) * 1e9).astype(np.float32)
        depth = 1e5 + DATA.random((48, 64, 1))
        self.write_layers("in.exr", self.layers(""), (["crypto00.r", "crypto00.g"], ids), (["Z"], depth))
        self.ok("in.exr", "--hdr-compress", "-d", "half", "-o", "out.exr")
        self.assertEqual(sorted(self.changed("in.exr", "out.exr")), ["B", "G", "R"])
        spec = pictures.spec_of("out.exr")
        self.assertEqual(str(spec.channelformat(spec.channelindex("R"))), "half")
        self.assertEqual(str(spec.channelformat(spec.channelindex("Z"))), "float")

    def test_the_type_of_one_channel(self):
        self.write_layers("in.exr", self.layers(""), (["Z"], 1 + DATA.random((48, 64, 1))))
        self.ok("in.exr", "-d", "Z=half", "-o", "out.exr")
        spec = pictures.spec_of("out.exr")
        self.assertEqual([str(spec.channelformat(i)) for i in range(4)], ["float", "float", "float", "half"])
        self.fails("in.exr", "-d", "=half", "-o", "out.exr", says="CHANNEL=TYPE")

    def test_labels_survive_any_compression(self):
        pictures.write("in.exr", self.picture, "float", {"compression": "pxr24"})
        self.warned("in.exr", "--dual-pieces:splits=2500", "-o", "lossy.exr")
        self.warned("in.exr", "--dual-pieces:splits=2500", "-o", "whole.tif")
        np.testing.assert_array_equal(pictures.read("lossy.exr"), pictures.read("whole.tif", oiio.UINT32))


if __name__ == "__main__":
    unittest.main()
