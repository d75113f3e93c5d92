#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the synthetic test pictures: make.py FOLDER

Each picture is a function below that returns its pixels; its docstring says what it is for. The table at the end gives
file name, pixel type and, where they matter, the placement of the data window. See README.md.
"""
import os
import sys

import numpy as np
import OpenImageIO as oiio


def grid(width, height):
    """Pixel coordinates x, y, each height x width."""
    return np.meshgrid(np.arange(width, dtype=np.float64), np.arange(height, dtype=np.float64))


def noise(width, height, seed=1):
    """Uniform noise in [0, 1), the same on every machine."""
    state = np.arange(1, width * height + 1, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(seed)
    state = (state ^ (state >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    state = (state ^ (state >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return ((state ^ (state >> np.uint64(31))) >> np.uint64(11)).reshape(height, width) / 2.0**53


def constant(width=40, height=30):
    """Nothing to see: every collapse costs the same."""
    return np.full((height, width), 0.5)


def ramp(width=61, height=33):
    """A plane: a mesh of two triangles is exact."""
    x, y = grid(width, height)
    return 0.1 + 0.6 * x / width + 0.25 * y / height


def step(width=64, height=48):
    """Two steps that cross: edges of either direction and a corner."""
    x, y = grid(width, height)
    return 0.2 + 0.4 * (x >= width // 2) + 0.2 * (y >= 17)


def disc(width=67, height=59):
    """A disc with an edge two pixels soft, odd sizes."""
    x, y = grid(width, height)
    distance = np.hypot(x - 0.5 * width, y - 0.45 * height)
    return 0.15 + 0.7 * np.clip((0.3 * width - distance) / 2 + 0.5, 0, 1)


def texture(width=96, height=80):
    """Edges, gradients and noise together: the ordinary picture."""
    return np.clip(0.6 * disc(width, height) + 0.25 * ramp(width, height) + 0.1 * noise(width, height), 0, 1)


def white_pixel(width=31, height=31):
    """All black but one pixel."""
    pixels = np.zeros((height, width))
    pixels[height // 2, width // 2] = 1
    return pixels


def colour(width=72, height=54):
    """Three channels whose edges do not coincide."""
    x, y = grid(width, height)
    red = 0.2 + 0.6 * (x + y > 0.5 * (width + height))
    green = 0.1 + 0.8 * disc(width, height)
    blue = 0.3 + 0.5 * (y / height) + 0.05 * noise(width, height)
    return np.stack([red, np.clip(green, 0, 1), np.clip(blue, 0, 1)], axis=2)


def rgba(width=72, height=54):
    """colour() under a soft, partly transparent matte."""
    x, _ = grid(width, height)
    alpha = np.clip(1.5 * x / width - 0.25, 0, 1)
    return np.concatenate([colour(width, height) * alpha[..., None], alpha[..., None]], axis=2)


def hdr(width=128, height=96):
    """A room with a window on a sunlit view: 18 stops, saturated colours, black corner."""
    x, y = grid(width, height)
    room = 0.02 * (1 + 0.5 * np.sin(x / 5) * np.sin(y / 7)) + 0.004 * noise(width, height)
    sky = 40 * (1.5 - y / height)
    view = np.where(y > 0.45 * height, 8 + 4 * noise(width, height, 2), sky)
    window = (np.abs(x - 0.6 * width) < 0.22 * width) & (np.abs(y - 0.4 * height) < 0.25 * height)
    light = np.where(window, view, room)
    light = np.where(np.hypot(x - 0.7 * width, y - 0.25 * height) < 4, 2e4, light)
    light = np.where((x < 6) & (y < 6), 0, light)
    warm = np.stack([light * 1.2, light * 0.9, light * 0.5], axis=2)
    cool = np.stack([light * 0.7, light * 0.95, light * 1.3], axis=2)
    return np.where(window[..., None], cool, warm)


def hdr_damaged(width=128, height=96):
    """hdr() with what renderers leave behind: NaN, Inf, -Inf, negatives, one 1e30 pixel."""
    pixels = hdr(width, height)
    pixels[20, 20] = np.nan
    pixels[21, 40] = np.inf
    pixels[50, 30, 1] = -np.inf
    pixels[70:74, 90:94] = -0.001
    pixels[80, 10] = 1e30
    return pixels


def zero(width=24, height=16):
    """All black, three channels."""
    return np.zeros((height, width, 3))


def row(width=37):
    """One pixel high."""
    return texture(width, 8)[:1]


def column(height=37):
    """One pixel wide."""
    return texture(8, height)[:, :1]


def single():
    """One pixel."""
    return np.full((1, 1), 0.5)


def write(path, pixels, pixel_type, origin=(0, 0), full=None):
    """Writes one picture; `full` = (x, y, width, height) is the display window when it is not the data window."""
    if pixels.ndim == 2:
        pixels = pixels[..., None]
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, pixel_type)
    spec.x, spec.y = origin
    if full:
        spec.full_x, spec.full_y, spec.full_width, spec.full_height = full
    else:
        spec.full_x, spec.full_y = origin
    buf = oiio.ImageBuf(spec)
    if not buf.set_pixels(oiio.ROI(spec.x, spec.x + width, spec.y, spec.y + height, 0, 1, 0, channels),
                          pixels.astype(np.float32)):
        sys.exit(f"{path}: {buf.geterror()}")
    if not buf.write(path, pixel_type):
        sys.exit(f"{path}: {buf.geterror()}")


PICTURES = [
    ("constant.png", constant, "uint8", {}),
    ("ramp.tif", ramp, "float", {}),
    ("step.png", step, "uint8", {}),
    ("disc.png", disc, "uint16", {}),
    ("texture.png", texture, "uint8", {}),
    ("texture_half.exr", texture, "half", {}),
    ("white_pixel.png", white_pixel, "uint8", {}),
    ("colour.png", colour, "uint8", {}),
    ("colour16.tif", colour, "uint16", {}),
    ("rgba.png", rgba, "uint8", {}),
    ("rgba.exr", rgba, "half", {}),
    ("window.exr", colour, "half", {"origin": (-5, 7), "full": (0, 0, 64, 64)}),
    ("hdr.exr", hdr, "half", {}),
    ("hdr_damaged.exr", hdr_damaged, "float", {}),
    ("zero.exr", zero, "half", {}),
    ("row.png", row, "uint8", {}),
    ("column.png", column, "uint8", {}),
    ("single.png", single, "uint8", {}),
]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    for name, picture, pixel_type, placement in PICTURES:
        write(os.path.join(folder, name), picture(), pixel_type, **placement)


if __name__ == "__main__":
    main()
