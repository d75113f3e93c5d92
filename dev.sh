#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Set-up, build, tests and demo on Debian 12: ./dev.sh help
set -euo pipefail
cd "$(dirname "$0")"

readonly build=build/release
readonly jobs=2

# For every configuration: the compiler cache, if there is one.
launcher=()
if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi

# Everything comes from Debian 12. openimageio-tools brings oiiotool, without which CMake's OpenImageIO package fails.
packages=(
    g++ cmake ninja-build pkg-config
    libopenimageio-dev openimageio-tools libopencolorio-dev libimath-dev libopenexr-dev libopencv-dev
    libhwy-dev liblcms2-dev libpugixml-dev libzstd-dev libboost-dev
    python3-dev python3-zstandard python3-numpy python3-openimageio pybind11-dev
    python3-venv python3-matplotlib python3-markdown
    libgegl-dev gegl
    libglfw3-dev libimgui-dev libgl-dev libgl1-mesa-dri
    libgtest-dev libbenchmark-dev libcgal-dev
    clang-format clang-tidy universal-ctags
    xvfb xauth xdotool binutils groff-base slurm-wlm munge blender-data
)

usage() {
    cat <<'END'
usage: ./dev.sh COMMAND

  setup   install the Debian packages that are missing (needs root or sudo; nothing to do the second time)
  build   setup, then configure and build everything in build/release
  test    setup, build with warnings as errors, run every test
  check   setup, then what needs no run: the rules of the house (tests/checks/house.py), clang-format, and clang-tidy on
          the sources that differ from a commit, remembered in ~/.cache; check [--minutes N] [--all] [--odr] [COMMIT]
          --minutes  clang-tidy begins with no further source after that time, and says which are left
          --all      clang-tidy on every source, and --odr
          --odr      a build for -Wodr in build/odr: no type is defined twice
          --deep     clang's static analyser instead of the other checks of clang-tidy, five times as slow
          COMMIT     is where this branch left main, or the one before the last on main itself
  fuzz    setup, build the fuzz targets with clang, run each for its share of a time: fuzz MINUTES [TARGET...]. It starts
          from fuzz/corpus and what earlier runs found; build/fuzz/crashes receives inputs that are findings.
          --quick  20 s for each: those of the codec instrumented, and the tests of core and codec in the same build;
                   the others blindly in the release build
  sanitize  setup, then the tests of core, codec and painting and the replay of all kept inputs with AddressSanitizer,
          UndefinedBehaviorSanitizer and the assertions of libstdc++
          --threads [FOLDER]  with ThreadSanitizer; with FOLDER, where an OpenImageIO is installed that was itself built
                     with it, the tests that call filters and the plugin from many threads, too
          --memory   with MemorySanitizer, the replay alone
  package setup, make the Debian packages in build/package and look them over with lintian
  demo    setup, build, tone-map a real HDR photograph and more, in build/demo
  gallery setup, build, make every figure of the paper and more in docs/gallery (some minutes)
  docs    setup, make the documentation site in build/docs
  bench   setup, build, measure against the peers and print the table of docs/performance.md;
          $PIMG_BENCH_PICTURE names a picture, which is tone-mapped, too, if it is OpenEXR; arguments go to pimg_bench
  clean   remove build/
  help    this text
END
}

say() { printf '\n== %s\n' "$*"; }

