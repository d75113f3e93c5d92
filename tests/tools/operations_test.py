# SPDX-License-Identifier: BSD-3-Clause
"""Every operation of pimgtool on a picture, and what must hold between its results.

Starting a program that links OpenImageIO takes a third of a second, so each run does several things."""

import json
import unittest

import numpy as np

import pictures
from pictures import psnr, read, spec_of, srgb

FILTERS = (
    "--build:base=64",
    "--level:fraction=0.1",
    "--wireframe:faces=500",
    "--feature-lowpass:splits=300",
    "--detail-enhance:gain=3:from=0.05",
    "--hdr-compress:s0=0.2:beta=4",
    "--dual-pieces:fraction=0.1:output=mean",
    "--segment:threshold=50:output=mean",
    "--paint:min=2:impasto=0.5",
    "--mosaic:tiles=150",
    "--ink",
)
UNCHANGING = ("--build", "--level", "--feature-lowpass:fraction=1", "--detail-enhance:gain=1")


def each_on_a_copy(operations, *outputs):
    """Arguments that run every operation on the picture on top and write {i}-{output}."""
    arguments = []
    for i, operation in enumerate(operations):
        arguments += ["--dup", operation]
        for output in outputs:
            arguments += ["-o", f"{i}-{output}"]
        arguments.append("--pop")
    return arguments


