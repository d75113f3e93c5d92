# SPDX-License-Identifier: BSD-3-Clause
"""The plugin in OpenImageIO's tools: found, converting, textures, viewer, errors."""

import os
import re
import shutil
import signal
import subprocess
import unittest

import numpy as np
import OpenImageIO as oiio

import plugin_files
from plugin_files import PLUGIN, bytes_of, opened, read, scene, store, write


class Catalogue(plugin_files.PluginTest):
    def test_formats_list_it_once(self):
        listed = self.ok("oiiotool", "--list-formats")
        self.assertEqual(re.findall(r"pimg *:.*", listed), ["pimg : pimg"], listed)
        if oiio.VERSION < 30000:  # later ones list no libraries of formats
            self.assertIn("pimg 0", self.ok("oiiotool", "--help"))
        self.assertIn("pimg", oiio.get_string_attribute("format_list").split(","))

    def test_a_searchpath_finds_it_without_the_environment(self):
        write("a.exr", scene(16, 16), "half")
        clean = {k: v for k, v in os.environ.items() if k not in ("OIIO_LIBRARY_PATH", "OPENIMAGEIO_PLUGIN_PATH")}
        folder = os.path.dirname(PLUGIN)
        self.ok("oiiotool", "--oiioattrib", "plugin_searchpath", folder, "a.exr", "-o", "a.pimg", env=clean)
        self.assert_same("a.exr", "a.pimg")

    @unittest.skipUnless(shutil.which("nm") and shutil.which("ldd"), "needs binutils")
    def test_six_symbols_and_none_missing(self):
        symbols = subprocess.run(["nm", "-D", "--defined-only", PLUGIN], capture_output=True, text=True).stdout
        self.assertEqual(
            sorted(line.split()[-1] for line in symbols.splitlines()),
            [
                "pimg_imageio_library_version",
                "pimg_imageio_version",
                "pimg_input_extensions",
                "pimg_input_imageio_create",
                "pimg_output_extensions",
                "pimg_output_imageio_create",
            ],
        )
        missing = subprocess.run(["ldd", "-r", PLUGIN], capture_output=True, text=True)
        self.assertNotRegex(missing.stdout + missing.stderr, "undefined symbol|not found")


    @unittest.skipUnless(shutil.which("file"), "needs file")
    def test_file_knows_the_magic(self):
        magic = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "codec", "share", "pimg.magic")
        write("a.pimg", scene(20, 10), "uint8", {"pimg:profile": "full"})
        done = subprocess.run(["file", "-m", magic, "a.pimg"], capture_output=True, text=True)
        self.assertIn("Progressive image (PIMG) data, version 1.0, full, 20 x 10, 3 channels", done.stdout)
        done = subprocess.run(["file", "--mime-type", "-m", magic, "a.pimg"], capture_output=True, text=True)
        self.assertIn("image/x-pimg", done.stdout)


