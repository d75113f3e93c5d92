# SPDX-License-Identifier: BSD-3-Clause
"""One scene, stored with several primaries and encodings, gives one picture."""

import os
import struct
import unittest
import zlib

import numpy as np
import OpenImageIO as oiio

import pictures
from pictures import codes, read, spec_of
from colour_test import ACES

PRIMARIES = {
    "lin_rec709": [0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290],
    "lin_rec2020": [0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.3290],
    "ACEScg": [0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767],
    "ACES2065-1": [0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767],
    "lin_ciexyzd65_scene": [1, 0, 0, 1, 0, 0, 0.3127, 0.3290],
    "equal energy XYZ": [1, 0, 0, 1, 0, 0, 1 / 3, 1 / 3],
}
BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])


def to_xyz(primaries):
    xy = np.array(primaries).reshape(4, 2)
    xyz = np.column_stack([xy, 1 - xy.sum(1)])
    white = xyz[3] / xyz[3, 1]
    return xyz[:3].T * np.linalg.solve(xyz[:3].T, white), white


def matrix(source, target):
    (a, white_a), (b, white_b) = to_xyz(source), to_xyz(target)
    cones = np.diag(BRADFORD @ white_b / (BRADFORD @ white_a))
    return np.linalg.inv(b) @ np.linalg.inv(BRADFORD) @ cones @ BRADFORD @ a


def patches():
    """Eight saturated and grey patches, each from dark to light."""
    colours = np.array([[.4, .05, .04], [.05, .3, .06], [.04, .06, .4], [.5, .4, .06], [.06, .3, .4], [.35, .06, .3],
                        [.18, .18, .18], [.7, .65, .6]])
    y, x = np.mgrid[0:96, 0:128]
    return colours[x // 32 + 4 * (y // 48)] * np.exp2(5 * y / 96)[..., None]


def stored_as(name):
    return patches() @ matrix(PRIMARIES["lin_rec709"], PRIMARIES[name]).T


def encoded(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)


class PrimariesTest(pictures.ToolTest):
    def setUp(self):
        super().setUp()
        with open("aces.ocio", "w", encoding="utf-8") as config:
            config.write(ACES)
        self.aces = os.path.abspath("aces.ocio")
        for name, primaries in PRIMARIES.items():
            self.write(f"{name}.exr", stored_as(name), primaries)

    def write(self, name, pixels, primaries):
        spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, "float")
        spec.attribute("chromaticities", oiio.TypeDesc("float[8]"), tuple(primaries))
        picture = oiio.ImageBuf(spec)
        picture.set_pixels(picture.roi, np.ascontiguousarray(pixels, dtype=np.float32))
        self.assertTrue(picture.write(name))

    def assert_codes(self, name, other, difference=2):
        self.assertLessEqual(np.abs(codes(name)[..., :3].astype(int) - codes(other)[..., :3]).max(), difference, name)

    def run_on_all(self, *arguments, **options):
        self.ok(*[word for name in PRIMARIES for word in (f"{name}.exr", *arguments, "-o", f"{name}.png")], **options)
        for name in PRIMARIES:
            self.assert_codes(f"{name}.png", "lin_rec709.png")
            self.assertIn(spec_of(f"{name}.png")["oiio:ColorSpace"], pictures.SRGB)


