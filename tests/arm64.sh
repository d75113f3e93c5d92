#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# arm64.sh: cross-compiles core, codec and painting for 64-bit ARM in build/arm64, runs their tests under qemu-user, and
# compares the files that codec_conformance writes with those of build/release. Not part of the tests: emulation takes
# long, and it needs Debian's packages g++-aarch64-linux-gnu and qemu-user, and loads five for arm64 into build/arm64.
set -euo pipefail
cd "$(dirname "$0")/.."
[[ -x build/release/tests/codec_conformance ]] || { echo "arm64.sh: expected build/release: ./dev.sh build" >&2; exit 2; }
tree=$PWD/build/arm64
export PIMG_ARM64_ROOT=$tree/root

# A list of packages of its own: the machine's stays without arm64.
unpack_packages() {
    local apt=(-q -o "Dir::State::lists=$tree/apt/lists" -o "Dir::Cache=$tree/apt" -o APT::Architecture=arm64
        -o APT::Architectures=arm64 -o APT::Sandbox::User=root)
    mkdir -p "$tree/apt/lists/partial" "$tree/apt/archives/partial" "$PIMG_ARM64_ROOT"
    apt-get "${apt[@]}" update
    (cd "$tree/apt" && apt-get "${apt[@]}" download libhwy1 libhwy-dev libzstd1 libzstd-dev libgtest-dev)
    local package
    for package in "$tree"/apt/*.deb; do
        dpkg-deb -x "$package" "$PIMG_ARM64_ROOT"
    done
}

[[ -e $PIMG_ARM64_ROOT/usr/include/gtest ]] || unpack_packages
launcher=()
if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
cmake -S . -B "$tree" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPIMG_CODEC_ONLY=ON "${launcher[@]}" \
    -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/aarch64-linux-gnu.cmake" >"$tree/configure.log"
cmake --build "$tree" -j "${JOBS:-2}"

echo "== conformance files"
rm -rf "$tree/conformance"
mkdir -p "$tree/conformance/here" "$tree/conformance/arm64"
build/release/tests/codec_conformance "$tree/conformance/here"
env LD_LIBRARY_PATH="$PIMG_ARM64_ROOT/usr/lib/aarch64-linux-gnu" qemu-aarch64 -L /usr/aarch64-linux-gnu \
    "$tree/tests/codec_conformance" "$tree/conformance/arm64"
diff -r "$tree/conformance/here" "$tree/conformance/arm64"
echo "$(find "$tree/conformance/here" -type f | wc -l) files, the same bytes"

echo "== tests"
ctest --test-dir "$tree" --output-on-failure --timeout 3600 -R '^(core|codec|painting)\.'
