#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Gain-map files of real pictures beside what was intended, in our decoder, in Chromium and in hdrify of npm.

usage: gain_maps.py PIMGTOOL PICTURE... [--key=value of -o, such as --scale=4]

Prints a table: size over that of the base, warnings of exiftool, whether the base has the pixels of `-o out.jpg`, and for
each decoder that is there the 95th percentile of the difference to the intended HDR rendition, in stops of luminance.
hdrify is looked for in $HDRIFY, the folder that `npm install hdrify` was run in.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import OpenImageIO as oiio

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "gainmap"))
from decoders import chromium_pixels, hdrify_pixels, stops_apart  # noqa: E402


def pixels(path, kind=oiio.FLOAT):
    return oiio.ImageBuf(str(path)).get_pixels(kind)[..., :3]


def make(tool, picture, folder, keys):
    linear = ["--tocolorspace", "linear", "-d", "float", "-o"]
    commands = [[picture, "--hdr-compress", "-o", folder / "base.jpg", "-o", f"{folder}/file.jpg:gainmap=1{keys}"],
                [picture, "--hdr-compress:peak=1000", *linear, folder / "wanted.exr"],
                [folder / "file.jpg", "--gainmap", *linear, folder / "ours.exr"]]
    for command in commands:
        subprocess.run([tool, *command], check=True, stderr=subprocess.DEVNULL)


def warnings_of(file):
    if not shutil.which("exiftool"):
        return "-"
    text = subprocess.run(["exiftool", "-warning", "-a", str(file)], capture_output=True, text=True,
                          check=False).stdout
    return str(text.count("Warning"))


def row(tool, picture, keys):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make(tool, picture, folder, keys)
        wanted = pixels(folder / "wanted.exr")
        apart = [stops_apart(pixels(folder / "ours.exr"), wanted)]
        browser, hdrify = shutil.which("chromium"), os.environ.get("HDRIFY")
        apart.append(stops_apart(chromium_pixels(folder, wanted.shape[:2], browser), wanted) if browser else np.nan)
        apart.append(stops_apart(hdrify_pixels(folder, wanted.shape[:2], hdrify), wanted) if hdrify else np.nan)
        base, file = folder / "base.jpg", folder / "file.jpg"
        same = (pixels(base, oiio.UINT8) == pixels(file, oiio.UINT8)).all()
        return [pathlib.Path(picture).stem, f"{os.path.getsize(file) / os.path.getsize(base):.2f}", warnings_of(file),
                "same" if same else "DIFFERS", *(f"{stops:.3f}" for stops in apart)]


def main(tool, *arguments):
    keys = "".join(":" + a[2:] for a in arguments if a.startswith("--"))
    print("| picture | size | warnings | base | pimg | Chromium | hdrify |\n|---|---|---|---|---|---|---|")
    for picture in (a for a in arguments if not a.startswith("--")):
        print("| " + " | ".join(row(tool, picture, keys)) + " |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
