# SPDX-License-Identifier: BSD-3-Clause
"""Every filter of the registry in every front end: pimgtool, the plugin, C, Python, GEGL and OpenFX where they were built.

And the one grammar of option text in those that read text. $PIMG_C is libpimg; $PIMG_GEGL, $GEGL, and $PIMG_OFX, the
bundle, may be empty.
"""

import ctypes
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "plugin"))

import numpy as np

import plugin_files
from plugin_files import read, scene, write

DOCS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "docs")
LABELS = {"segment", "dual_pieces"}  # no picture, so not for GEGL
QUOTED = "no:such:picture"


class Pixels(ctypes.Structure):
    _fields_ = [("data", ctypes.c_void_p), ("width", ctypes.c_int), ("height", ctypes.c_int), ("channels", ctypes.c_int),
                ("xstride", ctypes.c_ssize_t), ("ystride", ctypes.c_ssize_t)]


class C:
    """A picture in C."""

    def __init__(self, pixels):
        self.library = ctypes.CDLL(os.environ["PIMG_C"])
        self.library.pimg_build.restype = ctypes.c_void_p
        self.library.pimg_render.restype = ctypes.c_bool
        self.pixels = np.ascontiguousarray(pixels, dtype=np.float32)
        self.image = ctypes.c_void_p(self.library.pimg_build(ctypes.byref(self.window(self.pixels)), None, None,
                                                             ctypes.c_size_t(0)))

    @staticmethod
    def window(array):
        height, width, channels = array.shape
        return Pixels(array.ctypes.data, width, height, channels, 0, 0)

    def render(self, text):
        """The error, or None."""
        error = ctypes.create_string_buffer(2000)
        result = self.pixels.copy()
        done = self.library.pimg_render(self.image, text.encode(), ctypes.byref(self.window(result)), 0, 0, 0, error,
                                        ctypes.c_size_t(2000))
        return None if done else error.value.decode()


