# SPDX-License-Identifier: BSD-3-Clause
"""The source files of a tree, and what a check says about one of them."""
import os
from dataclasses import dataclass

CPP = (".cpp", ".h", ".c")
SCRIPTS = (".py", ".sh")
SKIPPED = {"build", "__pycache__"}


@dataclass(frozen=True, order=True)
class Finding:
    path: str
    line: int
    text: str

    def __str__(self):
        return f"{self.path}:{self.line}: {self.text}"


class Tree:
    """The files below `root`, by their path relative to it; build folders and hidden ones do not count."""

    def __init__(self, root):
        self.root = root
        self.paths = sorted(self._walk())

    def _walk(self):
        for folder, folders, files in os.walk(self.root):
            folders[:] = [name for name in folders if name not in SKIPPED and (name == ".ci" or name[0] != ".")]
            for name in files:
                yield os.path.relpath(os.path.join(folder, name), self.root)

    def ending(self, *ends):
        return [path for path in self.paths if path.endswith(ends)]

    def lines(self, path):
        with open(os.path.join(self.root, path), encoding="utf-8") as file:
            return file.read().splitlines()

    def text(self, path):
        return "\n".join(self.lines(path))
