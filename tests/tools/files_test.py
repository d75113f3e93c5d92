# SPDX-License-Identifier: BSD-3-Clause
"""Files as people have them: of several parts, on standard input and output, on their side, with colours under alpha 0."""

import os
import resource
import struct
import subprocess
import unittest
import zlib

import numpy as np
import OpenImageIO as oiio

import pictures
from pictures import read, spec_of

RANDOM = np.random.default_rng(11)
WIDTH, HEIGHT = 64, 48


def write_parts(name, *parts):
    """A file of several parts: (name, values, names of channels, type)."""
    specs = []
    for part, values, channels, kind in parts:
        spec = oiio.ImageSpec(values.shape[1], values.shape[0], values.shape[2], kind)
        spec.channelnames = channels
        spec.attribute("oiio:subimagename", part)
        specs.append(spec)
    out = oiio.ImageOutput.create(name)
    for i, (_, values, _, _) in enumerate(parts):
        opened = out.open(name, specs[i], "AppendSubimage") if i else out.open(name, tuple(specs))
        if not opened or not out.write_image(np.ascontiguousarray(values, np.float32)):
            raise RuntimeError(out.geterror())
    out.close()


def parts_of(name):
    """Values and headers of all parts of a file."""
    file = pictures.opened(name)
    parts = []
    while file.seek_subimage(len(parts), 0):
        spec = file.spec()
        pixels = file.read_image(len(parts), 0, 0, spec.nchannels, oiio.FLOAT)
        parts.append((pixels.reshape(spec.height, spec.width, -1), spec))
    return parts


class Encoded(pictures.ToolTest):
    """Encoded samples in files of floats, which are taken as linear light otherwise."""

    def test_openexr_files_say_so(self):
        picture = pictures.scene(64, 48)
        for source, kind in (("in.png", "uint8"), ("in.tif", "uint16"), ("in.jpg", "uint8")):
            pictures.write(source, picture, kind)
            for kind in ([], ["-d", "float"]):
                self.ok(source, *kind, "-o", "encoded.exr")
                self.assertEqual(spec_of("encoded.exr").get_string_attribute("colorInteropID"), "srgb_rec709_scene")
                self.assertLess(np.abs(read("encoded.exr") - read(source)).max(), 1e-3)  # the numbers stay
                self.ok(source, "--hdr-compress", "-o", "expected.png")
                self.ok("encoded.exr", "--hdr-compress", "-o", "out.png")
                self.assertLess(np.abs(pictures.codes("out.png") - pictures.codes("expected.png")).mean(), 2)
                self.ok("encoded.exr", "-d", "uint8", "-o", "back.png")  # and are not encoded twice
                self.assertLess(np.abs(read("back.png") - read(source)).max(), 0.005)

    def test_linear_light_is_not_called_encoded(self):
        pictures.write("in.png", pictures.scene(64, 48), "uint8")
        self.ok("in.png", "-d", "half", "-o", "encoded.exr")
        for source in ("in.png", "encoded.exr"):
            for words in (["--hdr-compress"], ["--tocolorspace", "linear"]):
                self.ok(source, *words, "-d", "half", "-o", "linear.exr")
                name = spec_of("linear.exr").get_string_attribute("colorInteropID")
                self.assertIn(name, ("", "lin_rec709_scene"))  # OpenImageIO 3.1 writes it of itself

    def test_formats_without_a_word_for_it_are_warned_of(self):
        pictures.write("in.png", pictures.scene(64, 48), "uint8")
        done = self.run_tool("in.png", "-o", "out.hdr")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (0, 1))
        self.assertIn("the samples are encoded, but hdr files of float are taken as linear light", done.stderr)
        self.ok("in.png", "--tocolorspace", "linear", "-o", "out.hdr")


