# SPDX-License-Identifier: BSD-3-Clause
"""The documentation site: complete, at home without a network, and refused when a link leads nowhere. $SOURCE is the tree."""

import glob
import html.parser
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = os.environ["SOURCE"]


class References(html.parser.HTMLParser):
    """What a page needs to be shown, and where it leads."""

    def __init__(self, path):
        super().__init__()
        self.needs, self.leads, self.ids = [], [], set()
        with open(path, encoding="utf-8") as file:
            self.feed(file.read())

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name == "id":
                self.ids.add(value)
            elif name in ("src", "href"):
                (self.leads if tag == "a" else self.needs).append(value)


class Site(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def make(self, source):
        return subprocess.run([sys.executable, os.path.join(source, "docs/make_site.py"), os.path.join(self.folder, "site")],
                              capture_output=True, text=True)

    def test_every_reference_is_in_the_site(self):
        made = self.make(SOURCE)
        self.assertEqual(made.returncode, 0, made.stderr)
        paths = glob.glob(os.path.join(self.folder, "site/**/*.html"), recursive=True)
        pages = {path: References(path) for path in paths}
        self.assertGreater(len(pages), 15)
        for path, page in pages.items():
            for target in page.needs + [lead for lead in page.leads if not lead.startswith("http")]:
                name, _, anchor = target.partition("#")
                file = os.path.normpath(os.path.join(os.path.dirname(path), name)) if name else path
                self.assertTrue(os.path.isfile(file), f"{path}: {target}")
                if anchor:
                    self.assertIn(anchor, pages[file].ids, f"{path}: {target}")
        with open(os.path.join(self.folder, "site/docs/site.css"), encoding="utf-8") as file:
            self.assertNotIn("url(", file.read())

    def test_every_page_is_in_the_contents(self):
        self.assertEqual(self.make(SOURCE).returncode, 0)
        links = {os.path.normpath(lead) for lead in References(os.path.join(self.folder, "site/index.html")).leads}
        for page in glob.glob(os.path.join(SOURCE, "docs/*.md")):
            self.assertIn("docs/" + os.path.basename(page)[:-3] + ".html", links)

    def test_links_that_lead_nowhere_are_named(self):
        source = os.path.join(self.folder, "source")
        shutil.copytree(SOURCE, source, ignore=shutil.ignore_patterns(".git", "build"))
        with open(os.path.join(source, "docs/python.md"), "a", encoding="utf-8") as file:
            file.write("\n[a](nothing.md) [b](plugin.md#no-such-heading)\n")
        made = self.make(source)
        self.assertNotEqual(made.returncode, 0)
        self.assertIn("docs/python.md: link to nothing.md: no such file", made.stderr)
        self.assertIn("docs/python.md: link to plugin.md#no-such-heading: no such heading", made.stderr)


if __name__ == "__main__":
    unittest.main()
