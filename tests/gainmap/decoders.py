# SPDX-License-Identifier: BSD-3-Clause
"""Gain-map files as other people's decoders show them: Debian's Chromium, and hdrify of npm."""

import functools
import http.server
import pathlib
import subprocess
import threading

import numpy as np

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
DARKEST = 1 / 64  # of SDR white; luminances below count as this

PAGE = """<script>
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
    await fetch('pixels', { method: 'POST', body: Float32Array.from(data) });
})();
</script>"""

READER = """import fs from 'fs';
import { readJpegGainMap } from 'hdrify';
const image = readJpegGainMap(new Uint8Array(fs.readFileSync(process.argv[2])));
fs.writeFileSync(process.argv[3], Buffer.from(image.data.buffer, image.data.byteOffset, image.data.byteLength));
"""


def stops_apart(a, b):
    """The 95th percentile of the difference of luminance."""
    stops = np.abs(np.log2(np.maximum(a @ WEIGHTS, DARKEST) / np.maximum(b @ WEIGHTS, DARKEST)))
    return np.percentile(stops, 95)


def decode_srgb(values):
    return np.where(values <= 0.04045, values / 12.92, ((np.maximum(values, 0) + 0.055) / 1.055) ** 2.4)


class Page(http.server.SimpleHTTPRequestHandler):
    """Gives the page and the picture, and takes the pixels."""

    def log_message(self, *args):
        pass

    def do_POST(self):
        self.server.pixels = self.rfile.read(int(self.headers["Content-Length"]))
        self.send_response(204)
        self.end_headers()
        self.server.has_pixels.set()


def chromium_pixels(folder, shape, browser):
    """Linear Rec. 709 of folder/file.jpg on a display of any brightness; shape is (height, width)."""
    (folder / "page.html").write_text(PAGE)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Page, directory=str(folder)))
    server.has_pixels = threading.Event()
    threading.Thread(target=server.serve_forever, daemon=True).start()
    command = [browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
               "--disable-background-networking", "--disable-component-update", "--disable-sync",
               f"--user-data-dir={folder}/profile", "--enable-experimental-web-platform-features",
               "--force-color-profile=scrgb-linear", "--remote-debugging-port=0",
               f"http://127.0.0.1:{server.server_port}/page.html"]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL) as process:
        done = server.has_pixels.wait(timeout=100)
        process.terminate()
    server.shutdown()
    if not done:
        raise TimeoutError("Chromium sent no pixels")
    pixels = np.frombuffer(server.pixels, np.float32)
    return decode_srgb(pixels.reshape(shape + (4,))[..., :3])


def hdrify_pixels(folder, shape, installed):
    """The same by hdrify, in the primaries of the base; `installed` is the folder that `npm install` was run in."""
    script = pathlib.Path(installed) / "pimg_read.mjs"
    script.write_text(READER)
    subprocess.run(["node", str(script), str(folder / "file.jpg"), str(folder / "out.raw")], check=True)
    return np.fromfile(folder / "out.raw", np.float32).reshape(shape + (4,))[..., :3]
