#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# clean_root.sh [FOLDER]: makes a small Debian 12 in FOLDER (a scratch folder unless given) with debootstrap, installs the
# packages of build/package there with what they depend on, and uses them as a user would: with stock oiiotool, Python,
# GEGL and pkg-config. Needs root and a Debian mirror. Not part of the tests.
set -euo pipefail
cd "$(dirname "$0")/../.."
packages=(build/package/*.deb)
[[ -e ${packages[0]} ]] || { echo "clean_root.sh: expected packages in build/package: ./dev.sh package" >&2; exit 2; }
root=${1:-$(mktemp -d)/root}
mirror=${PIMG_DEBIAN_MIRROR:-http://deb.debian.org/debian}

[[ -e $root/etc/debian_version ]] || debootstrap --variant=minbase bookworm "$root" "$mirror"
in_root() { chroot "$root" /usr/bin/env -i HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"; }
mkdir -p "$root/pimg"
cp "${packages[@]}" "$root/pimg/"
# What a user's programs are: oiiotool, Python's OpenImageIO, GEGL's command, a compiler.
in_root sh -c "apt-get -q -y --no-install-recommends install /pimg/*.deb openimageio-tools python3-openimageio gegl \
    g++ pkg-config file" >"$root/install.log" 2>&1 || { tail -30 "$root/install.log"; exit 1; }

in_root bash -euo pipefail -c '
    cd /pimg && mkdir -p work && cd work
    echo "== pimgtool, with no variable set"
    python3 -c "
import numpy, OpenImageIO as oiio
ramp = numpy.linspace(0, 40, 96 * 64 * 3, dtype=numpy.float32).reshape(64, 96, 3)
buffer = oiio.ImageBuf(ramp)
buffer.write(\"in.exr\")
"
    pimgtool in.exr --hdr-compress -o out.png
    pimgtool in.exr -o in.pimg
    man -w pimgtool >/dev/null 2>&1 || test -e /usr/share/man/man1/pimgtool.1.gz
    test -e /usr/share/bash-completion/completions/pimgtool
    grep -q pimg /usr/share/mime/packages/pimg.xml
    file -m /usr/share/pimg/pimg.magic in.pimg | grep "Progressive image"
    pimgview --help >help.txt
    grep -q Exec=pimgview /usr/share/applications/pimgview.desktop
    echo "== thumbnails, with no variable set"
    pimg-thumbnailer in.pimg thumbnail.png 48
    iinfo thumbnail.png | grep "48 x *32"
    echo "== Python, with no variable set"
    python3 -c "
import pimg, OpenImageIO as oiio
print(pimg.build(oiio.ImageBuf(\"in.exr\")).hdr_compress(beta=4).spec().width, oiio.ImageBuf(\"in.pimg\").spec().width)
"
    echo "== GEGL, with no variable set"
    gegl in.exr -o gegl.exr -- pimg:hdr-compress beta=4
    echo "== stock oiiotool, in a login shell, which reads /etc/profile.d"
    bash -lc "iinfo in.pimg && oiiotool in.pimg -o back.exr && idiff in.exr back.exr"
    echo "== C and C++, by pkg-config"
    echo "#include <pimg/pimg.h>" >c.cpp && echo "int main() { return pimg_version()[0] == 0; }" >>c.cpp
    g++ c.cpp -o c $(pkg-config --cflags --libs pimg-c) && ./c
    echo "#include <pimg/simplify.h>" >cpp.cpp
    echo "int main() { pimg::Hierarchy h; return int(h.levels()); }" >>cpp.cpp
    g++ -std=c++17 cpp.cpp -o cpp $(pkg-config --cflags --libs pimg) && ./cpp
    echo "== removed without a trace"
    cd / && dpkg --purge gegl-plugin-pimg libpimg-dev libpimg0 openimageio-plugin-pimg pimg-tools python3-pimg >purge.log 2>&1
    for left in /usr/lib/x86_64-linux-gnu/pimg /etc/profile.d/pimg.sh /usr/lib/python3/dist-packages/pimg; do
        if [[ -e $left ]]; then
            echo "clean_root.sh: $left stayed"
            exit 1
        fi
    done
'
echo "clean_root.sh: all of it works"
