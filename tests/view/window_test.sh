#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What pimgview shows is what pimgtool writes, to one code; under Xvfb with Mesa's software OpenGL. One window plays all
# states, since starting takes longer than drawing.
set -euo pipefail

if [[ ${DISPLAY_OF_TEST:-} != "${DISPLAY:-}" || -z ${DISPLAY:-} ]]; then
    # shellcheck disable=SC2016
    exec xvfb-run -a -s "-screen 0 1280x1024x24" bash -c 'DISPLAY_OF_TEST=$DISPLAY exec bash "$0"' "$0"
fi
export LIBGL_ALWAYS_SOFTWARE=1 XDG_CONFIG_HOME=$PWD/config XDG_DATA_HOME=$PWD/data

cat >pictures.py <<'PY'
import numpy, OpenImageIO as oiio
def write(name, pixels, kind):
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind)
    out = oiio.ImageOutput.create(name)
    assert out.open(name, spec) and out.write_image(pixels) and out.close()
random = numpy.random.default_rng(1)
y, x = numpy.mgrid[0:240, 0:320]
light = numpy.exp2(6 * numpy.sin(x / 40) + y / 60) * (1 + 0.1 * random.random((240, 320)))
rgb = numpy.stack([light, light * 0.7, light * 0.4 + 0.01], -1).astype(numpy.float32)
if __name__ == "__main__":
    write("scene.exr", rgb, "half")
    write("photo.png", (255 * numpy.clip(rgb / 64, 0, 1) ** 0.45).astype(numpy.uint8), "uint8")
    # Of one pixel, of rows too long for a texture, and with NaN.
    write("one.exr", numpy.full((1, 1, 3), 0.5, numpy.float32), "float")
    long = numpy.linspace(0, 2, 30000 * 40 * 3, dtype=numpy.float32).reshape(40, 30000, 3)
    write("long.exr", long, "half")
    rgb[3, 100:200] = numpy.nan
    rgb[4, 5] = numpy.inf
    write("broken.exr", rgb, "float")
PY
cat >compare.py <<'PY'
"""The middle of screenshots against the pictures pimgtool wrote: shot1.png expected1.png shot2.png ..."""
import sys, numpy, OpenImageIO as oiio
def compare(shot_name, expected_name):
    shot, expected = (oiio.ImageBuf(name).get_pixels(oiio.FLOAT) * 255 for name in (shot_name, expected_name))
    if expected.shape[2] == 1:
        expected = numpy.repeat(expected, 3, 2)
    top, left = ((shot.shape[i] - expected.shape[i] + 1) // 2 for i in (0, 1))
    seen = shot[top:top + expected.shape[0], left:left + expected.shape[1], :3]
    worst = numpy.abs(seen - expected[:, :, :3]).max()
    assert worst <= 1.01, f"{shot_name}: {worst} codes from {expected_name}"
    outside = shot[:top - 1].std() if top > 1 else 0
    assert outside < 1e-3, f"{shot_name}: something is drawn beside the picture"
for i in range(1, len(sys.argv), 2):
    compare(sys.argv[i], sys.argv[i + 1])
PY
"$PYTHON" pictures.py

operations=("" "--hdr-compress" "--hdr-compress:beta=30:saturation=0.5" "--level:fraction=0.02" "--feature-lowpass:strength=0.2"
    "--hdr-compress --detail-enhance:gain=3" "--mosaic:tiles=200" "--ink" "--paint:strokes=unwanted.svg")
states=() wanted=() pairs=()
for file in scene.exr photo.png; do
    for i in "${!operations[@]}"; do
        name=$i.$file.png
        states+=(--script "$file ${operations[i]} --view:panels=0:zoom=1" --screenshot "shot$name")
        # shellcheck disable=SC2206
        wanted+=("$file" ${operations[i]/:strokes=*/} -d uint8 -o "expected$name")
        pairs+=("shot$name" "expected$name")
    done
done
# The source beside a result, whole and as far as the split line goes, which is outside of the picture here.
for look in show=source show=split:split=1; do
    states+=(--script "scene.exr --hdr-compress --view:panels=0:zoom=1:$look" --screenshot "$look.png")
    pairs+=("$look.png" "expected0.scene.exr.png")
done
"$PIMGTOOL" "${wanted[@]}"
"$PIMGVIEW" "${states[@]}" --size 400x300
"$PYTHON" compare.py "${pairs[@]}"
if [[ -e unwanted.svg ]]; then
    echo "looking at a picture wrote a file" >&2
    exit 1
fi

# The same in textures smaller than the picture; then odd pictures; then saving, of strokes, too, and what else there is to see.
odd=(--script "scene.exr --hdr-compress --view:panels=0:zoom=1" --screenshot tiles.png)
for file in one.exr long.exr broken.exr; do
    odd+=(--script "$file --hdr-compress --view:clipped=1" --screenshot "$file.png")
done
odd+=(--script "scene.exr --level:fraction=0.1 --view:mesh=500:piece=1:histogram=1:waveform=1:show=difference" --screenshot overlays.png
    --script "scene.exr --paint:max=20 -o strokes.svg --view:light=1:exposure=1:gamma=1.2" --screenshot strokes.png
    --script "scene.exr --level:fraction=0.1 -o saved.pimg" --screenshot saved.png)
"$PIMGVIEW" "${odd[@]}" --size 800x500 --tile 100
"$PYTHON" compare.py tiles.png expected1.scene.exr.png
grep -q "<svg" strokes.svg
"$PIMGTOOL" --info saved.pimg | grep -q "full profile"

fails() { # pattern arguments...
    local pattern=$1
    shift
    if "$PIMGVIEW" "$@" >out.txt 2>&1; then
        echo "expected an error: $*" >&2
        exit 1
    fi
    grep -q "$pattern" out.txt && [[ $(wc -l <out.txt) == 1 ]] || { cat out.txt >&2 && exit 1; }
}
fails "nowhere.exr" nowhere.exr --screenshot shot.png
head -c 500 scene.exr >cut.exr
fails "cut.exr" cut.exr --screenshot shot.png
fails "expected a filter whose strokes" --script "scene.exr --level -o none.svg" --screenshot shot.png
fails "bata" scene.exr --script "--hdr-compress:bata=1"
fails "unknown option" --purple
fails "64 or more" scene.exr --tile 1
fails "has the option" scene.exr --script "--hdr-compress" --measure bata
fails "after the last one" scene.exr --screenshot a.png --script "--level"
MESA_GL_VERSION_OVERRIDE=2.1 fails "no window with OpenGL 3.2" scene.exr --screenshot shot.png
DISPLAY="" WAYLAND_DISPLAY="" fails "error: no display" scene.exr
"$PIMGVIEW" --help | grep -q "split line"
