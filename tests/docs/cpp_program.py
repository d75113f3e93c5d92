# SPDX-License-Identifier: BSD-3-Clause
"""One program of the C++ examples of pages: cpp_program.py PROGRAM.cpp PAGE.md...

Those of a page see what its first one declares."""

import re
import sys

from markdown_code import all_blocks

INCLUDE = re.compile(r"^#include .*\n", re.MULTILINE)

HEAD = """#include <cstdio>
#include <cstdlib>
{includes}
static void check(const OIIO::ImageBuf& result)
{{
    if (result.initialized() && !result.has_error())
        return;
    std::fprintf(stderr, "%s\\n", result.geterror().c_str());
    std::exit(1);
}}
"""


def main(program, *pages):
    includes, functions = set(), []
    for page in pages:
        examples = [block for block in all_blocks(page) if block.language == "cpp"]
        body = []
        for block in examples:
            includes.update(INCLUDE.findall(block.code))
            code = f'#line {block.line} "{page}"\n' + INCLUDE.sub("\n", block.code)
            if re.search(r"\bdst\b", code):
                code += "check(dst);\n"
            body.append("{\n" + code + "}\n" if body else code)
        if not body:
            sys.exit(f"no C++ in {page}")
        functions.append("".join(body))
    with open(program, "w", encoding="utf-8") as file:
        file.write(HEAD.format(includes="".join(sorted(includes))))
        for number, body in enumerate(functions):
            file.write(f"\nstatic void page{number}()\n{{\n{body}}}\n")
        calls = "".join(f"    page{number}();\n" for number in range(len(functions)))
        file.write(f"\nint main()\n{{\n{calls}}}\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
