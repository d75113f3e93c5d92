#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the documentation site: make_site.py FOLDER

Every Markdown page becomes HTML at the same place, README.md index.html; pictures and sources that pages link to come
along. A link to a page, file or heading that does not exist is an error. Nothing in it needs a network or a script.
"""
import html
import os
import re
import shutil
import sys

import markdown

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# The list at the side, in the order to read.
CONTENTS = (
    ("Use", ("README.md", "docs/cookbook.md", "docs/reference.md", "docs/view.md", "docs/troubleshooting.md",
             "docs/gallery/README.md")),
    ("Pipelines", ("docs/pipeline.md", "docs/python.md", "docs/plugin.md", "docs/hosts.md", "docs/ofx.md", "docs/gainmap.md")),
    ("How it works", ("docs/look.md", "docs/smoothing.md", "docs/adaptive.md", "docs/performance.md", "docs/format.md",
                      "docs/internals.md")),
    ("Trust", ("SECURITY.md", "docs/security.md", "docs/versions.md", "THIRD-PARTY.md", "fuzz/README.md")),
    ("Development", ("docs/architecture.md", "CONTRIBUTING.md", "CHANGELOG.md")),
)
PAGES = [page for _, pages in CONTENTS for page in pages]
LINK = re.compile(r'(?<=<a )href="([^"]*)"|(?<= )src="([^"]*)"')


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def place(path):
    """Where a file of the repository is in the site."""
    if path in PAGES:
        folder, name = os.path.split(path)
        return os.path.join(folder, "index.html" if name == "README.md" else name[:-3] + ".html")
    return path if re.search(r"\.(jpg|png|svg)$", path) else path + ".html"


class Site:
    def __init__(self, folder):
        self.folder = folder
        self.titles, self.bodies, self.anchors = {}, {}, {}
        self.files, self.errors = set(), []

    def convert(self, path):
        converter = markdown.Markdown(extensions=["tables", "fenced_code", "toc", "sane_lists"])
        body = converter.convert(read(path))
        self.titles[path] = re.search(r"<h1[^>]*>(.*?)</h1>", body)[1]
        self.bodies[path] = body.replace("<table>", '<div class="table"><table>').replace("</table>", "</table></div>")
        self.anchors[path] = set(re.findall(r'<h\d id="([^"]*)"', body))

    def link(self, page, target):
        """The href in `page` of what its Markdown calls `target`."""
        if re.match(r"[a-z]+:", target):
            return target
        name, _, anchor = html.unescape(target).partition("#")
        path = os.path.normpath(os.path.join(os.path.dirname(page), name)) if name else page
        if path not in PAGES and (path.startswith("..") or not os.path.isfile(os.path.join(ROOT, path))):
            self.errors.append(f"{page}: link to {target}: no such file")
        elif anchor and anchor not in self.anchors.get(path, ()):
            self.errors.append(f"{page}: link to {target}: no such heading")
        if path not in PAGES:
            self.files.add(path)
        href = os.path.relpath(place(path), os.path.dirname(place(page)))
        return html.escape(href + ("#" + anchor if anchor else ""))

    def linked(self, page):
        def replace(match):
            kind, target = ("href", match[1]) if match[1] is not None else ("src", match[2])
            return f'{kind}="{self.link(page, target)}"'

        return LINK.sub(replace, self.bodies[page])

    def write(self, path, title, body):
        here = os.path.dirname(place(path))
        sections = []
        for heading, pages in CONTENTS:
            items = "".join(
                f'<li><a href="{os.path.relpath(place(page), here)}"{" class=here" * (page == path)}>{self.titles[page]}</a></li>'
                for page in pages
            )
            sections.append(f"<h2>{heading}</h2><ul>{items}</ul>")
        target = os.path.join(self.folder, place(path))
        os.makedirs(os.path.dirname(target), exist_ok=True)
        with open(target, "w", encoding="utf-8") as file:
            file.write(
                f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
                '<meta name="viewport" content="width=device-width, initial-scale=1">'
                f'<link rel="stylesheet" href="{os.path.relpath("docs/site.css", here)}"></head>\n'
                f'<body><nav>{"".join(sections)}</nav>\n<main>\n{body}\n</main></body></html>\n'
            )

    def copy(self, path):
        if place(path) != path:  # a source: shown as text
            self.write(path, path, f"<h1>{path}</h1><pre><code>{html.escape(read(path))}</code></pre>")
            return
        target = os.path.join(self.folder, path)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        shutil.copyfile(os.path.join(ROOT, path), target)

    def make(self):
        for path in PAGES:
            self.convert(path)
        bodies = {path: self.linked(path) for path in PAGES}
        if self.errors:
            sys.exit("\n".join(self.errors))
        for path, body in bodies.items():
            self.write(path, self.titles[path], body)
        for path in self.files:
            self.copy(path)
        shutil.copyfile(os.path.join(ROOT, "docs/site.css"), os.path.join(self.folder, "docs/site.css"))


if __name__ == "__main__":
    Site(sys.argv[1]).make()
