# SPDX-License-Identifier: BSD-3-Clause
"""Panoramas and tiles: no filter leaves a line where their sides meet."""

import json
import unittest

import numpy as np

import pictures
from pictures import read, spec_of

WIDTH, HEIGHT = 256, 128


def periodic(width, height, across):
    """Waves and hard-edged discs that continue over the seams: in x, and in y if `across` both."""
    y, x = np.mgrid[0:height, 0:width]
    random = np.random.default_rng(5)
    picture = np.zeros((height, width))
    for k in (1, 2, 3, 5, 9, 17):
        for m in (1, 3):
            phase = random.random() * 6
            rows = 2 * m * y / height if across else m * y / height
            picture += np.sin(np.pi * (2 * k * x / width + rows) + phase) / k * 0.12
    for _ in range(14):
        cx, cy, radius = random.random() * width, random.random() * height, 4 + random.random() * 14
        dx = (x - cx + width / 2) % width - width / 2
        dy = (y - cy + height / 2) % height - height / 2 if across else y - cy
        picture[dx * dx + dy * dy < radius * radius] += random.random() - 0.5
    light = np.exp2(2 * picture)[..., None] * np.array([1, 0.9, 0.8])
    return light * (1 + 0.03 * random.standard_normal((height, width, 1)))


def seam(pixels, axis):
    """The 95th percentile of the steps at the seam, over the median of that of all other columns or rows."""
    values = np.log2(np.maximum(pixels.mean(2), 1e-4))
    steps = np.abs(np.roll(values, -1, axis) - values)
    steps = np.percentile(steps, 95, axis=1 - axis)
    return steps[-1], steps[:-1]


def write_panorama_jpeg(name, picture):
    """A JPEG file with the tags of programs for panoramas, which OpenImageIO does not write."""
    pictures.write(name, picture, "uint8")
    packet = (
        b"http://ns.adobe.com/xap/1.0/\0<x:xmpmeta xmlns:x='adobe:ns:meta/'>"
        b"<rdf:RDF xmlns:rdf='http://www.w3.org/1999/02/22-rdf-syntax-ns#'>"
        b"<rdf:Description rdf:about='' xmlns:GPano='http://ns.google.com/photos/1.0/panorama/'>"
        b"<GPano:ProjectionType>equirectangular</GPano:ProjectionType></rdf:Description></rdf:RDF></x:xmpmeta>"
    )
    with open(name, "rb") as file:
        jpeg = file.read()
    with open(name, "wb") as file:
        file.write(jpeg[:2] + b"\xff\xe1" + (len(packet) + 2).to_bytes(2, "big") + packet + jpeg[2:])


FILTERS = (
    "--feature-lowpass:log=1:strength=0.4",
    "--feature-lowpass:fraction=0.05",
    "--detail-enhance:gain=3",
    "--detail-enhance:strength=0.3:gain=3:log=1",
    "--level:fraction=0.02",
    "--paint",
    "--paint:impasto=0.5",
    "--hdr-compress",
    "--segment:regions=60:output=mean",
    "--dual-pieces:fraction=0.02:output=mean",
)


