#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the option tables of a page: make_options.py PIMGTOOL PAGE.md [--check]

A table stands below the line "<!-- options: NAME -->" or "<!-- styles: NAME -->" and is what `pimgtool --help NAME` says.
--check changes nothing and fails, naming the tables, if they are not, or if a filter has none.
"""
import re
import subprocess
import sys

TABLE = re.compile(r"(<!-- (options|styles): ([\w-]+) -->\n\n)((?:\|.*\n)*\n?)")
STYLES = "values where none is given:"


def cell(text):
    return text.replace("|", ", ")


def help_text(pimgtool, *name):
    return subprocess.run([pimgtool, "--help", *name], check=True, capture_output=True, text=True).stdout


def filters(pimgtool):
    group = re.search(r"^Filters on .*?:\n(.*?)\n\n", help_text(pimgtool), re.MULTILINE | re.DOTALL)[1]
    return re.findall(r"^  --([\w-]+)", group, re.MULTILINE)


def rows(pimgtool, name):
    """The lines of the options, and those of the styles."""
    lines = [line.strip() for line in help_text(pimgtool, name).splitlines()[2:]]
    at = lines.index(STYLES) if STYLES in lines else len(lines)
    return lines[:at], lines[at + 1:]


def styles(pimgtool, name):
    head, *lines = [re.split(r" {2,}", row) for row in rows(pimgtool, name)[1]]
    lines = [[f"`{key}`", *values] for key, *values in lines]
    return "".join(f"| {' | '.join(line)} |\n" for line in [head, ["---"] * len(head), *lines]) + "\n"


def table(pimgtool, name):
    lines = ["| key | default | values | |", "|---|---|---|---|"]
    for row in rows(pimgtool, name)[0]:
        setting, values, meaning = re.split(r" {2,}", row, maxsplit=2)
        key, default = setting.split("=")
        lines.append(f"| `{key}` | {default} | {cell(values)} | {cell(meaning)} |")
    return "\n".join(lines) + "\n\n"


def main(pimgtool, page, check=""):
    with open(page, encoding="utf-8") as file:
        text = file.read()
    stale = []

    def renew(match):
        new = (styles if match[2] == "styles" else table)(pimgtool, match[3])
        if new != match[4]:
            stale.append(match[3])
        return match[1] + new

    renewed = TABLE.sub(renew, text)
    missing = set(filters(pimgtool)) - {match[3] for match in TABLE.finditer(text) if match[2] == "options"}
    if missing:
        sys.exit(f"{page}: no table of {', '.join(sorted(missing))}")
    if check == "--check":
        if stale:
            sys.exit(f"{page}: tables of {', '.join(stale)} differ from pimgtool --help: run docs/make_options.py")
    elif stale:
        with open(page, "w", encoding="utf-8") as file:
            file.write(renewed)


if __name__ == "__main__":
    main(*sys.argv[1:])
