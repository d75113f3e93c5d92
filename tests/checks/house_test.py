# SPDX-License-Identifier: BSD-3-Clause
"""Each check of the house finds what it is for, in small trees made for it, and nothing in what is right."""
import os
import shutil
import tempfile
import unittest

import counts
import includes
import mirror
import tidy
from sources import Tree

LICENCE = "// SPDX-License-Identifier: BSD-3-Clause\n"


class InTree(unittest.TestCase):
    def setUp(self):
        self.root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.root)

    def tree(self, **files):
        """A tree of files; in their names, __ stands for a slash and ends with the extension after the last _."""
        for name, text in files.items():
            path = os.path.join(self.root, ".".join(name.replace("__", "/").rsplit("_", 1)))
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8") as file:
                file.write((LICENCE.replace("//", "#") if path.endswith(".py") else LICENCE) + text + "\n")
        return Tree(self.root)

    def assert_finds(self, findings, words):
        self.assertEqual(len(findings), 1, findings)
        self.assertIn(words, findings[0].text)


class Includes(InTree):
    def test_down_is_allowed(self):
        tree = self.tree(core__src__sweep__bands_cpp="#include <pimg/bands.h>\n#include <pimg/mesh.h>\n#include <vector>",
                         core__src__mesh__mesh_cpp="#include <pimg/mesh.h>\n#include <hwy/highway.h>",
                         core__include__pimg__bands_h="#include <pimg/mesh.h>", core__include__pimg__mesh_h="",
                         codec__src__encode_cpp="#include <pimg/bands.h>\n#include \"entropy/bytes.h\"",
                         codec__src__entropy__bytes_h="#include <zstd.h>")
        self.assertEqual(includes.check(tree), [])

    def test_back_is_not(self):
        tree = self.tree(core__src__mesh__mesh_cpp="#include <pimg/bands.h>", core__include__pimg__bands_h="",
                         core__src__sweep__bands_cpp="")
        self.assert_finds(includes.check(tree), "core/src/mesh includes core/include/pimg/bands.h of core/src/sweep")

    def test_core_sees_no_codec_and_painting_no_filters(self):
        tree = self.tree(core__src__mesh__mesh_cpp="#include <pimg/codec.h>", codec__include__pimg__codec_h="")
        self.assert_finds(includes.check(tree), "core/src/mesh includes codec/include")
        tree = self.tree(core__src__mesh__mesh_cpp="", painting__src__ink_cpp="#include <pimg/options.h>",
                         filters__include__pimg__options_h="", filters__src__base__options_cpp="")
        self.assert_finds(includes.check(tree), "painting includes filters/include")

    def test_private_headers_by_quotes(self):
        tree = self.tree(filters__src__colour__lab_h='#include "source/guide.h"', filters__src__source__guide_h="")
        self.assert_finds(includes.check(tree), "filters/src/colour includes filters/src/source/guide.h")

    def test_foreign_libraries_in_their_rooms(self):
        for room, header in (("core__src__mesh", "zstd.h"), ("core__src__mesh", "OpenImageIO/imageio.h"),
                             ("codec__src__raster", "zstd.h"), ("codec__src__entropy", "OpenImageIO/imageio.h"),
                             ("filters__src__ops", "OpenColorIO/OpenColorIO.h"), ("painting__src", "hwy/highway.h"),
                             ("tools", "OpenColorIO/OpenColorIO.h"), ("plugin", "zstd.h")):
            findings = includes.check(self.tree(**{room + "__x_cpp": f"#include <{header}>"}))
            self.assert_finds(findings, f"includes <{header}>")
            os.remove(os.path.join(self.root, room.replace("__", "/"), "x.cpp"))
        allowed = self.tree(filters__src__colour__x_cpp="#include <OpenColorIO/OpenColorIO.h>",
                            capi__include__pimg__x_h="#include <stddef.h>")
        self.assertEqual(includes.check(allowed), [])

    def test_installed_headers_include_installed_ones(self):
        cmake = "pimg_add_library(core\n HEADERS\n  include/pimg/mesh.h\n DETAIL_HEADERS\n  include/pimg/detail/r.h)"
        tree = self.tree(core__include__pimg__mesh_h="#include <pimg/detail/r.h>", core__src__mesh__mesh_cpp="",
                         core__include__pimg__detail__r_h="", core__CMakeLists_txt=cmake)
        self.assert_finds(includes.check(tree), "not installed")
        tree = self.tree(core__CMakeLists_txt=cmake.replace("DETAIL_HEADERS", ""))
        self.assertEqual(includes.check(tree), [])

    def test_a_header_without_a_source_is_in_the_lowest_room(self):
        tree = self.tree(core__include__pimg__pair_h="#include <pimg/bands.h>", core__include__pimg__bands_h="",
                         core__src__sweep__bands_cpp="")
        self.assert_finds(includes.check(tree), "core/src/mesh includes core/include/pimg/bands.h")

    def test_a_folder_of_no_room(self):
        self.assert_finds(includes.check(self.tree(painted__src__x_cpp="", codec__x_cpp="")), "belongs to no room")

    def test_headers_that_do_not_exist(self):
        self.assert_finds(includes.check(self.tree(plugin__x_cpp="#include <pimg/nowhere.h>")), "no folder has")


