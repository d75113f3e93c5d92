# SPDX-License-Identifier: BSD-3-Clause
"""Writers that are killed, and writers of one name at the same time: a file is the old one or a new one, whole.

Environment: PIMGTOOL; PIMG_KILLS, how often to kill the writer of each format, default 1; PIMG_KILL_FORMATS, which
formats, default all.
"""
import hashlib
import os
import random
import subprocess
import tempfile
import time
import unittest

import numpy as np
import OpenImageIO as oiio

TOOL = os.environ["PIMGTOOL"]
FORMATS = ("pimg", "exr", "tif", "png", "jpg", "bmp", "tga", "ppm", "sgi", "hdr", "gif", "jp2", "dpx", "webp")
CHOSEN = os.environ.get("PIMG_KILL_FORMATS", " ".join(FORMATS)).split()


def write(path, seed):
    noise = np.random.default_rng(seed).integers(0, 256, (120, 160, 3), dtype=np.uint8)
    buffer = oiio.ImageBuf(oiio.ImageSpec(160, 120, 3, "uint8"))
    buffer.set_pixels(buffer.roi, noise)
    buffer.write(path)


def pixels(path):
    """A digest of the samples; of a .pimg file, which Python's OpenImageIO reads with the plugin only, of the bytes.

    Read without OpenImageIO's cache, which may take a new file of the same name for the old one.
    """
    if path.endswith(".pimg"):
        with open(path, "rb") as file:
            return hashlib.sha256(file.read()).hexdigest()
    file = oiio.ImageInput.open(path)
    samples = file.read_image("float") if file else None
    return hashlib.sha256(samples.tobytes()).hexdigest() if samples is not None else "cannot be read"


class Killed(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        for seed in (1, 2):
            write(self.path(f"{seed}.ppm"), seed)

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self, seed, target):
        return subprocess.Popen([TOOL, self.path(f"{seed}.ppm"), "-o", target], stderr=subprocess.PIPE)

    def begun(self, process, before):
        """Waits until a file is there that was not `before`, the one that is written, or the process is over."""
        while process.poll() is None and set(os.listdir(self.folder)) <= before:
            pass

    def finished(self, seed, target):
        """What the target holds after a run that was left alone, and how long it took to begin to write and to end; None
        for no such writer."""
        before, start = set(os.listdir(self.folder)), time.monotonic()
        with self.start(seed, target) as process:
            self.begun(process, before)
            begun = time.monotonic()
            failed = process.wait() != 0
        return None if failed else (pixels(target), begun - start, time.monotonic() - begun)

    def test_killed_writers_leave_the_old_file_or_the_new(self):
        """Every other one is killed at any moment of its life, the others while the file is being written."""
        chance = random.Random(1)
        tried = 0
        for extension in CHOSEN:
            target = self.path(f"out.{extension}")
            old, new = self.finished(1, target), None
            if old is not None:
                os.remove(target)
                new = self.finished(2, target)
            if new is None:
                continue
            tried += 1
            replaced, kills = 0, int(os.environ.get("PIMG_KILLS", "1"))
            for kill in range(kills):
                before, names = pixels(target), set(os.listdir(self.folder))
                with self.start(2 if before == old[0] else 1, target) as process:
                    if kill % 2 == 0:
                        self.begun(process, names)
                        time.sleep(chance.uniform(0, 1.05) * new[2])
                    else:
                        time.sleep(chance.uniform(0.2, 1.05) * (new[1] + new[2]))
                    process.kill()
                self.assertIn(pixels(target), (old[0], new[0]), extension)
                replaced += pixels(target) != before
            print(f"{extension}: {kills} kills, after {replaced} the new file")
        self.assertGreaterEqual(tried, min(10, len(CHOSEN)))

    def test_of_two_writers_of_one_name_one_wins_whole(self):
        for extension in ("pimg", "exr", "png", "jpg"):
            target = self.path(f"both.{extension}")
            ends = [self.finished(seed, target)[0] for seed in (1, 2)]
            self.assertNotEqual(*ends)
            for _ in range(3):
                processes = [self.start(seed, target) for seed in (1, 2)]
                for process in processes:
                    with process:
                        self.assertEqual(process.wait(), 0)
                self.assertIn(pixels(target), ends, extension)
        self.assertEqual({name for name in os.listdir(self.folder) if name.startswith("both")},
                         {f"both.{extension}" for extension in ("pimg", "exr", "png", "jpg")})


if __name__ == "__main__":
    unittest.main()
