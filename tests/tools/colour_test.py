# SPDX-License-Identifier: BSD-3-Clause
"""Colour management: an ACES-style configuration made here, and the one that Debian's blender-data has."""

import os
import unittest

import numpy as np

import pictures
from pictures import codes, oiiotool, read, spec_of

# ACEScg to work in, interchange in AP0; a display with a curve of its own, a shot's grade in a file that the context names.
ACES = """\
ocio_profile_version: 2
search_path: grades
environment: {SHOT: none}
roles:
  default: ACEScg
  scene_linear: ACEScg
  aces_interchange: ACES2065-1
file_rules:
  - !<Rule> {name: Plates, colorspace: ACES2065-1, pattern: "*plate*", extension: "[eE][xX][rR]"}
  - !<Rule> {name: Default, colorspace: ACEScg}
displays:
  Monitor:
    - !<View> {name: Film, colorspace: Film}
    - !<View> {name: Graded, colorspace: Graded}
active_displays: []
active_views: []
colorspaces:
  - !<ColorSpace> {name: ACES2065-1}
  - !<ColorSpace>
    name: ACEScg
    to_scene_reference: !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}
  - !<ColorSpace>
    name: sRGB - Texture
    aliases: [srgb_tx]
    to_scene_reference: !<GroupTransform>
      children:
        - !<ExponentWithLinearTransform> {gamma: [2.4, 2.4, 2.4, 1], offset: [0.055, 0.055, 0.055, 0]}
        - !<MatrixTransform> {matrix: [0.4396, 0.3830, 0.1774, 0, 0.0898, 0.8134, 0.0968, 0, 0.0175, 0.1115, 0.8709, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: Linear Rec.709 (sRGB)
    aliases: [lin_rec709]
    to_scene_reference: !<MatrixTransform> {matrix: [0.4396, 0.3830, 0.1774, 0, 0.0898, 0.8134, 0.0968, 0, 0.0175, 0.1115, 0.8709, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: Film
    from_scene_reference: !<GroupTransform>
      children:
        - !<BuiltinTransform> {style: ACEScg_to_ACES2065-1, direction: inverse}
        - !<ExponentTransform> {value: [2.4, 2.4, 2.4, 1], direction: inverse}
  - !<ColorSpace>
    name: Graded
    from_scene_reference: !<GroupTransform>
      children:
        - !<FileTransform> {src: "${SHOT}.cc"}
        - !<ExponentTransform> {value: [2.4, 2.4, 2.4, 1], direction: inverse}
"""

GRADE = """<ColorCorrection id="{id}"><SOPNode><Slope>{slope} {slope} {slope}</Slope><Offset>0 0 0</Offset>
<Power>1 1 1</Power></SOPNode></ColorCorrection>
"""

BLENDER = "/usr/share/blender/datafiles/colormanagement/config.ocio"

# Y in Rec. 709 of each primary, white adapted by Bradford's method: one scene has one luminance, whatever it is stored in.
AP1_LUMINANCE = np.array([0.2676014, 0.6743990, 0.0579996])
AP0_LUMINANCE = np.array([0.3372618, 0.7296076, -0.0668694])
REC709_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])

needs_oiiotool = unittest.skipUnless(os.environ.get("OIIOTOOL"), "no oiiotool")


