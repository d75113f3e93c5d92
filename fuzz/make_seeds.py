#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""First inputs for the fuzz targets, and a dictionary of the words of our grammars.

usage: make_seeds.py CONFORMANCE PIMGTOOL FOLDER

CONFORMANCE is the program codec_conformance, which writes small .pimg files; PIMGTOOL tells the options. FOLDER receives
a folder of seeds for each target, and words.dict.
"""
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

SHOTS = ['{"frames": [{"frame": 1, "dmax": 3.5, "key": 0.18, "white": 4}]}',
         '{"frames": [{"frame": 1, "dmax": 3, "key": 0.1, "white": 4}, {"frame": -2147483648, "dmax": 1e-38, "key": 9, '
         '"white": 3e38}]}', '{"frames": []}', '{}']
COMMAND_LINES = ["in.png\n--level:fraction=0.1\n-o\nout.png", "--frames\n1-10x3\na.#.exr\n--hdr-compress\n-o\nb.#.png",
                 "--views\nleft,right\na.%V.exr\n-o\nb.%v.pimg", "--shot-stats:mode=lock\nshot.json\n--frames\n1,5-9\n"
                 "a.%04d.exr\n--hdr-compress:s0=0.3\n-o\nb.%04d.png", "--help", "--threads\n2\n--info\na.pimg",
                 "a.exr\n--colorconvert\nlinear\nsRGB\n-d\nuint8\n-o:quality=90\nb.jpg"]


BUILDS = ["", "guide=rgb:weights=1,0.5,0.5:base=2", "mesh=adaptive:density=0.5:control=curvature", "metric=exact:guide=lab",
          "wrap=xy:guide=log", "density=nan:mesh=adaptive", "weights=inf,1e38,-0", "base=2147483647", "incolorspace=lin_ap1_scene"]
COLOURS = [("", "black"), ("lin_rec709_scene", "0.9,0.8,0.7"), ("g22_adobergb", "nan"), ("srgb_p3d65_display", "1e39,2,3"),
           ("gamma2.2", ",,"), ("ACEScg", "0.5")]


def profile(curve):
    """A small ICC profile (ICC.1:2022) of Rec. 709's primaries: a header, a table of tags, and what they point at."""
    def fixed(*values):
        return b"".join(round(value * 65536).to_bytes(4, "big", signed=True) for value in values)

    xyz = {b"wtpt": (0.9642, 1, 0.8249), b"rXYZ": (0.4361, 0.2225, 0.0139), b"gXYZ": (0.3851, 0.7169, 0.0971),
           b"bXYZ": (0.1431, 0.0606, 0.7141)}
    tags = {name: b"XYZ \0\0\0\0" + fixed(*value) for name, value in xyz.items()}
    tags.update({name: curve for name in (b"rTRC", b"gTRC", b"bTRC")})
    tags[b"desc"] = b"desc\0\0\0\0" + (5).to_bytes(4, "big") + b"seed\0" + bytes(79)
    table, data = len(tags).to_bytes(4, "big"), b""
    for name, value in tags.items():
        table += name + (132 + 12 * len(tags) + len(data)).to_bytes(4, "big") + len(value).to_bytes(4, "big")
        data += value + bytes(-len(value) % 4)
    header = bytes(8) + b"\x02\x40\0\0mntrRGB XYZ " + bytes(12) + b"acsp" + bytes(28) + fixed(0.9642, 1, 0.8249) + bytes(48)
    return (128 + len(table) + len(data)).to_bytes(4, "big") + header[4:] + table + data


def profiles():
    """None, one with a gamma of 2.2, one with a table, one with the parameters of sRGB's curve."""
    srgb = b"".join(round(v * 65536).to_bytes(4, "big") for v in (2.4, 0.9479, 0.0521, 0.0774, 0.0405))
    return [b"", profile(b"curv\0\0\0\0\0\0\0\1\2\x33"), profile(b"curv\0\0\0\0\0\0\0\3\0\0\x40\0\xff\xff"),
            profile(b"para\0\0\0\0\0\3\0\0" + srgb)]