class Profiles(pictures.ToolTest):
    """ICC profiles that are not those of the pixels written: libpng would refuse the file."""

    def test_they_are_left_behind(self):
        for space, channels, command in (
            (b"CMYK", 3, "--feature-lowpass"),
            (b"Lab ", 3, "--paint"),
            (b"RGB ", 3, "--segment:regions=9"),
            (b"RGB ", 1, "--level:fraction=0.1"),
        ):
            profile = bytearray(132)
            profile[0:4] = (132).to_bytes(4, "big")
            profile[8:12], profile[12:16], profile[16:20], profile[20:24] = b"\2\x40\0\0", b"mntr", space, b"XYZ "
            profile[36:40], profile[68:80] = b"acsp", bytes.fromhex("0000f6d6000100000000d32d")  # its illuminant is D50
            spec = oiio.ImageSpec(64, 48, channels, "uint8")
            spec.attribute("ICCProfile", oiio.TypeDesc(f"uint8[{len(profile)}]"), np.frombuffer(bytes(profile), np.uint8))
            out = oiio.ImageOutput.create("in.tif")
            self.assertTrue(out.open("in.tif", spec), out.geterror())
            out.write_image(np.ascontiguousarray(pictures.scene(64, 48, channels), np.float32))
            out.close()
            self.ok("in.tif", command, "-o", "out.png")
            self.assertEqual(read("out.png").shape[:2], (48, 64))