class Converting(plugin_files.PluginTest):
    def test_there_and_back(self):
        for name, kind in (("a.png", "uint8"), ("b.png", "uint16"), ("c.exr", "half"), ("d.tif", "float")):
            # PNG has no associated alpha: OpenImageIO itself changes it on the way.
            write(name, scene(70, 50, 3 if name.endswith(".png") else 4), kind)
            for profile in ("compact", "full"):
                self.ok("oiiotool", name, "--attrib", "pimg:profile", profile, "-o", "a.pimg")
                self.ok("oiiotool", "a.pimg", "-o", "back_" + name)
                self.assert_same(name, "back_" + name)
                self.assertEqual(opened("back_" + name).spec().format, opened(name).spec().format)
                self.assertEqual(opened("a.pimg").spec().get_string_attribute("compression"), profile)
            self.ok("iconvert", name, "b.pimg")
            self.ok("iconvert", "b.pimg", "c.pimg")
            self.ok("idiff", "-a", name, "b.pimg")
            self.ok("idiff", "b.pimg", "c.pimg")
            for keys in ("", ":profile=compact:quality=100"):
                self.ok(os.environ["PIMGTOOL"], name, "-o", f"d.pimg{keys}", "d.pimg", "-o", "d_" + name)
                self.assert_same(name, "d_" + name)

    def test_windows_survive(self):
        # Inside the display window, and larger than it.
        for origin, full in (((-5, 12), (-20, 0, 100, 60)), ((-10, -10), (0, 0, 20, 10))):
            write("a.exr", scene(40, 30), "half", origin=origin, full=full)
            self.ok("oiiotool", "a.exr", "-o", "a.pimg")
            self.ok("oiiotool", "a.pimg", "-o", "b.exr")
            self.assertEqual(opened("b.exr").spec().roi, opened("a.exr").spec().roi)
            self.assertEqual(opened("b.exr").spec().roi_full, opened("a.exr").spec().roi_full)
            self.assert_same("a.exr", "b.exr")

    def test_build_options_at_write_time(self):
        write("a.exr", scene(70, 50), "half")
        sizes = {}
        for options in ("mesh=full", "mesh=adaptive", "mesh=adaptive density=0.1", "guide=rgb", "quality=0", "quality=100"):
            hints = [word for pair in options.split() for word in ("--attrib", "pimg:" + pair.split("=")[0], pair.split("=")[1])]
            for profile in ("compact", "full"):
                self.ok("oiiotool", "a.exr", "--attrib", "pimg:profile", profile, *hints, "-o", "a.pimg")
                self.assert_same("a.exr", "a.pimg")
                self.assertIsNone(opened("a.pimg").spec().getattribute("pimg:mesh"))
                sizes[options] = os.path.getsize("a.pimg")
            # All details and what the mesh cannot show, back through the stored hierarchy.
            self.assertLess(np.abs(read("a.pimg?detail_enhance=1") - read("a.exr")).max(), 1e-4, options)
        self.assertLess(sizes["mesh=adaptive"], sizes["mesh=full"])
        self.assertLess(sizes["mesh=adaptive density=0.1"], sizes["mesh=adaptive"])
        for key, value in (("mesh", "dense"), ("density", "7"), ("guide", "blue"), ("quality", "101"), ("tile", "8")):
            self.fails("oiiotool", "a.exr", "--attrib", "pimg:" + key, value, "-o", "no.pimg", says=[key, value])
        self.assertFalse(os.path.exists("no.pimg"))

    def test_metadata_survives_and_hints_do_not(self):
        attributes = {"Artist": "somebody", "my:number": 3, "my:share": 0.25}
        write("a.exr", scene(16, 16), "half", attributes)
        self.ok("oiiotool", "a.exr", "--attrib", "pimg:effort", 2, "-o", "a.pimg")
        self.ok("oiiotool", "a.pimg", "-o", "b.exr")
        for name in ("a.pimg", "b.exr"):
            for key, value in attributes.items():
                self.assertEqual(opened(name).spec().getattribute(key), value, name)
            self.assertIsNone(opened(name).spec().getattribute("pimg:effort"))

    def test_compression_names_the_profile(self):
        write("a.exr", scene(40, 30), "half")
        self.ok("oiiotool", "a.exr", "--compression", "full:2", "-o", "a.pimg")
        self.assertEqual(opened("a.pimg").spec().get_string_attribute("compression"), "full")
        self.ok("oiiotool", "a.pimg", "-o", "b.pimg")
        self.assertEqual(opened("b.pimg").spec().get_string_attribute("compression"), "full")
        self.ok("oiiotool", "a.exr", "--compression", "dwaa:45", "-o", "c.pimg")
        self.assertEqual(opened("c.pimg").spec().get_string_attribute("compression"), "compact")
        self.fails("oiiotool", "a.exr", "--compression", "full:9", "-o", "d.pimg", says="effort")

    def test_parts_and_tiles(self):
        write("a.exr", scene(150, 90, 4), "half")
        self.ok("oiiotool", "a.exr", "--tile", 32, 48, "-o", "a.pimg")
        self.assert_same("a.exr", "a.pimg")
        self.ok("oiiotool", "-i:ch=B,A", "a.pimg", "-o", "ba.exr")
        self.assertTrue(np.array_equal(read("ba.exr"), read("a.exr")[..., 2:4]))
        self.ok("oiiotool", "a.pimg", "--crop", "20x10+70+40", "-o", "crop.exr")
        self.assertTrue(np.array_equal(read("crop.exr"), read("a.exr")[40:50, 70:90]))

    def test_names_do_not_matter(self):
        write("a.png", scene(16, 16), "uint8")
        write("a.pimg", scene(20, 20), "uint8")
        shutil.copy("a.png", "png_inside.pimg")
        for name in ("pimg_inside.png", "pimg_inside.xyz", "pimg_inside"):
            shutil.copy("a.pimg", name)
            self.assertIn("20 x   20", self.ok("iinfo", name))
            self.assert_same("a.pimg", name)
        self.assertIn("16 x   16", self.ok("iinfo", "png_inside.pimg"))
        shutil.copy("a.pimg", "literal?name=1.pimg")
        self.assertIn("20 x   20", self.ok("iinfo", "literal?name=1.pimg"))

    def test_iinfo_tells_all(self):
        write("a.pimg", scene(40, 30, 4), "half", {"Artist": "somebody"})
        told = self.ok("iinfo", "-v", "a.pimg")
        for word in ("40 x   30, 4 channel, half pimg", "R, G, B, A", 'Artist: "somebody"', 'compression: "compact"'):
            self.assertIn(word, told)
        self.assertIn("SHA-1", self.ok("iinfo", "--hash", "a.pimg"))


