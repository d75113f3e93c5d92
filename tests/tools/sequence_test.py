# SPDX-License-Identifier: BSD-3-Clause
"""Sequences: frames and views, several at a time, and one exposure for a shot, on one machine or many."""

import json
import os
import shutil
import subprocess
import unittest

import numpy as np

import pictures
from pictures import read

FARM = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools/farm")
FRAMES = 24
WIDTH, HEIGHT = 160, 120
STATIC = (slice(92, HEIGHT), slice(25, 135))  # a title that stays where it is, less its rim


def pan():
    """A camera that pans over windows and a lamp while its exposure drifts by half a stop and swings; with noise."""
    noise = np.random.default_rng(3)
    y, x = np.mgrid[0:HEIGHT, 0 : WIDTH + 3 * FRAMES].astype(float)
    texture = 0.3 * np.sin(x / 3.1) * np.cos(y / 2.7) + 0.2 * np.sin(x / 9 + y / 7)
    scene = np.exp2(texture) * (0.08 + 0.1 * y / HEIGHT)
    window = (x % 80 > 25) & (x % 80 < 55) & (y > 20) & (y < 70)
    scene[window] = 60 * np.exp2(texture[window] / 2)
    scene[(x - 150) ** 2 + (y - 20) ** 2 < 30] = 2000
    title = 0.4 * np.exp2(0.4 * np.sin(np.arange(120) / 5))
    for frame in range(FRAMES):
        picture = scene[:, 3 * frame : 3 * frame + WIDTH].copy()
        picture[90:, 20:140] = title
        picture *= 2 ** (0.5 * frame / (FRAMES - 1) + 0.15 * np.sin(frame / 3))
        rgb = picture[..., None] * [1, 0.9, 0.7] * (1 + 0.02 * noise.standard_normal((HEIGHT, WIDTH, 3)))
        pictures.write(f"in.{frame + 1:04d}.exr", np.maximum(rgb, 0), "half")


def lightness(name):
    y = read(name)[..., :3] @ [0.2126, 0.7152, 0.0722]
    return np.where(y > 0.008856, 116 * np.cbrt(y) - 16, 903.3 * y)


class Sequences(pictures.ToolTest):
    def small(self, names):
        for i, name in enumerate(names):
            pictures.write(name, pictures.hdr_scene(24, 16) * (1 + i), "half")

    def test_frames_and_views(self):
        names = [f"{view}.{frame:04d}.exr" for view in ("left", "right") for frame in (1, 2, 3, 7)]
        self.small(names)
        self.ok("--frames", "1-3,7", "--views", "left,right", "%V.#.exr", "--level:faces=100", "-o", "out_%v.%03d.exr",
                "-d", "float", "-o", "f_%V@@.tif")
        for name in names:
            self.ok(name, "--level:faces=100", "-o", "alone.exr")
            self.assert_same(f"out_{name[0]}.{name.split('.')[1][1:]}.exr", "alone.exr")
            self.assertTrue(os.path.exists(f"f_{name.split('.')[0]}{name.split('.')[1][2:]}.tif"))
        self.ok("--frames", "7", "left.#.exr", "-o", "only.#.exr")
        self.assertTrue(os.path.exists("only.0007.exr"))

    def test_frames_at_a_time_change_nothing(self):
        self.small([f"in.{frame:04d}.exr" for frame in range(1, 7)])
        for threads in (1, 3):
            self.ok("--frames", "1-6", "in.#.exr", "--parallel-frames", "--threads", threads, "--hdr-compress",
                    "-o", f"out{threads}.#.exr")
        figures = json.loads(self.ok("--frames", "1-6", "in.#.exr", "--hdr-compress", "-o", "out.#.exr",
                                     "--stats:format=json"))
        self.assertEqual(len(figures["hierarchies"]), 6)
        for frame in range(1, 7):
            for threads in (1, 3):
                self.assert_same(f"out.{frame:04d}.exr", f"out{threads}.{frame:04d}.exr")

    def test_what_is_wrong_is_said_before_any_work(self):
        self.small(["in.0001.exr", "in.0002.exr"])
        shot = ("--shot-stats", "shot.json")
        for arguments, says in (
            (("--frames", "1-3", "in.#.exr", "-o", "out.#.exr"), ("frame 3", "in.0003.exr", "no such file")),
            (("--frames", "1-2", "in.#.exr", "-o", "out.exr"), ("out.exr", "#")),
            (("--frames", "0-9999999999", "in.#.exr", "-o", "out.#.exr"), ("0-9999999999", "at most 100000")),
            (("--frames", "0-9999999", "in.#.exr", "-o", "out.#.exr"), ("0-9999999", "at most 100000")),
            (("x" * 5000 + ".exr",), ("xxx...xxx",)),
            (("in.1-3#.exr", "-o", "out.exr"), ("in.1-3#.exr", "--frames")),
            (("--frames", "1-3", "in.#.exr", "-o", "b.1-3#.exr"), ("b.1-3#.exr", "--frames")),
            (("--frames", "1-2", "--views", "a,b", "in.#.exr", "-o", "out.#.exr"), ("out.0001.exr", "%V")),
            (("--frames", "one", "in.#.exr", "-o", "out.#.exr"), ("--frames", "one", "1-240")),
            (("--views", ",", "in.0001.exr", "-o", "out.%V.exr"), ("--views", "left,right")),
            (("--frames", "1-2", "in.#.exr", "--level", *shot, "-o", "out.#.exr"), ("--shot-stats", "--hdr-compress")),
            (("--frames", "1-2", "in.#.exr", "--hdr-compress", "--shot-stats", "no/shot.json", "-o", "out.#.exr"),
             ("--shot-stats", "no/shot.json")),
        ):
            self.fails(*arguments, says=says)
        for text in ("{", "{}", '{"frames": [{"frame": 1, "dmax": 1}]}'):
            with open("shot.json", "w", encoding="utf-8") as file:
                file.write(text)
            self.fails("--frames", "1", "in.#.exr", "--hdr-compress", *shot, "-o", "out.#.exr",
                       says=("shot.json", "expected"))

    def test_a_damaged_frame_is_named(self):
        self.small(["in.0001.exr", "in.0002.exr", "in.0003.exr"])
        with open("in.0002.exr", "wb") as file:
            file.write(b"not a picture")
        done = self.run_tool("--frames", "1-3", "in.#.exr", "-o", "out.#.exr")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"\Apimgtool: error: frame 2: [^\n]*in.0002.exr[^\n]*\n\Z")
        self.assertFalse(os.path.exists("out.0003.exr"))


