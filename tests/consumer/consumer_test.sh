#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the build, moves the tree, and uses it through find_package and through pkg-config.
# Environment: CMAKE CXX CXXFLAGS GENERATOR BUILD LIBDIR VERSION, set by tests/CMakeLists.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

check_version() { # program
    local said
    said=$("$1")
    [[ $said == "$VERSION" ]] || { echo "$1 says version '$said', expected '$VERSION'"; exit 1; }
}

rm -rf installed moved project
"$CMAKE" --install "$BUILD" --prefix "$PWD/installed" >install.log
mv installed moved
if grep -rlF "$BUILD" moved/"$LIBDIR"/cmake moved/"$LIBDIR"/pkgconfig moved/include; then
    echo "the files above name the build folder"
    exit 1
fi

grep -q "^.TH PIMGTOOL" moved/share/man/man1/pimgtool.1
grep -q "complete -F _pimgtool" moved/share/bash-completion/completions/pimgtool

echo "== find_package"
"$CMAKE" -S "$here" -B project -G "$GENERATOR" -DCMAKE_PREFIX_PATH="$PWD/moved" >configure.log
"$CMAKE" --build project >build.log || { cat build.log; exit 1; }
for program in use_core use_0_1 use_filters use_c; do
    check_version project/$program
done

echo "== another OpenImageIO than the one it was built with is turned away"
mkdir -p other
echo 'set(OpenImageIO_VERSION 9.9.9)' >other/OpenImageIOConfig.cmake
echo 'add_library(OpenImageIO::OpenImageIO INTERFACE IMPORTED)' >>other/OpenImageIOConfig.cmake
if "$CMAKE" -S "$here" -B refused -G "$GENERATOR" -DCMAKE_PREFIX_PATH="$PWD/moved" -DOpenImageIO_DIR="$PWD/other" \
    >refused.log 2>&1; then
    echo "pimgConfig.cmake took OpenImageIO 9.9.9"
    exit 1
fi
grep -q "pimg::filters was built with OpenImageIO .*, found: '9.9.9'" refused.log || { cat refused.log; exit 1; }

echo "== pkg-config"
export PKG_CONFIG_PATH="$PWD/moved/$LIBDIR/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}"
pkg-config --print-requires pimg | grep -q "^OpenImageIO < "
[[ $(pkg-config --modversion pimg) == "$VERSION" && $(pkg-config --modversion pimg-c) == "$VERSION" ]]
# shellcheck disable=SC2046,SC2086  # flags are words
"$CXX" -std=c++17 $CXXFLAGS "$here/use_core.cpp" -o use_core $(pkg-config --cflags --libs pimg)
check_version ./use_core
# shellcheck disable=SC2046,SC2086  # OpenImageIO's headers take seconds: only linked again
"$CXX" $CXXFLAGS project/CMakeFiles/use_filters.dir/use_filters.cpp.o -o use_filters $(pkg-config --libs pimg)
check_version ./use_filters

echo "== <pimg/pimg.hpp> has all headers of C++, and compiles alone"
for header in moved/include/pimg/*.h; do
    [[ $header == */pimg.h ]] || grep -q "<pimg/$(basename "$header")>" moved/include/pimg/pimg.hpp ||
        { echo "pimg.hpp lacks $header"; exit 1; }
done
echo "#include <pimg/pimg.hpp>" >header.cpp
# shellcheck disable=SC2046,SC2086
"$CXX" -std=c++17 $CXXFLAGS -fsyntax-only $(pkg-config --cflags pimg) header.cpp

echo "== headers that need no OpenImageIO compile alone"
for header in $(grep -L OpenImageIO moved/include/pimg/*.h); do
    echo "#include <pimg/$(basename "$header")>" >header.cpp
    # shellcheck disable=SC2086
    "$CXX" -std=c++17 $CXXFLAGS -fsyntax-only -Wall -Wextra -Werror -Imoved/include header.cpp ||
        { echo "not self-contained: $header"; exit 1; }
done

echo "== machines that there are no libraries for"
refused() { # a macro, what it is there, what the error says
    printf '#include <cstdint>\n#undef %s\n#define %s %s\n#include <pimg/abi.h>\n' "$1" "$1" "$2" >machine.cpp
    # shellcheck disable=SC2086
    if "$CXX" -std=c++17 $CXXFLAGS -fsyntax-only -w -Imoved/include machine.cpp 2>refused.log; then
        echo "abi.h: expected an error that says '$3'"
        exit 1
    fi
    grep -q "$3" refused.log || { cat refused.log; exit 1; }
}
refused __BYTE_ORDER__ __ORDER_BIG_ENDIAN__ "pimg needs a little-endian machine"
refused UINTPTR_MAX 0xffffffffu "pimg needs a 64-bit machine"