class Parts(pictures.ToolTest):
    """A render with depth, two views and IDs, each a part of its own."""

    def setUp(self):
        super().setUp()
        self.left = pictures.hdr_scene(WIDTH, HEIGHT)
        self.parts = [
            ("depth", 3 + RANDOM.random((HEIGHT, WIDTH, 1)), ("Z",), "float"),
            ("left", self.left, ("R", "G", "B"), "half"),
            ("right", self.left * 1.5, ("R", "G", "B"), "half"),
            ("crypto00", RANDOM.random((HEIGHT, WIDTH, 4)) * 1e9, ("R", "G", "B", "A"), "float"),
        ]
        write_parts("in.exr", *self.parts)

    def warned(self, *arguments):
        done = self.run_tool(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        return done.stderr

    def test_all_are_kept_and_pictures_filtered(self):
        for name in ("out.exr", "out.tif"):
            self.ok("in.exr", "--hdr-compress", "-d", "float", "-o", name)
            before, after = parts_of("in.exr"), parts_of(name)
            self.assertEqual(len(after), 4)
            for (a, spec_a), (b, spec_b), filtered in zip(before, after, (False, True, True, False)):
                self.assertEqual(np.array_equal(a, b), not filtered)
                if name == "out.exr":
                    self.assertEqual(spec_a.channelnames, spec_b.channelnames)
                    self.assertEqual(spec_a["oiio:subimagename"], spec_b["oiio:subimagename"])
                if filtered:
                    self.assertLessEqual(b.max(), 1.001)

    def test_views_are_exposed_alike(self):
        # The same scene twice: what is found from the picture holds for the other.
        self.parts[2] = ("right", self.left, ("R", "G", "B"), "half")
        write_parts("in.exr", *self.parts)
        self.ok("in.exr", "--hdr-compress", "-d", "float", "-o", "out.exr")
        left, right = parts_of("out.exr")[1][0], parts_of("out.exr")[2][0]
        np.testing.assert_allclose(left, right, rtol=1e-5)

    def test_formats_for_one_say_what_is_left_out(self):
        for name in ("out.png", "out.pimg"):
            said = self.warned("in.exr", "--hdr-compress", "-o", name)
            self.assertIn("of 4 parts only left is used", said)
            self.assertIn("depth, left, right, crypto00", said)
        write_parts("one.exr", self.parts[1])
        self.ok("one.exr", "--hdr-compress", "-o", "expected.png")
        self.assert_same("out.png", "expected.png")
        said = self.warned("in.exr", "--hdr-compress", "-o", "out.exr", "-o", "out.png")
        self.assertIn("without parts depth, right, crypto00", said)
        self.assert_same("out.png", "expected.png")

    def test_one_is_chosen_by_number_or_name(self):
        write_parts("one.exr", self.parts[2])
        self.ok("one.exr", "--hdr-compress", "-o", "expected.exr")
        for part in ("2", "right", "RIGHT"):
            self.ok("--part", part, "in.exr", "--hdr-compress", "-o", "out.exr")
            self.assertEqual(len(parts_of("out.exr")), 1)
            self.assert_same("out.exr", "expected.exr")

    def test_what_is_wrong_is_said(self):
        for part in ("4", "-1", "middle"):
            self.fails("--part", part, "in.exr", "-o", "out.exr", says=["no part", "depth, left, right, crypto00"])
        self.fails("--part", "", "in.exr", "-o", "out.exr", says="expected a number")
        self.fails("in.exr", "--part", "1", "-o", "out.exr", says="expected it before the file")

    def test_named_channels_drop_the_other_parts(self):
        self.ok("in.exr", "--ch", "R,B", "-o", "out.exr")
        self.assertEqual([spec.channelnames for _, spec in parts_of("out.exr")], [("R", "B")])

    def test_parts_of_another_size_are_left_out(self):
        self.parts[2] = ("small", self.left[:20, :30], ("R", "G", "B"), "half")
        out = oiio.ImageOutput.create("pages.tif")
        for i, (_, values, _, _) in enumerate(self.parts[1:3]):
            spec = oiio.ImageSpec(values.shape[1], values.shape[0], 3, "float")
            self.assertTrue(out.open("pages.tif", spec, "AppendSubimage" if i else "Create"))
            self.assertTrue(out.write_image(np.ascontiguousarray(values, np.float32)))
        out.close()
        self.assertIn("another display window", self.warned("pages.tif", "-o", "out.exr"))
        self.assertEqual(len(parts_of("out.exr")), 1)


class Streams(pictures.ToolTest):
    def setUp(self):
        super().setUp()
        pictures.write("in.exr", pictures.hdr_scene(WIDTH, HEIGHT), "half")
        pictures.write("in.png", pictures.scene(WIDTH, HEIGHT), "uint8")

    def piped(self, given, *arguments, expect=0):
        """Runs the tool with a file's bytes on standard input and returns those of standard output."""
        data = b"" if given is None else open(given, "rb").read()
        done = subprocess.run([pictures.TOOL, *arguments], input=data, capture_output=True, timeout=60, check=False)
        self.assertEqual(done.returncode, expect, done.stderr)
        self.said = done.stderr.decode()
        return done.stdout

    def written(self, name, data):
        with open(name, "wb") as file:
            file.write(data)
        return name

    def test_files_are_those_of_names(self):
        for name, extension in (("in.exr", ".png"), ("in.exr", ".exr"), ("in.png", ".pimg"), ("in.png", ".jpg"),
                                ("in.exr", ".tif"), ("in.exr", ".hdr")):
            with self.subTest(name + extension):
                self.ok(name, "--level:fraction=0.1", "-o", "expected" + extension)
                out = self.written("out" + extension, self.piped(name, "-", "--level:fraction=0.1", "-o", "-" + extension))
                self.assert_same(out, "expected" + extension)
                self.assertEqual(self.said, "")

    def test_a_pipe_of_three(self):
        first = self.written("1.pimg", self.piped("in.exr", "-", "-o", "-.pimg"))
        second = self.written("2.exr", self.piped(first, "-", "--hdr-compress", "-o", "-.exr"))
        self.written("out.png", self.piped(second, "-", "-o", "-.png"))
        self.ok("in.exr", "--hdr-compress", "-d", "half", "-o", "between.exr", "between.exr", "-o", "expected.png")
        self.assertLessEqual(np.abs(pictures.codes("out.png") - pictures.codes("expected.png")).max(), 1)

    def test_extensions_name_formats_without_signature(self):
        self.ok("in.png", "-o", "in.tga")
        self.written("out.png", self.piped("in.tga", "-.tga", "-o", "-.png"))
        self.assert_same("out.png", "in.png")

    def test_queries_work(self):
        self.ok("in.exr", "-o", "in.pimg")
        self.ok("in.pimg?level=100", "-d", "float", "-o", "expected.exr")
        self.written("out.exr", self.piped("in.pimg", "-.pimg?level=100", "-d", "float", "-o", "-.exr"))
        self.assert_same("out.exr", "expected.exr")

    def test_errors_leave_standard_output_empty(self):
        for given, arguments, says in (
            (None, ("-", "-o", "-.png"), "it is empty"),
            (pictures.TOOL, ("-", "-o", "-.png"), 'cannot read "-"'),
            ("in.png", ("-", "-o", "-"), "extension"),
            ("in.png", ("-", "-o", "-.xyz"), "no image format"),
            ("in.png", ("-", "-o", "-.png", "-o", "-.exr"), "nothing else"),
            ("in.png", ("-", "-o", "-.png", "--stats"), "nothing else"),
            ("in.png", ("-", "--level:splits=-5", "-o", "-.png"), "splits"),
        ):
            with self.subTest(arguments):
                self.assertEqual(self.piped(given, *arguments, expect=1), b"")
                self.assertIn(says, self.said)
                self.assertEqual(self.said.count("\n"), 1)
                self.assertNotIn("/proc", self.said)

    def test_a_full_disk_and_a_closed_pipe_are_errors(self):
        noise = "noise.exr"
        pictures.write(noise, RANDOM.random((300, 400, 3)), "float")
        if os.path.exists("/dev/full"):
            with open("/dev/full", "wb") as full:
                done = subprocess.run([pictures.TOOL, noise, "-o", "-.exr"], stdout=full, stderr=subprocess.PIPE,
                                      timeout=60, check=False)
            self.assertEqual(done.returncode, 1)
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run([pictures.TOOL, noise, "-o", "-.exr"], stdout=writer, stderr=subprocess.PIPE, text=True,
                              timeout=60, check=False)
        os.close(writer)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr.count("\n"), 1)


