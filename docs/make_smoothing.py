#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the pictures of docs/smoothing.md: smoothers side by side at equal removal of small-scale contrast.

usage: make_smoothing.py PIMGTOOL OUTDIR PHOTO[@X,Y]...

Writes OUTDIR/smoothing_<photo>.jpg for each: a crop at X,Y (default: the middle) of the input, the paper's low-pass, low-pass by
strength, OpenCV's bilateral filter and domain transform (recursive), and L0 gradient minimisation (Xu 2011). The parameter of
every method is the one of its sweep that leaves nearest to 40 % of the small-scale rms (luma minus a Gaussian of 3 pixels).
Needs python3-numpy, python3-opencv.
"""
import os
import subprocess
import sys
import tempfile

import cv2
import numpy as np

LEFT, CROP, GAP, CAPTION = 0.4, 260, 6, 22


def small_scale(image):
    luma = image @ np.float32([0.0722, 0.7152, 0.2126])  # OpenCV's order is B, G, R
    return (luma - cv2.GaussianBlur(luma, (0, 0), 3)).std()


def l0(image, weight):
    """L0 gradient minimisation by half-quadratic splitting, periodic, one decision for all channels."""
    h, w = image.shape[:2]
    fx = 2 * np.pi * np.fft.fftfreq(w)[None, :, None]
    fy = 2 * np.pi * np.fft.fftfreq(h)[:, None, None]
    laplace = 4 - 2 * np.cos(fx) - 2 * np.cos(fy)
    data, result, beta = np.fft.fft2(image, axes=(0, 1)), image.astype(np.float64), 2 * weight
    while beta < 1e5:
        gx, gy = np.roll(result, -1, 1) - result, np.roll(result, -1, 0) - result
        flat = (gx * gx + gy * gy).sum(2, keepdims=True) < weight / beta
        gx, gy = np.where(flat, 0, gx), np.where(flat, 0, gy)
        divergence = np.roll(gx, 1, 1) - gx + np.roll(gy, 1, 0) - gy
        result = np.fft.ifft2((data + beta * np.fft.fft2(divergence, axes=(0, 1))) / (1 + beta * laplace), axes=(0, 1)).real
        beta *= 2
    return result.astype(np.float32)


def pimg(tool, photo, key, values):
    """Results of one command, so that the hierarchy is built once."""
    with tempfile.TemporaryDirectory() as folder:
        files = [os.path.join(folder, "%d.png" % i) for i in range(len(values))]
        command = [tool, photo]
        for value, file in zip(values, files):
            command += ["--dup", "--feature-lowpass:%s=%g" % (key, value), "-o", file, "--pop"]
        subprocess.run(command, check=True)
        return [read(file) for file in files]


def read(file):
    return cv2.imread(file).astype(np.float32) / 255


def methods(tool, photo, image):
    fractions, strengths = np.geomspace(0.5, 0.002, 14), np.geomspace(0.008, 0.25, 18)
    yield "paper: fraction %.3g", fractions, pimg(tool, photo, "fraction", fractions)
    yield "pimg: strength %.3g", strengths, pimg(tool, photo, "strength", strengths)
    ranges = np.geomspace(0.03, 0.8, 14)
    yield "bilateral, 6 px, %.2g", ranges, [cv2.bilateralFilter(image, -1, r, 6) for r in ranges]
    ranges = np.geomspace(0.05, 4, 14)
    yield "domain transform, %.2g", ranges, [
        cv2.ximgproc.dtFilter(image, image, 20, r, mode=cv2.ximgproc.DTF_RF, numIters=3) for r in ranges]
    weights = np.geomspace(0.001, 0.2, 12)
    yield "L0, %.2g", weights, [l0(image, weight) for weight in weights]


def tile(image, caption, x, y):
    crop = np.uint8(np.clip(image[y:y + CROP, x:x + CROP], 0, 1) * 255 + 0.5)
    crop = cv2.copyMakeBorder(crop, CAPTION, GAP, 0, GAP, cv2.BORDER_CONSTANT, value=(255, 255, 255))
    return cv2.putText(crop, caption, (2, 16), cv2.FONT_HERSHEY_SIMPLEX, 0.45, (0, 0, 0), 1, cv2.LINE_AA)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    tool, folder = sys.argv[1:3]
    for argument in sys.argv[3:]:
        photo, _, place = argument.partition("@")
        image = read(photo)
        h, w = image.shape[:2]
        x, y = map(int, place.split(",")) if place else ((w - CROP) // 2, (h - CROP) // 2)
        before, tiles = small_scale(image), [tile(image, "input", x, y)]
        for caption, values, results in methods(tool, photo, image):
            left = [small_scale(result) / before for result in results]
            best = int(np.argmin(np.abs(np.log(np.array(left) / LEFT))))
            tiles.append(tile(results[best], caption % values[best] + " (left %.0f %%)" % (100 * left[best]), x, y))
        name = "smoothing_" + os.path.splitext(os.path.basename(photo))[0] + ".jpg"
        sheet = np.vstack([np.hstack(tiles[:3]), np.hstack(tiles[3:])])
        cv2.imwrite(os.path.join(folder, name), sheet, [cv2.IMWRITE_JPEG_QUALITY, 88])


if __name__ == "__main__":
    main()