missing_packages() {
    local package
    for package in "${packages[@]}"; do
        [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || echo "$package"
    done
}

setup() {
    if ! command -v dpkg-query >/dev/null; then
        echo "dev.sh: not a Debian system; expecting its packages' equivalents: ${packages[*]}" >&2
        return
    fi
    local missing
    mapfile -t missing < <(missing_packages)
    if [[ ${#missing[@]} -eq 0 ]]; then
        return
    fi
    say "installing ${missing[*]}"
    local as_root=()
    if [[ $(id -u) -ne 0 ]]; then
        as_root=(sudo)
    fi
    "${as_root[@]}" apt-get update -q
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
}

configure() { # cmake options...
    cmake --preset release ${launcher[@]+"${launcher[@]}"} "$@" >"$build.configure.log" || {
        cat "$build.configure.log"
        return 1
    }
}

compile() { # targets...
    cmake --build "$build" -j "$jobs" --target "$@"
}

run_build() {
    setup
    say "building in $build"
    mkdir -p build
    configure -DPIMG_BUILD_BENCH=OFF "$@"
    compile all
}

run_test() {
    run_build -DPIMG_WERROR=ON
    say "testing"
    ctest --test-dir "$build" --output-on-failure -j "$jobs"
}

# The commit since which sources count as changed.
base_commit() {
    local base
    base=$(git merge-base HEAD origin/main 2>/dev/null || git merge-base HEAD main 2>/dev/null || true)
    if [[ -z $base || $base == "$(git rev-parse HEAD)" ]]; then
        base=$(git rev-parse --verify -q HEAD~1 || git rev-parse HEAD)
    fi
    echo "$base"
}

check_odr() {
    say "the one-definition rule, in build/odr"
    cmake --preset odr >build/odr.configure.log || { cat build/odr.configure.log; return 1; }
    cmake --build build/odr -j "$jobs" --target pimgtool pimg.imageio pimg_c
}

run_check() { # options as in usage()
    local odr='' base='' tidy=()
    while [[ $# -gt 0 ]]; do
        case $1 in
        --all) odr=1 tidy+=(--all) ;;
        --odr) odr=1 ;;
        --deep) tidy+=(--deep) ;;
        --minutes) tidy+=(--minutes "${2:?}") && shift ;;
        -*) usage >&2 && exit 2 ;;
        *) base=$1 ;;
        esac
        shift
    done
    setup
    mkdir -p build
    say "the rules of the house"
    /usr/bin/python3 -B tests/checks/house_test.py
    /usr/bin/python3 -B tests/checks/house.py
    say "clang-format"
    find . \( -name build -o -name '.?*' \) -prune -o \( -name '*.cpp' -o -name '*.h' -o -name '*.c' \) -print0 |
        xargs -0 -n 50 -P "$jobs" clang-format --dry-run -Werror
    say "clang-tidy"
    cmake --preset release -B build/check -DPIMG_BUILD_BENCH=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >build/check.log ||
        { cat build/check.log; return 1; }
    /usr/bin/python3 -B tests/checks/tidy.py build/check --base "${base:-$(base_commit)}" ${tidy[@]+"${tidy[@]}"}
    if [[ -n $odr ]]; then
        check_odr
    fi
}

readonly fuzz_targets=(decoder roundtrip stroke_file build colour options metadata plugin command_line shot gain_map)

build_fuzz() { # tree, option or '', targets of the build...
    local tree=$1 option=$2
    shift 2
    packages+=(clang libclang-rt-14-dev)
    setup
    say "building the fuzz targets in $tree"
    mkdir -p build
    cmake --preset fuzz -B "$tree" ${launcher[@]+"${launcher[@]}"} ${option:+"$option"} >"$tree.configure.log" ||
        { cat "$tree.configure.log"; return 1; }
    cmake --build "$tree" -j "$jobs" --target "$@"
}

fuzz_one() { # tree, target, seconds
    local tree=$PWD/$1 target=$2 seconds=$3 top=$PWD
    local found=$tree/found/$target crashes=$tree/crashes/$target log=$tree/$target.log
    mkdir -p "$found" "$crashes" "$tree/fuzz/corpus/$target"
    (cd "$tree/fuzz/scratch/$target" && LSAN_OPTIONS=suppressions=$top/fuzz/leaks.supp:print_suppressions=0 \
        "$tree/fuzz/fuzz_$target" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -max_len=8192 \
        -artifact_prefix="$crashes/" -print_final_stats=1 "$found" "$tree/fuzz/corpus/$target") >"$log" 2>&1 || true
    echo "$target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") executions in $seconds s"
    if [[ -n $(ls "$crashes") ]] || ! grep -q "^stat::number_of_executed_units" "$log"; then
        grep -vE '^#|DICT|NEW_FUNC|dictionary|# Uses' "$log" | tail -50
        echo "dev.sh: findings of $target in $crashes" >&2
        return 1
    fi
}

