#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures drawings and paintings beside those of other programs.

usage: painting.py tone PIMGTOOL PHOTOGRAPH...        how well drawings have the tones of their photographs
       painting.py strokes PIMGTOOL PHOTOGRAPH...     how well one sees the strokes of paintings, and what they cost
       painting.py scales PIMGTOOL PHOTOGRAPH...      whether drawings have the same lines at half and twice the resolution
       painting.py noise PIMGTOOL PHOTOGRAPH...       how much paintings change when the noise of the photograph does

tone     RMS and mean of the error of L*, drawing less photograph. Both are blurred with a Gaussian of 1/100 of their width, in L*; what
         is darker than L* = 5 in the photograph counts as 5, the darkest tone of --ink. Photographs are enlarged twice before.
strokes  legibility: standard deviation of L* between Gaussians of 1 and 10 pixels (as they are 4 pixels away from each other, strokes
         are seen between these), where the standard deviation of the photograph's L* in 21 x 21 pixels is below 3; spill: the error of
         colour 2 to 6 pixels beside strong edges over that more than 10 pixels away (1: paint does not cross edges); edge: share of
         strong edges that are still an edge; align: how well strokes follow the edges (0.64 at random, 1 at best).
scales   the photograph is enlarged twice, and that halved and enlarged twice again; share of the length of lines that is within half a
         pen of a line of the other drawing, the mean of both ways.
noise    two frames with Gaussian noise of sigma 2 of 255: mean difference of colour of the paintings over that of the frames.

