# SPDX-License-Identifier: BSD-3-Clause
"""What pimgtool writes: types, sRGB encoding, colour operations, windows, metadata, whole files or none."""

import os
import resource
import subprocess
import unittest

import numpy as np
import OpenImageIO as oiio

import pictures
from pictures import codes, oiiotool, read, spec_of, srgb

CONFIG = """\
ocio_profile_version: 2
roles: { default: raw, scene_linear: working }
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  Screen:
    - !<View> {name: Film, colorspace: film}
active_displays: []
active_views: []
colorspaces:
  - !<ColorSpace> {name: raw, isdata: true}
  - !<ColorSpace> {name: working}
  - !<ColorSpace>
    name: film
    from_scene_reference: !<ExponentTransform> {value: [2.2, 2.2, 2.2, 1], direction: inverse}
"""

needs_oiiotool = unittest.skipUnless(os.environ.get("OIIOTOOL"), "no oiiotool")


def quantised(values):
    return np.rint(np.clip(values, 0, 1) * 255)


class OutputTest(pictures.ToolTest):
    def setUp(self):
        super().setUp()
        pictures.write("rgb.png", pictures.scene(40, 30), "uint8")
        pictures.write("half.exr", pictures.hdr_scene(40, 30), "half")
        pictures.write("hdr.exr", pictures.hdr_scene(40, 30), "float")

    def assert_codes(self, name, expected):
        """An 8-bit file holds what is expected to one code value."""
        self.assertLessEqual(np.abs(codes(name) - expected).max(), 1, name)


