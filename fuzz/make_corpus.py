#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Packs a folder of inputs as a corpus: the smallest ones, in an archive that is the same each time.

usage: make_corpus.py FOLDER ARCHIVE.zip

Minimise the folder first: fuzz_TARGET -merge=1 FOLDER FOUND...
"""
import hashlib
import pathlib
import sys
import zipfile

MOST_BYTES, MOST_FILES = 40_000, 150  # of a target: what a repository of sources can carry


def main(folder, archive):
    inputs = sorted({path.read_bytes() for path in pathlib.Path(folder).iterdir()}, key=lambda data: (len(data), data))
    total = 0
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as packed:
        for data in inputs:
            total += len(data)
            if total > MOST_BYTES or len(packed.namelist()) == MOST_FILES:
                break
            name = hashlib.sha1(data).hexdigest()[:12]
            packed.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), data, zipfile.ZIP_DEFLATED)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
