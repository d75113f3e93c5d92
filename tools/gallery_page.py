# SPDX-License-Identifier: BSD-3-Clause
"""Sheets of pictures, the plot of h, and the pages that show them. Used by gallery.py."""
import base64
import html
import os

import numpy as np
import OpenImageIO as oiio

LARGEST_FILE = 200_000  # bytes of a picture that is kept in the repository
GAP = 6                 # pixels between the pictures of a sheet


def read_rgb(filename):
    """Pixels of an 8-bit picture as height x width x 3 in 0..1; grey is repeated."""
    picture = oiio.ImageBuf(filename)
    pixels = picture.get_pixels(oiio.FLOAT).reshape(picture.spec().height, picture.spec().width, -1)
    return pixels[..., :3] if pixels.shape[2] >= 3 else np.repeat(pixels[..., :1], 3, axis=2)


def to_buffer(pixels):
    picture = oiio.ImageBuf(oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, oiio.FLOAT))
    picture.set_pixels(picture.roi, np.ascontiguousarray(pixels, dtype=np.float32))
    return picture


def resized(pixels, width):
    """Scaled to a width; whole factors up keep pixels visible."""
    height = max(1, round(pixels.shape[0] * width / pixels.shape[1]))
    if width == pixels.shape[1]:
        return pixels
    if width % pixels.shape[1] == 0:
        factor = width // pixels.shape[1]
        return pixels.repeat(factor, axis=0).repeat(factor, axis=1)
    result = oiio.ImageBufAlgo.resize(to_buffer(pixels), roi=oiio.ROI(0, width, 0, height, 0, 1, 0, 3))
    return np.clip(result.get_pixels(oiio.FLOAT).reshape(height, width, 3), 0, 1)


def cut(pixels, window):
    """window: left, top, width, height in pixels; None for all."""
    if window is None:
        return pixels
    x, y, width, height = window
    return pixels[y:y + height, x:x + width]


def sheet(pictures, columns, width):
    """Pictures in rows on white, each as wide as its column."""
    each = (width - GAP * (columns - 1)) // columns
    pictures = [resized(p, each) for p in pictures]
    rows = []
    for first in range(0, len(pictures), columns):
        row = pictures[first:first + columns]
        height = max(p.shape[0] for p in row)
        strip = np.ones((height, width, 3), dtype=np.float32)
        for i, p in enumerate(row):
            strip[:p.shape[0], i * (each + GAP):i * (each + GAP) + each] = p
        rows += [strip, np.ones((GAP, width, 3), dtype=np.float32)]
    return np.concatenate(rows[:-1])


def write_jpeg(filename, pixels):
    """As good as fits LARGEST_FILE."""
    picture = to_buffer(pixels)
    picture.set_write_format(oiio.UINT8)
    for quality in range(92, 20, -6):
        picture.specmod().attribute('Compression', 'jpeg:%d' % quality)
        if not picture.write(filename):
            raise SystemExit('gallery: cannot write %s: %s' % (filename, picture.geterror()))
        if os.path.getsize(filename) <= LARGEST_FILE:
            return


