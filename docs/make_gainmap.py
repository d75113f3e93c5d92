#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the picture of docs/gainmap.md: a gain-map file as Chromium shows it on an SDR and on an HDR display.

usage: make_gainmap.py PIMGTOOL PICTURE OUTFILE.jpg

Paper has no highlights above white. So beside what an SDR display has, both displays' pictures are shown two stops darker.
Needs chromium and python3-opencv.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

import cv2
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "gainmap"))
from decoders import chromium_pixels, decode_srgb  # noqa: E402

WIDTH, GAP, CAPTION = 460, 8, 24


def encode_srgb(light):
    light = np.clip(light, 0, 1)
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)


def panel(light, stops, caption):
    """8-bit pixels of the light, brightened by so many stops, above a line of text."""
    height = round(WIDTH * light.shape[0] / light.shape[1])
    small = cv2.resize(light.astype(np.float32), (WIDTH, height), interpolation=cv2.INTER_AREA) * 2.0 ** stops
    picture = np.full((height + CAPTION, WIDTH, 3), 255, np.uint8)
    picture[:height] = np.round(255 * encode_srgb(small))[..., ::-1]
    cv2.putText(picture, caption, (2, height + 17), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (0, 0, 0), 1, cv2.LINE_AA)
    return cv2.copyMakeBorder(picture, 0, 0, 0, GAP, cv2.BORDER_CONSTANT, value=(255, 255, 255))


def main(tool, picture, outfile):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([tool, picture, "--hdr-compress", "-o", f"{folder}/file.jpg:gainmap=1"], check=True)
        base = decode_srgb(cv2.imread(str(folder / "file.jpg"))[..., ::-1] / 255)
        rendition = chromium_pixels(folder, base.shape[:2], shutil.which("chromium"))
    panels = [panel(base, 0, "SDR display"), panel(base, -2, "SDR display, two stops darker"),
              panel(rendition, -2, "HDR display, two stops darker")]
    cv2.imwrite(outfile, np.hstack(panels), [cv2.IMWRITE_JPEG_QUALITY, 88])


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
