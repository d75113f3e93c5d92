# SPDX-License-Identifier: BSD-3-Clause
"""The direction of includes: each room of the house sees only those below it; docs/architecture.md draws the picture."""
import os
import re

from sources import CPP, Finding

# A room is a folder, or one file by its name without extension, with the rooms it may include beside itself. The
# longest name that begins a path is its room. A public header belongs to the room of the source of the same name.
ROOMS = {
    "core/abi": [],
    "core/src/mesh": ["core/abi"],
    "core/src/sweep": ["core/abi", "core/src/mesh"],
    "core/src/sampling": ["core/abi", "core/src/mesh"],
    "core/src/simplify": ["core/abi", "core/src/mesh", "core/src/sweep", "core/src/sampling"],
    "core/src/pieces": ["core/abi", "core/src/mesh", "core/src/sweep"],
    "core/src/smoothing": ["core/abi", "core/src/mesh", "core/src/sweep", "core/src/pieces"],
    "codec/include": ["core"],
    "codec/src/entropy": ["core/abi"],
    "codec/src/raster": ["codec/include", "codec/src/entropy", "core"],
    "codec/src/mesh_layer": ["codec/include", "codec/src/entropy", "core"],
    "codec/src/sequence": ["codec/include", "codec/src/entropy", "codec/src/raster", "codec/src/mesh_layer", "core"],
    "codec/src": ["codec", "core"],
    "painting/src/drawing": ["painting", "core"],
    "painting": ["core"],
    "filters/src/base": ["core"],
    "filters/src/colour": ["filters/src/base", "core"],
    "filters/src/source": ["filters/src/base", "filters/src/colour", "core"],
    "filters/src/frame": ["filters/src/base", "filters/src/colour", "filters/src/source", "core"],
    "filters/src/ops": ["filters/src/base", "filters/src/colour", "filters/src/source", "filters/src/frame", "core"],
    "filters/src/ops/painting": ["filters/src/base", "filters/src/colour", "filters/src/source", "filters/src/frame",
                                 "painting", "core"],
    "filters/src/ops/regions": ["filters/src/base", "filters/src/colour", "filters/src/source", "filters/src/frame",
                                "core"],
    "filters/src": ["filters", "core"],
    "umbrella": ["gainmap", "filters", "painting", "codec", "core"],
    "gainmap": ["filters", "core"],
    "plugin": ["filters", "codec", "core"],
    "shot": ["filters", "core"],
    "tools/session": ["shot", "gainmap", "plugin", "filters", "codec", "core"],
    "tools/command": ["tools/session", "shot", "plugin", "filters", "codec", "core"],
    "tools": ["tools/command", "tools/session", "shot", "plugin", "filters", "codec", "core"],
    "view/src/state": ["tools", "plugin", "filters", "codec", "core"],
    "view/src/render": ["view/src/state", "tools", "plugin", "filters", "codec", "core"],
    "view/src/display": ["view/src/render", "view/src/state", "tools", "plugin", "filters", "codec", "core"],
    "view/src": ["view/src/state", "view/src/render", "view/src/display", "tools", "plugin", "filters", "codec", "core"],
    "view/window/gl": ["view/src/render", "view/src/state", "filters", "core"],
    "view/window": ["view/window/gl", "view/src", "tools", "plugin", "filters", "codec", "core"],
    "python": ["gainmap", "plugin", "filters", "codec", "core"],
    "capi": ["filters", "core"],
    "gegl": ["filters", "core"],
    "ofx/abi": [],
    "ofx/host": ["ofx/abi", "filters", "core"],
    "ofx": ["ofx/host", "ofx/abi", "shot", "filters", "core"],
    "ofx/test_host": ["ofx/abi"],
    "examples": ["filters", "core", "capi"],
    "bench": ["filters", "painting", "codec", "core"],
    "tests": ["gainmap", "plugin", "shot", "tools", "view", "filters", "painting", "codec", "core", "capi"],
}

# Where a public header without a source of the same name is: in the lowest room of its library, or here.
LOWEST = {"core": "core/src/mesh", "codec": "codec/include", "filters": "filters/src/base", "painting": "painting",
          "gainmap": "gainmap", "capi": "capi"}
HEADERS = {
    "core/include/pimg/abi.h": "core/abi",
    "filters/include/pimg/pimg.hpp": "umbrella",
    "filters/include/pimg/imagebufalgo.h": "filters/src/frame",
}

# Generated or umbrella headers, which belong to no room.
GENERATED = {"pimg/version.h": "core"}

# In place of ofx/abi/ofx_abi_types.h, where somebody has them.
OFFICIAL_OFX = ["ofxColour.h", "ofxCore.h", "ofxImageEffect.h", "ofxMemory.h", "ofxMessage.h", "ofxMultiThread.h",
                "ofxParam.h", "ofxProgress.h", "ofxProperty.h", "ofxTimeLine.h"]

# Everybody may use the standard library; of other libraries, these.
FOREIGN = {
    "core": ["hwy"],
    "codec": [],
    "codec/src/entropy": ["zstd.h"],
    "painting": [],
    "filters": ["OpenImageIO", "hwy"],
    "filters/src/colour": ["OpenImageIO", "hwy", "OpenColorIO", "lcms2.h"],
    "gainmap": ["OpenImageIO", "pugixml.hpp"],
    "plugin": ["OpenImageIO"],
    "shot": ["OpenImageIO", "boost"],
    "tools": ["OpenImageIO"],
    "view/src": ["OpenImageIO"],
    "view/window": ["OpenImageIO", "OpenColorIO", "GLFW", "imgui.h", "imgui_stdlib.h", "backends"],
    "python": ["OpenImageIO", "pybind11", "Python.h"],
    "capi": ["OpenImageIO"],
    "gegl": ["OpenImageIO", "gegl.h", "gegl-plugin.h", "glib.h", "glib-object.h"],
    "ofx": ["OpenImageIO"] + OFFICIAL_OFX,
    "ofx/test_host": ["OpenImageIO"],
    "examples": ["OpenImageIO"],
    "bench": None,
    "tests": None,
    "fuzz": None,
}

