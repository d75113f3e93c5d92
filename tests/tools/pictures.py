# SPDX-License-Identifier: BSD-3-Clause
"""Runs pimgtool ($PIMGTOOL) in a scratch folder, on small pictures made here."""

import os
import subprocess
import tempfile
import unittest

import numpy as np
import OpenImageIO as oiio

import warm

SRGB = ("sRGB", "srgb_rec709_scene")  # what OpenImageIO calls it, up to 3.0 and later

TOOL = os.path.abspath(os.environ["PIMGTOOL"])

# Nothing of the user's may change a result.
for name in ("OCIO", "OCIO_OPTIMIZATION_FLAGS", "OPENIMAGEIO_OPTIONS"):
    os.environ.pop(name, None)

# pimgtool with its libraries loaded, where the build has it.
WARM = warm.Program(TOOL, os.environ["PIMGTOOL_WARM"]) if os.environ.get("PIMGTOOL_WARM") else None


def scene(width, height, channels=3):
    """A shaded background, a bright disc, a dark bar and a little noise: 0..1, always the same."""
    y, x = np.mgrid[0:height, 0:width].astype(np.float64)
    picture = 0.2 + 0.4 * x / width
    disc = (x - 0.65 * width) ** 2 + (y - 0.4 * height) ** 2 < (0.22 * height) ** 2
    picture[disc] = 0.9
    picture[int(0.75 * height) : int(0.82 * height), int(0.1 * width) : int(0.6 * width)] = 0.05
    picture += np.random.default_rng(7).normal(0, 0.01, picture.shape)
    tint = np.array([1.0, 0.8, 0.6, 1.0])[:channels]
    return np.clip(picture[..., None] * tint, 0, 1)


def hdr_scene(width, height):
    """The same with the disc a thousand times brighter than the bar."""
    return scene(width, height) ** 3 * 200


def write(name, pixels, kind, attributes=None, names=None, origin=None, full=None):
    """Writes an array with values 0..1, or any for half and float."""
    pixels = np.ascontiguousarray(pixels, dtype=np.float32)
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, kind)
    if names:
        spec.channelnames = names
        spec.alpha_channel = names.index("A") if "A" in names else -1
    if origin:
        spec.x, spec.y = origin
    if full:
        spec.full_x, spec.full_y, spec.full_width, spec.full_height = full
    for key, value in (attributes or {}).items():
        spec.attribute(key, value)
    buffer = oiio.ImageBuf(spec)
    buffer.set_pixels(buffer.roi, pixels)
    if not buffer.write(name):
        raise RuntimeError(buffer.geterror())


def opened(name, config=None):
    # Not by ImageBuf, whose cache would go on showing what was in the file before.
    file = oiio.ImageInput.open(name, config) if config else oiio.ImageInput.open(name)
    if file is None:
        raise RuntimeError(oiio.geterror())
    return file


def spec_of(name):
    return opened(name).spec()


def read(name, kind=oiio.FLOAT, config=None):
    """The pixels of a file as float, or as another type; `config` is an ImageSpec of hints for the reader."""
    file = opened(name, config)
    pixels = file.read_image(0, 0, 0, file.spec().nchannels, kind)
    if pixels is None:
        raise RuntimeError(file.geterror())
    return pixels.reshape(file.spec().height, file.spec().width, -1)


def codes(name):
    """The pixels of an 8-bit file as whole numbers."""
    return read(name, oiio.UINT8).astype(int)


def oiiotool(*arguments, env=None):
    """OpenImageIO's own tool, to make and to compare pictures."""
    subprocess.run([os.environ["OIIOTOOL"], *map(str, arguments)], check=True, env={**os.environ, **(env or {})})


def srgb(linear):
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def psnr(a, b):
    return 10 * np.log10(1 / max(np.mean((a - b) ** 2), 1e-20))


class ToolTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="pimgtool_")
        self.addCleanup(scratch.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(scratch.name)

    def run_tool(self, *arguments, env=None):
        if WARM and not env:
            return WARM.run(*arguments, timeout=60)
        return subprocess.run(
            [TOOL, *map(str, arguments)],
            capture_output=True,
            text=True,
            timeout=60,
            env={**os.environ, **(env or {})},
        )

    def ok(self, *arguments, env=None):
        """Runs a command that must succeed in silence but for what was asked for, and leave no temporary file."""
        done = self.run_tool(*arguments, env=env)
        self.assertEqual(done.returncode, 0, f"{arguments}: {done.stderr}")
        self.assertEqual([name for name in os.listdir() if ".temp" in name], [])
        if "-v" not in arguments:
            self.assertEqual(done.stderr, "")
        return done.stdout

    def fails(self, *arguments, says, env=None):
        """Runs a command that must fail with one line on standard error and leave everything as it was."""
        before = {name: os.stat(name).st_mtime_ns for name in os.listdir()}
        done = self.run_tool(*arguments, env=env)
        self.assertEqual(done.returncode, 1, arguments)
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, r"\Apimgtool: error: [^\n]+\n\Z")
        for word in [says] if isinstance(says, str) else says:
            self.assertIn(word, done.stderr)
        self.assertEqual({name: os.stat(name).st_mtime_ns for name in os.listdir()}, before)

    def assert_same(self, a, b, kind=oiio.FLOAT):
        """Two files hold the same numbers, NaN included."""
        left, right = read(a, kind), read(b, kind)
        self.assertEqual(left.shape, right.shape)
        self.assertTrue(np.array_equal(left, right, equal_nan=kind != oiio.UINT8), f"{a} and {b} differ")
