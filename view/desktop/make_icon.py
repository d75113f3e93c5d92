#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the icon of pimgview: a landscape, as the mesh of some hundred vertices sees it.

usage: make_icon.py PIMGTOOL pimgview.png

Needs python3-numpy and python3-opencv.
"""
import subprocess
import sys
import tempfile

import cv2
import numpy as np

SIDE, ICON, VERTICES = 512, 256, 220


def landscape():
    """Two mountains in front of an evening sky with the sun; 0..1."""
    y, x = np.mgrid[0:SIDE, 0:SIDE] / SIDE
    sky = np.stack([0.25 + 0.7 * y, 0.45 + 0.25 * y, 0.85 - 0.35 * y], -1)
    sun = np.hypot(x - 0.66, y - 0.36)
    sky += 0.5 * np.exp(-sun[..., None] * 7) * np.array([1, 0.8, 0.4])
    sky[sun < 0.1] = (1, 0.93, 0.7)
    far = y > 0.5 + 0.9 * abs(x - 0.3) - 0.16 * (x < 0.3) * (0.3 - x)
    near = y > 0.62 + 0.55 * abs(x - 0.82)
    shade = (0.5 + 0.5 * (x > 0.3))[..., None]
    picture = np.where(far[..., None], np.array([0.30, 0.33, 0.55]) * shade + 0.1, sky)
    picture = np.where(near[..., None], np.array([0.12, 0.2, 0.3]) * (0.7 + 0.6 * (x < 0.82)[..., None]), picture)
    lake = y > 0.86
    picture = np.where(lake[..., None], np.array([0.75, 0.5, 0.45]) * (1.5 - 0.6 * y[..., None]), picture)
    return np.clip(picture, 0, 1)


def rounded(side, radius):
    """Alpha of a square with round corners."""
    y, x = np.mgrid[0:side, 0:side] + 0.5
    out = np.hypot(np.maximum(abs(x - side / 2) - side / 2 + radius, 0), np.maximum(abs(y - side / 2) - side / 2 + radius, 0))
    return np.clip(radius - out + 0.5, 0, 1)


def main(tool, target):
    with tempfile.TemporaryDirectory() as folder:
        cv2.imwrite(f"{folder}/in.png", np.round(255 * landscape()[..., ::-1]))
        for name, command in (("level", "--level"), ("lines", "--wireframe")):
            subprocess.run([tool, f"{folder}/in.png", f"{command}:vertices={VERTICES}", "-o", f"{folder}/{name}.png"], check=True)
        level, lines = (cv2.imread(f"{folder}/{name}.png").astype(np.float64) for name in ("level", "lines"))
    drawn = level + (1 - lines / 255) * 0.45 * (255 - level)
    icon = cv2.resize(drawn, (ICON, ICON), interpolation=cv2.INTER_AREA)
    cv2.imwrite(target, np.round(np.dstack([icon, 255 * rounded(ICON, 40)])), [cv2.IMWRITE_PNG_COMPRESSION, 9])


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
