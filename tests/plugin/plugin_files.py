# SPDX-License-Identifier: BSD-3-Clause
"""Runs OpenImageIO's own tools with the plugin ($PIMG_PLUGIN, found through $OIIO_LIBRARY_PATH) in a scratch folder."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import OpenImageIO as oiio

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tools"))
from pictures import opened, read  # noqa: E402, F401

PLUGIN = os.environ["PIMG_PLUGIN"]


def tool(name):
    """Path of one of OpenImageIO's tools; they lie beside each other."""
    beside = os.path.join(os.path.dirname(os.environ["OIIOTOOL"]), name)
    return beside if os.path.exists(beside) else shutil.which(name)


def scene(width, height, channels=3):
    """A shaded background, a bright disc, a dark bar: 0..1, always the same."""
    y, x = np.mgrid[0:height, 0:width].astype(np.float64)
    picture = 0.2 + 0.4 * x / width + 0.1 * np.sin(y / 3)
    picture[(x - 0.65 * width) ** 2 + (y - 0.4 * height) ** 2 < (0.22 * height) ** 2] = 0.9
    picture[int(0.75 * height) : int(0.82 * height), int(0.1 * width) : int(0.6 * width)] = 0.05
    return np.clip(picture[..., None] * np.array([1.0, 0.8, 0.6, 1.0])[:channels], 0, 1)


def write(name, pixels, kind, attributes=None, origin=None, full=None):
    pixels = np.ascontiguousarray(pixels, dtype=np.float32)
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, kind)
    if origin:
        spec.x, spec.y = origin
    if full:
        spec.full_x, spec.full_y, spec.full_width, spec.full_height = full
    for key, value in (attributes or {}).items():
        spec.attribute(key, value)
    out = oiio.ImageOutput.create(name)
    if not out.open(name, spec) or not out.write_image(pixels) or not out.close():
        raise RuntimeError(out.geterror())


def bytes_of(name):
    with open(name, "rb") as file:
        return file.read()


def store(name, data):
    with open(name, "wb") as file:
        file.write(data)


class PluginTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="pimg_plugin_")
        self.addCleanup(scratch.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(scratch.name)

    def run_tool(self, name, *arguments, **options):
        return subprocess.run(
            [tool(name), *map(str, arguments)], capture_output=True, text=True, timeout=60, **options
        )

    def ok(self, name, *arguments, **options):
        """Runs a tool that must succeed and say nothing on standard error."""
        done = self.run_tool(name, *arguments, **options)
        self.assertEqual(done.returncode, 0, f"{name} {arguments}: {done.stdout}{done.stderr}")
        self.assertEqual(done.stderr, "")
        return done.stdout

    def fails(self, name, *arguments, says, **options):
        done = self.run_tool(name, *arguments, **options)
        self.assertGreater(done.returncode, 0, arguments)
        for word in [says] if isinstance(says, str) else says:
            self.assertIn(word, done.stdout + done.stderr)

    def assert_same(self, a, b):
        left, right = read(a), read(b)
        self.assertEqual(left.shape, right.shape)
        self.assertTrue(np.array_equal(left, right, equal_nan=True), f"{a} and {b} differ")
