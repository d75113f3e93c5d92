#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What pimgview shows is what pimgtool writes, to one code; under Xvfb with Mesa's software OpenGL.
set -euo pipefail

export LIBGL_ALWAYS_SOFTWARE=1 XDG_CONFIG_HOME=$PWD/config XDG_DATA_HOME=$PWD/data
view() { xvfb-run -a -s "-screen 0 1280x1024x24" "$PIMGVIEW" "$@"; }

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
write("scene.exr", rgb, "half")
write("photo.png", (255 * numpy.clip(rgb / 64, 0, 1) ** 0.45).astype(numpy.uint8), "uint8")
PY
cat >compare.py <<'PY'
"""The middle of a screenshot against the picture pimgtool wrote."""
import sys, numpy, OpenImageIO as oiio
shot, expected = (oiio.ImageBuf(name).get_pixels(oiio.FLOAT) * 255 for name in sys.argv[1:3])
if expected.shape[2] == 1:
    expected = numpy.repeat(expected, 3, 2)
top, left = ((shot.shape[i] - expected.shape[i] + 1) // 2 for i in (0, 1))
seen = shot[top:top + expected.shape[0], left:left + expected.shape[1], :3]
worst = numpy.abs(seen - expected[:, :, :3]).max()
assert worst <= 1.01, f"{sys.argv[1]}: {worst} codes"
outside = shot[:top - 1].std() if top > 1 else 0
assert outside < 1e-3, f"{sys.argv[1]}: something is drawn beside the picture"
PY
"$PYTHON" pictures.py

for tile in 0 100; do
    for operations in "" "--hdr-compress" "--hdr-compress:beta=30:saturation=0.5" "--level:fraction=0.02" \
        "--feature-lowpass:strength=0.2" "--hdr-compress --detail-enhance:gain=3" "--mosaic:tiles=200" "--ink"; do
        for file in scene.exr photo.png; do
            [[ $tile == 0 || $operations == --hdr-compress ]] || continue
            # shellcheck disable=SC2086
            "$PIMGTOOL" $file $operations -d uint8 -o expected.png
            view $file --script "$operations --view:panels=0:zoom=1" --screenshot shot.png --size 400x300 --tile $tile
            echo "$file $operations"
            "$PYTHON" compare.py shot.png expected.png
        done
    done
done

# Random keys, clicks, drags and turns of the wheel. PIMG_RANDOM_EVENTS asks for more than a test of a minute can play.
for seed in 1 2; do
    view scene.exr photo.png --script "--hdr-compress --detail-enhance" --random-events "${PIMG_RANDOM_EVENTS:-300}" --seed $seed --size 800x600
done

# A user's hands, where xdotool is there: drags the picture, zooms, splits, undoes, and closes the window; then closes it
# while a large picture is being built.
cat >hands.sh <<'SH'
set -euo pipefail
"$PIMGVIEW" "$1" --script "--hdr-compress" --size 800x600 &
window=$(xdotool search --sync --onlyvisible --name pimgview | head -1)
xdotool windowfocus "$window" || true
if [[ $2 == play ]]; then
    xdotool mousemove --window "$window" 600 300 mousedown 1 mousemove_relative 60 40 mouseup 1 click --repeat 3 4 click 5
    for key in s d d b m p ctrl+z ctrl+y F1 F1; do xdotool key --window "$window" "$key"; done
fi
before=$SECONDS
for _ in 1 2 3 4 5; do
    xdotool key --window "$window" q 2>/dev/null || break
    sleep 0.2
done
wait $!
[[ $((SECONDS - before)) -lt 20 ]] || { echo "closing took $((SECONDS - before)) s" >&2 && exit 1; }
SH
if command -v xdotool >/dev/null; then
    "$PYTHON" - <<'PY'
import numpy
from pictures import write
write("large.exr", numpy.random.default_rng(2).random((2000, 2500, 3), numpy.float32), "half")
PY
    export PIMGVIEW
    xvfb-run -a -s "-screen 0 1280x1024x24" bash hands.sh scene.exr play
    xvfb-run -a -s "-screen 0 1280x1024x24" bash hands.sh large.exr close
fi

# Pictures of one pixel, of one long row, and with NaN.
"$PYTHON" - <<'PY'
import numpy, OpenImageIO as oiio
from pictures import write
write("one.exr", numpy.full((1, 1, 3), 0.5, numpy.float32), "float")
long = numpy.linspace(0, 2, 30000 * 40 * 3, dtype=numpy.float32).reshape(40, 30000, 3)
long[3, 100:200] = numpy.nan
long[4, 5] = numpy.inf
write("long.exr", long, "float")
PY
for file in one.exr long.exr; do
    view $file --script "--hdr-compress" --screenshot shot.png --size 400x300
done

fails() { # pattern arguments...
    local pattern=$1
    shift
    if view "$@" >out.txt 2>&1; then
        echo "expected an error: $*" >&2
        exit 1
    fi
    grep -q "$pattern" out.txt || { cat out.txt >&2 && exit 1; }
}
fails "nowhere.exr" nowhere.exr --screenshot shot.png
head -c 500 scene.exr >cut.exr
fails "cut.exr" cut.exr --screenshot shot.png
fails "bata" scene.exr --script "--hdr-compress:bata=1"
fails "unknown option" --purple
if env -u DISPLAY -u WAYLAND_DISPLAY "$PIMGVIEW" scene.exr >out.txt 2>&1; then exit 1; fi
grep -q "pimgview: error: no display" out.txt
"$PIMGVIEW" --help | grep -q "split line"
