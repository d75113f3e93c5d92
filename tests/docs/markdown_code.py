# SPDX-License-Identifier: BSD-3-Clause
"""The code in a Markdown file: markdown_code.py FILE LANGUAGE prints the fenced blocks of one language."""

import re
import sys
import textwrap
from collections import namedtuple

Block = namedtuple("Block", "language line code")  # language "": indented; line: number of the first, from 1

FENCED = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"(?<=\n\n)((?: {4}.*\n|\n(?= {4}))+)")


def all_blocks(filename):
    """In the order of the page."""
    with open(filename, encoding="utf-8") as file:
        text = file.read()
    found = [(match.start(2), match[1], match[2]) for match in FENCED.finditer(text)]
    prose = FENCED.sub(lambda match: re.sub(r"\S", "`", match[0]), text)
    found += [(match.start(), "", textwrap.dedent(match[1])) for match in INDENTED.finditer(prose) if "`" * 3 not in match[1]]
    return [Block(language, text.count("\n", 0, start) + 1, code) for start, language, code in sorted(found)]


def blocks(filename, language):
    return [block.code for block in all_blocks(filename) if block.language == language]


if __name__ == "__main__":
    found = blocks(*sys.argv[1:])
    if not found:
        sys.exit(f"no {sys.argv[2]} in {sys.argv[1]}")
    print("\n".join(found))
