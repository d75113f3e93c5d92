# SPDX-License-Identifier: BSD-3-Clause
"""Checks the rules of the house that need no compiler: includes, counts, tests that mirror the sources.

usage: house.py [FOLDER]    FOLDER is the top of the tree, the one this script is in unless given
"""
import os
import sys

import counts
import includes
import mirror
from sources import Tree


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    tree = Tree(sys.argv[1] if len(sys.argv) > 1 else os.path.join(here, "..", ".."))
    findings = sorted(includes.check(tree) + counts.check(tree) + mirror.check(tree))
    for finding in findings:
        print(finding)
    print(counts.summary(tree))
    print(f"{len(findings)} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