class FullDisk(OutputTest):
    """A limit on the size of files stands in for a disk that is full."""

    FORMATS = ("png", "jpg", "bmp", "tga", "gif", "sgi", "jp2", "exr", "tif", "hdr", "ppm", "webp", "pimg")

    def limited(self, *arguments, blocks=8):
        """pimgtool with files of at most so many kilobytes; SIGXFSZ is its own business."""
        return subprocess.run(["bash", "-c", 'ulimit -f %d; exec "$@"' % blocks, "bash", pictures.TOOL, *arguments],
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def test_leaves_the_old_file_and_nothing_else(self):
        os.mkdir("small")
        pictures.write("noise.exr", np.random.default_rng(3).random((120, 160, 3)), "float")
        for extension in self.FORMATS:
            name = "small/x." + extension
            with open(name, "w", encoding="utf-8") as file:
                file.write("old")
            result = self.limited("noise.exr", "-o", name)
            if "no image format" in result.stderr:
                os.remove(name)
                continue
            with self.subTest(extension):
                self.assertEqual(result.returncode, 1, result.stderr)
                self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
                with open(name, encoding="utf-8") as file:
                    self.assertEqual(file.read(), "old")
                self.assertEqual(os.listdir("small"), ["x." + extension])
            for left in os.listdir("small"):
                os.remove(os.path.join("small", left))

    def test_reports_are_whole_or_not_there(self):
        os.mkdir("small")
        pictures.write("noise.png", np.random.default_rng(3).random((120, 160, 3)), "uint8")
        for arguments in (("--segment:regions=900:stats=small/report.csv",), ("--paint:strokes=small/report.svg",),
                          ("--paint:strokes=small/report.json",)):
            name = arguments[0].rpartition("=")[2]
            with open(name, "w", encoding="utf-8") as file:
                file.write("old")
            result = self.limited("noise.png", *arguments, "-o", "small/out.null")
            self.assertEqual(result.returncode, 1, arguments)
            with open(name, encoding="utf-8") as file:
                self.assertEqual(file.read(), "old")
            self.assertEqual(os.listdir("small"), [os.path.basename(name)])
            os.remove(name)

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full")
    def test_what_is_printed_has_to_arrive(self):
        for arguments in (("--help",), ("--version",)):
            with open("/dev/full", "w", encoding="utf-8") as full:
                result = subprocess.run([pictures.TOOL, *arguments], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(result.returncode, 1, arguments)
            self.assertIn("No space left", result.stderr)

    def test_little_address_space_is_one_line(self):
        # How much the libraries alone take, which is the loader's business, differs from machine to machine.
        for kilobytes in range(380000, 600000, 10000):
            result = subprocess.run(["bash", "-c", f'ulimit -v {kilobytes}; exec "$@"', "bash", pictures.TOOL, "--version"],
                                    stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.assertEqual(result.stderr.count("\n"), 0 if result.returncode == 0 else 1, result.stderr)
            if result.returncode != 127:
                break
        self.assertEqual((result.returncode, result.stderr), (1, "pimgtool: error: not enough memory\n"))
        for kilobytes in (500000, 540000, 620000):  # where threads of libraries took what others needed to start
            result = subprocess.run(["bash", "-c", f'ulimit -v {kilobytes}; exec "$@"', "bash", pictures.TOOL, "--version"],
                                    stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=60)
            self.assertIn((result.returncode, result.stderr), ((0, ""), (1, "pimgtool: error: not enough memory\n")))


class Targets(OutputTest):
    def test_nothing_stays_when_a_library_ends_the_program(self):
        """libjpeg does, when there is no room for the last bytes of a file."""
        self.ok("rgb.png", "-o", "old.jpg")
        with open("old.jpg", "rb") as file:
            before = file.read()
        names = set(os.listdir("."))
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (400, 400))
        done = subprocess.run([pictures.TOOL, "rgb.png", "--hdr-compress", "-o", "old.jpg"], preexec_fn=limit,
                              stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertEqual(set(os.listdir(".")), names)
        with open("old.jpg", "rb") as file:
            self.assertEqual(file.read(), before)

    def test_links_modes_and_pipes_are_respected(self):
        os.mkdir("elsewhere")
        extensions = [e for e in ("png", "exr", "jp2") if oiio.ImageOutput.create("a." + e)] + ["pimg"]
        for extension in extensions:
            real, link = "elsewhere/real." + extension, "link." + extension
            self.ok("rgb.png", "-o", real)
            os.chmod(real, 0o640)
            os.symlink(real, link)
            before = os.stat(real).st_ino
            self.ok("rgb.png", "--level:fraction=0.1", "-o", link)
            self.assertTrue(os.path.islink(link))
            self.assertEqual(os.stat(real).st_mode & 0o777, 0o640)
            self.assertNotEqual(os.stat(real).st_ino, before)
        os.mkfifo("pipe.png")
        reader = subprocess.Popen(["cat", "pipe.png"], stdout=subprocess.PIPE)
        self.ok("rgb.png", "-o", "pipe.png")
        self.assertEqual(reader.communicate()[0][:4], b"\x89PNG")
        self.assertTrue(os.path.exists("pipe.png") and not os.path.isfile("pipe.png"))


class Types(OutputTest):
    def assert_type(self, name, kind):
        self.assertEqual(str(spec_of(name).format), kind, name)

    def test_type_is_the_input_s_unless_told(self):
        self.ok("rgb.png", "--feature-lowpass", "-o", "bytes.tif",
                "half.exr", "--feature-lowpass", "-o", "half_out.exr", "-o", "half.png",
                "hdr.exr", "--feature-lowpass", "-o", "float_out.exr", "-o", "float.tif")
        for name, kind in (("bytes.tif", "uint8"), ("half_out.exr", "half"), ("half.png", "uint8"),
                           ("float_out.exr", "float"), ("float.tif", "float")):
            self.assert_type(name, kind)

    def test_d_holds_for_the_files_that_follow(self):
        self.ok("half.exr", "-o", "0.exr", "-d", "float", "-o", "1.exr", "-d", "uint16", "-o", "2.png", "-o", "3.tif",
                "-d", "half", "-o", "4.exr")
        for name, kind in (("0.exr", "half"), ("1.exr", "float"), ("2.png", "uint16"), ("3.tif", "uint16"),
                           ("4.exr", "half")):
            self.assert_type(name, kind)
        self.assert_same("half.exr", "4.exr")

    @needs_oiiotool
    def test_mixed_channel_types_are_kept(self):
        oiiotool("hdr.exr", "--ch", "R,G,B,Z=R", "-d", "R=half", "-d", "G=half", "-d", "B=half", "-d", "Z=float",
                 "-o", "mixed.exr")
        self.ok("mixed.exr", "--feature-lowpass", "-o", "out.exr", "mixed.exr", "--ch", "Z,B", "-o", "two.exr")

        def kinds(name):
            spec = spec_of(name)
            return {channel: str(spec.channelformat(c)) for c, channel in enumerate(spec.channelnames)}

        self.assertEqual(kinds("out.exr"), {"R": "half", "G": "half", "B": "half", "Z": "float"})
        self.assertEqual(kinds("two.exr"), {"B": "half", "Z": "float"})
        self.assertTrue(np.array_equal(read("out.exr")[..., 3], read("mixed.exr")[..., 3]))  # Z is no colour


class Encoding(OutputTest):
    def test_compressed_picture_is_encoded_for_whole_numbers(self):
        self.ok("hdr.exr", "--hdr-compress", "-o", "out.exr", "-o", "out.png", "-d", "uint8", "-o", "out.tif",
                "--raw", "-o", "raw.png")
        linear = read("out.exr")
        for name in ("out.png", "out.tif"):
            self.assert_codes(name, quantised(srgb(linear)))
            self.assertIn(spec_of(name)["oiio:ColorSpace"], pictures.SRGB)
        self.assert_codes("raw.png", quantised(linear))
        self.assertNotEqual(spec_of("raw.png")["oiio:ColorSpace"], "sRGB")

    def test_eight_bit_input(self):
        self.ok("rgb.png", "--dup", "--hdr-compress", "-o", "out.png", "-d", "float", "-o", "out.exr", "--pop",
                "--feature-lowpass:fraction=1", "-d", "uint8", "-o", "same.png", "-d", "uint16", "-o", "same.tif")
        self.assert_codes("out.png", quantised(srgb(read("out.exr"))))
        # A picture that is stored encoded is not encoded again.
        self.assert_same("rgb.png", "same.png")
        self.assertLess(np.abs(read("rgb.png") - read("same.tif")).max(), 1e-4)

    def test_linear_input_of_any_operation(self):
        self.ok("hdr.exr", "--level:fraction=0.2", "-o", "out.png", "-o", "out.exr")
        self.assert_codes("out.png", quantised(srgb(read("out.exr"))))

    def test_alpha_is_not_encoded(self):
        pixels = np.dstack([pictures.hdr_scene(40, 30) / 200, np.full((30, 40), 0.5)])
        pixels[..., :3] *= 0.5  # associated
        pictures.write("rgba.exr", pixels, "float", names=("R", "G", "B", "A"))
        self.ok("rgba.exr", "-o", "out.tif", "-d", "uint16", "-o", "out.png")
        out = read("out.png")
        self.assertTrue(np.allclose(out[..., 3], 0.5, atol=1e-4))
        self.assertTrue(np.allclose(out[..., :3], 0.5 * srgb(2 * pixels[..., :3]), atol=1e-3))
        self.assertTrue(np.array_equal(read("out.tif"), read("rgba.exr")))  # float: untouched

    def test_colour_operation_replaces_the_encoding(self):
        self.ok("hdr.exr", "--hdr-compress", "-o", "linear.exr", "-o", "default.png",
                "--dup", "--colorconvert", "linear", "sRGB", "-o", "srgb.png",
                "--pop", "--dup", "--tocolorspace", "sRGB", "-o", "to.png",
                "--pop", "--colorconvert", "linear", "linear", "-o", "asked.png")
        self.assert_codes("srgb.png", codes("default.png"))
        self.assert_same("srgb.png", "to.png")
        self.assert_codes("asked.png", quantised(read("linear.exr")))

    def test_declared_colour_space(self):
        self.ok("hdr.exr", "--incolorspace", "sRGB", "-o", "as_stored.png",
                "--tocolorspace", "linear", "-o", "linear.tif")
        self.assert_codes("as_stored.png", quantised(read("hdr.exr")))
        inside = read("hdr.exr") < 1
        self.assertTrue(np.allclose(srgb(read("linear.tif"))[inside], read("hdr.exr")[inside], atol=1e-4))

    def test_display_transform(self):
        with open("config.ocio", "w") as config:
            config.write(CONFIG)
        ocio = {"OCIO": os.path.abspath("config.ocio")}
        self.ok("hdr.exr", "--hdr-compress", "-o", "linear.exr", "--dup", "--ociodisplay", "Screen", "Film",
                "-o", "out.png", "--pop", "--ociodisplay", "default", "default", "-o", "default.png", env=ocio)
        self.assert_codes("out.png", quantised(np.maximum(read("linear.exr"), 0) ** (1 / 2.2)))
        self.assert_same("out.png", "default.png")
        for arguments, says in ((("--ociodisplay", "Screen", "Sepia"), ("Sepia", "Film")),
                                (("--ociodisplay", "Wall", "Film"), ("Wall", "Screen")),
                                (("--tocolorspace", "sepia"), ("sepia", "working"))):
            self.fails("hdr.exr", *arguments, "-o", "no.png", says=says, env=ocio)
        if os.environ.get("OIIOTOOL"):
            oiiotool("linear.exr", "--iscolorspace", "working", "--ociodisplay", "Screen", "Film", "-o", "peer.png",
                     env=ocio)
            self.assert_codes("out.png", codes("peer.png"))


class Files(OutputTest):
    def test_windows(self):
        pictures.write("in.exr", pictures.hdr_scene(20, 10), "half", origin=(5, -3), full=(0, 0, 40, 30))
        self.ok("in.exr", "--feature-lowpass:fraction=1", "-o", "out.exr", "-o", "out.png", "-o", "out.tif")
        spec = spec_of("out.exr")
        self.assertEqual((spec.x, spec.y, spec.width, spec.height), (5, -3, 20, 10))
        self.assertEqual((spec.full_x, spec.full_y, spec.full_width, spec.full_height), (0, 0, 40, 30))
        self.assert_same("in.exr", "out.exr")
        # PNG knows one window only: the display's.
        expected = np.zeros((30, 40, 3))
        expected[:7, 5:25] = srgb(read("in.exr")[3:])
        self.assert_codes("out.png", quantised(expected))

    def test_metadata_is_kept(self):
        pictures.write("in.exr", pictures.hdr_scene(20, 10), "half", {"Artist": "somebody", "compression": "piz"})
        self.ok("in.exr", "--hdr-compress", "-o", "out.exr", "-o", "out.png")
        self.assertEqual(spec_of("out.exr")["Artist"], "somebody")
        self.assertEqual(spec_of("out.exr")["compression"], "piz")
        self.assertEqual(spec_of("out.png")["Artist"], "somebody")

    def test_a_file_may_replace_its_own_source(self):
        before = read("rgb.png")
        self.ok("rgb.png", "--feature-lowpass:fraction=0.1", "-o", "rgb.png")
        self.assertEqual(read("rgb.png").shape, before.shape)
        self.assertFalse(np.array_equal(read("rgb.png"), before))

    def test_other_formats_and_names(self):
        os.mkdir("a b:c=d")
        names = ("out.jpg", "out.bmp", "out.tga", "out.ppm", "out.dpx", "OUT.EXR", "a b:c=d/e#1.png")
        self.ok("rgb.png", "--level", *(word for name in names for word in ("-o", name)), names[-1], "-o", "copy.png")
        for name in names:
            self.assertEqual(read(name).shape, (30, 40, 3), name)
        self.assert_same("rgb.png", "copy.png")


if __name__ == "__main__":
    unittest.main()
