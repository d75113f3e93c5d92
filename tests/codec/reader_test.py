#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares tests/codec/reader.py with the library: reader_test.py CODEC_CONFORMANCE_PROGRAM"""
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import reader  # noqa: E402


def main():
    compared = refused = 0
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[1], folder], check=True)
        for path in sorted(pathlib.Path(folder).glob('*.pimg')):
            data = path.read_bytes()
            for raw in sorted(path.parent.glob(path.stem + '.*raw')):
                cut = raw.name.split('.')[1]
                size = int(cut[3:]) if cut.startswith('cut') else len(data)
                if reader.read(data[:size]).samples != raw.read_bytes():
                    print('%s differs when read up to byte %d' % (path.name, size))
                    return 1
                compared += 1
            for bit in range(0, 8 * len(data), max(1, 8 * len(data) // 60)):
                bad = bytearray(data)
                bad[bit // 8] ^= 1 << bit % 8
                try:
                    p = reader.read(bytes(bad))
                    if p.exact and p.samples != (path.parent / (path.stem + '.raw')).read_bytes():
                        print('%s: bit %d changes the picture unnoticed' % (path.name, bit))
                        return 1
                except reader.Bad:
                    refused += 1
    print('%d pictures equal, %d damaged files refused' % (compared, refused))
    return compared == 0


if __name__ == '__main__':
    sys.exit(main())
