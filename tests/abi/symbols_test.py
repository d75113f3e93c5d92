# SPDX-License-Identifier: BSD-3-Clause
"""What our shared libraries and plugins export is what their lists say, and the generation of the ABI has one name.

usage: symbols_test.py [--update]    --update writes the lists of the C++ libraries anew: look at the difference

Environment: SOURCE; VERSION, of the project; PIMG_C and PIMG_PLUGIN, the libraries; PIMG_SHARED, the folder of the shared
libraries of C++; PIMG_MODULES, other modules, separated by ':', which export what their hosts look up.
"""
import os
import re
import subprocess
import sys
import unittest

SOURCE, SHARED, VERSION = os.environ["SOURCE"], os.environ["PIMG_SHARED"], os.environ["VERSION"]
LIBRARIES = ("core", "codec", "painting", "filters", "gainmap")
LISTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "symbols")
# By the name of the file, up to its first dot: what Python, GEGL and OpenFX ask a module for.
ENTRY_POINTS = {"_pimg": {"PyInit__pimg"}, "pimg": {"gegl_module_query", "gegl_module_register"},
                "pimg_ofx": {"OfxGetNumberOfPlugins", "OfxGetPlugin"}}
# What the standard library calls its types, as users write them.
SPELLINGS = ((r"std::__cxx11::basic_string<char, std::char_traits<char>, std::allocator<char> >", "std::string"),
             (r"std::basic_string_view<char, std::char_traits<char> >", "std::string_view"),
             (r"OpenImageIO(_|::)v\d+_\d+::", "OIIO::"),
             (r"fmt::v\d+::", "fmt::"))
ALLOCATOR = re.compile(r", std::allocator<(?:[^<>]|<(?:[^<>]|<(?:[^<>]|<[^<>]*>)*>)*>)*> ?>")


def listed(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as file:
        return set(re.findall(r"^\s+(\w+);", file.read(), re.M))


def exported(library, *options):
    """{symbol: its kind, as nm has it}"""
    text = subprocess.run(["nm", "-D", "--defined-only", *options, library], check=True, capture_output=True,
                          text=True).stdout
    words = (line.split(" ", 2) for line in text.splitlines())
    return {name.split("@")[0]: kind for _, kind, name in words}


def spelt(name):
    for pattern, spelling in SPELLINGS:
        name = re.sub(pattern, spelling, name)
    while ALLOCATOR.search(name):
        name = ALLOCATOR.sub(">", name)
    return name


def shared(library):
    return os.path.join(SHARED, f"libpimg_{library}.so")


def interface(library):
    """The functions and data of a library, without what any translation unit may have made: inline functions."""
    return sorted({spelt(name) for name, kind in exported(shared(library), "-C").items() if kind in "TDBR"})


def list_of(library):
    with open(os.path.join(LISTS, f"{library}.txt"), encoding="utf-8") as file:
        return [line for line in file.read().splitlines() if not line.startswith("#")]


def update():
    for library in LIBRARIES:
        with open(os.path.join(LISTS, f"{library}.txt"), "w", encoding="utf-8") as file:
            file.write(f"# What libpimg_{library}.so exports: symbols_test.py --update\n")
            file.writelines(f"{name}\n" for name in interface(library))


class Symbols(unittest.TestCase):
    def test_libraries_of_cpp_export_what_their_lists_say(self):
        for library in LIBRARIES:
            with self.subTest(library=library):
                self.assertTrue(list_of(library))
                self.assertEqual(interface(library), list_of(library))

    def test_libraries_of_cpp_export_nothing_of_others(self):
        generation = "v" + "_".join(VERSION.split(".")[:2])
        for library in LIBRARIES:
            for name in exported(shared(library)):  # functions, tables of virtual functions, types and their names
                with self.subTest(library=library, symbol=name):
                    self.assertRegex(name, f"^_Z(TV|TI|TS)?NK?4pimg{len(generation)}{generation}")

    def test_names_of_libraries_have_the_generation(self):
        generation = ".".join(VERSION.split(".")[:2])
        for library in LIBRARIES:
            self.assertIn(f"soname: [libpimg_{library}.so.{generation}]", self.dynamic(shared(library)))
        self.assertIn("soname: [libpimg.so.0]", self.dynamic(os.environ["PIMG_C"]))

    def test_libpimg_exports_its_header_and_nothing_else(self):
        with open(os.path.join(SOURCE, "capi/include/pimg/pimg.h"), encoding="utf-8") as file:
            declared = set(re.findall(r"^PIMG_API[^(]*?\b(pimg_\w+)\(", file.read(), re.M))
        self.assertTrue(declared)
        self.assertEqual(set(exported(os.environ["PIMG_C"])), declared)
        self.assertEqual(listed("capi/pimg.map"), declared)

    def test_plugins_export_what_their_hosts_ask_for(self):
        self.assertEqual(set(exported(os.environ["PIMG_PLUGIN"])), listed("plugin/pimg_imageio.map"))
        for module in filter(None, os.environ["PIMG_MODULES"].split(":")):
            name = os.path.basename(module).split(".")[0]
            key = "pimg_ofx" if module.endswith(".ofx") else name
            with self.subTest(module=module):
                self.assertEqual(set(exported(module)), ENTRY_POINTS[key])

    def dynamic(self, library):
        return subprocess.run(["readelf", "-d", library], check=True, capture_output=True, text=True).stdout


if __name__ == "__main__":
    if sys.argv[1:] == ["--update"]:
        update()
    else:
        unittest.main()