def option_rows(tool):
    """(command, key, default) of every option, from the long help."""
    text = subprocess.run([tool, "--help:format=man"], capture_output=True, text=True, check=True).stdout
    return sorted(set(re.findall(r"[a-z_]{2,}", text)))


def write(folder, number, content):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"seed{number:03d}").write_bytes(content if isinstance(content, bytes) else content.encode())


def pimg_files(program):
    with tempfile.TemporaryDirectory() as scratch:
        subprocess.run([program, scratch], check=True)
        return [path.read_bytes() for path in sorted(pathlib.Path(scratch).glob("*.pimg"))]


def gain_map_files(tool):
    """Small JPEG files with a gain map, of a ramp up to a bright light."""
    with tempfile.TemporaryDirectory() as scratch:
        picture, file = pathlib.Path(scratch, "in.pfm"), pathlib.Path(scratch, "out.jpg")
        samples = [0.01 * 1.02 ** i for i in range(24 * 16 * 3)]
        picture.write_bytes(b"PF\n24 16\n-1.0\n" + struct.pack(f"<{len(samples)}f", *samples))
        files = []
        for keys in ("", ":scale=1", ":scale=4:channels=1"):
            subprocess.run([tool, picture, "--hdr-compress:gamut=p3", "-o", f"{file}:gainmap=1{keys}"], check=True)
            files.append(file.read_bytes())
    without_iso = files[0].replace(b"urn:iso:std:iso:ts:21496", b"urn:xxx:std:iso:ts:21496")
    return [*files, without_iso, without_iso.replace(b"MPF\0", b"xPF\0")]


def attributes_of(file):
    """The payload of a file's META chunk; empty if there is none."""
    at = 8
    while at + 16 <= len(file):
        length = int.from_bytes(file[at + 8:at + 16], "little")
        if file[at:at + 4].upper() == b"META":
            return file[at + 16:at + 16 + length]
        at += 20 + length
    return b""


def main(conformance, tool, folder):
    folder = pathlib.Path(folder)
    files = pimg_files(conformance)
    filters = subprocess.run([tool, "--help"], capture_output=True, text=True, check=True).stdout
    names = [name.replace("-", "_") for name in re.findall(r"^\s+--([a-z-]+)", filters, re.M)]
    queries = ["", "level=0.5", "mip=1", "partial=1&display=1"] + [f"{name}=1" for name in names]
    for number, file in enumerate(files):
        write(folder / "decoder", number, file)
        write(folder / "metadata", number, attributes_of(file))
    for number, file in enumerate(gain_map_files(tool)):
        write(folder / "gain_map", number, file)
    for number, query in enumerate(queries):
        write(folder / "plugin", number, query.encode() + b"\0" + files[number % len(files)])
    for number, name in enumerate(names):
        write(folder / "options", number, f"{name}\nfraction=0.5:seed=3:stats=\"a b.json\"")
    for number, text in enumerate(COMMAND_LINES):
        write(folder / "command_line", number, text)
    for number, text in enumerate(BUILDS):
        write(folder / "build", number, text.encode() + b"\n\x0b\x07\x02" + bytes(range(256)) * 3)
    for number, (space, colours) in enumerate(COLOURS):
        for profile in profiles():
            write(folder / "colour", number, f"{space}\n{colours}\n".encode() + profile)
            number += len(COLOURS)
    for number, text in enumerate(SHOTS):
        write(folder / "shot", number, text)
    for number in range(4):
        noise = bytes((17 * i * (number + 3)) % 251 for i in range(64 << number))
        write(folder / "roundtrip", number, noise)
        write(folder / "stroke_file", number, noise)
    words = option_rows(tool) + ["=", ":", "&", "%04d", "#", "@", "\\x89PIM", "nan", "inf", "-1", "1e38", "2147483648"]
    (folder / "words.dict").write_text("".join(f'"{word}"\n' for word in words))


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