class Chromaticities(PrimariesTest):
    def test_one_picture_whatever_the_primaries(self):
        self.run_on_all("--hdr-compress")
        expected = codes("lin_rec709.png")
        self.run_on_all("--hdr-compress", env={"OCIO": self.aces})
        self.assertLessEqual(np.abs(codes("ACEScg.png").astype(int) - expected).max(), 2)

    def test_written_plainly(self):
        """Colours within Rec. 709 come out as the sRGB curve of their Rec. 709 values."""
        for environment in ({}, {"OCIO": self.aces}):
            self.run_on_all(env=environment)
            expected = np.round(np.clip(encoded(patches()), 0, 1) * 255)
            self.assertLessEqual(np.abs(codes("ACEScg.png") - expected).max(), 1)

    def test_results_keep_true_metadata(self):
        """What is written as OpenEXR says its primaries, and reads back as the same light."""
        for name in ("lin_rec2020", "equal energy XYZ"):
            self.ok(f"{name}.exr", "--hdr-compress", "-d", "float", "-o", "out.exr", "-d", "uint8", "-o", "at_once.png",
                    "out.exr", "-o", "later.png")
            self.assert_codes("later.png", "at_once.png", 1)

    def test_conversions_start_from_them(self):
        for environment in ({}, {"OCIO": self.aces}):
            for name in ("ACEScg", "lin_rec2020"):
                space = "ACES2065-1" if environment else "sRGB"
                self.ok(f"{name}.exr", "-d", "float", "--tocolorspace", space, "-o", "to.exr", env=environment)
                expected = stored_as("ACES2065-1") if environment else encoded(patches())
                self.assertTrue(np.allclose(read("to.exr"), expected, rtol=2e-3, atol=2e-3), name)

    def test_chromaticities_beat_file_rules(self):
        os.rename("lin_rec709.exr", "a_plate.exr")
        self.ok("--ocio", self.aces, "a_plate.exr", "--hdr-compress", "-o", "plate.png",
                "ACEScg.exr", "--hdr-compress", "-o", "ACEScg.png")
        self.assert_codes("plate.png", "ACEScg.png")


class Names(PrimariesTest):
    def test_said_by_the_user_or_a_rule(self):
        self.ok("lin_rec709.exr", "--hdr-compress", "-o", "expected.png")
        for space, stored in (("lin_rec2020", "lin_rec2020"), ("lin_rec2020_scene", "lin_rec2020"), ("ACEScg", "ACEScg"),
                              ("lin_ap1_scene", "ACEScg"), ("lin_ap0", "ACES2065-1"), ("Linear Rec.2020", "lin_rec2020"),
                              ("lin_ciexyzd65_scene", "lin_ciexyzd65_scene"), ("lin_rec709_scene", "lin_rec709")):
            pictures.write("said.exr", stored_as(stored), "float")
            for environment in ({}, {"OCIO": self.aces}):
                with self.subTest(space=space, environment=environment):
                    self.ok("said.exr", "--incolorspace", space, "--hdr-compress", "-o", "said.png",
                            "said.exr", f"--build:incolorspace={space}", "--hdr-compress", "-o", "built.png", env=environment)
                    self.assert_codes("said.png", "expected.png")
                    self.assert_codes("built.png", "expected.png")
        pictures.write("a_plate.exr", stored_as("ACES2065-1"), "float")
        self.ok("--ocio", self.aces, "a_plate.exr", "--hdr-compress", "-o", "plate.png")
        self.assert_codes("plate.png", "expected.png")
        # Untagged, it is what the configuration works in.
        pictures.write("plain.exr", stored_as("ACEScg"), "float")
        self.ok("--ocio", self.aces, "plain.exr", "--hdr-compress", "-o", "plain.png")
        self.assert_codes("plain.png", "expected.png")

    def test_encoded_with_other_primaries(self):
        dim = patches() / 32
        pictures.write("srgb.png", encoded(dim), "uint16")
        self.ok("srgb.png", "--hdr-compress", "-o", "expected.png")
        wide = encoded(dim @ matrix(PRIMARIES["lin_rec709"], PRIMARIES["lin_rec2020"]).T)
        pictures.write("wide.tif", wide, "uint16")
        for environment in ({}, {"OCIO": self.aces}):
            self.ok("wide.tif", "--build:incolorspace=srgb_rec2020", "--hdr-compress", "-o", "wide.png", env=environment)
            self.assert_codes("wide.png", "expected.png")


def s15(value):
    return struct.pack(">i", round(value * 65536))


