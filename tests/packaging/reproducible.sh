#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# reproducible.sh: makes the Debian packages of the commit that is checked out twice, in two folders, the second time
# without ccache, and compares them byte by byte. Not part of the tests: it takes two builds.
set -euo pipefail
top=$(cd "$(dirname "$0")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
first=$scratch/a second=$scratch/another/folder/with/a/longer/name

for folder in "$first" "$second"; do
    git clone --quiet "$top" "$folder"
    git -C "$folder" checkout --quiet "$(git -C "$top" rev-parse HEAD)"
done
"$first/dev.sh" package >"$scratch/first.log" 2>&1 || { tail -30 "$scratch/first.log"; exit 1; }
CCACHE_DISABLE=1 "$second/dev.sh" package >"$scratch/second.log" 2>&1 || { tail -30 "$scratch/second.log"; exit 1; }

different=0
for package in "$first"/build/package/*.deb; do
    if cmp -s "$package" "$second/build/package/${package##*/}"; then
        echo "$(sha256sum <"$package" | cut -c1-16) ${package##*/}: the same bytes"
    else
        echo "${package##*/}: two builds differ" >&2
        different=1
    fi
done
exit "$different"
