#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Other people's decoders show the HDR rendition that we meant: Debian's Chromium, and hdrify of npm.

Skipped where neither is there. hdrify is looked for in $HDRIFY, the folder that `npm install hdrify` was run in.
"""

import base64
import functools
import http.server
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np
import OpenImageIO as oiio

import pimg

SKIPPED = 77  # what ctest takes for it
WEIGHTS = np.array([0.2126, 0.7152, 0.0722])

PAGE = """<body><pre id=o>wait</pre><script>
(async () => {
    const image = new Image();
    image.src = 'file.jpg';
    await image.decode();
    const canvas = document.createElement('canvas');
    canvas.width = image.width;
    canvas.height = image.height;
    const context = canvas.getContext('2d', { colorType: 'float16' });
    context.globalHDRHeadroom = 10;
    context.drawImage(image, 0, 0);
    const data = context.getImageData(0, 0, image.width, image.height, { pixelFormat: 'rgba-float16' }).data;
    const bytes = new Uint8Array(Float32Array.from(data).buffer);
    let text = '';
    for (let i = 0; i < bytes.length; i += 32768)
        text += String.fromCharCode(...bytes.subarray(i, i + 32768));
    document.getElementById('o').textContent = 'pixels:' + btoa(text) + ':';
})();
</script>"""

READER = """import fs from 'fs';
import { readJpegGainMap } from 'hdrify';
const image = readJpegGainMap(new Uint8Array(fs.readFileSync(process.argv[2])));
fs.writeFileSync(process.argv[3], Buffer.from(image.data.buffer, image.data.byteOffset, image.data.byteLength));
"""


def scene(width=160, height=120):
    """A dim room with a bright, coloured window; display-linear, up to five times SDR white."""
    y, x = np.mgrid[0:height, 0:width].astype(np.float32)
    light = 0.05 + 0.2 * x / width
    colour = np.stack([light, light * 0.9, light * 1.1], axis=-1)
    glow = np.exp(-((x - 100) ** 2 + (y - 50) ** 2) / 900)[..., None]
    return (colour + 5 * glow * np.array([1.0, 0.8, 0.5])).astype(np.float32)


def gain_map_file(folder):
    rendition = scene()
    base = pimg.srgb_encoded(rendition / (1 + rendition / 1.5))
    path = folder / "base.jpg"
    out = oiio.ImageOutput.create(str(path))
    spec = oiio.ImageSpec(base.shape[1], base.shape[0], 3, "uint8")
    spec.attribute("Compression", "jpeg:97")
    if not (out.open(str(path), spec) and out.write_image(base) and out.close()):
        raise RuntimeError(out.geterror())
    file = folder / "file.jpg"
    file.write_bytes(pimg.gain_map_jpeg(path.read_bytes(), rendition))
    return file


def stops_apart(a, b):
    """The 95th percentile of the difference of luminance."""
    stops = np.abs(np.log2(np.maximum(a @ WEIGHTS, 1e-3) / np.maximum(b @ WEIGHTS, 1e-3)))
    return np.percentile(stops, 95)


def decode_srgb(values):
    return np.where(values <= 0.04045, values / 12.92, ((np.maximum(values, 0) + 0.055) / 1.055) ** 2.4)


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *args):
        pass


def chromium_pixels(folder, browser):
    (folder / "page.html").write_text(PAGE)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(folder)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    command = [browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
               "--disable-background-networking", "--disable-component-update", "--disable-sync",
               f"--user-data-dir={folder}/profile", "--enable-experimental-web-platform-features",
               "--force-color-profile=scrgb-linear", "--virtual-time-budget=20000", "--dump-dom",
               f"http://127.0.0.1:{server.server_port}/page.html"]
    try:
        text = subprocess.run(command, capture_output=True, text=True, timeout=100).stdout
    finally:
        server.shutdown()
    pixels = np.frombuffer(base64.b64decode(text.split("pixels:")[1].split(":")[0]), np.float32)
    return decode_srgb(pixels.reshape(scene().shape[:2] + (4,))[..., :3])


def hdrify_pixels(folder, installed):
    script = pathlib.Path(installed) / "pimg_read.mjs"
    script.write_text(READER)
    subprocess.run(["node", str(script), str(folder / "file.jpg"), str(folder / "out.raw")], check=True)
    return np.fromfile(folder / "out.raw", np.float32).reshape(scene().shape[:2] + (4,))[..., :3]


class DecodersTest(unittest.TestCase):
    def compare(self, decode, tool):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            ours = pimg.gain_map_rendition(gain_map_file(folder).read_bytes(), array=True)
            theirs = decode(folder, tool)
        self.assertLess(stops_apart(ours, scene()), 0.1)
        self.assertLess(stops_apart(theirs, scene()), 0.1)

    @unittest.skipUnless(shutil.which("chromium"), "no Chromium")
    def test_chromium(self):
        self.compare(chromium_pixels, shutil.which("chromium"))

    @unittest.skipUnless(os.environ.get("HDRIFY") and shutil.which("node"), "no hdrify")
    def test_hdrify(self):
        self.compare(hdrify_pixels, os.environ["HDRIFY"])


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    sys.exit(SKIPPED if len(result.skipped) == result.testsRun else not result.wasSuccessful())