Peers, each if it is installed: G'MIC, ImageMagick, GEGL. Debian: python3-numpy python3-scipy python3-openimageio gmic imagemagick gegl.
"""
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np
import OpenImageIO as oiio
from scipy import ndimage as ndi
from scipy.spatial import cKDTree

DRAWINGS = {  # name: command
    '--ink': 'pimgtool {} --ink -o {}',
    '--ink:style=contour': 'pimgtool {} --ink:style=contour -o {}',
    '--ink:style=stipple': 'pimgtool {} --ink:style=stipple -o {}',
    'gmic fx_engrave': 'gmic {} fx_engrave 0.5,50,0,8,40,0,0,0,10,1,0,0,0,1,0 -o {}',
    'gmic pencilbw': 'gmic {} pencilbw 0.3,60 -o {}',
    'gmic fx_sketchbw': 'gmic {} fx_sketchbw 1,45,180,30,1.75,0.02,0.5,0.75,0.1,0.7,3,6,0,1,4 -o {}',
    'ImageMagick -sketch': 'convert {} -colorspace Gray -sketch 0x20+120 {}',
    'ImageMagick -charcoal': 'convert {} -charcoal 2 {}',
    'gegl:photocopy': 'gegl {} -o {} -- gegl:photocopy',
}
PAINTINGS = {
    '--paint': 'pimgtool {} --paint -o {}',
    'gmic brushify': 'gmic {} fx_brushify 7,0.25,4,64,25,12,0,2,4,0.2,0.5,30,1,1,1,5,0,0.2,1 -o {}',
    'gmic painting': 'gmic {} fx_painting 5,2.5,1.5,50,1,0 -o {}',
    'ImageMagick -paint': 'convert {} -paint 4 {}',
    'gegl:oilify': 'gegl {} -o {} -- gegl:oilify mask-radius=6',
}


def read(name):
    """sRGB-encoded floats, height x width x 3."""
    picture = oiio.ImageBuf(name)
    pixels = picture.get_pixels(oiio.FLOAT)
    return pixels[..., :3] if pixels.shape[2] >= 3 else np.repeat(pixels[..., :1], 3, axis=2)


def lab(encoded):
    """CIELAB of sRGB (IEC 61966-2-1, CIE 15)."""
    light = np.where(encoded <= 0.04045, encoded / 12.92, ((np.maximum(encoded, 0) + 0.055) / 1.055) ** 2.4)
    matrix = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    xyz = light @ (matrix / matrix.sum(axis=1, keepdims=True)).T
    f = np.where(xyz > 216 / 24389, np.cbrt(np.maximum(xyz, 1e-9)), (24389 / 27 * xyz + 16) / 116)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], axis=-1)


def tone_errors(photograph, drawing):
    sigma = photograph.shape[1] / 100
    wanted = ndi.gaussian_filter(np.maximum(lab(photograph)[..., 0], 5.0), sigma)
    off = ndi.gaussian_filter(lab(drawing)[..., 0], sigma) - wanted
    return float(np.sqrt((off ** 2).mean())), float(off.mean())


def legibility(photograph, painting):
    source, painted = lab(photograph)[..., 0], lab(painting)[..., 0]
    mean = ndi.uniform_filter(source, 21)
    flat = ndi.uniform_filter(source ** 2, 21) - mean ** 2 < 9.0
    strokes = ndi.gaussian_filter(painted, 1.0) - ndi.gaussian_filter(painted, 10.0)
    return float(strokes[flat].std()) if flat.any() else float('nan')


def directions(lightness, sigma, around):
    """Angle across the edges, how one-sided, and how much contrast."""
    smooth = ndi.gaussian_filter(lightness, sigma)
    gx, gy = ndi.sobel(smooth, 1), ndi.sobel(smooth, 0)
    xx, yy, xy = (ndi.gaussian_filter(p, around) for p in (gx * gx, gy * gy, gx * gy))
    return 0.5 * np.arctan2(2 * xy, xx - yy), np.hypot(xx - yy, 2 * xy) / np.maximum(xx + yy, 1e-9), xx + yy


def edges(photograph, painting):
    """spill, edge, align"""
    source, painted = lab(photograph), lab(painting)
    off = np.sqrt(((source - painted) ** 2).sum(axis=-1))
    slope = ndi.gaussian_gradient_magnitude(source[..., 0], 2.0)
    strong = slope >= max(np.percentile(slope, 94), 0.5)
    away = ndi.distance_transform_edt(~strong)
    spill = off[(away >= 2) & (away <= 6)].mean() / max(off[away > 10].mean(), 1e-6)
    fine = ndi.gaussian_gradient_magnitude(source[..., 0], 1.0)
    limit = 0.5 * np.median(fine[strong])
    before = strong & (ndi.maximum_filter(fine, 5) >= limit)
    after = ndi.maximum_filter(ndi.gaussian_gradient_magnitude(painted[..., 0], 1.0), 5) >= limit
    a, clear_a, much_a = directions(source[..., 0], 1.5, 3.0)
    b, clear_b, much_b = directions(painted[..., 0], 0.7, 2.0)
    weight = clear_a * clear_b * np.minimum(np.sqrt(much_a), 20) * np.minimum(np.sqrt(much_b), 20)
    align = (weight * np.abs(np.cos(a - b))).sum() / max(weight.sum(), 1e-9)
    return float(spill), 100.0 * float((after & before).sum() / max(before.sum(), 1)), float(align)


def run(command, pimgtool, source, target):
    """Seconds, or None if the program is not there or fails."""
    words = [pimgtool if w == 'pimgtool' else w for w in shlex.split(command.format(shlex.quote(source), shlex.quote(target)))]
    if shutil.which(words[0]) is None:
        return None
    start = time.monotonic()
    done = subprocess.run(words, capture_output=True)
    return time.monotonic() - start if done.returncode == 0 and os.path.exists(target) else None


def tone(pimgtool, photographs, work):
    print('| drawing | photograph | RMS of L* | mean of L* | s/Mpixel |\n|---|---|---|---|---|')
    for photograph in photographs:
        source = os.path.join(work, 'source.png')
        picture = oiio.ImageBuf(photograph)
        spec = picture.spec()
        large = oiio.ImageBufAlgo.resize(picture, roi=oiio.ROI(0, 2 * spec.width, 0, 2 * spec.height, 0, 1, 0, spec.nchannels))
        oiio.ImageBufAlgo.clamp(large, large, 0.0, 1.0)
        large.write(source, 'uint8')
        for name, command in DRAWINGS.items():
            target = os.path.join(work, 'drawing.png')
            seconds = run(command, pimgtool, source, target)
            if seconds is None:
                continue
            wanted, drawn = read(source), read(target)
            if wanted.shape == drawn.shape:
                rms, mean = tone_errors(wanted, drawn)
                print('| %s | %s | %.2f | %+.2f | %.1f |' % (name, os.path.basename(photograph), rms, mean,
                                                          1e6 * seconds / wanted[..., 0].size), flush=True)
            os.remove(target)


def strokes(pimgtool, photographs, work):
    print('| painting | photograph | legibility | spill | edge | align | s/Mpixel |\n|---|---|---|---|---|---|---|')
    for photograph in photographs:
        wanted = read(photograph)
        print('| the photograph | %s | %.2f | | | | |' % (os.path.basename(photograph), legibility(wanted, wanted)))
        for name, command in PAINTINGS.items():
            target = os.path.join(work, 'painting.png')
            seconds = run(command, pimgtool, photograph, target)
            if seconds is None:
                continue
            painted = read(target)
            if wanted.shape == painted.shape:
                print('| %s | %s | %.2f | %.2f | %.1f %% | %.3f | %.1f |'
                      % (name, os.path.basename(photograph), legibility(wanted, painted), *edges(wanted, painted),
                         1e6 * seconds / wanted[..., 0].size), flush=True)
            os.remove(target)


def resize(photograph, factor, target):
    picture = oiio.ImageBuf(photograph)
    spec = picture.spec()
    size = [factor * s for s in (spec.width, spec.height)]  # so that all have the same shape
    other = oiio.ImageBufAlgo.resize(picture, roi=oiio.ROI(0, size[0], 0, size[1], 0, 1, 0, spec.nchannels))
    oiio.ImageBufAlgo.clamp(other, other, 0.0, 1.0)
    other.write(target, 'uint8')


def line_places(name, step):
    """Places along the lines, as shares of the picture's width."""
    with open(name) as file:
        drawing = json.load(file)
    places = []
    for line in drawing['lines']:
        points = (np.array(line['points'])[:, :2] + 0.5) / drawing['width']
        length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
        at = np.arange(0.5 * step, length[-1], step) if length[-1] > step else [0.0]
        places.append(np.stack([np.interp(at, length, points[:, c]) for c in (0, 1)], axis=1))
    return np.concatenate(places)


