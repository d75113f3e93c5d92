#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sizes, previews and speed of .pimg files beside PNG and OpenEXR, all through OpenImageIO in one run.

usage: format.py PLUGIN_DIRECTORY PICTURES_DIRECTORY [sizes] [preview] [speed]

The pictures are those of its folders ldr (8 bit) and hdr. One thread. Ratios are what counts; docs/plugin.md quotes them."""

import os
import sys
import tempfile
import time
import zlib

if len(sys.argv) < 3:
    sys.exit(__doc__)
os.environ["OIIO_LIBRARY_PATH"] = os.environ["OPENIMAGEIO_PLUGIN_PATH"] = os.path.abspath(sys.argv[1])

import numpy as np  # noqa: E402
import OpenImageIO as oiio  # noqa: E402

PROFILES = ("compact", "full")


def read(name, kind=None):
    file = oiio.ImageInput.open(name)
    if file is None:
        sys.exit(oiio.geterror())
    spec = file.spec()
    pixels = file.read_image(0, 0, 0, spec.nchannels, kind or spec.format)
    return pixels.reshape(spec.height, spec.width, spec.nchannels)


def write(name, pixels, kind, **attributes):
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind)
    for key, value in attributes.items():
        spec.attribute(key.replace("_", ":"), value)
    out = oiio.ImageOutput.create(name)
    if not out.open(name, spec) or not out.write_image(np.ascontiguousarray(pixels)) or not out.close():
        sys.exit(out.geterror())
    return os.path.getsize(name)


def pictures(folder, kind):
    """Name and pixels of each picture, without alpha."""
    for name in sorted(os.listdir(folder)):
        pixels = read(os.path.join(folder, name), kind)
        yield os.path.splitext(name)[0], pixels[..., : 3 if pixels.shape[2] >= 3 else 1]


def mean(rows, column):
    return float(np.mean([row[column] for row in rows]))


# ---- sizes ----------------------------------------------------------------------------------------------------------


def sizes(root):
    groups = {"RGB8": [], "gray8": [], "RGB half": []}
    print("%-20s %9s %9s %9s   (bytes; PNG level 6, all filters; EXR ZIP)" % ("", "peer", "compact", "full"))
    todo = [(n, p, "uint8", "a.png", {"png_filter": 248, "png_compressionLevel": 6})
            for n, p in pictures(root + "/ldr", oiio.UINT8)]
    todo += [(n, p, "half", "a.exr", {"compression": "zip"}) for n, p in pictures(root + "/hdr", oiio.HALF)]
    for name, pixels, kind, peer, attributes in todo:
        count = pixels.shape[0] * pixels.shape[1]
        peer_size = write(peer, pixels, kind, **attributes)
        ours = []
        for profile in PROFILES:
            ours.append(write("a.pimg", pixels, kind, pimg_profile=profile))
            if not np.array_equal(read("a.pimg").view(np.uint8), pixels.view(np.uint8)):
                sys.exit(name + ": " + profile + " is not exact")
        group = "RGB half" if kind == "half" else "RGB8" if pixels.shape[2] == 3 else "gray8"
        groups[group].append((ours[0] / peer_size, ours[1] * 8 / count, ours[1] / peer_size))
        print("%-20s %9d %9d %9d   %.3f   %.2f bpp" % (name, peer_size, *ours, ours[0] / peer_size, ours[1] * 8 / count))
    for group, rows in groups.items():
        print("mean %-9s compact / peer %.3f   full %.2f bits/pixel, %.2f of the peer"
              % (group, mean(rows, 0), mean(rows, 1), mean(rows, 2)))


# ---- previews -------------------------------------------------------------------------------------------------------

ADAM7 = ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2))  # x, y, steps


def filtered(rows):
    """The rows of one pass after PNG's filters, each by the least sum of absolute values."""
    height, width, channels = rows.shape
    x = rows.reshape(height, -1).astype(np.int16)
    left = np.zeros_like(x)
    left[:, channels:] = x[:, :-channels]
    up = np.vstack([np.zeros_like(x[:1]), x[:-1]])
    corner = np.zeros_like(x)
    corner[:, channels:] = up[:, :-channels]
    p = left + up - corner
    near = np.where((abs(p - left) <= abs(p - up)) & (abs(p - left) <= abs(p - corner)), left,
                    np.where(abs(p - up) <= abs(p - corner), up, corner))
    tries = [((x - guess) & 255).astype(np.uint8) for guess in (0 * x, left, up, (left + up) // 2, near)]
    cost = [np.minimum(t.astype(int), 256 - t.astype(int)).sum(1) for t in tries]
    best = np.argmin(cost, 0)
    return b"".join(bytes([best[y]]) + tries[best[y]][y].tobytes() for y in range(height))


def interlaced(pixels):
    """The image data of an Adam7 PNG, and the length of the file."""
    data = b"".join(filtered(pixels[y::dy, x::dx]) for x, y, dx, dy in ADAM7 if pixels[y::dy, x::dx].size)
    packed = zlib.compress(data, 6)
    return packed, 8 + 25 + 12 + 12 + len(packed)


def beginning(pixels, packed, size):
    """What a decoder shows of the first `size` bytes of such a file: every pixel fills its block."""
    have = len(zlib.decompressobj().decompress(packed[: max(0, size - 41)]))
    shown = np.zeros_like(pixels)
    for x0, y0, dx, dy in ADAM7:
        part = pixels[y0::dy, x0::dx]
        row = 1 + part.shape[1] * part.shape[2]
        whole = min(part.shape[0], max(0, have) // row)
        have -= part.shape[0] * row
        high, wide = (dy - y0 if y0 else dy), (dx - x0 if x0 else dx)
        for i in range(whole):
            block = np.repeat(part[i], wide, axis=0)[None].repeat(high, axis=0)
            for j in range(part.shape[1]):
                y, x = y0 + i * dy, x0 + j * dx
                fits = shown[y : y + high, x : x + wide]
                fits[:] = block[: fits.shape[0], j * wide : j * wide + fits.shape[1]]
    return shown


def psnr(a, b):
    error = np.mean((b - np.asarray(a, float)) ** 2)
    return 99.0 if error == 0 else 10 * np.log10(255**2 / error)


def partial(data, size):
    with open("cut.pimg", "wb") as file:
        file.write(data[:size])
    file = oiio.ImageInput.open("cut.pimg?partial=1")  # too short for a picture: black
    pixels = file and file.read_image(0, 0, 0, file.spec().nchannels, oiio.UINT8)
    return 0 if pixels is None else pixels.reshape(file.spec().height, file.spec().width, -1)


def preview(root):
    shares = (0.01, 0.02, 0.03, 0.05, 0.08, 0.12, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 1.0)
    print("\nPSNR in dB of the first 5 % of the compact file, and of as many bytes of an Adam7 PNG")
    rows, falls = [], []
    for name, pixels in pictures(root + "/ldr", oiio.UINT8):
        write("a.pimg", pixels, "uint8")
        with open("a.pimg", "rb") as file:
            data = file.read()
        packed, _ = interlaced(pixels)
        size = len(data) // 20
        ours, peer = psnr(partial(data, size), pixels), psnr(beginning(pixels, packed, size), pixels)
        along = [psnr(partial(data, int(len(data) * s)), pixels) for s in shares]
        fall = max(0.0, max(a - b for a, b in zip(along, along[1:])))
        rows.append((ours, peer, ours - peer))
        falls.append(fall)
        print("%-20s %6.2f %6.2f  %+6.2f   along the file: %s" % (name, ours, peer, ours - peer,
                                                              " ".join("%.1f" % a for a in along)))
    print("mean %.2f, Adam7 %.2f: %+.2f dB; largest fall along a file %.3f dB"
          % (mean(rows, 0), mean(rows, 1), mean(rows, 2), max(falls)))


# ---- speed ----------------------------------------------------------------------------------------------------------


def best_time(work, rounds=5):
    times = []
    for _ in range(rounds):
        start = time.process_time()  # whatever else the machine does
        work()
        times.append(time.process_time() - start)
    return min(times)


def speed(root):
    oiio.attribute("threads", 1)
    oiio.attribute("exr_threads", -1)
    print("\nseconds of one core, best of several")
    ratios, builds = [], []
    for name, pixels in pictures(root + "/hdr", oiio.HALF):
        write("a.exr", pixels, "half", compression="piz")
        write("a.pimg", pixels, "half")
        write("full.pimg", pixels, "half", pimg_profile="full")
        piz = best_time(lambda: read("a.exr"))
        ours = best_time(lambda: read("a.pimg"))
        opened = best_time(lambda: oiio.ImageInput.open("full.pimg"))
        build = best_time(lambda: read("a.pimg?hdr_compress=1"), 2)
        stored = best_time(lambda: read("full.pimg?hdr_compress=1"), 2)
        ratios.append((piz / ours,))
        builds.append((build / stored,))
        print("%-20s %4d x %4d  PIZ %.3f  compact %.3f  speed %.2f of PIZ   open %.2f ms   hdr_compress building %.2f"
              "  stored %.2f  %.1f times" % (name, pixels.shape[1], pixels.shape[0], piz, ours, piz / ours,
                                             1000 * opened, build, stored, build / stored))
    print("mean: decoding %.2f of PIZ's speed, hdr_compress %.1f times as fast from full" % (mean(ratios, 0),
                                                                                              mean(builds, 0)))


def main():
    parts = sys.argv[3:] or ["sizes", "preview", "speed"]
    root = os.path.abspath(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for part in parts:
            {"sizes": sizes, "preview": preview, "speed": speed}[part](root)
        os.chdir("/")


if __name__ == "__main__":
    main()