class Shots(pictures.ToolTest):
    def setUp(self):
        super().setUp()
        pan()

    def flicker(self, pattern):
        """Mean change of mean L* from frame to frame, and the median change of the pixels of the title."""
        frames = [lightness(pattern % (frame + 1)) for frame in range(FRAMES)]
        means = np.abs(np.diff([frame.mean() for frame in frames])).mean()
        return means, np.median([np.median(np.abs(b[STATIC] - a[STATIC])) for a, b in zip(frames, frames[1:])])

    def test_a_shot_does_not_flicker(self):
        self.ok("--frames", f"1-{FRAMES}", "--parallel-frames", "in.#.exr", "--hdr-compress",
                "--shot-stats", "shot.json", "-o", "out.#.exr")
        flicker, still = self.flicker("out.%04d.exr")
        self.assertLess(flicker, 0.3)
        self.assertLess(still, 1.0)
        # Exposed each for itself they do more, so there was something to do.
        self.ok("--frames", f"1-{FRAMES}", "in.#.exr", "--hdr-compress", "-o", "alone.#.exr")
        self.assertGreater(self.flicker("alone.%04d.exr")[0], 2 * flicker)

        with open("shot.json", encoding="utf-8") as file:
            frames = json.load(file)["frames"]
        self.assertEqual([frame["frame"] for frame in frames], list(range(1, FRAMES + 1)))
        drift = np.log2(frames[-1]["key"] / frames[0]["key"])
        self.assertGreater(drift, 0.02)

        # Any frame alone, from the figures, is the same.
        self.ok("--frames", 9, "in.#.exr", "--hdr-compress", "--shot-stats", "shot.json", "-o", "farm.#.exr")
        self.assert_same("farm.0009.exr", "out.0009.exr")
        self.ok("--frames", 9, "in.#.exr", "--hdr-compress", "--shot-stats:mode=lock", "shot.json", "-o", "lock.#.exr")
        self.assertFalse(np.array_equal(read("lock.0009.exr"), read("out.0009.exr")))
        self.fails("--frames", "25", "in.0001.exr", "--hdr-compress", "--shot-stats", "shot.json", "-o", "x.#.exr",
                   says=("shot.json", "frame 25", "update=1"))

        # Measuring alone writes no pictures; views count together.
        before = os.stat("shot.json").st_mtime_ns
        self.ok("--frames", "1-2", "in.#.exr", "--hdr-compress", "--shot-stats:update=1:render=0", "shot.json",
                "-o", "never.#.exr")
        self.assertFalse(os.path.exists("never.0001.exr"))
        self.assertNotEqual(os.stat("shot.json").st_mtime_ns, before)
        shutil.copy("in.0001.exr", "l.exr")
        shutil.copy("in.0024.exr", "r.exr")
        self.ok("--views", "l,r", "%V.exr", "--hdr-compress", "--shot-stats", "views.json", "-o", "out_%V.exr")
        with open("views.json", encoding="utf-8") as file:
            self.assertEqual([frame["frame"] for frame in json.load(file)["frames"]], [0, 0])

    def shot(self, lights, *keys):
        """Means of L* of a room rendered as a shot whose frames have these shares of its light."""
        for frame, light in enumerate(lights):
            pictures.write(f"ev.{frame:04d}.exr", pictures.hdr_scene(48, 36) * light, "float")
        option = ":".join(("--shot-stats:update=1", *keys))
        self.ok("--frames", f"0-{len(lights) - 1}", "ev.#.exr", "--hdr-compress", option, "events.json",
                "-o", "events.#.exr")
        return np.array([lightness(f"events.{frame:04d}.exr").mean() for frame in range(len(lights))])

    def test_a_black_frame_changes_no_other(self):
        alone = self.shot([1])[0]
        for mode in ("mode=smooth", "mode=lock"):
            means = self.shot([1, 1, 1, 1, 0, 1, 1, 1, 1], mode)
            self.assertLess(means[4], 1)
            self.assertLess(np.abs(np.delete(means, 4) - alone).max(), 0.5, mode)
        with open("events.json", encoding="utf-8") as file:
            frames = json.load(file)["frames"]
        self.assertEqual([frame["key"] for frame in frames if frame["frame"] == 4], [0])  # not measured
        self.assertEqual(self.shot([0, 0])[0], 0)  # nothing but black is no error

    def test_a_fade_darkens(self):
        alone = self.shot([1])[0]
        for frames in (6, 16):
            lights = np.linspace(1, 0, frames)
            means = self.shot([1, 1, 1, *lights])
            self.assertLess(np.diff(means[3:]).max(), -0.3)
            self.assertLess(abs(means[3] - alone), 1)
            self.assertLess(np.abs(self.shot([*lights[::-1], 1, 1, 1]) - means[::-1]).max(), 0.1)

    def test_a_flash_changes_no_other_frame(self):
        alone = self.shot([1])[0]
        means = self.shot([1, 1, 1, 1, 8, 1, 1, 1, 1, 1])
        self.assertLess(np.abs(np.delete(means, 4) - alone).max(), 0.5)
        self.assertGreater(means[4], alone + 3)

    def test_scenes_have_their_own_exposure(self):
        alone = self.shot([1])[0]
        lights = [1] * 6 + [16] * 6
        for keys in ((), ("cuts=6",), ("mode=lock",)):
            self.assertLess(np.abs(self.shot(lights, *keys) - alone).max(), 0.5, keys)
        one = self.shot(lights, "cuts=none")
        self.assertGreater(one[6] - one[5], 3)
        self.fails("--frames", "0-1", "ev.#.exr", "--hdr-compress", "--shot-stats:cuts=soon", "e.json", "-o", "e.#.exr",
                   says=("cuts=", "soon", "expected"))

    def farmed(self, script, environment, *arguments):
        done = subprocess.run([os.path.join(FARM, script), *arguments], text=True, timeout=100, check=False,
                              capture_output=True, env={**os.environ, **environment, "PIMGTOOL": pictures.TOOL})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done

    def test_xargs_renders_a_shot(self):
        self.farmed("xargs.sh", {"JOBS": "2"}, "1-6", "shot.json", "in.#.exr", "--hdr-compress", "-o", "out.#.exr")
        self.ok("--frames", "1-6", "in.#.exr", "--hdr-compress", "--shot-stats", "one.json", "-o", "one.#.exr")
        for frame in range(1, 7):
            self.assert_same(f"out.{frame:04d}.exr", f"one.{frame:04d}.exr")


if __name__ == "__main__":
    unittest.main()