class Operations(pictures.ToolTest):
    def setUp(self):
        super().setUp()
        pictures.write("gray.png", pictures.scene(61, 47, 1), "uint8")
        pictures.write("rgb.png", pictures.scene(61, 47), "uint8")
        pictures.write("fine.tif", pictures.scene(61, 47), "uint16")
        pictures.write("hdr.exr", pictures.hdr_scene(61, 47), "half")

    def test_every_filter_on_every_kind_of_picture(self):
        for source in ("gray.png", "rgb.png", "fine.tif", "hdr.exr"):
            self.ok(source, *each_on_a_copy(FILTERS, "out.exr", "out.png"))
            for i, operation in enumerate(FILTERS):
                with self.subTest(source=source, operation=operation):
                    for result in (f"{i}-out.exr", f"{i}-out.png"):
                        spec = spec_of(result)
                        self.assertEqual((spec.width, spec.height), (61, 47))
                        pixels = read(result)
                        self.assertTrue(np.isfinite(pixels).all())
                        self.assertGreater(pixels.std(), 0)

    def test_operations_that_change_nothing(self):
        for source in ("gray.png", "rgb.png", "fine.tif", "hdr.exr"):
            self.ok(source, *each_on_a_copy(UNCHANGING, source))
            for i, operation in enumerate(UNCHANGING):
                with self.subTest(source=source, operation=operation):
                    self.assert_same(source, f"{i}-{source}")

    def test_awkward_sizes(self):
        operations = FILTERS + UNCHANGING
        for width, height in ((1, 1), (1, 9), (9, 1), (2, 2), (3, 2)):
            pictures.write("small.png", pictures.scene(width, height), "uint8")
            self.ok("small.png", *each_on_a_copy(operations, "out.png"))
            for i, operation in enumerate(operations):
                with self.subTest(width=width, height=height, operation=operation):
                    self.assertEqual(read(f"{i}-out.png").shape[:2], (height, width))
                    if operation in UNCHANGING:
                        self.assert_same("small.png", f"{i}-out.png")

    def test_more_of_the_hierarchy_is_nearer_to_the_picture(self):
        fractions = (0.02, 0.1, 0.5)
        for operation in ("--level", "--feature-lowpass"):
            self.ok("rgb.png", *each_on_a_copy([f"{operation}:fraction={f}" for f in fractions], "out.png"))
            found = [psnr(read(f"{i}-out.png"), read("rgb.png")) for i in range(3)]
            with self.subTest(operation=operation, found=found):
                self.assertEqual(found, sorted(found))
                self.assertGreater(found[-1], 30)

    def test_keys_that_name_the_same_level(self):
        levels = ("vertices=200", f"fraction={200 / (61 * 47):.9f}", "faces=396", "faces=40")
        self.ok("rgb.png", *each_on_a_copy(["--level:" + level for level in levels], "out.png"))
        near = [psnr(read("0-out.png"), read(f"{i}-out.png")) for i in range(4)]
        self.assertGreater(near[1], 40)
        self.assertGreater(near[2], 30)  # the number of faces depends on how many vertices are on the border
        self.assertLess(near[3], near[2])

    def test_wireframe_draws_lines(self):
        self.ok("rgb.png", *each_on_a_copy(
            ("--wireframe:faces=60", "--wireframe:faces=60:overlay=1", "--wireframe:faces=400"), "out.png"))
        lines, overlay, more = (read(f"{i}-out.png") for i in range(3))
        self.assertGreater((lines == 1).mean(), 0.2)  # paper
        self.assertLess(lines.min(), 0.5)  # ink
        self.assertLess(more.mean(), lines.mean())
        self.assertGreater(psnr(overlay, read("rgb.png")), psnr(lines, read("rgb.png")))

    def test_enhancement_amplifies(self):
        gains = (0, 1, 2, 4)
        self.ok("hdr.exr", *each_on_a_copy([f"--detail-enhance:gain={gain}:from=0.3" for gain in gains], "out.exr"))
        contrast = [np.abs(np.diff(read(f"{i}-out.exr"), axis=1)).mean() for i in range(len(gains))]
        self.assertEqual(contrast, sorted(contrast))

    def test_labels_are_numbers_in_every_format(self):
        self.ok("rgb.png", "--segment:regions=300:stats=regions.csv", "-o", "out.png", "-o", "out.tif", "-o", "out.exr")
        labels = {name: read(name, kind) for name, kind in
                  (("out.png", "uint16"), ("out.tif", "uint32"), ("out.exr", "float"))}
        self.assertEqual(set(labels["out.png"].flat), set(range(300)))
        for name in labels:
            self.assertTrue(np.array_equal(labels[name].astype(int), labels["out.png"].astype(int)), name)
        with open("regions.csv", encoding="utf-8") as file:
            self.assertEqual(len(file.read().splitlines()), 301)
        self.fails("rgb.png", "--segment:regions=300", "-d", "uint8", "-o", "8.png", says="at most 256")

    def test_dual_pieces_are_nested(self):
        levels = (10, 200, 2000)
        self.ok("rgb.png", *each_on_a_copy([f"--dual-pieces:splits={level}" for level in levels], "out.tif"))
        coarse, middle, fine = (read(f"{i}-out.tif", "uint32").flatten() for i in range(len(levels)))
        for finer, coarser in ((middle, coarse), (fine, middle)):
            pairs = set(zip(finer, coarser))
            self.assertEqual(len(pairs), finer.max() + 1)
        self.assertEqual(fine.max() - middle.max(), 1800)

    def test_painting_and_drawing_export_their_strokes(self):
        self.ok("rgb.png", "--dup", "--paint:strokes=paint.svg", "--pop", "--dup", "--ink:strokes=ink.svg", "--pop",
                "--paint:strokes=paint.json", "-o", "out.png")
        for name in ("paint.svg", "ink.svg"):
            with open(name, encoding="utf-8") as file:
                self.assertTrue(file.read().startswith("<svg"), name)
        with open("paint.json", encoding="utf-8") as file:
            self.assertGreater(len(json.load(file)["strokes"]), 10)

    def test_hdr_compression_fits_a_display(self):
        self.ok("hdr.exr", "--hdr-compress", "-o", "out.exr")
        source, result = read("hdr.exr"), read("out.exr")
        ratio = lambda a: np.percentile(a, 99) / np.percentile(a, 1)
        self.assertLess(ratio(result), ratio(source) / 4)
        self.assertGreater(result.min(), 0)
        self.assertLess(np.percentile(result, 95), 1.001)
        self.assertGreater(srgb(np.median(result)), 0.2)

    def test_options_reach_the_filter(self):
        options = ("", ":s0=0.5", ":beta=3", ":saturation=0", ":key=0.4", ":s0=0.1:beta=10:saturation=0.5")
        self.ok("hdr.exr", *each_on_a_copy(["--hdr-compress" + option for option in options], "out.exr"))
        results = [read(f"{i}-out.exr") for i in range(len(options))]
        for i in range(1, len(options)):
            self.assertGreater(np.abs(results[i] - results[0]).max(), 1e-3, options[i])
        grey = results[3]
        self.assertLess(np.abs(grey[..., 0] - grey[..., 2]).max(), 2e-3)

    def test_threads_change_nothing(self):
        pictures.write("large.exr", pictures.hdr_scene(400, 300), "half")
        for threads in (1, 2):
            self.ok("large.exr", "-d", "float", "--threads", threads, *each_on_a_copy(FILTERS, f"{threads}.exr"))
        for i, operation in enumerate(FILTERS):
            with self.subTest(operation=operation):
                self.assert_same(f"{i}-1.exr", f"{i}-2.exr")

    def test_operations_chain(self):
        self.ok("hdr.exr", "-d", "float", "--hdr-compress", "-o", "first.exr", "--feature-lowpass:fraction=0.2",
                "-o", "at_once.exr", "first.exr", "--feature-lowpass:fraction=0.2", "-o", "second.exr")
        self.assert_same("at_once.exr", "second.exr")


