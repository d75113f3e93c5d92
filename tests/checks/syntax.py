# SPDX-License-Identifier: BSD-3-Clause
"""Checks every source with another compiler, language level or OpenImageIO, without making anything; warnings are errors.

usage: syntax.py BUILD [--compiler CXX] [--std c++20] [--headers FOLDER]... [--only REGEX]
    BUILD      a configured build, whose compile_commands.json has the sources
    --headers  is searched first, such as the folder of another OpenImageIO's headers
    --only     sources whose path in the tree the expression matches; tests are left out unless it does

Not part of the tests: it takes some minutes. Prints what fails and, at the end, how many sources there were.
"""
import argparse
import concurrent.futures
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

# What most sources include, parsed once.
PARSED_ONCE = ("functional", "string", "vector", "OpenImageIO/filesystem.h", "OpenImageIO/imagebuf.h",
               "OpenImageIO/imagebufalgo.h", "OpenImageIO/strutil.h")
ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
SKIPPED = re.compile(r"^(tests|fuzz|bench|examples|build)/|/build/")


def arguments_of(command):
    """The options of a compilation that mean something to every compiler: folders, definitions, warnings."""
    kept, words = [], iter(shlex.split(command)[1:])
    for word in words:
        if word in ("-isystem", "-I"):
            kept += [word, next(words)]
        elif word in ("-o", "-c", "-include", "-MF", "-MT", "-Xclang"):
            next(words)
        elif re.match(r"-(I|D|W(?!no-maybe|invalid-pch))|-pthread|-fvisibility", word):
            kept.append(word)
    return kept


class Checker:
    def __init__(self, options, scratch):
        self.base = [options.compiler, f"-std={options.std}", "-fsyntax-only", "-Werror", "-Wno-maybe-uninitialized"]
        self.is_clang = "clang" in options.compiler
        if self.is_clang:
            self.base.append("-Wno-unknown-warning-option")
        self.headers = [word for folder in options.headers for word in ("-isystem", os.path.abspath(folder))]
        self.header = os.path.join(scratch, "once.h")
        self.once = {}  # what was parsed once, by the options it was parsed with

    def parse_once(self, arguments):
        key = tuple(word for word in arguments if not re.match(r"-D(pimg|PIMG)", word))
        if key not in self.once:
            header = self.header.replace("once", f"once{len(self.once)}")
            with open(header, "w", encoding="utf-8") as file:
                file.writelines(f"#include <{name}>\n" for name in PARSED_ONCE)
            made = header + (".pch" if self.is_clang else ".gch")
            command = [word for word in self.base if word != "-fsyntax-only"] + self.headers + list(key)
            subprocess.run(command + ["-x", "c++-header", header, "-o", made], check=True)
            self.once[key] = ["-include-pch", made] if self.is_clang else ["-include", header]
        return list(key) + self.once[key]

    def command(self, entry):
        arguments = arguments_of(entry["command"])
        once = any("OpenImageIO" in word or "filters/include" in word for word in arguments)
        with open(entry["file"], encoding="utf-8") as file:
            if "HWY_TARGET_INCLUDE" in file.read():
                once = False
        return self.base + self.headers + (self.parse_once(arguments) if once else arguments) + [entry["file"]]


def sources(options):
    with open(os.path.join(options.build, "compile_commands.json"), encoding="utf-8") as file:
        entries = {os.path.relpath(entry["file"], ROOT): entry for entry in json.load(file)}
    for path in sorted(entries):
        if re.search(options.only, path) if options.only else not SKIPPED.search(path):
            if path.endswith(".cpp"):
                yield path, entries[path]


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1])
    parser.add_argument("build")
    parser.add_argument("--compiler", default="g++")
    parser.add_argument("--std", default="c++17")
    parser.add_argument("--headers", action="append", default=[])
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    failed = 0
    with tempfile.TemporaryDirectory() as scratch:
        checker = Checker(options, scratch)
        jobs = [(path, checker.command(entry), entry["directory"]) for path, entry in sources(options)]

        def run(job):
            path, command, folder = job
            return path, subprocess.run(command, cwd=folder, capture_output=True, text=True)

        with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS", "2"))) as pool:
            for path, result in pool.map(run, jobs):
                if result.returncode != 0:
                    failed += 1
                    print(f"{path}:\n{result.stderr[:3000]}", flush=True)
    print(f"{len(jobs)} sources, {failed} failed")
    return 1 if failed or not jobs else 0


if __name__ == "__main__":
    sys.exit(main())