def plot_of_h(s0, betas, width=520, height=320):
    """Fig. 6 as SVG: the scale h(d) = s0 + (1 - s0) (1 - d/dmax)^beta of a detail d."""
    left, top, right, bottom = 46, 14, width - 14, height - 40
    x = lambda d: left + d * (right - left)
    y = lambda h: bottom - h * (bottom - top)
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" width="%d" height="%d" '
             'font-family="sans-serif" font-size="13">' % (width, height, width, height),
             '<rect width="100%" height="100%" fill="#fff"/>',
             '<path d="M%g %gV%gH%g" fill="none" stroke="#333"/>' % (left, top, bottom, right)]
    for value in (0, 0.5, 1):
        parts.append('<text x="%g" y="%g" text-anchor="middle">%g</text>' % (x(value), bottom + 18, value))
    for value in (0, s0, 0.5, 1):
        parts.append('<text x="%g" y="%g" text-anchor="end">%g</text>' % (left - 6, y(value) + 4, value))
    parts.append('<text x="%g" y="%g" text-anchor="middle">d / dmax</text>' % (x(0.5), bottom + 34))
    for beta, color in zip(betas, ('#c0392b', '#2471a3', '#1e8449')):
        line = ' '.join('%.1f,%.1f' % (x(d), y(s0 + (1 - s0) * (1 - d) ** beta)) for d in np.linspace(0, 1, 101))
        parts.append('<polyline points="%s" fill="none" stroke="%s" stroke-width="2"/>' % (line, color))
        at = 0.72 / (1 + 0.35 * beta)
        parts.append('<text x="%.1f" y="%.1f" fill="%s">β = %g</text>'
                     % (x(at) + 8, y(s0 + (1 - s0) * (1 - at) ** beta) - 4, color, beta))
    return '\n'.join(parts) + '</svg>\n'


def table_html(rows):
    cells = lambda row, tag: ''.join('<%s>%s</%s>' % (tag, html.escape(str(c)), tag) for c in row)
    return '<table><tr>%s</tr>%s</table>' % (cells(rows[0], 'th'), ''.join('<tr>%s</tr>' % cells(r, 'td')
                                                                          for r in rows[1:]))


def table_markdown(rows):
    line = lambda row: '| ' + ' | '.join(str(c) for c in row) + ' |\n'
    return line(rows[0]) + '|' + '---|' * len(rows[0]) + '\n' + ''.join(line(r) for r in rows[1:])


STYLE = '''body{max-width:1000px;margin:2em auto;padding:0 1em;font:16px/1.5 sans-serif;color:#222}
img,svg{max-width:100%;height:auto}figure{margin:0 0 3em}figcaption{margin:.5em 0}
pre{background:#f4f4f4;padding:.6em;overflow-x:auto;font-size:13px}
table{border-collapse:collapse;margin:1em 0}td,th{border:1px solid #ccc;padding:.2em .6em;text-align:right}
td:first-child,th:first-child{text-align:left}'''


def write_html(filename, title, intro, figures, folder):
    """One page with all pictures inside."""
    out = ['<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>%s</title><style>%s</style>' % (title, STYLE),
           '<h1>%s</h1><p>%s</p>' % (title, html.escape(intro))]
    for f in figures:
        out.append('<figure id="%s"><h2>%s</h2>' % (f.name, html.escape(f.title)))
        if f.picture.endswith('.svg'):
            out.append(open(os.path.join(folder, f.picture), encoding='utf-8').read())
        elif f.picture:
            data = base64.b64encode(open(os.path.join(folder, f.picture), 'rb').read()).decode()
            out.append('<img alt="%s" src="data:image/jpeg;base64,%s">' % (html.escape(f.title), data))
        if f.table:
            out.append(table_html(f.table))
        out.append('<figcaption>%s</figcaption>' % html.escape(f.text))
        if f.commands:
            out.append('<pre>%s</pre>' % html.escape('\n'.join(f.commands)))
        out.append('</figure>')
    with open(filename, 'w', encoding='utf-8') as file:
        file.write('\n'.join(out) + '</html>\n')


def write_markdown(filename, title, intro, figures):
    """The same for the repository's pages, with the pictures beside it."""
    out = ['# %s\n\n%s\n' % (title, intro)]
    for f in figures:
        out.append('\n## %s\n' % f.title)
        if f.picture:
            out.append('\n![%s](%s)\n' % (f.title, f.picture))
        if f.table:
            out.append('\n' + table_markdown(f.table))
        out.append('\n%s\n' % f.text)
        if f.commands:
            out.append('\n' + ''.join('    %s\n' % c for c in f.commands))
    with open(filename, 'w', encoding='utf-8') as file:
        file.write(''.join(out))
