# SPDX-License-Identifier: BSD-3-Clause
"""Every picture there is, through both profiles and back, bit by bit: the synthetic ones of the build ($PIMG_TESTIMAGES) and,
where they are, photographs and files of OpenEXR's own tests in ../shared/testimages beside the project. Of these the full
profile is tried on a corner, since building takes its time; with $PIMG_WHOLE on all of them."""

import os
import pathlib
import unittest

import numpy as np
import OpenImageIO as oiio

import plugin_files
from plugin_files import opened

PHOTOGRAPHS = pathlib.Path(__file__).resolve().parents[2].parent / "shared" / "testimages"


CORNER = 1 << 20 if os.environ.get("PIMG_WHOLE") else 300


def names():
    folders = [pathlib.Path(os.environ["PIMG_TESTIMAGES"]), PHOTOGRAPHS]
    return sorted(str(path) for folder in folders for path in folder.rglob("*") if path.is_file())


def native(file):
    """The samples as bytes, one array per channel, each of its own type."""
    spec = file.spec()
    if not spec.channelformats:
        pixels = file.read_image(0, 0, 0, spec.nchannels, spec.format)
        return None if pixels is None else [pixels[..., c : c + 1].copy().view(np.uint8) for c in range(spec.nchannels)]
    channels = [file.read_image(0, 0, c, c + 1, spec.channelformat(c)) for c in range(spec.nchannels)]
    return None if any(channel is None for channel in channels) else [channel.view(np.uint8) for channel in channels]


class Pictures(plugin_files.PluginTest):
    def test_both_profiles_give_back_every_bit(self):
        seen = 0
        for name in names():
            source = oiio.ImageInput.open(name)
            if source is None:
                oiio.geterror()
                continue  # no picture
            spec = source.spec()
            if spec.deep:
                continue
            wanted = native(source)
            if wanted is None:
                continue
            seen += 1
            corner = min(CORNER, spec.width), min(CORNER, spec.height)
            crop = [] if corner == (spec.width, spec.height) else [
                "--crop", f"{corner[0]}x{corner[1]}{spec.x:+d}{spec.y:+d}"]
            self.ok("oiiotool", name, "--attrib", "pimg:profile", "compact", "-o", "compact.pimg",
                    *crop, "--attrib", "pimg:profile", "full", "-o", "full.pimg")
            for profile, (width, height) in ("compact", (spec.width, spec.height)), ("full", corner):
                found = opened(f"{profile}.pimg")
                self.assertEqual(found.spec().get_string_attribute("compression"), profile, name)
                roi = oiio.ROI(spec.x, spec.x + width, spec.y, spec.y + height, 0, 1, 0, spec.nchannels)
                self.assertEqual((found.spec().roi, found.spec().roi_full), (roi, spec.roi_full), name)
                self.assertEqual(found.spec().channelnames, spec.channelnames, name)
                for c, channel in enumerate(native(found)):
                    self.assertEqual(found.spec().channelformat(c), spec.channelformat(c), name)
                    self.assertTrue(np.array_equal(channel, wanted[c][:height, :width]), f"{name}, channel {c}, {profile}")
        self.assertGreater(seen, 10)


if __name__ == "__main__":
    unittest.main()
