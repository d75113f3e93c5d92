# SPDX-License-Identifier: BSD-3-Clause
"""Runs clang-tidy with the committed .clang-tidy over sources, and remembers which had nothing to report.

A source is not looked at again before it, a header of ours that it includes, its compiler command, .clang-tidy or
clang-tidy itself changes. What is remembered is in $XDG_CACHE_HOME/pimg-tidy (~/.cache/pimg-tidy).
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import subprocess
import sys
import time

from includes import INCLUDE, Rooms
from sources import Tree

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
# Takes five times as long as all other checks together (51 s and 9 s for mesh.cpp on a busy machine).
ANALYZER = "clang-analyzer-*,-clang-analyzer-deadcode.DeadStores,-clang-analyzer-optin.performance.Padding"


class Closure:
    """What a file consists of: itself and all headers of ours that it includes, directly or not."""

    def __init__(self, tree):
        self.tree, self.rooms, self.known = tree, Rooms(tree), {}

    def direct(self, path):
        if path not in self.known:
            matches = [INCLUDE.match(line) for line in self.tree.lines(path)]
            targets = [m.group(1) or m.group(2) for m in matches if m]
            self.known[path] = [p for p in (self.rooms.resolve(path, t) for t in targets) if p]
        return self.known[path]

    def of(self, path):
        found, open_paths = {path}, [path]
        while open_paths:
            new = set(self.direct(open_paths.pop())) - found
            found |= new
            open_paths += new
        return sorted(found)


def key_of(tree, closure, path, command):
    digest = hashlib.sha256(command.replace(ROOT, "").encode())
    more_config = os.path.join(tree.root, path.split("/")[0], ".clang-tidy")
    if os.path.exists(more_config):
        with open(more_config, "rb") as file:
            digest.update(file.read())
    for part in closure.of(path):
        digest.update(part.encode() + tree.text(part).encode())
    return digest.hexdigest()


def changed_since(base):
    """Paths that differ from the commit, in the work tree or not yet known to git."""
    def git(*words):
        result = subprocess.run(["git", *words], cwd=ROOT, check=True, text=True, stdout=subprocess.PIPE)
        return result.stdout.split("\n")
    return set(git("diff", "--name-only", base)) | set(git("ls-files", "--others", "--exclude-standard"))


def select(commands, closure, changed):
    """The sources to look at: those that changed; for a changed header the source of its name, else one user of it."""
    chosen = [path for path in commands if path in changed]
    for header in sorted(path for path in changed if path.endswith(".h")):
        stem = os.path.splitext(os.path.basename(header))[0]
        users = [path for path in commands if header in closure.of(path)]
        named = [path for path in users if os.path.splitext(os.path.basename(path))[0] == stem]
        chosen += (named or users)[:1]
    return list(dict.fromkeys(chosen))


class Checker:
    def __init__(self, build, deep):
        cache = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
        self.folder = os.path.join(cache, "pimg-tidy")
        os.makedirs(self.folder, exist_ok=True)
        self.command = ["clang-tidy", "-p", build, "--quiet"] + ([f"--checks={ANALYZER}"] if deep else [])
        version = subprocess.run(["clang-tidy", "--version"], check=True, stdout=subprocess.PIPE).stdout
        with open(os.path.join(ROOT, ".clang-tidy"), "rb") as file:
            self.config = hashlib.sha256(version + file.read() + str(deep).encode()).hexdigest()[:16]

    def mark(self, key):
        return os.path.join(self.folder, f"{self.config}-{key}")

    def run(self, path, key):
        """What clang-tidy has to say about a source; empty when it is content."""
        result = subprocess.run(self.command + [path], cwd=ROOT, text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)
        if "warning:" in result.stdout or "error:" in result.stdout or result.returncode:
            return result.stdout or result.stderr
        with open(self.mark(key), "w", encoding="utf-8"):
            return ""


def read_commands(build):
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        entries = json.load(file)
    commands = {os.path.relpath(entry["file"], ROOT): entry["command"] for entry in entries}
    return {path: command for path, command in sorted(commands.items())
            if path.endswith(".cpp") and not path.startswith(("..", "build"))}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="a configured build folder without precompiled headers")
    parser.add_argument("--base", default="HEAD", help="the commit since which sources changed (default: HEAD)")
    parser.add_argument("--all", action="store_true", help="all sources")
    parser.add_argument("--deep", action="store_true", help="clang's static analyser instead, five times as slow")
    parser.add_argument("--minutes", type=float, default=1e9, help="begin with no further source after this time")
    parser.add_argument("--only", default="", help="sources whose path begins so")
    return parser.parse_args()


def main():
    options = arguments()
    tree = Tree(ROOT)
    closure, commands = Closure(tree), read_commands(options.build)
    chosen = list(commands) if options.all else select(commands, closure, changed_since(options.base))
    chosen = [path for path in chosen if path.startswith(options.only)]
    checker = Checker(options.build, options.deep)
    keys = {path: key_of(tree, closure, path, commands[path]) for path in chosen}
    wanted = [path for path in chosen if not os.path.exists(checker.mark(keys[path]))]
    until = time.monotonic() + 60 * options.minutes
    bad, left = [], []

    def one(path):
        if time.monotonic() > until:
            left.append(path)
            return
        said = checker.run(path, keys[path])
        if said:
            bad.append(path)
            print(said.replace(ROOT + "/", ""), flush=True)

    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        list(pool.map(one, wanted))
    print(f"clang-tidy: {len(chosen)} sources, {len(chosen) - len(wanted)} known to be clean, {len(bad)} with findings")
    if left:
        print(f"clang-tidy: no time for {len(left)}: {' '.join(left)}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
