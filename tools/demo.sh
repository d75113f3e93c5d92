#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# demo.sh PIMGTOOL FOLDER: tone-maps an HDR photograph and shows what a progressive image can do.
# The photograph (CC0, Greg Zaal, HDRI Haven) comes with Debian's package blender-data; when that is not installed it is
# taken out of the downloaded package without installing it.
set -euo pipefail

pimgtool=$1
folder=$2
photo=$folder/courtyard.exr
mkdir -p "$folder"

as_root() {
    if [[ $(id -u) -eq 0 ]]; then "$@"; else sudo "$@"; fi
}

take_photo_from_package() { # scratch folder
    local download=(apt-get -q -q -o APT::Sandbox::User=root download blender-data)
    # Without package lists, or with old ones, the first attempt fails.
    (cd "$1" && { "${download[@]}" 2>/dev/null || { as_root apt-get -q -q update && "${download[@]}"; }; })
    dpkg-deb --fsys-tarfile "$1"/blender-data_*.deb |
        tar -x -C "$1" --wildcards '*/studiolights/world/courtyard.exr'
    find "$1" -name courtyard.exr -exec cp {} "$photo" \;
}

fetch_photo() {
    local installed
    installed=$(find /usr/share/blender -path '*/studiolights/world/courtyard.exr' 2>/dev/null | head -n 1 || true)
    if [[ -n $installed ]]; then
        cp "$installed" "$photo"
    else
        echo "fetching a photograph from Debian's blender-data (31 MB)"
        local scratch
        scratch=$(mktemp -d)
        take_photo_from_package "$scratch" || true
        rm -rf "$scratch"
    fi
    [[ -s $photo ]] || { echo "demo.sh: no photograph: is Debian's archive reachable?" >&2; exit 1; }
}

made=()
picture() { # description, file name, arguments that make it...
    local description=$1 file=$folder/$2
    shift 2
    "$pimgtool" "$photo" "$@" -o "$file"
    made+=("$(printf '%-58s %s' "$description" "$file")")
}

[[ -s $photo ]] || fetch_photo

printf '\n== pictures\n'
oiiotool "$photo" --clamp:min=0:max=1 --ch R,G,B --colorconvert linear sRGB -d uint8 -o "$folder/exposure.png"
made+=("$(printf '%-58s %s' "the photograph at plain exposure" "$folder/exposure.png")")
picture "tone-mapped" tonemapped.png --hdr-compress
picture "tone-mapped, stronger, high dynamic range out" tonemapped.exr --hdr-compress:s0=0.05:beta=2 -d half
for percent in 0.5 2 10; do
    fraction=$(awk "BEGIN { print $percent / 100 }")
    picture "tone-mapped, then shown by $percent % of the vertices" "level_$percent.png" \
        --hdr-compress --level:fraction="$fraction"
    picture "its mesh" "mesh_$percent.png" --hdr-compress --wireframe:fraction="$fraction"
done
picture "feature low-pass, 2 % of the splits" lowpass.png --hdr-compress --feature-lowpass:fraction=0.02
picture "details enhanced twice" enhanced.png --hdr-compress --detail-enhance:gain=2

printf '\n== what it costs: building once, then %d settings of the same filter\n' 5
settings=()
for beta in 0.5 1 2 5 10; do
    settings+=(--dup --hdr-compress:beta="$beta" --pop)
done
"$pimgtool" --stats:format=json "$photo" --build "${settings[@]}" --raw -o "$folder/untouched.exr" |
    awk '/"width"/ { sub(/.*"width": */, ""); gsub(/[^0-9 ]/, ""); pixels = $1 * $2 / 1e6 }
         /"seconds"/ { gsub(/[",:]/, " "); for (i = 1; i < NF; ++i) seconds[$i] = $(i + 1) }
         END { printf "built in %.2f s (%.2f Mpixel), each setting after that in %.3f s\n",
                      seconds["build"], pixels, seconds["filter"] / 5 }'
rm "$folder/untouched.exr"

printf '\n== look at\n'
printf '%s\n' "${made[@]}"
