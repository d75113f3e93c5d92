#!/bin/bash -eu
# SPDX-License-Identifier: BSD-3-Clause
# OSS-Fuzz runs this in its container, with the compiler, its flags and the engine in the environment, and $OUT for the
# results. Only the targets that need the core and the codec are built there: they need no OpenImageIO.
cmake -G Ninja -S . -B "$WORK/build" -DCMAKE_BUILD_TYPE=None -DPIMG_CODEC_ONLY=ON -DPIMG_BUILD_FUZZERS=ON \
    -DPIMG_FUZZING_ENGINE="$LIB_FUZZING_ENGINE" -DCMAKE_CXX_FLAGS="$CXXFLAGS -DHWY_COMPILE_ONLY_STATIC"
for target in decoder roundtrip; do
    cmake --build "$WORK/build" --target "fuzz_$target"
    cp "$WORK/build/fuzz/fuzz_$target" "$OUT/"
    cp "fuzz/corpus/$target.zip" "$OUT/fuzz_${target}_seed_corpus.zip"
done
