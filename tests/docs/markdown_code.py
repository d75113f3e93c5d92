# SPDX-License-Identifier: BSD-3-Clause
"""The fenced blocks of code in a Markdown file: markdown_code.py FILE LANGUAGE prints those of one language."""

import re
import sys


def blocks(filename, language):
    with open(filename, encoding="utf-8") as file:
        return re.findall(rf"^```{language}\n(.*?)^```", file.read(), re.MULTILINE | re.DOTALL)


if __name__ == "__main__":
    found = blocks(*sys.argv[1:])
    if not found:
        sys.exit(f"no {sys.argv[2]} in {sys.argv[1]}")
    print("\n".join(found))