class Claims(pictures.ToolTest):
    def test_a_few_bytes_take_no_memory_for_what_they_only_claim(self):
        """A .pimg file of 30000 x 30000 pixels that has none of them."""
        pictures.write("in.png", pictures.scene(64, 48), "uint8")
        self.ok("in.png", "-o", "in.pimg")
        with open("in.pimg", "rb") as file:
            data = file.read()
        claim, at = data[:8], 8
        while at < len(data):
            kind, length = struct.unpack_from("<4s4xQ", data, at)
            chunk = bytearray(data[at : at + 16 + length])
            if kind == b"HEAD":
                for side in (16, 32):  # of the data window, of the display window
                    struct.pack_into("<II", chunk, 16 + side, 30000, 30000)
            if kind in (b"HEAD", b"CHAN", b"DONE"):
                claim += bytes(chunk) + struct.pack("<I", zlib.crc32(chunk))
            at += 20 + length
        with open("claim.pimg", "wb") as file:
            file.write(claim)
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
        done = subprocess.run([pictures.TOOL, "claim.pimg", "-o", "out.exr"], preexec_fn=limit, stderr=subprocess.PIPE,
                              text=True)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "^pimgtool: error: cannot read \"claim.pimg\": .*(tiles|order).*\n$")
        self.assertFalse(os.path.exists("out.exr"))


class Unassociated(pictures.ToolTest):
    ASK = ("--iconfig", "oiio:UnassociatedAlpha", "1")

    def setUp(self):
        super().setUp()
        self.pixels = RANDOM.integers(0, 256, (HEIGHT, WIDTH, 4)).astype(np.uint8)
        self.pixels[:20, :, 3] = 0
        spec = oiio.ImageSpec(WIDTH, HEIGHT, 4, "uint8")
        spec.attribute("oiio:UnassociatedAlpha", 1)
        out = oiio.ImageOutput.create("in.png")
        self.assertTrue(out.open("in.png", spec) and out.write_image(self.pixels))
        out.close()

    def stored(self, name):
        config = oiio.ImageSpec()
        config.attribute("oiio:UnassociatedAlpha", 1)
        return oiio.ImageInput.open(name, config).read_image(oiio.UINT8)

    def test_colours_under_alpha_0_come_back_bit_for_bit(self):
        for profile in ("full", "compact"):
            self.ok(*self.ASK, "in.png", f"-o:profile={profile}", "a.pimg")
            np.testing.assert_array_equal(self.stored("a.pimg"), self.pixels)
            self.ok(*self.ASK, "a.pimg", "-o", "out.png")
            np.testing.assert_array_equal(self.stored("out.png"), self.pixels)

    def test_readers_who_do_not_ask_get_colours_multiplied(self):
        self.ok(*self.ASK, "in.png", "-o", "a.pimg")
        expected, got = pictures.codes("in.png"), pictures.codes("a.pimg")
        self.assertLessEqual(np.abs(expected - got).max(), 1)
        self.assertIsNone(spec_of("a.pimg").getattribute("oiio:UnassociatedAlpha"))
        self.assertEqual(got[:20, :, :3].max(), 0)
        self.ok("a.pimg", "--level:splits=300", "-o", "out.png")  # not with the hierarchy of other colours
        self.ok("a.pimg?level=300", "-o", "out.png")

    def test_formats_that_cannot_say_it_get_colours_multiplied(self):
        self.ok(*self.ASK, "in.png", "-d", "float", "--raw", "-o", "a.exr")
        alpha = self.pixels[..., 3:] / 255
        np.testing.assert_allclose(read("a.exr")[..., :3], self.pixels[..., :3] / 255 * alpha, atol=0.6 / 255)

    def test_hints_are_checked(self):
        self.fails("--iconfig:type=int", "a", "x", "in.png", "-o", "out.png", says="expected a value of type int")
        self.fails("in.png", "--iconfig", "a", "1", "-o", "out.png", says="before the file")


