#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Compiles and runs the examples of docs/hosts.md, and of examples/, against an installed tree.
# Environment: CMAKE CC CXX CXXFLAGS GENERATOR INSTALLED LIBDIR SOURCE PYTHON OIIOTOOL GEGL, set by tests/CMakeLists.txt.
set -euo pipefail

code() { "$PYTHON" "$SOURCE/tests/docs/markdown_code.py" "$SOURCE/docs/hosts.md" "$1"; }

rm -rf host && mkdir host
export PKG_CONFIG_PATH="$INSTALLED/$LIBDIR/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}"

echo "== C++, find_package"
code cmake >host/CMakeLists.txt
code cpp >host/host.cpp
cat >>host/CMakeLists.txt <<END
add_executable(host_tile_server $SOURCE/examples/host_tile_server.cpp)
target_link_libraries(host_tile_server PRIVATE pimg::filters)
END
"$CMAKE" -S host -B host/build -G "$GENERATOR" -DCMAKE_PREFIX_PATH="$INSTALLED" >configure.log
"$CMAKE" --build host/build >build.log || { cat build.log; exit 1; }
host/build/host
host/build/host_tile_server

echo "== C, pkg-config"
code c >host/host.c
# shellcheck disable=SC2046  # flags are words
"$CC" -std=c99 -Wall -Wextra -Werror host/host.c -o host/host_c $(pkg-config --cflags --libs pimg-c)
LD_LIBRARY_PATH="$INSTALLED/$LIBDIR${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" host/host_c
if command -v nm >/dev/null; then
    strangers=$(nm -D --defined-only "$INSTALLED/$LIBDIR/libpimg.so" | awk '$3 !~ /^pimg_/')
    [[ -z $strangers ]] || { echo "libpimg exports $strangers"; exit 1; }
fi

if [[ -n $GEGL ]]; then
    echo "== GEGL"
    "$OIIOTOOL" --pattern constant:color=0.1,0.2,0.3 160x120 3 --pattern noise:type=uniform:min=0:max=20 160x120 3 --add \
        -d half -o in.exr
    code sh | sed "s#/usr/local#$INSTALLED#" >host/gegl.sh
    bash -e host/gegl.sh >gegl.log
    for result in compressed.exr painting.png smooth.exr; do
        [[ -s $result ]] || { echo "no $result"; exit 1; }
    done
fi
