#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# same_with_clang.sh PICTURE...: builds pimgtool with g++ and with clang++ (Debian: clang) and compares the files and the
# tone-mapped pixels both make. Not part of the tests: it takes two builds.
set -euo pipefail
cd "$(dirname "$0")/.."
[[ $# -gt 0 ]] || { sed -n 3,4p "$0" >&2; exit 2; }
pictures=("$@")
for compiler in g++ clang++; do
    cmake -S . -B "build/$compiler" -G Ninja -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_COMPILER=$compiler" >/dev/null
    cmake --build "build/$compiler" -j 2 --target pimgtool >/dev/null
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
different=0
for picture in "${pictures[@]}"; do
    for compiler in g++ clang++; do
        "build/$compiler/tools/pimgtool" "$picture" -o "$scratch/$compiler.pimg"
        "build/$compiler/tools/pimgtool" "$picture" --hdr-compress --raw -o "$scratch/$compiler.exr"
    done
    cmp "$scratch/g++.pimg" "$scratch/clang++.pimg" || different=1
    idiff -fail 0 -warn 0 "$scratch/g++.exr" "$scratch/clang++.exr" || different=1
done
exit "$different"
