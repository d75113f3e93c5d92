# SPDX-License-Identifier: BSD-3-Clause
"""The operations in GIMP 2.10 itself: load, apply, undo, apply again, save; see gimp_plugin.c. $GIMP_PLUGIN is that plug-in,
$GIMP the program; where they are not there, the test is skipped."""

import os
import shutil
import subprocess
import sys
import unittest

import numpy as np

import pictures

GIMP, PLUGIN = os.environ.get("GIMP", ""), os.environ.get("GIMP_PLUGIN", "")
OPERATIONS = ("hdr-compress", "feature-lowpass", "detail-enhance", "level", "wireframe", "paint", "mosaic", "ink")
GEGL_PATH = os.environ["PIMG_GEGL"] + ":" + os.environ["GEGL_MODULES"]


class Gimp(pictures.ToolTest):
    def run_gimp(self, *command, window):
        """The lines of the plug-in's report."""
        os.makedirs("profile/plug-ins/pimg-gimp-test")
        shutil.copy(PLUGIN, "profile/plug-ins/pimg-gimp-test/pimg-gimp-test")
        pictures.write("in.png", pictures.scene(200, 150), "uint8")
        script = f'(pimg-gimp-test RUN-NONINTERACTIVE "{os.getcwd()}" {int(window)})'
        environment = {**os.environ, "GEGL_PATH": GEGL_PATH, "HOME": os.getcwd(), "XDG_CONFIG_HOME": os.getcwd(),
                       "XDG_CACHE_HOME": os.getcwd(), "GIMP2_DIRECTORY": os.path.join(os.getcwd(), "profile")}
        done = subprocess.run([*command, GIMP, *([] if window else ["-i"]), "-n", "-s", "-d", "-f", "-b", script, "-b",
                               "(gimp-quit TRUE)"], capture_output=True, text=True, errors="replace", timeout=500,
                              env=environment)
        self.assertTrue(os.path.exists("report.txt"), done.stderr[-2000:])
        with open("report.txt", encoding="utf-8") as file:
            lines = file.read().splitlines()
        self.assertEqual(lines[-1], "all done: yes", done.stderr[-2000:])
        self.assertEqual([line for line in lines if not line.endswith(": yes")], [])
        return lines

    def test_without_a_window(self):
        lines = self.run_gimp(window=False)
        self.assertEqual(len(lines), 3 * len(OPERATIONS) + 1)
        # What GIMP saved is what gegl makes of the file, but for its 8 bits: babl converts them in a way that it chooses by
        # speed, and the last bit of a float may decide which of two equal edges collapses.
        for operation, arguments in (("level", "fraction=0.05"), ("feature-lowpass", "strength=0.1"), ("mosaic", "grout=1.5")):
            subprocess.run([os.environ["GEGL"], "in.png", "-o", "gegl.png", "--", "pimg:" + operation, arguments], check=True,
                           env={**os.environ, "GEGL_PATH": GEGL_PATH}, capture_output=True, timeout=60)
            difference = np.abs(pictures.codes(operation + ".png")[..., :3] - pictures.codes("gegl.png")[..., :3])
            self.assertLess(difference.mean(), 1, operation)

    @unittest.skipUnless(shutil.which("xvfb-run") and shutil.which("xdotool"), "xvfb-run and xdotool are not installed")
    def test_with_a_window(self):
        lines = self.run_gimp("xvfb-run", "-a", window=True)
        self.assertEqual(len(lines), 5 * len(OPERATIONS) + 1)
        self.assertEqual(sum("is undone: yes" in line for line in lines), len(OPERATIONS))


if __name__ == "__main__":
    if not GIMP or not PLUGIN:
        print("GIMP 2.10 and its development files (Debian: gimp, libgimp2.0-dev) are not installed")
        sys.exit(77)
    unittest.main()