def icc_profile(primaries, gamma):
    """The bytes of an ICC profile (version 2) for a display: matrix and gamma."""
    to_d50 = np.linalg.inv(BRADFORD) @ np.diag(
        (BRADFORD @ [0.9642, 1, 0.8249]) / (BRADFORD @ to_xyz(primaries)[1])) @ BRADFORD
    colorants = to_d50 @ to_xyz(primaries)[0]
    xyz = lambda v: b"XYZ \0\0\0\0" + b"".join(map(s15, v))
    curve = b"curv\0\0\0\0" + struct.pack(">IH", 1, round(gamma * 256)) + b"\0\0"
    text = b"desc\0\0\0\0" + struct.pack(">I", 5) + b"test\0" + bytes(79)
    tags = {b"desc": text, b"cprt": b"text\0\0\0\0none\0\0\0\0", b"wtpt": xyz([0.9642, 1, 0.8249]),
            b"rXYZ": xyz(colorants[:, 0]), b"gXYZ": xyz(colorants[:, 1]), b"bXYZ": xyz(colorants[:, 2]),
            b"rTRC": curve, b"gTRC": curve, b"bTRC": curve}
    table, body, at = b"", b"", 128 + 4 + 12 * len(tags)
    for name, value in tags.items():
        value += bytes(-len(value) % 4)
        table += name + struct.pack(">II", at + len(body), len(value))
        body += value
    header = struct.pack(">I4sI4s4s4s", at + len(body), b"none", 0x02400000, b"mntr", b"RGB ", b"XYZ ") + bytes(12)
    header += b"acsp" + bytes(28) + s15(0.9642) + s15(1) + s15(0.8249) + bytes(48)
    return header + struct.pack(">I", len(tags)) + table + body


def means(name):
    """The colours of the patches of an 8-bit file, without their borders."""
    return codes(name).reshape(2, 48, 4, 32, 3)[:, 8:-8, :, 8:-8].mean((1, 3))


class Profiles(PrimariesTest):
    ADOBE = [0.64, 0.33, 0.21, 0.71, 0.15, 0.06, 0.3127, 0.3290]
    PROPHOTO = [0.734699, 0.265301, 0.159597, 0.840403, 0.036598, 0.000105, 0.345704, 0.358540]

    def test_pictures_with_icc_profiles(self):
        dim = patches() / 24
        self.write("dim.exr", dim, PRIMARIES["lin_rec709"])
        pictures.write("grey.png", encoded(dim), "uint16")
        self.ok("dim.exr", "--hdr-compress", "-o", "expected.png", "grey.png", "--hdr-compress", "-o", "srgb.png")
        self.assert_codes("srgb.png", "expected.png", 3)
        for primaries, gamma in ((self.ADOBE, 563 / 256), (self.PROPHOTO, 1.8)):
            stored = np.clip(dim @ matrix(PRIMARIES["lin_rec709"], primaries).T, 0, 1) ** (1 / gamma)
            profile = np.frombuffer(icc_profile(primaries, gamma), dtype=np.uint8)
            for name, kind in (("icc.tif", "uint16"), ("icc.png", "uint16"), ("icc8.png", "uint8"), ("icc.jpg", "uint8")):
                spec = oiio.ImageSpec(128, 96, 3, kind)
                spec.attribute("ICCProfile", oiio.TypeDesc(f"uint8[{len(profile)}]"), profile)
                spec.attribute("Compression", "jpeg:100")
                spec.attribute("jpeg:subsampling", "4:4:4")
                picture = oiio.ImageBuf(spec)
                picture.set_pixels(picture.roi, np.ascontiguousarray(stored, dtype=np.float32))
                self.assertTrue(picture.write(name))
                # A JPEG's numbers are not those that were written: what counts is what they mean.
                linear = pictures.read(name) ** gamma @ matrix(primaries, PRIMARIES["lin_rec709"]).T
                self.write("meant.exr", linear, PRIMARIES["lin_rec709"])
                self.ok("meant.exr", "--hdr-compress", "-o", "expected.png")
                self.assertIn("ICCProfile", [a.name for a in spec_of(name).extra_attribs])
                for environment in ({}, {"OCIO": self.aces}):
                    with self.subTest(name=name, gamma=gamma, environment=environment):
                        done = self.run_tool("-v", name, "--hdr-compress", "-o", "out.png", env=environment)
                        self.assertEqual(done.returncode, 0, done.stderr)
                        self.assertIn("ICC profile", done.stderr)
                        self.assertLessEqual(np.abs(means("out.png") - means("expected.png")).max(), 2)

    def test_icc_profiles_of_png_files_outrank_their_gamma(self):
        """A PNG file may have both chunks; its standard says which one counts."""
        dim = patches() / 24
        stored = np.clip(dim @ matrix(PRIMARIES["lin_rec709"], self.PROPHOTO).T, 0, 1) ** (1 / 1.8)
        profile = np.frombuffer(icc_profile(self.PROPHOTO, 1.8), dtype=np.uint8)
        self.write("meant.exr", dim, PRIMARIES["lin_rec709"])
        self.ok("meant.exr", "--hdr-compress", "-d", "uint16", "-o", "expected.png")
        spec = oiio.ImageSpec(128, 96, 3, "uint16")
        spec.attribute("ICCProfile", oiio.TypeDesc(f"uint8[{len(profile)}]"), profile)
        picture = oiio.ImageBuf(spec)
        picture.set_pixels(picture.roi, np.ascontiguousarray(stored, dtype=np.float32))
        self.assertTrue(picture.write("icc.png"))
        with open("icc.png", "rb") as file:
            data = file.read()
        linear = (1.0,) if oiio.VERSION < 30000 else ()  # later ones do not say that it is from there
        for gamma in (1.8, 2.2, *linear):
            with self.subTest(gamma=gamma):
                body = b"gAMA" + struct.pack(">I", round(100000 / gamma))
                chunk = struct.pack(">I", 4) + body + struct.pack(">I", zlib.crc32(body))
                header = 8 + 25  # the signature, and the chunk that comes first
                with open("both.png", "wb") as file:
                    file.write(data[:header] + chunk + self.without(data[header:], b"gAMA"))
                self.assertAlmostEqual(spec_of("both.png").getattribute("oiio:Gamma"), gamma, 2)
                done = self.run_tool("-v", "both.png", "--hdr-compress", "-o", "out.png")
                self.assertIn("ICC profile", done.stderr)
                self.assertLessEqual(np.abs(means("out.png") - means("expected.png")).max(), 2)

    @staticmethod
    def without(chunks, name):
        """The bytes of a PNG file after its header, without the chunks of that name."""
        kept, at = b"", 0
        while at < len(chunks):
            end = at + 12 + struct.unpack(">I", chunks[at:at + 4])[0]
            if chunks[at + 4:at + 8] != name:
                kept += chunks[at:end]
            at = end
        return kept


