# SPDX-License-Identifier: BSD-3-Clause
"""Runs the examples of a page from top to bottom, as a reader would: page_test.py PAGE.md [PROGRAM]

Blocks of python and sh, and indented ones that are nothing but commands of ours or OpenImageIO's; PROGRAM is what
cpp_program.py made of the C++. They find the pictures that make_pictures() writes.
Environment: PIMGTOOL OIIOTOOL PIMG_PLUGIN PYTHONPATH, set by tests/CMakeLists.txt.
"""

import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import OpenImageIO as oiio

from markdown_code import all_blocks

COMMANDS = re.compile(r"((pimgtool|oiiotool|iinfo|idiff|export OIIO_LIBRARY_PATH|export OPENIMAGEIO_PLUGIN_PATH)\b.*\n?)+")
WRITTEN = re.compile(r"(?:(?<=-o )|(?<=write\(\"))([\w.]+\.(?:png|exr|tif|pimg))\b")
WIDTH, HEIGHT = 160, 120


def write(name, pixels, pixel_type):
    spec = oiio.ImageSpec(WIDTH, HEIGHT, pixels.shape[2], pixel_type)
    picture = oiio.ImageBuf(spec)
    picture.set_pixels(picture.roi, np.ascontiguousarray(pixels, dtype=np.float32))
    if not picture.write(name):
        sys.exit(picture.geterror())


def scene(shift=0):
    """Scene-linear light: a dark room with texture, a bright window, a coloured ball that moves."""
    x, y = np.meshgrid(np.arange(WIDTH, dtype=np.float32), np.arange(HEIGHT, dtype=np.float32))
    light = 0.05 + 0.001 * x + 0.02 * ((x // 8 + y // 8) % 2)
    light = np.where((abs(x - 115) < 28) & (abs(y - 40) < 26), 12 + 0.1 * y, light)
    pixels = light[..., None] * np.float32([1, 0.9, 0.8])
    ball = np.hypot(x - 45 - shift, y - 75) < 24
    pixels[ball] = np.float32([0.6, 0.15, 0.1])
    return pixels


def srgb(light):
    light = np.clip(light, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def make_pictures():
    grain = np.random.default_rng(3).normal(1, 0.05, (HEIGHT, WIDTH, 3)).astype(np.float32)
    light = scene() * grain
    write("in.exr", light, "half")
    write("in.png", srgb(light), "uint8")
    for name, seconds in (("dark.png", 1 / 30), ("middle.png", 1 / 4), ("bright.png", 2)):
        write(name, srgb(light * seconds), "uint8")
    for frame in range(1, 5):
        for view, shift in (("", 0), ("_left", -1), ("_right", 1)):
            write(f"plate{view}.{frame:04}.exr", scene(2 * frame + shift) * grain, "half")
    with open("show.ocio", "w", encoding="utf-8") as file:
        file.write(CONFIGURATION)


CONFIGURATION = """ocio_profile_version: 2
environment: {SHOT: sh000}
roles: {default: scene, scene_linear: scene}
displays:
  ACES:
    - !<View> {name: SDR Video, colorspace: display}
colorspaces:
  - !<ColorSpace> {name: scene}
  - !<ColorSpace> {name: ACEScg, to_scene_reference: !<MatrixTransform> {matrix: [1.7, -0.6, -0.1, 0, -0.1, 1.1, 0, 0, 0, -0.1, 1.1, 0, 0, 0, 0, 1]}}
  - !<ColorSpace> {name: display, to_scene_reference: !<ExponentTransform> {value: [2.4, 2.4, 2.4, 1]}}
"""


def run_shell(code):
    env = dict(os.environ)
    folders = [os.path.dirname(env[name]) for name in ("PIMGTOOL", "OIIOTOOL")]
    env["PATH"] = os.pathsep.join(folders + [env["PATH"]])
    env["OCIO"] = os.path.abspath("show.ocio")
    env["OIIO_LIBRARY_PATH"] = env["OPENIMAGEIO_PLUGIN_PATH"] = env["PIMG_PLUGIN"]
    code = re.sub(r"/usr/local/lib/pimg/oiio-[0-9.]+", env["PIMG_PLUGIN"], code)
    return subprocess.run(["bash", "-euo", "pipefail", "-c", code], env=env, stdin=subprocess.DEVNULL).returncode


def main(page, program=None):
    page = os.path.abspath(page)
    names = {}
    done = 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        make_pictures()
        for example in glob.glob(os.path.join(os.path.dirname(page), "..", "examples", "*.ocio")):
            shutil.copy(example, ".")
        for block in all_blocks(page):
            print(f"-- {os.path.basename(page)}:{block.line}", flush=True)
            if block.language == "python":
                exec(compile("\n" * (block.line - 1) + block.code, page, "exec"), names)
            elif block.language == "sh" or not block.language and COMMANDS.fullmatch(block.code):
                if run_shell(block.code):
                    sys.exit(f"{page}:{block.line}: failed:\n{block.code}")
            else:
                continue
            done += 1
            for name in WRITTEN.findall(block.code):
                if not os.path.exists(name):
                    sys.exit(f"{page}:{block.line}: no {name}")
        if program:
            subprocess.run([program], check=True)
        os.chdir("/")
    if not done:
        sys.exit(f"no examples in {page}")


if __name__ == "__main__":
    main(*sys.argv[1:])