run_fuzz() { # minutes, targets...
    local minutes=${1:?"fuzz: expected a number of minutes"} seconds target
    shift
    local targets=("$@")
    if [[ ${#targets[@]} -eq 0 ]]; then
        targets=("${fuzz_targets[@]}")
    fi
    build_fuzz build/fuzz '' "${targets[@]/#/fuzz_}"
    seconds=$(awk -v m="$minutes" -v n="${#targets[@]}" 'BEGIN { print int(60 * m / n + 0.5) }')
    say "$seconds s each"
    for target in "${targets[@]}"; do
        fuzz_one build/fuzz "$target" "$seconds"
    done
}

fuzz_blindly() { # target, seconds; in the release build
    local target=$1 seconds=$2 tree=$PWD/$build/fuzz inputs=()
    local scratch=$tree/scratch/$target log=$PWD/$build/$target.blind.log
    mapfile -t inputs < <(ls -d "$tree/corpus/$target" "$PWD/fuzz/crashes/$target" 2>/dev/null)
    rm -f "$scratch/finding"
    if ! (cd "$scratch" && "$tree/fuzz_${target}_replay" --seconds "$seconds" "${inputs[@]}") >"$log" 2>&1; then
        tail -50 "$log"
        echo "dev.sh: finding of $target: $scratch/finding" >&2
        return 1
    fi
    echo "$target, blindly: $(tail -1 "$log") in $seconds s"
}

# Calls a function for each word, as many at a time as there are jobs, and fails if one call did.
for_each() { # function, words...
    local call=$1 word pid failed=0 pids=()
    shift
    for word; do
        if [[ ${#pids[@]} -eq $jobs ]]; then
            wait "${pids[0]}" || failed=1
            pids=("${pids[@]:1}")
        fi
        "$call" "$word" &
        pids+=($!)
    done
    for pid in "${pids[@]}"; do
        wait "$pid" || failed=1
    done
    return "$failed"
}

readonly quick_tree=build/fuzz-quick quick_targets=(decoder roundtrip)

fuzz_quickly() { # target
    if [[ " ${quick_targets[*]} " == *" $1 "* ]]; then
        fuzz_one "$quick_tree" "$1" 20
    else
        fuzz_blindly "$1" 20
    fi
}

# 20 seconds for each target: those of the codec instrumented, and the tests of core and codec in the same build; the
# others, whose libraries take minutes to instrument, blindly in the release build.
run_fuzz_quick() {
    local failed=0
    build_fuzz "$quick_tree" -DPIMG_CODEC_ONLY=ON "${quick_targets[@]/#/fuzz_}" tests_of_core tests_of_codec
    configure -DPIMG_BUILD_BENCH=OFF -DPIMG_WERROR=ON
    compile fuzz_replays
    say "20 s for each target"
    for_each fuzz_quickly "${fuzz_targets[@]}" || failed=1
    say "tests of core and codec with AddressSanitizer and UndefinedBehaviorSanitizer"
    ctest --test-dir "$quick_tree" --output-on-failure -j "$jobs" -R '^(core|codec)\.' || failed=1
    return "$failed"
}

run_sanitize() { # --threads [folder], --memory
    local preset=asan options=(-DPIMG_CODEC_ONLY=ON) targets=(all) tests=.
    case ${1:-} in
    '') ;;
    --threads)
        preset=tsan
        if [[ -n ${2:-} ]]; then
            options=(-DPIMG_CODEC_ONLY=OFF -DCMAKE_PREFIX_PATH="$2")
            targets=(tests_of_{core,codec,painting,plugin} filters_base_threads_test pimg.imageio)
            tests='^(core|codec|painting)\.|^filters\.base\.threads$|^plugin\.plugin$'
        fi
        ;;
    --memory) preset=msan ;;
    *) usage >&2 && exit 2 ;;
    esac
    local tree=build/sanitize-$preset
    if [[ $preset == msan ]]; then
        packages+=(clang libclang-rt-14-dev)
        targets=(fuzz_{decoder,roundtrip}_replay)
    fi
    setup
    mkdir -p build
    say "building in $tree"
    cmake --preset "$preset" -B "$tree" "${options[@]}" ${launcher[@]+"${launcher[@]}"} >"build/$preset.log" ||
        { cat "build/$preset.log"; return 1; }
    cmake --build "$tree" -j "$jobs" --target "${targets[@]}"
    say "running what was built"
    if [[ $preset == msan ]]; then
        "$tree/fuzz/fuzz_decoder_replay" fuzz/crashes/decoder "$tree/fuzz/corpus/decoder"
        "$tree/fuzz/fuzz_roundtrip_replay" "$tree/fuzz/corpus/roundtrip"
    else
        TSAN_OPTIONS=suppressions=$PWD/tests/tsan.supp ctest --test-dir "$tree" --output-on-failure -j "$jobs" -R "$tests"
    fi
}

run_package() {
    packages+=(dpkg-dev file fakeroot lintian)
    setup
    local tree=build/package epoch
    epoch=$(git log -1 --format=%ct 2>/dev/null || date +%s)
    export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$epoch}
    say "building the packages in $tree"
    mkdir -p build
    cmake -S . -B "$tree" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DPIMG_PACKAGING=ON \
        -DPIMG_WERROR=ON -DPIMG_BUILD_TESTS=OFF -DPIMG_BUILD_BENCH=OFF -DPIMG_BUILD_PYTHON=ON -DPIMG_BUILD_GEGL=ON \
        -DPIMG_BUILD_VIEW=ON -DPIMG_BUILD_OFX=OFF -DPIMG_INSTALL_PYTHONDIR=lib/python3/dist-packages ${launcher[@]+"${launcher[@]}"} >"$tree.configure.log" ||
        { cat "$tree.configure.log"; return 1; }
    cmake --build "$tree" -j "$jobs"
    (cd "$tree" && rm -f ./*.deb && cpack -G DEB >cpack.log) || { cat "$tree/cpack.log"; return 1; }
    say "lintian"
    lintian --tag-display-limit 0 --fail-on error "$tree"/*.deb
    ls -l "$tree"/*.deb
}

run_demo() {
    setup
    say "building pimgtool in $build"
    mkdir -p build
    configure
    compile pimgtool
    tools/demo.sh "$build/tools/pimgtool" build/demo
}

run_gallery() {
    setup
    say "building pimgtool in $build"
    mkdir -p build
    configure
    compile pimgtool
    say "making the figures"
    /usr/bin/python3 tools/gallery.py "$build/tools/pimgtool" build/gallery docs/gallery
    echo "docs/gallery/index.html"
}

run_docs() {
    setup
    /usr/bin/python3 docs/make_site.py build/docs
    echo "build/docs/index.html"
}

run_bench() {
    packages+=(libmeshoptimizer-dev pfstools pfstmo luminance-hdr)
    setup
    say "building the benchmarks in $build"
    mkdir -p build
    configure -DPIMG_BUILD_BENCH=ON
    compile pimg_bench pimgtool
    say "measuring"
    /usr/bin/python3 bench/report.py "$build/bench/pimg_bench" "$build/tools/pimgtool" build/growth.svg "$@"
}

command=${1:-help}
shift || true
case $command in
setup) setup && echo "all packages are installed" ;;
build) run_build ;;
test) run_test ;;
check) run_check "$@" ;;
package) run_package ;;
fuzz) if [[ ${1:-} == --quick ]]; then run_fuzz_quick; else run_fuzz "$@"; fi ;;
sanitize) run_sanitize "$@" ;;
demo) run_demo ;;
gallery) run_gallery ;;
docs) run_docs ;;
bench) run_bench "$@" ;;
clean) rm -rf build ;;
help | -h | --help) usage ;;
*)
    usage >&2
    exit 2
    ;;
esac