class Encoding(pictures.ToolTest):
    def test_whole_numbers_are_encoded_and_floats_linear(self):
        linear = pictures.scene(96, 64)
        for name, kind in (("8.png", "uint8"), ("16.png", "uint16"), ("8.tif", "uint8"), ("16.tif", "uint16")):
            pictures.write(name, encoded(linear), kind)
        for name, kind in (("float.exr", "float"), ("half.exr", "half"), ("float.tif", "float")):
            pictures.write(name, linear, kind)
        pictures.write("linear.png", linear, "uint16", {"oiio:ColorSpace": "Linear"})
        with open("linear.pfm", "wb") as pfm:
            pfm.write(b"PF\n96 64\n-1.0\n" + np.ascontiguousarray(linear[::-1], dtype="<f4").tobytes())
        means = {}
        names = ("8.png", "16.png", "8.tif", "16.tif", "float.exr", "half.exr", "float.tif", "linear.pfm", "linear.png")
        self.ok(*[word for name in names for word in (name, "--hdr-compress", "-d", "uint8", "-o", f"out_{name}.png")])
        means = {name: codes(f"out_{name}.png").mean() for name in names}
        self.assertLessEqual(max(means.values()) - min(means.values()), 1, means)
        # Written as they are, floats are encoded and whole numbers stay.
        for name in ("16.tif", "float.exr", "linear.pfm"):
            self.ok(name, "-d", "uint8", "-o", "out.png")
            self.assertLessEqual(np.abs(codes("out.png") - np.round(encoded(linear) * 255)).max(), 1, name)


if __name__ == "__main__":
    unittest.main()
