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

echo "== pkg-config"
export PKG_CONFIG_PATH="$PWD/moved/$LIBDIR/pkgconfig"
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
