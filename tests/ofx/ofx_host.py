# SPDX-License-Identifier: BSD-3-Clause
"""Runs the test host ($OFX_TEST_HOST) on the bundle ($PIMG_OFX), on small pictures made here."""

import os
import subprocess

import numpy as np

import pictures
import warm

HOST = os.environ["OFX_TEST_HOST"]
BUNDLE = os.environ["PIMG_OFX"]
WARM = warm.Program(HOST, os.environ["OFX_TEST_HOST_WARM"], os.environ["PIMG_OFX_LIBRARY"])


def scene(width, height, alpha=True):
    """High dynamic range with soft edges to transparency, associated."""
    colours = pictures.hdr_scene(width, height)
    y, x = np.mgrid[0:height, 0:width]
    cover = np.clip(1.4 - np.hypot(x / width - 0.5, y / height - 0.5) * 1.6, 0, 1)[..., None]
    return np.concatenate([colours * cover, cover], axis=2) if alpha else colours


def write(name, pixels):
    pictures.write(name, pixels, "float", names=["R", "G", "B", "A"][: pixels.shape[2]])


def run(*arguments):
    return WARM.run(BUNDLE, *arguments, timeout=200)


class HostTest(pictures.ToolTest):
    def setUp(self):
        super().setUp()
        write("in.exr", scene(90, 70))

    def host(self, *arguments, status=0, environment=None):
        """What the host says on standard output and error. Violations of the interface make it fail."""
        done = run(*arguments) if environment is None else subprocess.run(
            [HOST, BUNDLE, *map(str, arguments)], capture_output=True, text=True, timeout=200, check=False,
            env={**os.environ, **environment})
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def render(self, effect, *arguments, source="in.exr", target="out.exr"):
        self.host("render", effect, source, target, *arguments)
        return pictures.read(target)

    def tool(self, effect, options="", source="in.exr"):
        self.ok(source, f"--{effect.replace('_', '-')}" + (":" + options if options else ""), "-d", "float", "-o", "tool.exr")
        return pictures.read("tool.exr")