class Stack(pictures.ToolTest):
    def setUp(self):
        super().setUp()
        pictures.write("a.png", pictures.scene(40, 30), "uint8")
        pictures.write("b.png", 1 - pictures.scene(50, 20), "uint8")

    def figures(self, *arguments):
        return json.loads(self.ok(*arguments, "--stats:format=json"))

    def test_dup_pop_swap(self):
        self.ok("a.png", "b.png", "-o", "top.png", "--swap", "-o", "swapped.png", "--pop", "-o", "popped.png",
                "a.png", "--dup", "--level:faces=50", "--pop", "-o", "untouched.png")
        self.assert_same("top.png", "b.png")
        self.assert_same("swapped.png", "a.png")
        self.assert_same("popped.png", "b.png")
        self.assert_same("untouched.png", "a.png")

    def test_copies_and_files_named_twice_share_one_hierarchy(self):
        self.ok("a.png", "--level:faces=200", "-o", "alone.png")
        for again in (("--dup", "--level:faces=50", "--pop"), ("--level:faces=50", "-o", "1.png", "a.png")):
            with self.subTest(again=again):
                figures = self.figures("a.png", *again, "--level:faces=200", "-o", "2.png")
                self.assertEqual(len(figures["hierarchies"]), 1)
                self.assert_same("2.png", "alone.png")

    def test_a_file_written_in_between_is_read_again(self):
        self.ok("b.png", "-o", "c.png", "c.png", "a.png", "-o", "c.png", "c.png", "-o", "d.png",
                "b.png", "-o", "a.png", "a.png", "-o", "e.png")
        self.assertEqual(read("c.png").shape, (30, 40, 3))
        self.assert_same("d.png", "c.png")
        self.assert_same("a.png", "b.png")
        self.assert_same("e.png", "b.png")

    def test_build_is_used_by_what_follows(self):
        built = self.figures("a.png", "--build:base=300", "--level:splits=0", "-o", "base.png",
                             "a.png", "--level:faces=300", "-o", "level.png")["hierarchies"]
        self.assertEqual(len(built), 2)
        self.assertLessEqual(abs(built[0]["base_faces"] - 300), 2)
        self.assertLess(built[1]["base_faces"], 200)
        self.assertGreater(psnr(read("base.png"), read("level.png")), 25)

    def test_figures(self):
        figures = self.figures("a.png", "--level:faces=50", "-o", "out.png", "--threads", 1)
        built = figures["hierarchies"][0]
        self.assertEqual((built["width"], built["height"], built["channels"]), (40, 30, 3))
        self.assertEqual((built["name"], built["type"], built["guide"]), ("a.png", "uint8", "luma"))
        self.assertEqual(built["vertices"], 40 * 30)
        self.assertEqual(built["splits"] + built["base_vertices"], built["vertices"])
        self.assertEqual(built["faces"], 2 * 39 * 29)
        self.assertEqual(set(figures["seconds"]), {"read", "luminance", "build", "filter", "write", "total"})
        stages = sum(seconds for stage, seconds in figures["seconds"].items() if stage != "total")
        self.assertLessEqual(stages, figures["seconds"]["total"] * 1.01)
        self.assertEqual(figures["threads"], 1)
        self.assertGreater(figures["peak_memory_bytes"], 1 << 20)

    def test_figures_for_people(self):
        done = self.run_tool("a.png", "--level:faces=50", "-o", "out.png", "--stats", "-v")
        self.assertEqual(done.returncode, 0)
        for word in ("a.png", "1200 vertices", "splits", "faces", "build", "write", "peak memory"):
            self.assertIn(word, done.stdout)
        for word in ("a.png", "40 x 30", "vertices", "out.png", "uint8"):
            self.assertIn(word, done.stderr)  # -v


if __name__ == "__main__":
    unittest.main()
