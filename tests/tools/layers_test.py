# SPDX-License-Identifier: BSD-3-Clause
"""Which channels are the picture, and what becomes of the others."""

import unittest

import numpy as np

import pictures
from pictures import read, spec_of

COLOUR = pictures.scene(48, 32)
DATA = np.linspace(1, 100, 48 * 32).reshape(32, 48)


def render(name, layers, kind="float"):
    """Writes layers given as {prefix: pixels with as many channels as the letters after the last dot}."""
    names, planes = [], []
    for prefix, (letters, pixels) in layers.items():
        for i, letter in enumerate(letters):
            names.append(f"{prefix}.{letter}" if prefix else letter)
            planes.append(pixels[..., i] if pixels.ndim == 3 else pixels)
    pictures.write(name, np.dstack(planes), kind, names=tuple(names))


class LayersTest(pictures.ToolTest):
    def changed(self, name, *arguments):
        """Names of the channels that a filter changes."""
        self.ok(name, *arguments, "--hdr-compress", "-d", "float", "-o", "changed.exr")
        before, after = read(name), read("changed.exr")
        names = spec_of(name).channelnames
        self.assertEqual(spec_of("changed.exr").channelnames, names)
        return {n for i, n in enumerate(names) if not np.array_equal(before[..., i], after[..., i])}


class Choice(LayersTest):
    def test_usual_layers(self):
        normal = ("XYZ", COLOUR[..., ::-1] - 0.4)
        for layer in ("rgba", "Color", "beauty", "ViewLayer.Combined", "C", "diffuse"):
            render("in.exr", {"N": normal, "crypto00": ("rgba", DATA), layer: ("RGB", COLOUR)})
            self.assertEqual(self.changed("in.exr"), {f"{layer}.{c}" for c in "RGB"}, layer)
        render("in.exr", {"ViewLayer.AO": ("RGB", COLOUR / 2), "ViewLayer.Combined": ("RGB", COLOUR)})
        self.assertEqual(self.changed("in.exr"), {f"ViewLayer.Combined.{c}" for c in "RGB"})
        render("in.exr", {"diffuse": ("RGB", COLOUR / 2), "": ("RGB", COLOUR)})
        self.assertEqual(self.changed("in.exr"), set("RGB"))

    def test_layer_by_name(self):
        render("in.exr", {"key": ("RGB", COLOUR), "fill": ("RGB", COLOUR / 3), "N": ("XYZ", COLOUR - 0.4)})
        self.fails("in.exr", "--hdr-compress", "-o", "out.exr", says=("--layer NAME", "key", "fill", "N"))
        self.fails("in.exr", "--layer", "rim", "--hdr-compress", "-o", "out.exr", says=("rim", "key", "fill"))
        self.fails("in.exr", "-o", "out.png", says=("--layer NAME", "key"))
        self.assertEqual(self.changed("in.exr", "--layer", "FILL"), {f"fill.{c}" for c in "RGB"})
        self.assertEqual(self.changed("in.exr", "--build:layer=key"), {f"key.{c}" for c in "RGB"})
        self.ok("in.exr", "--layer", "fill", "-d", "float", "--hdr-compress", "-o", "fill.tif", "-d", "uint8", "-o", "fill.png")
        self.assertEqual(read("fill.png").shape[2], 3)
        render("fill.exr", {"": ("RGB", COLOUR / 3)})
        self.ok("fill.exr", "--hdr-compress", "-o", "expected.png")
        self.assert_same("fill.png", "expected.png")


class Output(LayersTest):
    def test_formats_without_names_get_colour_and_real_alpha(self):
        alpha = np.full((32, 48), 0.5)
        render("z.exr", {"": ("RGBZ", np.dstack([COLOUR, DATA]))})
        render("a.exr", {"": ("ABGRZ", np.dstack([alpha, COLOUR[..., ::-1] / 2, DATA]))})
        render("many.exr", {"": ("RGB", COLOUR), "N": ("XYZ", COLOUR), "crypto00": ("rgba", DATA)})
        for name, channels, left_out in (("z.exr", 3, ("Z",)), ("a.exr", 4, ("Z",)), ("many.exr", 3, ("N.X", "crypto00.a"))):
            done = self.ok(name, "--hdr-compress", "-o", "out.png")
            self.assertEqual(read("out.png").shape[2], channels, name)
            for channel in left_out:
                self.assertIn(channel, done.stderr)
        self.ok("a.exr", "-o", "out.png")
        self.assertTrue(np.allclose(read("out.png")[..., 3], 0.5, atol=0.01))

    def test_data_channels_keep_their_type(self):
        ids = DATA * 123456.7
        render("in.exr", {"": ("RGBZ", np.dstack([COLOUR, DATA * 1000])), "crypto00": ("rg", ids), "N": ("XYZ", COLOUR)})
        self.ok("in.exr", "--hdr-compress", "-d", "half", "-o", "out.exr")
        before, after = read("in.exr"), read("out.exr")
        self.assertTrue(np.array_equal(before[..., 3:], after[..., 3:]))
        types = [str(t) for t in spec_of("out.exr").channelformats]
        self.assertEqual(types, ["half"] * 3 + ["float"] * 6)
        self.ok("in.exr", "--hdr-compress", "-d", "half", "-d", "Z=half", "-d", "N=half", "-o", "out.exr")
        self.assertEqual([str(t) for t in spec_of("out.exr").channelformats], ["half"] * 4 + ["float"] * 2 + ["half"] * 3)
        self.fails("in.exr", "-d", "Z=quarter", "-o", "out.exr", says=("Z=quarter", "half"))

    def test_labels_never_through_a_lossy_codec(self):
        pixels = np.random.default_rng(1).random((64, 64, 3))
        for compression in ("pxr24", "dwaa", "b44"):
            pictures.write("in.exr", pixels, "half", {"compression": compression})
            done = self.ok("in.exr", "--segment:regions=3000", "-o", "labels.exr", "in.exr", "--segment:regions=3000", "-o", "l.tif")
            self.assertIn("zip", done.stderr)
            self.assertEqual(spec_of("labels.exr")["compression"], "zip")
            self.assertTrue(np.array_equal(read("labels.exr"), read("l.tif")), compression)


if __name__ == "__main__":
    unittest.main()
