#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# coverage.sh: which lines of the codec its tests and the kept inputs of its fuzz targets reach, by llvm-cov (Debian: clang,
# llvm), in build/coverage. Only the codec is instrumented; the rest is that of build/release. Prints a line for each
# source; build/coverage/html/index.html shows every line.
set -euo pipefail
cd "$(dirname "$0")/../.."
core=$PWD/build/release/core
[[ -e $core/libpimg_core.a ]] || { echo "coverage.sh: expected build/release: ./dev.sh build" >&2; exit 2; }
tree=$PWD/build/coverage
version=$(clang++ -dumpversion)
mkdir -p "$tree"

flags=(-std=c++17 -O1 -fprofile-instr-generate -fcoverage-mapping -Icodec/include -Icodec/src -Icore/include -Icore/src
    "-I$core/include" -Itests -I.)
objects=()
for source in $(cd codec/src && find . -name '*.cpp' | sort); do
    object=$tree/$(echo "${source#./}" | tr / _).o
    if [[ ! -e $object || codec/src/$source -nt $object ]]; then
        clang++ "${flags[@]}" -c "codec/src/$source" -o "$object"
    fi
    objects+=("$object")
done
program() { # its name, its sources, what else it is linked with...
    local name=$1 sources
    read -r -a sources <<<"$2"
    shift 2
    clang++ "${flags[@]}" "${sources[@]}" "${objects[@]}" "$core/libpimg_core.a" -lhwy -lzstd -pthread "$@" -o "$tree/$name"
}
program codec_test tests/codec/codec_test.cpp -lgtest -lgtest_main
program conformance tests/codec/conformance.cpp
program damage tests/codec/damage.cpp
program decoder "fuzz/replay.cpp fuzz/decoder.cpp"
program roundtrip "fuzz/replay.cpp fuzz/roundtrip.cpp"

rm -rf "$tree/run" "$tree/html"
mkdir -p "$tree/run/conformance" "$tree/run/decoder" "$tree/run/roundtrip"
for target in decoder roundtrip; do
    cmake -E chdir "$tree/run/$target" cmake -E tar x "$PWD/fuzz/corpus/$target.zip"
    if [[ -d fuzz/crashes/$target ]]; then
        cp fuzz/crashes/"$target"/* "$tree/run/$target"
    fi
done
cd "$tree/run"
export LLVM_PROFILE_FILE=$tree/run/%p.profraw
"$tree/codec_test" --gtest_brief=1
"$tree/conformance" conformance
"$tree/damage" 100 1
"$tree/decoder" decoder
"$tree/roundtrip" roundtrip

"llvm-profdata-${version%%.*}" merge -sparse ./*.profraw -o codec.profdata
cd ../../..
shown=("$tree/codec_test" -object "$tree/conformance" -object "$tree/damage" -object "$tree/decoder"
    -object "$tree/roundtrip" "-instr-profile=$tree/run/codec.profdata")
"llvm-cov-${version%%.*}" show "${shown[@]}" -format=html "-output-dir=$tree/html" codec/src codec/include >/dev/null
"llvm-cov-${version%%.*}" report "${shown[@]}" -show-region-summary=0 -show-branch-summary=0 codec/src codec/include