class Counts(InTree):
    def test_parameters_of_signatures(self):
        for signature, count in (("()", 0), ("(void)", 0), ("(int a)", 1), ("(std::map<int,int> a,int (*f)(int,int))", 2),
                                 ("(F f = g(1,2),int b) const", 2), ("(T a = {1,2})", 1)):
            self.assertEqual(counts.parameter_count(signature), count, signature)

    @unittest.skipUnless(shutil.which("ctags"), "Universal Ctags is not installed")
    def test_long_functions_and_many_parameters(self):
        body = "    f();\n" * counts.FUNCTION_LINES
        self.assert_finds(counts.check(self.tree(core__src__x_cpp=f"void long_one()\n{{\n{body}}}")), "long_one has")
        self.assertEqual(counts.check(self.tree(core__src__x_cpp="void f();", tests__x_cpp=f"void g()\n{{\n{body}}}")), [])
        many = ", ".join(f"int p{i}" for i in range(counts.PARAMETERS + 1))
        self.assert_finds(counts.check(self.tree(core__src__x_cpp=f"void wide({many})\n{{\n}}")), "wide has")

    @unittest.skipUnless(shutil.which("ctags"), "Universal Ctags is not installed")
    def test_parameters_of_public_functions(self):
        many = ", ".join(f"int p{i}" for i in range(counts.PUBLIC_PARAMETERS + 1))
        tree = self.tree(core__include__pimg__x_h=f"void wide({many});")
        self.assert_finds(counts.check(tree), "wide is public")

    def test_long_functions_of_python(self):
        body = "    pass\n" * counts.FUNCTION_LINES
        tree = self.tree(docs__x_py=f"def long_one():\n{body}")
        self.assert_finds(counts.check(tree), "long_one has")

    def test_long_files(self):
        self.assert_finds(counts.check(self.tree(core__src__x_cpp="\n" * counts.FILE_LINES)), "are allowed")

    def test_full_folders(self):
        files = {f"core__src__mesh__x{i}_{end}": "" for i in range(counts.FOLDER_FILES // 2) for end in ("cpp", "h")}
        self.assertEqual(counts.check(self.tree(**files, core__src__sweep__x_cpp="")), [])
        self.assert_finds(counts.check(self.tree(core__src__mesh__one_more_cpp="")), "sources in one folder")

    def test_licence_line(self):
        tree = self.tree(core__src__x_cpp="")
        open(os.path.join(self.root, "core/src/x.cpp"), "w", encoding="utf-8").close()
        self.assert_finds(counts.check(tree), "licence")

    def test_paths_of_one_machine(self):
        self.assert_finds(counts.check(self.tree(core__src__x_cpp="// see /ho" + "me/someone/notes")), "one machine")
        self.assertEqual(counts.check(self.tree(core__src__x_cpp="// see docs/home/page and /tmp/x")), [])

    def test_functions_that_differ_between_libraries(self):
        tree = self.tree(painting__src__x_cpp="float f(float x) { return std::pow(x, 2.0f); }",
                         filters__src__ops__x_cpp="float f(float x) { return std::pow(x, 2.0f); }",
                         core__src__mesh__x_cpp="float f(float x) { return std::sqrt(x) + elementary::exp(x); }")
        self.assert_finds(counts.check(tree), "elementary.h")

    def test_calls_that_versions_spell_differently(self):
        tree = self.tree(tools__x_cpp="bool f() { return OIIO::ImageBufAlgo::resize(a, b); }",
                         plugin__x_cpp="bool f() { return pimg::resize_picture(a, b); }")
        self.assert_finds(counts.check(tree), "oiio_compat.h")


class Mirror(InTree):
    def test_a_source_has_a_test_or_is_listed(self):
        tree = self.tree(core__src__mesh__mesh_cpp="", tests__core__mesh__other_cpp="", plugin__x_cpp="")
        self.assert_finds(mirror.check(tree), "has no tests/core/mesh/mesh_test.cpp")
        self.list_lines("core/src/mesh/mesh.cpp tests/core/mesh/other.cpp")
        self.assertEqual(mirror.check(Tree(self.root)), [])

    def test_the_list_is_true(self):
        self.tree(core__src__mesh__mesh_cpp="", tests__core__mesh__mesh_test_cpp="")
        for line, words in (("core/src/gone.cpp tests/core/mesh/mesh_test.cpp", "does not exist"),
                            ("core/src/mesh/mesh.cpp tests/core/mesh/mesh_test.cpp", "of its own now")):
            self.list_lines(line)
            self.assert_finds(mirror.check(Tree(self.root)), words)

    def list_lines(self, *lines):
        os.makedirs(os.path.join(self.root, "tests/checks"), exist_ok=True)
        with open(os.path.join(self.root, mirror.LIST), "w", encoding="utf-8") as file:
            file.write("# a comment\n" + "\n".join(lines) + "\n")


class Tidy(InTree):
    """Which sources clang-tidy looks at, and when again."""

    def setUp(self):
        super().setUp()
        self.made = self.tree(core__src__mesh__mesh_cpp="#include <pimg/mesh.h>", core__include__pimg__ring_h="",
                              core__src__mesh__hierarchy_cpp="#include <pimg/mesh.h>",
                              core__include__pimg__mesh_h="#include <pimg/ring.h>", codec__src__container_cpp="")
        self.sources = self.made.ending(".cpp")

    def key(self, path):
        tree = Tree(self.root)
        return tidy.key_of(tree, tidy.Closure(tree), path, "c++ -c")

    def test_a_header_asks_for_the_source_of_its_name_or_one_user(self):
        closure = tidy.Closure(self.made)
        for changed, chosen in (("core/include/pimg/mesh.h", ["core/src/mesh/mesh.cpp"]),
                                ("core/include/pimg/ring.h", ["core/src/mesh/hierarchy.cpp"]),
                                ("codec/src/container.cpp", ["codec/src/container.cpp"]), ("docs/format.md", [])):
            self.assertEqual(tidy.select(self.sources, closure, {changed}), chosen)

    def test_a_changed_header_changes_the_key_of_its_users_only(self):
        before = {path: self.key(path) for path in self.sources}
        self.tree(core__include__pimg__ring_h="struct Ring;")
        after = {path: self.key(path) for path in self.sources}
        self.assertEqual([path for path in self.sources if before[path] == after[path]], ["codec/src/container.cpp"])


if __name__ == "__main__":
    unittest.main()