class Orientation(pictures.ToolTest):
    def test_every_order_of_a_radiance_file_is_upright(self):
        picture = np.stack([np.linspace(0.1, 1, WIDTH) * np.ones((HEIGHT, 1)),
                            np.linspace(0.1, 1, HEIGHT)[:, None] * np.ones((1, WIDTH)), np.full((HEIGHT, WIDTH), 0.3)], 2)
        exponent = np.ceil(np.log2(picture.max(2)))
        mantissa = np.floor(picture * np.ldexp(1.0, (8 - exponent).astype(int))[..., None])
        codes = np.concatenate([np.clip(mantissa, 0, 255), exponent[..., None] + 128], 2).astype(np.uint8)
        length = {"X": WIDTH, "Y": HEIGHT}
        for order in ("-Y +X", "-Y -X", "+Y +X", "+Y -X", "+X -Y", "-X -Y", "+X +Y", "-X +Y"):
            slow, fast = order.split()
            stored = codes
            for axis in (slow, fast):
                if axis in ("-X", "+Y"):
                    stored = np.flip(stored, 1 if "X" in axis else 0)
            if "X" in slow:
                stored = stored.transpose(1, 0, 2)
            with open("in.hdr", "wb") as file:
                header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{slow} {length[slow[1]]} {fast} {length[fast[1]]}\n"
                file.write(header.encode() + stored.tobytes())
            with self.subTest(order):
                self.ok("in.hdr", "-d", "float", "-o", "out.exr")
                np.testing.assert_allclose(read("out.exr"), picture, atol=1 / 128)

    def test_strokes_are_upright_for_every_orientation(self):
        upright = pictures.scene(WIDTH, HEIGHT)
        pictures.write("upright.tif", upright, "float")
        self.ok("upright.tif", "--paint:strokes=expected.svg", "-o", "out.png")
        turned = {2: upright[:, ::-1], 3: upright[::-1, ::-1], 4: upright[::-1], 5: upright.transpose(1, 0, 2),
                  6: np.rot90(upright, 1), 7: upright.transpose(1, 0, 2)[::-1, ::-1], 8: np.rot90(upright, -1)}
        for orientation, stored in turned.items():
            with self.subTest(orientation):
                pictures.write("in.tif", stored, "float", {"Orientation": orientation})
                self.ok("in.tif", "--paint:strokes=out.svg", "-o", "out.tif")
                with open("out.svg", encoding="utf-8") as out, open("expected.svg", encoding="utf-8") as expected:
                    self.assertEqual(out.read(), expected.read())


class Labels(pictures.ToolTest):
    def test_formats_that_change_numbers_are_refused(self):
        pictures.write("in.png", pictures.scene(WIDTH, HEIGHT), "uint8")
        self.ok("in.png", "--segment:regions=150", "-o", "expected.tif")
        expected = read("expected.tif", oiio.UINT32)[..., 0]
        self.assertEqual(len(np.unique(expected)), 150)
        for extension in ("jpg", "webp", "jp2", "hdr", "png", "bmp", "gif", "tif", "exr", "pimg"):
            name = "out." + extension
            done = self.run_tool("in.png", "--segment:regions=150", "-o", name)
            with self.subTest(extension):
                if extension in ("jpg", "hdr"):
                    self.assertEqual(done.returncode, 1)
                if "no image format" in done.stderr:
                    continue
                if done.returncode != 0:
                    self.assertRegex(done.stderr, r"\Apimgtool: error: [^\n]+labels[^\n]+\n\Z")
                    self.assertFalse(os.path.exists(name))
                    continue
                spec = spec_of(name)
                got = read(name, {"uint8": oiio.UINT8, "uint16": oiio.UINT16, "uint": oiio.UINT32}.get(
                    str(spec.format), oiio.FLOAT))
                np.testing.assert_array_equal(got[..., 0], expected)


if __name__ == "__main__":
    unittest.main()