def near(a, b, distance):
    return float(np.isfinite(cKDTree(b).query(a, distance_upper_bound=distance)[0]).mean())


def scales(pimgtool, photographs, work):
    print('| photograph | half | twice |\n|---|---|---|')
    for photograph in photographs:
        lines, name = [], os.path.basename(photograph)
        for factor in (1, 2, 4):
            source, target = (os.path.join(work, '%d_%s.%s' % (factor, name, kind)) for kind in ('png', 'json'))
            resize(photograph, factor, source)
            subprocess.run([pimgtool, source, '--ink:strokes=' + target, '-o', os.path.join(work, 'drawing.png')], check=True)
            spec = oiio.ImageBuf(source).spec()
            sides = sorted([spec.width, spec.height])
            pen = 0.4 * max(sides[1] / 210.0, sides[0] / 148.0) / spec.width
            lines.append(line_places(target, 0.25 * pen))
        shares = [50.0 * (near(lines[i], lines[1], 0.5 * pen) + near(lines[1], lines[i], 0.5 * pen)) for i in (0, 2)]
        print('| %s | %.1f %% | %.1f %% |' % (name, *shares), flush=True)


def noise(pimgtool, photographs, work):
    print('| photograph | change at sigma 2 |\n|---|---|')
    for photograph in photographs:
        name = os.path.basename(photograph)  # in the names of files, since OpenImageIO keeps what it has read
        chance, frames, paintings = np.random.default_rng(1), [], []
        for frame in (0, 1):
            source, target = (os.path.join(work, '%s%d_%s.png' % (kind, frame, name)) for kind in ('frame', 'painting'))
            pixels = read(photograph)
            pixels = np.clip(pixels + chance.normal(0.0, 2.0 / 255.0, pixels.shape), 0.0, 1.0).astype(np.float32)
            picture = oiio.ImageBuf(oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, 'uint8'))
            picture.set_pixels(picture.roi, pixels)
            picture.write(source)
            subprocess.run([pimgtool, source, '--paint', '-o', target], check=True)
            for kept, file in ((frames, source), (paintings, target)):
                kept.append(lab(read(file)))
        change = [np.sqrt(((a - b) ** 2).sum(axis=-1)).mean() for a, b in (paintings, frames)]
        print('| %s | %.2f |' % (name, change[0] / change[1]), flush=True)


def main():
    measures = {'tone': tone, 'strokes': strokes, 'scales': scales, 'noise': noise}
    if len(sys.argv) < 4 or sys.argv[1] not in measures:
        raise SystemExit(__doc__)
    with tempfile.TemporaryDirectory() as work:
        measures[sys.argv[1]](os.path.abspath(sys.argv[2]), sys.argv[3:], work)


if __name__ == '__main__':
    main()
