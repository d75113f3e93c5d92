# SPDX-License-Identifier: BSD-3-Clause
"""What our shared libraries export is what their lists say, and libpimg's list is its header.

Environment: SOURCE; PIMG_C and PIMG_PLUGIN, the libraries.
"""
import os
import re
import subprocess
import unittest

SOURCE = os.environ["SOURCE"]


def listed(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as file:
        return set(re.findall(r"^\s+(\w+);", file.read(), re.M))


def exported(library):
    text = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    return {line.split()[-1].split("@")[0] for line in text.splitlines()}


class Symbols(unittest.TestCase):
    def test_libpimg_exports_its_header_and_nothing_else(self):
        with open(os.path.join(SOURCE, "capi/include/pimg/pimg.h"), encoding="utf-8") as file:
            declared = set(re.findall(r"^PIMG_API[^(]*?\b(pimg_\w+)\(", file.read(), re.M))
        self.assertTrue(declared)
        self.assertEqual(exported(os.environ["PIMG_C"]), declared)
        self.assertEqual(listed("capi/pimg.map"), declared)

    def test_the_plugin_exports_what_openimageio_asks_for(self):
        self.assertEqual(exported(os.environ["PIMG_PLUGIN"]), listed("plugin/pimg_imageio.map"))

    def test_the_name_of_libpimg_has_the_version_of_its_interface(self):
        text = subprocess.run(["readelf", "-d", os.environ["PIMG_C"]], check=True, capture_output=True, text=True).stdout
        self.assertIn("soname: [libpimg.so.0]", text)


if __name__ == "__main__":
    unittest.main()
