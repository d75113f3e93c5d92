# SPDX-License-Identifier: BSD-3-Clause
"""pimgtool run with something wrong: one line, exit status 1, no file. command_test.cpp knows the wordings."""

import os
import unittest

import numpy as np

import pictures


class Errors(pictures.ToolTest):
    def setUp(self):
        super().setUp()
        pictures.write("in.png", pictures.scene(20, 15), "uint8")

    def test_wrong_command_lines(self):
        for arguments, says in (
            ((), "input file"),
            (("in.png", "--lvel", "-o", "out.png"), "did you mean --level?"),
            (("in.png", "--level:fraction=2", "-o", "out.png"), "0 to 1"),
            (("in.png", "--level:size=2", "-o", "out.png"), '"size"'),
            (("missing.exr", "-o", "out.png"), "no such file"),
            (("--help", "--sepia"), "--sepia"),
        ):
            with self.subTest(arguments=arguments):
                self.fails(*arguments, says=says)

    def test_wrong_ends_are_found_before_the_work(self):
        for end in (("-o", "out.xyz"), ("--colorconvert", "linear", "sepia")):
            with self.subTest(end=end):
                self.fails("in.png", "--level", "-o", "first.png", *end, says=end[-1])

    def test_contradictions(self):
        self.fails("in.png", "--level:faces=10:splits=3", "-o", "out.png", says=("--level", "faces", "splits"))
        self.fails("in.png", "--feature-lowpass:fraction=0.1:splits=3", "-o", "out.png", says=("fraction", "splits"))

    def test_broken_inputs(self):
        with open("text.png", "w") as file:
            file.write("no picture")
        self.fails("text.png", "-o", "out.png", says='cannot read "text.png"')
        pictures.write("whole.exr", pictures.hdr_scene(64, 64), "half")
        with open("whole.exr", "rb") as whole, open("cut.exr", "wb") as part:
            part.write(whole.read()[:3000])
        self.fails("cut.exr", "-o", "out.png", says='cannot read "cut.exr"')

    def test_deep_pictures(self):
        if not os.environ.get("OIIOTOOL"):
            self.skipTest("no oiiotool")
        pictures.oiiotool("in.png", "--ch", "R,G,B,A=1,Z=1", "--deepen", "-o", "deep.exr")
        self.fails("deep.exr", "--level", "-o", "out.exr", says=("--level", "deep"))

    def test_missing_channel(self):
        self.fails("in.png", "--ch", "R,Q", "-o", "out.png", says=("--ch", '"Q"', "R, G, B"))

    def test_unreadable_configuration(self):
        self.fails("in.png", "--hdr-compress", "-o", "out.png", says="missing.ocio",
                   env={"OCIO": os.path.abspath("missing.ocio")})

    @unittest.skipIf(os.getuid() == 0, "root may write anywhere")
    def test_locked_folder(self):
        os.mkdir("locked", 0o500)
        self.fails("in.png", "-o", "locked/out.png", says=('"locked/out.png"', "permission"))


class Answers(pictures.ToolTest):
    def test_help(self):
        text = self.ok("--help")
        for word in ("--hdr-compress[:key=value...]", "saturation=1", "-o[:key=value...] FILE", "--threads N"):
            self.assertIn(word, text)
        text = self.ok("-help", "hdr-compress")
        self.assertIn("saturation=1", text)
        self.assertNotIn("--level", text)

    def test_version(self):
        self.assertRegex(self.ok("--version"), r"\Apimgtool \d+\.\d+\.\d+ \(OpenImageIO \d+\.\d+\.\d+\)\n\Z")


if __name__ == "__main__":
    unittest.main()
