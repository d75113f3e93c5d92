# SPDX-License-Identifier: BSD-3-Clause
"""The rules of CONTRIBUTING.md that can be counted: functions, parameters, files, folders, licence lines, paths."""
import ast
import collections
import json
import os
import re
import shutil
import subprocess

from sources import CPP, SCRIPTS, Finding

# From its first line to its closing brace. A test may tell its story in one go and is not counted.
FUNCTION_LINES = 50
UNCOUNTED_FUNCTIONS = ("tests/", "bench/")
# Of what users call, and of everything else. OpenImageIO and C set signatures of their own.
PUBLIC_PARAMETERS = 5
PARAMETERS = 8
FILE_LINES = 600
FOLDER_FILES = 20

# Longer than FILE_LINES, with the reason.
LONG_FILES = {
    "tests/codec/reader.py": "the independent reader of the format is one file that can be taken away",
}

# Functions that differ in the last bit from one C library to another, and where they would decide bytes, meshes and strokes.
LIBRARY_FUNCTION = re.compile(r"std::(?:sin|cos|tan|a?sin|acos|atan2?|exp2?|expm1|log(?:2|10|1p)?|pow|cbrt|hypot)\(")
SAME_BITS = ("core/", "codec/", "painting/")
# Rounds log2 to whole numbers, from which the exact values are far enough away.
LIBRARY_USERS = {"codec/src/entropy/symbol_coder.cpp"}

# What versions of OpenImageIO spell differently is called in one header, and by the test host, which uses nothing of ours.
VERSIONED = re.compile(r"ImageBufAlgo::resize\(|(?:ImageCache|TextureSystem)::create\(|createDisplayTransform\(|getDefaultViewName\(")
VERSIONED_USERS = {"filters/include/pimg/detail/oiio_compat.h", "ofx/test_host/effect.cpp"}

# Folders of one machine; a path into them means nothing elsewhere.
MACHINE = re.compile(r"(?<![\w.}~-])/(?:home|root|work|Users|mnt)/\w")


def parameter_count(signature):
    """Of a C++ signature as ctags prints it."""
    inner = signature[signature.find("(") + 1:signature.rfind(")")].strip()
    if inner in ("", "void"):
        return 0
    depth, count = 0, 1
    for previous, letter in zip(" " + inner, inner):
        if letter in "(<[{":
            depth += 1
        elif letter in ")]}" or (letter == ">" and previous != "-"):
            depth -= 1
        elif letter == "," and depth == 0:
            count += 1
    return count


def cpp_functions(tree, paths, kinds="f"):
    """(path, line, name, lines, parameters) of every function that is defined; with kind `p`, that is declared."""
    command = ["ctags", "--languages=C,C++", "--langmap=C++:+.h", f"--kinds-C++={kinds}", f"--kinds-C={kinds}",
               "--fields=NFneS", "--output-format=json", "-L", "-", "-f", "-"]
    output = subprocess.run(command, cwd=tree.root, input="\n".join(paths), text=True, check=True,
                            stdout=subprocess.PIPE).stdout
    for line in output.splitlines():
        tag = json.loads(line)
        lines = tag.get("end", tag["line"]) - tag["line"] + 1
        yield tag["path"], tag["line"], tag["name"], lines, parameter_count(tag.get("signature", "()"))


def python_functions(tree, paths):
    for path in paths:
        for node in ast.walk(ast.parse(tree.text(path))):
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                arguments = node.args
                names = [a.arg for a in arguments.posonlyargs + arguments.args + arguments.kwonlyargs]
                yield (path, node.lineno, node.name, node.end_lineno - node.lineno + 1,
                       len(names) - (names[:1] in (["self"], ["cls"])))


def functions(tree):
    """All that are defined in the tree; those of C++ only where Universal Ctags is installed."""
    found = list(python_functions(tree, tree.ending(".py")))
    if shutil.which("ctags"):
        found += cpp_functions(tree, tree.ending(*CPP))
    return found