def coloured(width=60, height=40):
    """An HDR picture with saturated colours in it."""
    pixels = pictures.hdr_scene(width, height)
    pixels[: height // 2, : width // 3] *= [0.1, 0.3, 2.0]
    pixels[height // 2 :, : width // 3] *= [2.0, 0.2, 0.1]
    return pixels


class ColourTest(pictures.ToolTest):
    def setUp(self):
        super().setUp()
        with open("aces.ocio", "w", encoding="utf-8") as config:
            config.write(ACES)
        os.mkdir("grades")
        for name, slope in (("none", 1), ("sh010", 0.25)):
            with open(f"grades/{name}.cc", "w", encoding="utf-8") as grade:
                grade.write(GRADE.format(id=name, slope=slope))
        self.aces = os.path.abspath("aces.ocio")
        pictures.write("hdr.exr", coloured(), "half")

    def assert_codes(self, name, other):
        self.assertLessEqual(np.abs(codes(name) - codes(other)).max(), 1, name)

    def assert_luminance(self, source, arguments, weights):
        """Without colour and fitting, the result is luminance itself, never below 3 % of the largest channel."""
        self.ok(source, *arguments, "-d", "float", "--hdr-compress:saturation=0:fit=0:s0=1", "-o", "y.exr")
        pixels = read(source)
        expected = np.maximum(pixels @ weights, 0.03 * pixels.max(axis=-1))
        self.assertTrue(np.allclose(read("y.exr")[..., 1], expected, rtol=2e-3), arguments)


class Route(ColourTest):
    @needs_oiiotool
    def test_display_in_one_go_or_by_oiiotool(self):
        """--ociodisplay after --hdr-compress is what oiiotool makes of the linear file, to one 8-bit code."""
        rgba = np.dstack([coloured() * 0.7, np.full((40, 60), 0.7)])
        pictures.write("rgba.exr", rgba, "half", names=("R", "G", "B", "A"))
        routes = [(self.aces, "Monitor", "Film"), (self.aces, "Monitor", "Graded")]
        if os.path.exists(BLENDER):
            routes += [(BLENDER, "sRGB", "Standard"), (BLENDER, "sRGB", "Filmic"), (BLENDER, "XYZ", "Standard")]
        for config, display, view in routes:
            # Files say "Linear"; oiiotool must be told what that is where the configuration does not know.
            known = ("--iscolorspace", "ACEScg") if config == self.aces else ()
            for source in ("hdr.exr", "rgba.exr"):
                for option in ("", ":unpremult=1"):
                    with self.subTest(config=config, view=view, source=source, option=option):
                        self.ok("--ocio", config, source, "--hdr-compress", "-d", "float", "-o", "linear.exr",
                                "-d", "uint8", f"--ociodisplay{option}", display, view, "-o", "at_once.tif")
                        oiiotool("--colorconfig", config, "linear.exr", *known, f"--ociodisplay{option}", display, view,
                                 "-d", "uint8", "-o", "by_oiiotool.tif")
                        self.assert_codes("at_once.tif", "by_oiiotool.tif")
                        self.assertGreater(codes("at_once.tif")[..., :3].std(), 10)

    @needs_oiiotool
    def test_spaces_by_oiiotool(self):
        environment = {"OCIO": self.aces}
        for option in ("", ":unpremult=1"):
            self.ok("hdr.exr", "-d", "float", f"--tocolorspace{option}", "ACES2065-1", "-o", "to.exr",
                    f"--colorconvert{option}", "ACES2065-1", "srgb_tx", "-o", "convert.exr", env=environment)
            oiiotool("hdr.exr", "--iscolorspace", "ACEScg", f"--tocolorspace{option}", "ACES2065-1", "-d", "float", "-o", "to2.exr",
                     f"--colorconvert{option}", "ACES2065-1", "srgb_tx", "-o", "convert2.exr", env=environment)
            for a, b in (("to.exr", "to2.exr"), ("convert.exr", "convert2.exr")):
                self.assertTrue(np.allclose(read(a), read(b), rtol=1e-5, atol=1e-6))

    @needs_oiiotool
    def test_context(self):
        self.ok("--ocio", self.aces, "hdr.exr", "--hdr-compress", "-o", "linear.exr",
                "--dup", "--ociodisplay", "Monitor", "Graded", "-o", "plain.tif", "-d", "uint8", "-o", "plain.tif",
                "--pop", "--ociodisplay:key=SHOT:value=sh010", "Monitor", "Graded", "-o", "graded.tif")
        self.ok("--ocio", self.aces, "--ociokey", "SHOT=sh010", "linear.exr", "--ociodisplay", "Monitor", "Graded",
                "-d", "uint8", "-o", "keyed.tif")
        oiiotool("--colorconfig", self.aces, "linear.exr", "--iscolorspace", "ACEScg",
                 "--ociodisplay:key=SHOT:value=sh010", "Monitor", "Graded", "-d", "uint8", "-o", "peer.tif")
        self.assert_codes("graded.tif", "peer.tif")
        self.assert_codes("keyed.tif", "peer.tif")
        self.assertGreater(codes("plain.tif").mean(), codes("graded.tif").mean() + 10)


class Spaces(ColourTest):
    def test_luminance_is_that_of_the_working_space(self):
        pictures.write("grey.exr", coloured(), "float")
        for arguments, expected in (
            ((), REC709_LUMINANCE),
            (("--ocio", self.aces), AP1_LUMINANCE),
            (("--incolorspace", "ACEScg"), AP1_LUMINANCE),
            (("--ocio", self.aces, "--incolorspace", "ACES2065-1"), AP0_LUMINANCE),
        ):
            self.assert_luminance("grey.exr", arguments, expected)

    def test_rules_of_the_configuration(self):
        pictures.write("a_plate.exr", coloured(), "float")
        pictures.write("other.exr", coloured(), "float")
        self.assert_luminance("a_plate.exr", ("--ocio", self.aces), AP0_LUMINANCE)
        self.assert_luminance("other.exr", ("--ocio", self.aces), AP1_LUMINANCE)
        # What is said beats the rule; so does a space that the file itself names.
        self.assert_luminance("a_plate.exr", ("--ocio", self.aces, "--incolorspace", "ACEScg"), AP1_LUMINANCE)
        self.ok("--ocio", self.aces, "a_plate.exr", "-d", "float", "--tocolorspace", "ACEScg", "-o", "cg.exr",
                "other.exr", "--tocolorspace", "ACEScg", "-o", "same.exr")
        self.assertFalse(np.allclose(read("cg.exr"), read("a_plate.exr"), rtol=0.01))
        self.assert_same("same.exr", "other.exr")

    def test_eight_bits_are_decoded_into_the_working_space(self):
        pictures.write("rgb.png", pictures.scene(40, 30), "uint8", {"oiio:ColorSpace": "sRGB"})
        self.ok("--ocio", self.aces, "rgb.png", "-d", "float", "--dup", "--hdr-compress:fit=0:s0=1:coherence=0:beta=0",
                "-o", "working.exr", "--pop", "--colorconvert", "srgb_tx", "ACEScg", "-o", "expected.exr")
        self.assertTrue(np.allclose(read("working.exr"), read("expected.exr"), rtol=2e-3, atol=1e-4))

    def test_aliases_and_names_of_other_versions(self):
        """Rec. 709 is Rec. 709 by every name, also where scene_linear is ACEScg; so is sRGB."""
        pictures.write("linear.exr", np.full((4, 4, 3), (0.8, 0.3, 0.1), np.float32), "float")
        for name in ("Linear Rec.709 (sRGB)", "lin_rec709", "lin_rec709_scene"):
            self.ok("--ocio", self.aces, "linear.exr", "--incolorspace", name, "--tocolorspace", "ACES2065-1", "-o", "by.exr")
            self.assertTrue(np.allclose(read("by.exr")[0, 0], (0.484, 0.326, 0.135), atol=1e-3), name)
        self.ok("linear.exr", "--colorconvert", "lin_rec709_scene", "srgb_rec709_scene", "-o", "new.exr",
                "linear.exr", "--colorconvert", "linear", "sRGB", "-o", "old.exr")
        self.assert_same("new.exr", "old.exr")
        self.assertFalse(np.allclose(read("new.exr"), read("linear.exr"), atol=0.05))

    def test_displays_from_any_name_of_a_space(self):
        pictures.write("rgb.png", pictures.scene(40, 30), "uint8", {"oiio:ColorSpace": "sRGB"})
        show = ("Monitor", "Film", "-d", "uint8", "-o")
        self.ok("--ocio", self.aces, "rgb.png", "--ociodisplay", *show, "own.tif")
        for name in ("sRGB - Texture", "srgb_tx", "sRGB", "srgb_rec709_scene"):
            self.ok("--ocio", self.aces, "rgb.png", f"--ociodisplay:from={name}", *show, "named.tif")
            self.assert_codes("own.tif", "named.tif")
        self.ok("--ocio", self.aces, "rgb.png", "--ociodisplay:from=ACEScg", *show, "other.tif")
        self.assertGreater(np.abs(codes("own.tif") - codes("other.tif")).max(), 20)

    def test_configuration_that_is_wrong(self):
        with open("broken.ocio", "w", encoding="utf-8") as config:
            config.write("ocio_profile_version: 2\nroles: [\n")
        out = ("--hdr-compress", "-o", "out.exr")
        self.fails("--ocio", "none.ocio", "hdr.exr", *out, says=("--ocio", "none.ocio", "no such file"))
        self.fails("--colorconfig", "broken.ocio", "hdr.exr", *out, says=("--colorconfig", "$OCIO", "broken.ocio"))
        self.fails("hdr.exr", *out, says="none.ocio", env={"OCIO": "none.ocio"})
        self.fails("--ociokey", "SHOT", "hdr.exr", *out, says=("--ociokey", "KEY=VALUE"))
        self.fails("--ocio", self.aces, "hdr.exr", "--hdr-compress", "--ociodisplay:from=sepia", "Monitor", "Film",
                   "-o", "out.exr", says=("sepia", "ACEScg"))


class Channels(ColourTest):
    def test_other_channels_metadata_and_windows(self):
        names = ("R", "G", "B", "A", "Z", "normal.x", "normal.y", "id")
        extra = np.dstack([np.full((40, 60), 0.8), *(pictures.scene(60, 40, 1)[..., 0] * k + k for k in (10, 1, -1, 300))])
        pictures.write("aov.exr", np.dstack([coloured() * 0.8, extra]), "float", {"Artist": "somebody", "shot": "sh010"},
                       names=names, origin=(7, -4), full=(0, 0, 90, 50))
        for operations in (("--hdr-compress",), ("--hdr-compress", "--ociodisplay", "Monitor", "Film"),
                           ("--tocolorspace", "ACES2065-1")):
            with self.subTest(operations=operations):
                self.ok("--ocio", self.aces, "aov.exr", *operations, "-o", "out.exr")
                spec, before = spec_of("out.exr"), spec_of("aov.exr")
                self.assertEqual(spec.channelnames, before.channelnames)
                self.assertEqual((spec.roi, spec.roi_full), (before.roi, before.roi_full))
                for key in ("Artist", "shot"):
                    self.assertEqual(spec[key], before[key])
                out, source = read("out.exr"), read("aov.exr")
                self.assertTrue(np.array_equal(out[..., 3:], source[..., 3:]))
                self.assertFalse(np.allclose(out[..., :3], source[..., :3], rtol=0.01))
        # Selected, they are the picture.
        self.ok("aov.exr", "--ch", "normal.x,normal.y", "--feature-lowpass:fraction=0.05", "-o", "normals.exr")
        self.assertEqual(spec_of("normals.exr").channelnames, ("normal.x", "normal.y"))
        self.assertFalse(np.array_equal(read("normals.exr")[..., 0], read("aov.exr")[..., 5]))

    def test_alpha(self):
        alpha = np.linspace(0, 1, 60)[None, :].repeat(40, axis=0)
        pictures.write("rgba.exr", np.dstack([coloured() * alpha[..., None], alpha]), "float", names=("R", "G", "B", "A"))
        self.ok("rgba.exr", "--unpremult", "-o", "straight.exr", "--premult", "-o", "again.exr",
                "rgba.exr", "--hdr-compress", "-o", "out.exr")
        inside = alpha > 0
        self.assertTrue(np.allclose(read("straight.exr")[inside][:, :3], coloured()[inside], rtol=1e-5))
        self.assertTrue(np.allclose(read("again.exr")[inside], read("rgba.exr")[inside], rtol=1e-5))
        self.assertTrue(np.array_equal(read("out.exr")[..., 3], read("rgba.exr")[..., 3]))
        self.assertEqual(np.abs(read("out.exr")[~inside]).max(), 0)


@unittest.skipUnless(os.path.exists(BLENDER), "no blender-data")
class Blender(ColourTest):
    def test_blender_s_configuration(self):
        self.assert_luminance("hdr.exr", ("--ocio", BLENDER), REC709_LUMINANCE)
        self.assert_luminance("hdr.exr", ("--ocio", BLENDER, "--incolorspace", "Linear ACEScg"), AP1_LUMINANCE)
        self.ok("--ocio", BLENDER, "hdr.exr", "--hdr-compress", "--dup", "--ociodisplay", "sRGB", "Filmic", "-o", "film.png",
                "--pop", "--dup", "--ociodisplay", "default", "default", "-o", "default.png",
                "--pop", "--ociodisplay", "sRGB", "Standard", "-o", "standard.png")
        self.assert_same("default.png", "standard.png")
        self.assertFalse(np.array_equal(codes("film.png"), codes("standard.png")))
        self.fails("--ocio", BLENDER, "hdr.exr", "--ociodisplay", "sRGB", "Sepia", "-o", "no.png", says=("Sepia", "Filmic"))


if __name__ == "__main__":
    unittest.main()
