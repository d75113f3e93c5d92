#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes every figure and table of the paper, and what goes beyond it: gallery.py PIMGTOOL WORK FOLDER

WORK receives the photographs and the results at full size, FOLDER the sheets, index.html with everything inside, and
README.md. The photographs come with Debian's packages; one that is not installed is downloaded and unpacked in WORK.
"""
import glob
import json
import os
import shlex
import subprocess
import sys
from dataclasses import dataclass, field

import numpy as np

import gallery_page as page

PHOTOS = {  # package, path in it, origin
    'astronaut.png': ('python3-skimage', 'skimage/data/astronaut.png', 'NASA, public domain'),
    'camera.png': ('python3-skimage', 'skimage/data/camera.png', 'Lav Varshney, CC0'),
    'chelsea.png': ('python3-skimage', 'skimage/data/chelsea.png', 'Stefan van der Walt, CC0'),
    'coffee.png': ('python3-skimage', 'skimage/data/coffee.png', 'Rachel Michetti, CC0'),
    'courtyard.exr': ('blender-data', 'studiolights/world/courtyard.exr', 'Greg Zaal, HDRI Haven, CC0'),
    'interior.exr': ('blender-data', 'studiolights/world/interior.exr', 'Greg Zaal, HDRI Haven, CC0'),
    'sunrise.exr': ('blender-data', 'studiolights/world/sunrise.exr', 'Greg Zaal, HDRI Haven, CC0'),
}


@dataclass
class Figure:
    name: str
    title: str
    text: str
    commands: list = field(default_factory=list)
    picture: str = ''
    table: list = field(default_factory=list)


class Gallery:
    def __init__(self, pimgtool, work, folder):
        self.pimgtool = os.path.abspath(pimgtool)
        self.work, self.folder = work, folder
        self.figures = []
        os.makedirs(work, exist_ok=True)
        os.makedirs(folder, exist_ok=True)

    # ---- photographs

    def fetch(self, name):
        """Puts a photograph into the work folder."""
        package, path, _ = PHOTOS[name]
        target = os.path.join(self.work, name)
        if os.path.exists(target):
            return
        listed = subprocess.run(['dpkg', '-L', package], capture_output=True, text=True).stdout.split('\n')
        found = [f for f in listed if f.endswith(path)] or self.unpacked(package, path)
        if not found:
            raise SystemExit('gallery: %s: not in the package %s' % (path, package))
        with open(found[0], 'rb') as source, open(target, 'wb') as copy:
            copy.write(source.read())

    def unpacked(self, package, path):
        scratch = os.path.join(self.work, package)
        if not os.path.isdir(scratch):
            print('fetching the package', package)
            download = ['apt-get', '-q', '-q', '-o', 'APT::Sandbox::User=root', 'download', package]
            subprocess.run(download, cwd=self.work, check=True)
            archive = glob.glob(os.path.join(self.work, package + '_*.deb'))[0]
            subprocess.run(['dpkg-deb', '-x', archive, scratch], check=True)
        return glob.glob(os.path.join(scratch, '**', os.path.basename(path)), recursive=True)

    # ---- commands

    def run(self, command):
        """Runs a command line as the captions show it, in the work folder; returns what it printed."""
        words = shlex.split(command)
        if words[0] == 'pimgtool':
            words[0] = self.pimgtool
        done = subprocess.run(words, cwd=self.work, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit('gallery: %s\n%s' % (command, done.stderr.strip()))
        return done.stdout

    def seconds(self, arguments, stage):
        """Seconds of a stage on one thread: the best of three."""
        runs = [json.loads(self.run('pimgtool --threads 1 --stats:format=json %s -o scratch.exr' % arguments))
                for _ in range(3)]
        return min(r['seconds'][stage] for r in runs)

    def first_and_again(self, photo, operation, times=10):
        """Seconds of a filter on a new hierarchy, and when it is run again."""
        first = self.seconds('%s --build %s' % (photo, operation), 'filter')
        more = self.seconds('%s --build%s %s' % (photo, (' --dup %s --pop' % operation) * times, operation), 'filter')
        return first, max(0.0, more - first) / times

    def picture(self, filename, window=None):
        return page.cut(page.read_rgb(os.path.join(self.work, filename)), window)

    def figure(self, name, title, text, commands, shown=None, columns=2, width=1000, windows=None):
        """Runs the commands; the sheet shows what they write, or the files `shown`."""
        print(name, title, flush=True)
        for command in commands:
            self.run(command)
        shown = shown or [shlex.split(c)[-1] for c in commands]
        windows = windows or [None] * len(shown)
        sheet = page.sheet([self.picture(f, w) for f, w in zip(shown, windows)], columns, width)
        page.write_jpeg(os.path.join(self.folder, name + '.jpg'), sheet)
        self.figures.append(Figure(name, title, text, commands, name + '.jpg'))

    def rms(self, a, b):
        return 255 * float(np.sqrt(np.mean((self.picture(a) - self.picture(b)) ** 2)))

    def table(self, name, title, text, rows, commands):
        self.figures.append(Figure(name, title, text, commands, '', rows))


def exposed(photo, factor, out):
    return ('oiiotool %s --ch R,G,B --mulc %g --clamp:min=0:max=1 --colorconvert linear sRGB -d uint8 -o %s'
            % (photo, factor, out))


# ---- the figures, in the paper's order


def levels(g):
    commands = []
    for i, faces in enumerate((500, 4000, 30000)):
        commands.append('pimgtool camera.png --level:faces=%d -o fig01_level%d.png' % (faces, i))
        commands.append('pimgtool camera.png --wireframe:faces=%d -o fig01_mesh%d.png' % (faces, i))
    shown = ['fig01_level%d.png' % i for i in range(3)] + ['fig01_mesh%d.png' % i for i in range(3)]
    g.figure('fig01', 'Fig. 1: levels of a progressive image',
             'A photograph by 500, 4000 and 30000 triangles, and the meshes. The whole hierarchy is built once.',
             commands, shown, columns=3)


def metrics(g):
    commands = ['pimgtool camera.png --build:metric=%s --level:fraction=0.01 -o fig02_%s.png' % (m, m)
                for m in ('volume', 'quadric', 'exact')]
    g.figure('fig02', 'Fig. 2: error metrics', '', commands, columns=3)
    errors = ['%s %.2f' % (m, g.rms('camera.png', 'fig02_%s.png' % m)) for m in ('volume', 'quadric', 'exact')]
    g.figures[-1].text = ('1 % of the vertices, chosen by volume optimisation, by quadrics and by the largest deviation '
                          'with half-edge collapse. Root mean square difference from the photograph, of 255: '
                          + ', '.join(errors) + '.')


def lowpass_and_enhancement(g):
    g.figure('fig03', 'Fig. 3: feature low-pass and enhancement',
             'The photograph, its first 500 vertex splits, and its details from split 30000 on amplified six times. The '
             'same as a curve: 0:1,30000:1,30000:6.',
             ['pimgtool astronaut.png --feature-lowpass:splits=500 -o fig03_lowpass.png',
              'pimgtool astronaut.png --detail-enhance:gain=6:from=30000 -o fig03_enhanced.png',
              'pimgtool astronaut.png --detail-enhance:curve=0:1,30000:1,30000:6 -o fig03_curve.png'],
             ['astronaut.png', 'fig03_lowpass.png', 'fig03_enhanced.png'], columns=3)


def dual_pieces(g):
    g.figure('fig04', 'Fig. 4: dual pieces',
             'The pieces that 400 and 3000 vertices stand for, outlined as the polygons through the centres of the '
             'triangles around each vertex.',
             ['pimgtool chelsea.png --mosaic:shape=pieces:variation=0:tiles=%d:grout=0.7:bevel=0:colour=1 -o fig04_%d.png' % (n, n)
              for n in (400, 3000)])


def segmentation(g):
    commands = ['pimgtool coffee.png --segment:regions=%d:output=mean -o fig05_mean%d.png' % (n, n)
                for n in (50, 200, 1000)]
    commands += ['pimgtool coffee.png --segment:regions=%d:output=boundaries -o fig05_lines%d.png' % (n, n)
                 for n in (50, 200, 1000)]
    g.figure('fig05', 'Fig. 5: segmentation',
             'Pieces merged to 50, 200 and 1000 regions: mean colours, and where regions meet. A coarser segmentation is '
             'a union of finer regions.', commands, columns=3)


def scale_of_details(g):
    s0, betas = 0.1, (1, 4, 12)
    with open(os.path.join(g.folder, 'fig06.svg'), 'w', encoding='utf-8') as file:
        file.write(page.plot_of_h(s0, betas))
    g.figures.append(Figure('fig06', 'Fig. 6: the scale h of a detail',
                            'h(d) = s0 + (1 - s0) (1 - d/dmax)^β for s0 = %g and three β: the larger β, the fewer '
                            'details are compressed less than fully.' % s0, [], 'fig06.svg'))


def parameters(g):
    commands = [exposed('courtyard.exr', 2.0 ** stops, 'fig07_exposure%d.png' % i) for i, stops in enumerate((-3, 0, 3))]
    for s0 in (0.1, 0.3):
        for beta in (1, 4, 12):
            commands.append('pimgtool courtyard.exr --hdr-compress:s0=%g:beta=%g -o fig07_%g_%g.png' % (s0, beta, s0, beta))
    g.figure('fig07', 'Fig. 7: HDR compression and its parameters',
             'Three exposures of one HDR photograph, then β = 1, 4, 12 from left to right for s0 = 0.1 and 0.3.',
             commands, columns=3)


def hdr_photographs(g):
    commands = []
    for name in ('interior', 'sunrise'):
        commands += [exposed(name + '.exr', 1.0, 'fig08_%s_plain.png' % name),
                     'pimgtool %s.exr --hdr-compress -o fig08_%s.png' % (name, name)]
    g.figure('fig08', 'Fig. 8: HDR photographs at the defaults', 'Left at plain exposure, right compressed.', commands)


def contrast_envelope(g):
    window = (300, 150, 300, 200)
    g.figure('fig09', 'Fig. 9: strong edges',
             'Left Eq. (2) as printed, where small details beside a strong edge are compressed less than the edge; right '
             'the default, where they go with the contrast around them. Enlarged twice.',
             ['pimgtool courtyard.exr --hdr-compress:coherence=0 -o fig09_printed.png',
              'pimgtool courtyard.exr --hdr-compress -o fig09_default.png'], windows=[window, window], width=1206)


def painterly(g):
    for name, photo in (('fig10', 'astronaut.png'), ('fig11', 'coffee.png')):
        g.figure(name, 'Fig. %s: painterly rendering' % name[3:],
                 'The photograph (%s), painted at the defaults, with larger brushes, and with a knife and '
                 'thick paint.' % PHOTOS[photo][2],
                 ['pimgtool %s --paint -o %s_default.png' % (photo, name),
                  'pimgtool %s --paint:min=8:max=60:brush=flat -o %s_large.png' % (photo, name),
                  'pimgtool %s --paint:style=impasto -o %s_impasto.png' % (photo, name)],
                 [photo] + ['%s_%s.png' % (name, n) for n in ('default', 'large', 'impasto')])


def build_and_retune(g):
    rows = [['photograph', 'Mpixel', 'build, s', 'analysis, s', 'low-pass, s', 'enhancement, s', 'HDR compression, s',
             'painting, s']]
    for photo in ('camera.png', 'astronaut.png', 'coffee.png', 'courtyard.exr'):
        build = g.seconds(photo + ' --build', 'build')
        first, again = zip(*[g.first_and_again(photo, f)
                             for f in ('--feature-lowpass', '--detail-enhance', '--hdr-compress')])
        paint = g.seconds(photo + ' --build --paint', 'filter')
        analysis = max(0.0, first[0] - again[0])
        height, width = g.picture(photo).shape[:2]
        rows.append([photo, '%.2f' % (width * height / 1e6)]
                    + ['%.3f' % t for t in (build, analysis, *again, paint)])
    rows.append(['the paper, Pentium IV', '0.26', '41.6', '', '13', '13', '', '9 to 14'])
    g.table('table1', 'Table 1: seconds to build, to retune and to paint',
            'One thread, wall clock, the best of three, with other work on the machine. A picture is built once; its '
            'channels are analysed once, before the first low-pass or enhancement; every change of a parameter costs what '
            'the filters\' columns say.', rows,
            ['pimgtool --threads 1 --stats courtyard.exr --build --hdr-compress -o out.png'])


def simpler_meshes(g):
    rows = [['photograph', 'all pixels, s', 'a third of them, s', 'times faster', 'difference of the mesh, of 255']]
    for photo in ('camera.png', 'astronaut.png', 'coffee.png', 'chelsea.png'):
        full = g.seconds(photo + ' --build', 'build')
        adaptive = g.seconds(photo + ' --build:mesh=adaptive', 'build')
        g.run('pimgtool %s --build:mesh=adaptive --level -o table2.png' % photo)
        off = 255 * float(np.mean(np.abs(g.picture(photo) - g.picture('table2.png'))))
        rows.append([photo, '%.3f' % full, '%.3f' % adaptive, '%.1f' % (full / adaptive), '%.2f' % off])
    rows.append(['the paper', '', '', '', '3.76'])
    g.table('table2', 'Table 2: simpler initial meshes',
            'One thread, wall clock, best of three, with other work on the machine. The difference is kept as the '
            'residual, so that pictures come back exactly.', rows,
            ['pimgtool --threads 1 --stats camera.png --build:mesh=adaptive --level -o out.png'])


def other_styles(g):
    g.figure('brushes', 'Brushes', 'round, flat, bristle and knife; enlarged twice.',
             ['pimgtool astronaut.png --paint:min=4:max=40:brush=%s -o brush_%s.png' % (b, b)
              for b in ('round', 'flat', 'bristle', 'knife')], windows=[(130, 10, 200, 150)] * 4)
    g.figure('paint_styles', 'Styles of painting',
             'The photograph, and the styles oil, which is the default, impasto, wash, pastel and '
             'pointillist. Oil and impasto would hang on a wall, pointillist from two steps away. Wash leaves '
             'black grey, as its pigment is thin. Pastel loses what is finer than its chalk, such as the '
             'spoon, because narrow strokes hardly press on the paper.',
             ['pimgtool coffee.png --paint:style=%s -o style_%s.png' % (n, n)
              for n in ('oil', 'impasto', 'wash', 'pastel', 'pointillist')],
             ['coffee.png'] + ['style_%s.png' % n for n in ('oil', 'impasto', 'wash', 'pastel', 'pointillist')], width=1206)
    g.figure('mosaics', 'Mosaics',
             'Cells, which are the default, the pieces they grow from, and stained glass. The window and the '
             'cup of cells would hang on a wall. Where a feature is narrower than a cell, as at the handle, '
             'the cells are ragged; and the cat needs more and smaller panes than a glazier would cut. Pieces '
             'follow the grain of the wood better than cells do.',
             ['pimgtool coffee.png --mosaic:tiles=900 -o mosaic_cells.png',
              'pimgtool coffee.png --mosaic:tiles=900:shape=pieces -o mosaic_pieces.png',
              'pimgtool coffee.png --mosaic:tiles=600:leading=4:colour=0.1 -o mosaic_glass.png',
              'pimgtool chelsea.png --mosaic:tiles=1500:leading=3:colour=0.1 -o mosaic_cat.png'])
    g.figure('styles', 'Mosaic, pen and ink',
             'Tiles grown from dual pieces, and a drawing with outlines and hatching; lines can be had as SVG.',
             ['pimgtool chelsea.png --mosaic:tiles=1500 -o mosaic.png', 'pimgtool chelsea.png --ink -o ink.png'])


def main():
    if len(sys.argv) != 4:
        raise SystemExit(__doc__)
    g = Gallery(*sys.argv[1:])
    for name in PHOTOS:
        g.fetch(name)
    for make in (levels, metrics, lowpass_and_enhancement, dual_pieces, segmentation, scale_of_details, parameters,
                 hdr_photographs, contrast_envelope, painterly, build_and_retune, simpler_meshes, other_styles):
        make(g)
    intro = ('Every figure and table of the paper, made by ./dev.sh gallery. Photographs: '
             + '; '.join('%s, %s' % (name, origin) for name, (_, _, origin) in PHOTOS.items())
             + '. Fig. 12, the samples of a simpler initial mesh, is in docs/adaptive.md; paintings, drawings and mosaics '
             'beside those of other programs are in docs/gallery/peers.md.')
    page.write_html(os.path.join(g.folder, 'index.html'), 'Gallery', intro, g.figures, g.folder)
    page.write_markdown(os.path.join(g.folder, 'README.md'), 'Gallery', intro, g.figures)


if __name__ == '__main__':
    main()