def declarations(tree):
    """All functions of the installed headers of C++."""
    headers = [path for path in tree.ending(".h") if is_public(path)]
    return list(cpp_functions(tree, headers, "fp")) if shutil.which("ctags") and headers else []


def is_public(path):
    return "/include/pimg/" in path and "/detail/" not in path and not path.startswith("capi/")


def check_functions(found, declared):
    findings = []
    for path, line, name, lines, parameters in found:
        if lines > FUNCTION_LINES and not path.startswith(UNCOUNTED_FUNCTIONS):
            findings.append(Finding(path, line, f"{name} has {lines} lines; {FUNCTION_LINES} are allowed"))
        if parameters > PARAMETERS:
            findings.append(Finding(path, line, f"{name} has {parameters} parameters; {PARAMETERS} are allowed"))
    for path, line, name, _, parameters in declared:
        if parameters > PUBLIC_PARAMETERS:
            text = f"{name} is public and has {parameters} parameters; {PUBLIC_PARAMETERS} are allowed"
            findings.append(Finding(path, line, text))
    return findings


def check_files(tree):
    findings = []
    for path in tree.ending(*CPP, *SCRIPTS):
        lines = tree.lines(path)
        if len(lines) > FILE_LINES and path not in LONG_FILES:
            findings.append(Finding(path, len(lines), f"{len(lines)} lines; {FILE_LINES} are allowed"))
        if not any("SPDX-License-Identifier: BSD-3-Clause" in line for line in lines[:3]):
            findings.append(Finding(path, 1, "the licence line is missing: SPDX-License-Identifier: BSD-3-Clause"))
    for path in LONG_FILES:
        if path in tree.paths and len(tree.lines(path)) <= FILE_LINES:
            findings.append(Finding(path, 1, "is short enough now: strike it from tests/checks/counts.py"))
    return findings


def check_folders(tree):
    files = collections.Counter(os.path.dirname(path) for path in tree.ending(*CPP, *SCRIPTS))
    return [Finding(folder, 1, f"{count} sources in one folder; {FOLDER_FILES} are allowed")
            for folder, count in sorted(files.items()) if count > FOLDER_FILES]


def check_paths(tree):
    findings = []
    for path in tree.ending(*CPP, *SCRIPTS, ".txt", ".cmake", ".in", ".md", ".json", ".toml"):
        for number, line in enumerate(tree.lines(path), 1):
            if MACHINE.search(line):
                findings.append(Finding(path, number, "names a folder of one machine"))
    return findings


def check_library_functions(tree):
    findings = []
    for path in tree.ending(*CPP):
        if path.startswith(SAME_BITS) and path not in LIBRARY_USERS:
            for number, line in enumerate(tree.lines(path), 1):
                if LIBRARY_FUNCTION.search(line):
                    findings.append(Finding(path, number, "use pimg/detail/elementary.h: the same bits everywhere"))
    return findings


def check_versioned_calls(tree):
    return [Finding(path, number, "use pimg/detail/oiio_compat.h: other versions of OpenImageIO spell this differently")
            for path in tree.ending(*CPP) if path not in VERSIONED_USERS
            for number, line in enumerate(tree.lines(path), 1) if VERSIONED.search(line)]


def check(tree):
    return (check_functions(functions(tree), declarations(tree)) + check_files(tree) + check_folders(tree)
            + check_paths(tree) + check_library_functions(tree) + check_versioned_calls(tree))


def summary(tree):
    """One line of figures."""
    found = [f for f in functions(tree) if f[0].endswith(CPP) and not f[0].startswith(UNCOUNTED_FUNCTIONS)]
    if not found:
        return "functions of C++ not counted: Universal Ctags is not installed"
    lengths = sorted(f[3] for f in found)
    return (f"{len(found)} functions of C++ outside tests: {lengths[len(lengths) // 2]} lines in the middle, "
            f"{lengths[len(lengths) * 9 // 10]} at nine tenths, {lengths[-1]} at most; "
            f"{max(f[4] for f in found)} parameters at most")