PLATFORM = {"unistd.h", "fcntl.h", "sys", "signal.h", "malloc.h", "dlfcn.h"}
C = {"assert.h", "float.h", "limits.h", "math.h", "stdarg.h", "stdbool.h", "stddef.h", "stdint.h", "stdio.h",
     "stdlib.h", "string.h"}
INCLUDE = re.compile(r'\s*#\s*include\s*(?:<([^>]+)>|"([^"]+)")')
LIBRARIES = ("core", "codec", "painting", "filters", "gainmap", "capi")


def longest_prefix(path, names):
    """The longest of `names` that is `path`, a folder of it, or its name without extension; None if there is none."""
    stem = os.path.splitext(path)[0]
    found = [name for name in names if path == name or stem == name or path.startswith(name + "/")]
    return max(found, key=len, default=None)


def installed_headers(tree, library):
    """The headers a library's CMakeLists.txt names after HEADERS or, the C interface, after FILES."""
    path = f"{library}/CMakeLists.txt"
    text = tree.text(path) if path in tree.paths else ""
    headers = re.findall(r"(?<!_)(?:HEADERS|FILES)\s((?:\s*[^\sA-Z)]\S*\.h(?:pp)?\b)*)", text)
    return [f"{library}/{header}" for group in headers for header in group.split()]


class Rooms:
    def __init__(self, tree):
        self.tree = tree
        self.present = set(tree.paths)
        self.installed = {path for library in LIBRARIES for path in installed_headers(tree, library)}
        self.sources = {}
        for path in tree.ending(".cpp"):
            self.sources.setdefault((path.split("/")[0], os.path.splitext(os.path.basename(path))[0]), path)

    def of_file(self, path):
        """The room of a file; None outside the house."""
        if path in HEADERS:
            return HEADERS[path]
        parts = path.split("/")
        if parts[0] in LIBRARIES and parts[1] == "include":
            source = self.sources.get((parts[0], os.path.splitext(parts[-1])[0]))
            return longest_prefix(source, ROOMS) if source else LOWEST[parts[0]]
        return longest_prefix(path, ROOMS)

    def resolve(self, path, target):
        """The file of ours that an include of `target` in `path` means; None for what is not ours."""
        if target.startswith("pimg/"):
            for library in LIBRARIES:
                if f"{library}/include/{target}" in self.present:
                    return f"{library}/include/{target}"
            return None
        library = path.split("/")[0]
        beside = os.path.normpath(os.path.join(os.path.dirname(path), target))
        for candidate in (beside, f"{library}/src/{target}", f"{library}/{target}"):
            if candidate in self.present:
                return candidate
        # Headers of the plugin, which is a library for the tools and for Python.
        for folder in ("plugin", "shot", "tools", "view/src", "view/window", "core/src", "filters/src", "codec/src", "painting/src"):
            if f"{folder}/{target}" in self.present:
                return f"{folder}/{target}"
        return None


def may_include(room, other):
    return room == other or any(other == allowed or other.startswith(allowed + "/") for allowed in ROOMS[room])


def foreign_name(target):
    """The library a foreign header belongs to; None for the standard library's."""
    first = target.split("/")[0]
    if target in C or first in PLATFORM or ("." not in first and "/" not in target):
        return None
    return first


def check_foreign(room, target):
    allowed = FOREIGN.get(longest_prefix(room, FOREIGN), [])
    name = foreign_name(target)
    if allowed is None or name is None or name in allowed:
        return None
    return f"{room} includes <{target}>; of foreign libraries it may use {', '.join(allowed) or 'none'}"


def check_line(rooms, path, target):
    """What is wrong with an include of `target` in `path`, or None."""
    room = rooms.of_file(path)
    if target in GENERATED:
        return None if may_include(room, GENERATED[target]) or room.startswith("core") else f"{room} includes {target}"
    resolved = rooms.resolve(path, target)
    if resolved is None:
        if target.startswith("pimg/"):
            return f"no folder has <{target}>"
        return check_foreign(room, target)
    if path in rooms.installed and resolved not in rooms.installed:
        return f"an installed header includes <{target}>, which is not installed"
    other = rooms.of_file(resolved)
    if other is None or not may_include(room, other):
        allowed = ", ".join(ROOMS[room]) or "nothing else of ours"
        return f"{room} includes {resolved} of {other}; it may include {allowed}"
    return None


def check(tree):
    rooms = Rooms(tree)
    findings = []
    for path in tree.ending(*CPP, ".hpp"):
        if rooms.of_file(path) is None:
            if path.split("/")[0] in LIBRARIES:
                findings.append(Finding(path, 1, "belongs to no room: name it in tests/checks/includes.py"))
            continue
        for number, line in enumerate(tree.lines(path), 1):
            found = INCLUDE.match(line)
            problem = check_line(rooms, path, found.group(1) or found.group(2)) if found else None
            if problem:
                findings.append(Finding(path, number, problem))
    return findings
