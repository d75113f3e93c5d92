#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sheets of paintings, drawings and mosaics of six photographs, beside those of other programs.

usage: gallery_peers.py PIMGTOOL WORK FOLDER [paint] [ink] [mosaic] PHOTOGRAPH...

Every sheet is FOLDER/NAME_KIND.jpg, made in WORK; the commands are printed. Those of programs that are not installed are left out.
FOLDER/NAME_drawing.png is the drawing of --ink at full size; photographs below a thousand pixels are enlarged twice for it. Without a
kind: all.
Debian: python3-numpy python3-openimageio gmic imagemagick gegl.
"""
import os
import shlex
import shutil
import subprocess
import sys

import numpy as np
import OpenImageIO as oiio

import gallery_page as page

KINDS = {
    'paint': (
        'pimgtool {} --paint -o {}',
        'pimgtool {} --paint:style=impasto -o {}',
        'gmic {} fx_brushify 7,0.25,4,64,25,12,0,2,4,0.2,0.5,30,1,1,1,5,0,0.2,1 -o {}',
        'gmic {} fx_painting 5,2.5,1.5,50,1,0 -o {}',
        'convert {} -paint 4 {}',
        'gegl {} -o {} -- gegl:oilify mask-radius=6',
    ),
    'ink': (
        'pimgtool {} --ink -o {}',
        'pimgtool {} --ink:light=1 -o {}',
        'pimgtool {} --ink:style=contour -o {}',
        'pimgtool {} --ink:style=stipple -o {}',
        'gmic {} fx_engrave 0.5,50,0,8,40,0,0,0,10,1,0,0,0,1,0 -o {}',
        'gmic {} fx_sketchbw 1,45,180,30,1.75,0.02,0.5,0.75,0.1,0.7,3,6,0,1,4 -o {}',
        'gmic {} pencilbw 0.3,60 -o {}',
        'convert {} -colorspace Gray -sketch 0x20+120 {}',
        'convert {} -charcoal 2 {}',
        'gegl {} -o {} -- gegl:photocopy',
    ),
    'mosaic': (
        'pimgtool {} --mosaic:tiles=1200 -o {}',
        'pimgtool {} --mosaic:tiles=800:leading=3:colour=0.1 -o {}',
        'gmic {} fx_crystal 50,0.2,20 -o {}',
        'gmic {} fx_polygonize 300,10,10,10,10,0,0,0,255 -o {}',
        'gegl {} -o {} -- gegl:mosaic tile-size=16',
        'gegl {} -o {} -- gegl:cubism tile-size=12',
    ),
}
COLUMNS, WIDTH = 3, 1500
NIGHTS = ('rocket', 'GoldenGate')  # the drawing at full size has light=1


def made(command, pimgtool, photograph, result):
    """Pixels of what a command makes, or nothing if its program is not there or fails."""
    words = shlex.split(command.format(shlex.quote(photograph), shlex.quote(result)))
    if words[0] == 'pimgtool':
        words[0] = pimgtool
    elif not shutil.which(words[0]):
        return None
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0 or not os.path.exists(result):
        print('  failed:', command, done.stderr.strip().split('\n')[-1])
        return None
    return page.read_rgb(result)


def for_print(photograph, target):
    """The name of the photograph, at twice its size if it is smaller than a thousand pixels."""
    picture = oiio.ImageBuf(photograph)
    spec = picture.spec()
    if max(spec.width, spec.height) >= 1000:
        return photograph
    large = oiio.ImageBufAlgo.resize(picture, roi=oiio.ROI(0, 2 * spec.width, 0, 2 * spec.height, 0, 1, 0, spec.nchannels))
    oiio.ImageBufAlgo.clamp(large, large, 0.0, 1.0)
    large.write(target, 'uint8')
    return target


def write_drawing(pixels, name):
    """Sixteen greys, which is enough for black lines."""
    grey = np.round(pixels[..., 0] * 15) / 15
    picture = oiio.ImageBuf(oiio.ImageSpec(grey.shape[1], grey.shape[0], 1, 'uint8'))
    picture.set_pixels(picture.roi, grey[..., None].astype(np.float32))
    picture.write(name)


def main():
    if len(sys.argv) < 5:
        raise SystemExit(__doc__)
    pimgtool, work, folder = (os.path.abspath(a) for a in sys.argv[1:4])
    os.makedirs(work, exist_ok=True)
    kinds = [a for a in sys.argv[4:] if a in KINDS] or list(KINDS)
    for photograph in (os.path.abspath(a) for a in sys.argv[4:] if a not in KINDS):
        name = os.path.splitext(os.path.basename(photograph))[0]
        for kind in kinds:
            pictures = [page.read_rgb(photograph)]
            for i, command in enumerate(KINDS[kind]):
                pixels = made(command, pimgtool, photograph, os.path.join(work, '%s_%s_%d.png' % (name, kind, i)))
                if pixels is not None:
                    pictures.append(pixels)
                    print(name, kind, len(pictures), command)
            if kind == 'ink':
                source, target = (os.path.join(work, name + end) for end in ('_print.png', '_drawing.png'))
                command = KINDS['ink'][1 if name in NIGHTS else 0]
                drawing = made(command, pimgtool, for_print(photograph, source), target)
                write_drawing(drawing, os.path.join(folder, name + '_drawing.png'))
            page.write_jpeg(os.path.join(folder, '%s_%s.jpg' % (name, kind)), page.sheet(pictures, COLUMNS, WIDTH))


if __name__ == '__main__':
    main()