class Seams(pictures.ToolTest):
    def check(self, wrap, axes):
        # One build for all.
        arguments = [f"--build:wrap={wrap}"]
        for i, command in enumerate(FILTERS):
            arguments += ["--dup", command, "-d", "float", "-o", f"out{i}.exr", "--pop"]
        self.ok("in.exr", *arguments)
        for i, command in enumerate(FILTERS):
            for axis in axes:
                at_seam, elsewhere = seam(read(f"out{i}.exr"), axis)
                self.assertLessEqual(at_seam, np.percentile(elsewhere, 99), f"{wrap} {command} {axis}")

    def test_panorama(self):
        pictures.write("in.exr", periodic(WIDTH, HEIGHT, False), "float")
        self.check("x", (1,))

    def test_tile(self):
        pictures.write("in.exr", periodic(WIDTH, HEIGHT, True), "float")
        self.check("xy", (0, 1))

    def test_drawings_continue(self):
        # Of lines and joints, as many cross a seam as any other column: what is drawn on one side continues on the other.
        pictures.write("in.exr", periodic(WIDTH, HEIGHT, False), "float")
        for command in ("--ink", "--ink:style=stipple", "--mosaic:tiles=300", "--wireframe:faces=800"):
            self.ok("in.exr", "--build:wrap=x", command, "-d", "float", "-o", "out.exr")
            self.assertEqual(read("out.exr").shape, (HEIGHT, WIDTH, 3))
            dark = read("out.exr").mean(2) < 0.5 * np.median(read("out.exr"))
            columns = dark.mean(0)
            for end in (columns[0], columns[-1]):
                self.assertLessEqual(end, np.percentile(columns, 99), command)

    def test_strokes_cross(self):
        pictures.write("in.exr", periodic(WIDTH, HEIGHT, False), "float")
        for command in ("--paint", "--ink"):
            self.ok("in.exr", "--build:wrap=x", f"{command}:strokes=s.json", "-o", "out.png")
            with open("s.json", encoding="utf-8") as file:
                strokes = json.load(file)
            self.assertEqual((strokes["width"], strokes["height"]), (WIDTH, HEIGHT))
            lines = strokes["strokes" if command == "--paint" else "lines"]
            ends = [[point[0] for point in line["points"]] for line in lines]
            beyond = [(min(x), max(x)) for x in ends if min(x) < -0.5 or max(x) > WIDTH - 0.5]
            self.assertGreater(len(beyond), 4, command)
            for first, last in beyond:  # each is there again, a picture's width away
                other = WIDTH if first < 0 else -WIDTH
                again = [abs(min(x) - first - other) < 1e-2 and abs(max(x) - last - other) < 1e-2 for x in ends]
                self.assertTrue(any(again), command)

    def test_labels_continue(self):
        for wrap, axes in (("x", (1,)), ("xy", (0, 1))):
            picture = periodic(WIDTH, HEIGHT, wrap == "xy")
            for command in ("--segment:regions=60", "--dual-pieces:fraction=0.01"):
                seams, others = {0: [], 1: []}, {0: [], 1: []}
                for shift in range(0, WIDTH, WIDTH // 4):
                    pictures.write("in.exr", np.roll(picture, shift, 1), "float")
                    self.ok("in.exr", f"--build:wrap={wrap}", command, "-d", "float", "-o", "out.exr")
                    labels = read("out.exr")[..., 0]
                    count = int(labels.max()) + 1
                    self.assertEqual(len(np.unique(labels)), count)
                    if "segment" in command:
                        self.assertEqual(count, 60)
                    for axis in axes:
                        differ = (np.roll(labels, -1, axis) != labels).mean(1 - axis)
                        seams[axis].append(differ[-1])
                        others[axis].append(np.percentile(differ[:-1], 95))
                for axis in axes:
                    self.assertLess(np.mean(seams[axis]), np.mean(others[axis]), command)

    def test_figures_of_a_region_that_crosses(self):
        picture = np.full((32, 64, 3), 0.2)
        picture[8:24, :6] = picture[8:24, -10:] = 0.9
        pictures.write("in.png", picture, "uint8")
        self.ok("in.png", "--build:wrap=x", "--segment:regions=2:stats=s.json", "-o", "out.png")
        with open("s.json", encoding="utf-8") as file:
            box = min(json.load(file), key=lambda region: region["pixels"])
        self.assertEqual((box["pixels"], box["x"], box["y"]), (256, 61.5, 15.5))
        self.assertEqual((box["xmin"], box["xmax"]), (54, 69))

    def test_amplifying_by_one_changes_no_bit(self):
        pictures.write("in.exr", periodic(WIDTH, HEIGHT, True), "float")
        self.ok("in.exr", "--build:wrap=xy", "--detail-enhance:gain=1", "-o", "out.exr")
        self.assertTrue(np.array_equal(read("in.exr"), read("out.exr")))

    def test_special_samples(self):
        picture = periodic(64, 32, True)
        picture[3, 0, 0] = np.nan
        picture[0, 5] = np.inf
        pictures.write("in.exr", picture, "float")
        self.ok("in.exr", "--build:wrap=xy", "--feature-lowpass:strength=0.1", "-o", "out.exr")
        out = read("out.exr")
        self.assertTrue(np.isnan(out[3, 0, 0]) and np.isposinf(out[0, 5]).all())
        self.assertEqual(np.isfinite(out).sum(), out.size - 4)


class Asked(pictures.ToolTest):
    def said(self, *arguments):
        done = self.run_tool("-v", *arguments, "--level:fraction=0.1", "-o", "out.exr")
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr

    def test_metadata_turn_it_on(self):
        picture = np.clip(periodic(64, 32, False) / 4, 0, 1)
        pictures.write("map.exr", picture, "half", {"textureformat": "LatLong Environment"})
        pictures.write("pano.png", picture, "uint8", {"GPano:ProjectionType": "equirectangular"})
        write_panorama_jpeg("pano.jpg", picture)
        for name in ("map.exr", "pano.png", "pano.jpg"):
            self.assertIn("wrap=x", self.said(name), name)
            self.assertNotIn("wrap=", self.said(name, "--build:wrap=none"), name)
        pictures.write("plain.exr", periodic(64, 32, False), "half")
        self.assertNotIn("wrap=", self.said("plain.exr"))

    def test_results_say_it_again(self):
        pictures.write("map.exr", periodic(64, 32, False), "half", {"textureformat": "LatLong Environment"})
        self.ok("map.exr", "--level:fraction=0.1", "-o", "out.exr")
        self.assertEqual(spec_of("out.exr").get_string_attribute("textureformat"), "LatLong Environment")

    def test_parts_of_a_picture_are_refused(self):
        pictures.write("crop.exr", periodic(64, 32, False), "half", full=(0, 0, 80, 32))
        done = self.run_tool("crop.exr", "--build:wrap=x", "--level", "-o", "out.exr")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("wrap=x: expected a picture that fills its display window", done.stderr)
        done = self.run_tool("crop.exr", "--build:wrap=y", "--level", "-o", "out.exr")
        self.assertIn("expected one of none, x, xy", done.stderr)

    def test_pimg_files_keep_the_picture_and_say_it(self):
        # A stored mesh has no margins: what reads a panorama builds anew.
        pictures.write("map.exr", periodic(64, 32, False), "half", {"textureformat": "LatLong Environment"})
        self.ok("map.exr", "-o", "map.pimg")
        self.assertTrue(np.array_equal(read("map.exr"), read("map.pimg")))
        self.assertIn("wrap=x", self.said("map.pimg"))
        self.ok("map.exr", "--feature-lowpass", "-d", "float", "-o", "a.exr")
        self.ok("map.pimg", "--feature-lowpass", "-d", "float", "-o", "b.exr")
        self.assertTrue(np.array_equal(read("a.exr"), read("b.exr")))
        filtered = read("map.pimg?feature_lowpass=on")
        self.assertLess(np.abs(filtered - read("a.exr")).max(), 2e-3)


if __name__ == "__main__":
    unittest.main()