class FrontEnds(plugin_files.PluginTest):
    def setUp(self):
        super().setUp()
        self.pixels = scene(40, 30)
        write("a.pimg", self.pixels, "half")
        self.c = C(self.pixels)
        message = self.c.render("there is no such filter")
        self.names = message.split("expected one of ")[1].split(", ")
        self.assertGreater(len(self.names), 5, message)

    def pimgtool(self, *arguments):
        return subprocess.run([os.environ["PIMGTOOL"], *arguments], capture_output=True, text=True, timeout=60)

    def test_pimgtool(self):
        text, manual, completion = (self.pimgtool(argument).stdout
                                    for argument in ("--help", "--help:format=man", "--help:format=bash"))
        for name in self.names:
            command = "--" + name.replace("_", "-")
            self.assertIn(f"  {command}[", text)
            self.assertIn(command.replace("-", "\\-"), manual)
            self.assertIn(command, completion)
            self.assertEqual(self.pimgtool("--help", command).returncode, 0, command)
            self.assertEqual(self.pimgtool("a.pimg", command, "-o", "b.exr").returncode, 0, command)

    def test_c(self):
        for name in self.names:
            self.assertIsNone(self.c.render(name))
            self.assertIsNone(self.c.render(name.replace("_", "-")))

    def test_plugin(self):
        for name in self.names:
            # Of the pixels only that they come: level=1 is the mesh after one split.
            self.assertEqual(read(f"a.pimg?{name}=1").shape[:2], (30, 40), name)
            self.assertEqual(read(f"a.pimg?{name}=on").shape[:2], (30, 40), name)
        self.fails("iconvert", "a.pimg?sepia=1", "out.png", says=[f"{name}=" for name in self.names])

    def test_ink_through_the_plugin_is_that_of_pimgtool(self):
        self.assertEqual(self.pimgtool("a.pimg", "--ink:width=2", "-d", "half", "-o", "b.exr").returncode, 0)
        self.assertLess(np.abs(read("a.pimg?ink=1&width=2") - read("b.exr")).max(), 1e-3)
        self.fails("iconvert", "a.pimg?ink=1&strokes=b.svg", "out.png", says=["strokes", "pimgtool"])

    @unittest.skipUnless(os.environ.get("PIMG_PYTHON_MODULE"), "the module was not built")
    def test_python(self):
        import pimg

        self.assertEqual(sorted(pimg.filters()), sorted(self.names))
        for name in self.names:
            self.assertTrue(getattr(pimg, name).__doc__, name)
            self.assertTrue(getattr(pimg.ProgressiveImage, name).__doc__, name)
            getattr(pimg, name)(self.pixels.astype(np.float32))
        both = [pimg.mosaic(self.pixels.astype(np.float32), tiles=50, **{key: "0.7"}) for key in ("color", "colour")]
        self.assertTrue(np.array_equal(*both))

    @unittest.skipUnless(os.environ.get("GEGL"), "there is no GEGL")
    def test_gegl(self):
        path = os.environ["PIMG_GEGL"] + ":" + os.environ["GEGL_MODULES"]
        listed = subprocess.run([os.environ["GEGL"], "--list-all"], capture_output=True, text=True, timeout=60,
                                errors="replace", env={**os.environ, "GEGL_PATH": path}).stdout.split()
        for name in self.names:
            self.assertEqual("pimg:" + name.replace("_", "-") in listed, name not in LABELS, name)

    @unittest.skipUnless(os.environ.get("PIMG_OFX"), "the effects for OpenFX were not built")
    def test_ofx(self):
        done = subprocess.run([os.environ["OFX_TEST_HOST"], os.environ["PIMG_OFX"], "list"], capture_output=True, text=True,
                              timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(sorted(line.split()[0] for line in done.stdout.splitlines()),
                         sorted("org.pimg." + name for name in self.names))

    def test_pages_name_every_filter_and_only_keys_that_there_are(self):
        with open(os.path.join(DOCS, "plugin.md"), encoding="utf-8") as page:
            keys_of_reading = page.read().split("Configuration settings for reading")[1].split("for writing")[0]
        rows = {line.split("`")[1]: line for line in keys_of_reading.splitlines() if line.startswith("| `")}
        for name in self.names:
            self.assertIn(name, rows, "docs/plugin.md")
            words = [word.split("=")[0] for word in rows[name].split(";", 1)[-1].split("`")[1::2]]
            helped = self.pimgtool("--help", "--" + name.replace("_", "-")).stdout
            keys = [line.split()[0].split("=")[0] for line in helped.splitlines() if line.startswith("  ") and line.strip()]
            for word in words:
                if word not in (*self.names, "on") and not word.startswith("pimgtool"):
                    self.assertIn(word, keys, f"docs/plugin.md, {name}")
        with open(os.path.join(DOCS, "reference.md"), encoding="utf-8") as page:
            headings = [line.strip("# \n") for line in page if line.startswith("#")]
        for name in self.names:
            self.assertIn(name, headings, "docs/reference.md")

    def test_quotes_mean_the_same_everywhere(self):
        for mark in "\"'":
            quoted = f"brush={mark}{QUOTED}{mark}"
            self.assertIn(QUOTED, self.pimgtool("a.pimg", f"--paint:{quoted}:seed=2", "-o", "b.exr").stderr)
            self.assertIn(QUOTED, self.c.render(f"paint:{quoted}:seed=2"))
            with self.assertRaisesRegex(RuntimeError, QUOTED):
                read(f"a.pimg?paint=1&{quoted}&seed=2")
            unfinished = f"brush={mark}a"
            done = self.run_tool("iconvert", f"a.pimg?paint=1&{unfinished}", "out.png")
            for said in (self.pimgtool("a.pimg", f"--paint:{unfinished}", "-o", "b.exr").stderr,
                         self.c.render(f"paint:{unfinished}"),
                         "".join((done.stdout, done.stderr))):
                self.assertIn("brush: expected", said)

    def test_colons_before_digits_belong_to_the_value(self):
        curve = "curve=0:1,1:3"
        self.assertEqual(self.pimgtool("a.pimg", f"--detail-enhance:{curve}", "-o", "b.exr").returncode, 0)
        self.assertIsNone(self.c.render(f"detail_enhance:{curve}"))
        read(f"a.pimg?detail_enhance=on&{curve}")

    def test_older_spellings(self):
        for key in ("color", "colour"):
            self.assertIsNone(self.c.render(f"mosaic:tiles=50:{key}=0.7"))
            done = self.pimgtool("a.pimg", f"--mosaic:tiles=50:{key}=0.7", "-d", "float", "-o", f"{key}.exr")
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_same("color.exr", "colour.exr")
        self.assert_same("a.pimg?mosaic=1&tiles=50&color=0.7", "a.pimg?mosaic=1&tiles=50&colour=0.7")


if __name__ == "__main__":
    unittest.main()
