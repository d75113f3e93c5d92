# SPDX-License-Identifier: BSD-3-Clause
"""Tests mirror the sources: core/src/mesh/mesh.cpp has tests/core/mesh/mesh_test.cpp. A source that is tested through
another is named in tested_through.txt with that test."""
import os

from sources import Finding

LIBRARIES = ("core", "codec", "painting", "filters")
LIST = "tests/checks/tested_through.txt"


def mirrored(source):
    library, _, rest = source.partition("/src/")
    return f"tests/{library}/{os.path.splitext(rest)[0]}_test.cpp"


def read_list(tree):
    """{source: (line, test)}; a line of the list is `SOURCE TEST`."""
    entries = {}
    for number, line in enumerate(tree.lines(LIST) if LIST in tree.paths else [], 1):
        words = line.split()
        if words and not words[0].startswith("#"):
            entries[words[0]] = (number, words[1] if len(words) > 1 else "")
    return entries


def check(tree):
    present, listed, findings = set(tree.paths), read_list(tree), []
    for source in tree.ending(".cpp"):
        library = source.split("/")[0]
        if library in LIBRARIES and mirrored(source) not in present and source not in listed:
            findings.append(Finding(source, 1, f"has no {mirrored(source)} and is not in {LIST}"))
    for source, (line, test) in listed.items():
        if source not in present:
            findings.append(Finding(LIST, line, f"{source} does not exist"))
        elif mirrored(source) in present:
            findings.append(Finding(LIST, line, f"{source} has a test of its own now"))
        if test not in present:
            findings.append(Finding(LIST, line, f"the test of {source} does not exist: '{test}'"))
    return findings