class Levels(plugin_files.PluginTest):
    def test_mip_levels_on_request(self):
        write("a.exr", scene(130, 70), "half")
        self.ok("oiiotool", "a.exr", "-o", "a.pimg")
        self.assertNotIn("MIP", self.ok("iinfo", "-v", "a.pimg"))
        self.assertIn("MIP-map levels: 130x70 65x35 32x17 16x8 8x4 4x2 2x1 1x1", self.ok("iinfo", "-v", "a.pimg?mip=1"))
        for name in ("b.exr", "b.tif"):
            self.ok("oiiotool", "a.pimg?mip=1", "-o", name)
            self.assertIn("MIP-map levels: 130x70 65x35", self.ok("iinfo", "-v", name))
            self.assert_same("a.exr", name)
            self.ok("oiiotool", "a.pimg", "-o", "plain_" + name)
            self.assertNotIn("MIP", self.ok("iinfo", "-v", "plain_" + name))
        self.ok("oiiotool", "a.pimg?mip=1", "--selectmip", 2, "-o", "c.exr")
        self.assertEqual(read("c.exr").shape, (17, 32, 3))
        write("e.pimg", scene(128, 64), "float")
        self.ok("oiiotool", "e.pimg?mip=1", "--selectmip", 2, "-o", "e.exr")
        halves = read("e.pimg").reshape(16, 4, 32, 4, 3).mean((1, 3))
        self.assertLess(np.abs(read("e.exr") - halves).max(), 1e-5)
        self.ok("oiiotool", "a.pimg?mip=1", "--unmip", "-o", "d.exr")
        self.assertNotIn("MIP", self.ok("iinfo", "-v", "d.exr"))

    def test_textures(self):
        write("a.pimg", scene(128, 64), "half")
        self.ok("maketx", "a.pimg", "-o", "a.tx")
        self.ok("oiiotool", "a.pimg", "-otex", "b.tx")
        self.ok("oiiotool", "a.pimg?feature_lowpass=0.2", "-otex", "c.tx")
        for name in ("a.tx", "b.tx", "c.tx"):
            self.assertIn("MIP-map levels: 128x64 64x32", self.ok("iinfo", "-v", name))
        if plugin_files.tool("testtex"):
            self.ok("testtex", "--nowarp", "-res", 64, 64, "a.pimg?mip=1", "-o", "out.exr")
            self.assertGreater(read("out.exr").mean(), 0.1)

    @unittest.skipUnless(plugin_files.tool("iv") and shutil.which("xvfb-run"), "needs iv and Xvfb")
    def test_viewer(self):
        write("a.pimg", scene(128, 64), "half")
        # It stays open until it is ended.
        viewer = subprocess.Popen(
            ["xvfb-run", "-a", plugin_files.tool("iv"), "-F", "a.pimg?mip=1"],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        try:
            viewer.wait(4)
            self.fail(viewer.stdout.read())
        except subprocess.TimeoutExpired:
            pass
        finally:
            os.killpg(viewer.pid, signal.SIGTERM)
            viewer.communicate()


class Errors(plugin_files.PluginTest):
    def test_missing_folder(self):
        write("a.exr", scene(16, 16), "half")
        for name in ("oiiotool", "iconvert"):
            arguments = ["a.exr", "-o", "no/a.pimg"] if name == "oiiotool" else ["a.exr", "no/a.pimg"]
            self.fails(name, *arguments, says="no/a.pimg")

    def test_a_full_disk_is_an_error_and_leaves_what_was(self):
        write("a.exr", np.random.default_rng(1).random((200, 200, 3)), "float")
        write("old.pimg", scene(8, 8), "uint8")

        def small_files():
            import resource

            resource.setrlimit(resource.RLIMIT_FSIZE, (50000, 50000))

        before = bytes_of("old.pimg")
        # Python ignores SIGXFSZ, and its children must go on doing so: then write() fails as on a full disk.
        limited = {"preexec_fn": small_files, "restore_signals": False}
        for name in ("new.pimg", "old.pimg"):
            self.fails("oiiotool", "a.exr", "-o", name, says="too large", **limited)
            self.fails("iconvert", "a.exr", name, says="too large", **limited)
        self.assertEqual(bytes_of("old.pimg"), before)
        self.assertEqual(sorted(os.listdir()), ["a.exr", "old.pimg"])

    def test_unreadable_files_are_refused_at_once(self):
        store("junk.pimg", b"junk" * 100)
        store("empty.pimg", b"")
        store("junk.xyz", b"junk" * 100)
        write("a.pimg", scene(40, 40), "uint8")
        whole = bytes_of("a.pimg")
        store("cut.pimg", whole[: len(whole) // 2])
        for name in ("junk.pimg", "empty.pimg", "junk.xyz", "absent.pimg"):
            # A hang would be the lock of OpenImageIO's list of formats, which is held while every reader is tried.
            self.fails("oiiotool", name, "-o", "out.exr", says="")
            self.fails("iinfo", name, says="")
        # The plugin, which is asked too, adds nothing to what is said of others' files.
        clean = {k: v for k, v in os.environ.items() if k not in ("OIIO_LIBRARY_PATH", "OPENIMAGEIO_PLUGIN_PATH")}
        with_plugin, without = self.run_tool("iinfo", "junk.xyz"), self.run_tool("iinfo", "junk.xyz", env=clean)
        self.assertEqual((with_plugin.stdout, with_plugin.stderr), (without.stdout, without.stderr))
        self.fails("oiiotool", "cut.pimg", "-o", "out.exr", says="partial=1")
        self.ok("oiiotool", "cut.pimg?partial=1", "-o", "part.exr")
        self.assertLess(np.abs(read("part.exr") - read("a.pimg")).mean(), 0.2)

    def test_volumes_are_refused(self):
        spec = oiio.ImageSpec(8, 8, 1, "uint8")
        spec.depth = 2
        out = oiio.ImageOutput.create("a.pimg")
        self.assertFalse(out.open("a.pimg", spec))
        self.assertIn("volumes", out.geterror())


if __name__ == "__main__":
    unittest.main()
